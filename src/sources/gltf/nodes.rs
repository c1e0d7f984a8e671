//! Which nodes does the scene show, and where do they stand?

use super::document::{Node, SceneEntry};
use super::reader::Reader;
use crate::base::error::Result;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// No node.
const NONE: u32 = u32::MAX;
/// How far a rotation's squared length may lie from 1: digits that an exporter cut off.
const UNIT: f64 = 0.01;

/// Instances that any file may have; one with more bytes in its buffers may have as many as those.
const LEAST_INSTANCES: usize = 1 << 16;

/// A node that carries something, in its place.
pub(super) struct Placed {
    /// Its number in the document.
    pub(super) id: u32,
    /// From its coordinates to the scene's, both as glTF has them: +y up.
    pub(super) to_world: DAffine3,
}

/// A glTF vector in our axes, with no negative zero: +z is up.
pub(super) fn turned(v: DVec3) -> DVec3 {
    DVec3::new(v.x, -v.z, v.y) + DVec3::ZERO
}

/// Whether every coordinate is a number within `most` of 0; the extremes of a vector pass over what is none.
pub(super) fn within(v: DVec3, most: f64) -> bool {
    v.abs().cmple(DVec3::splat(most)).all()
}

impl<'a> Reader<'a> {
    /// The scene that the file shows: the one it names, or its first.
    pub(super) fn scene(&self) -> Result<(usize, &'a SceneEntry<'a>)> {
        let (id, scenes) = (self.document.scene.unwrap_or(0), &self.document.scenes);
        if scenes.is_empty() {
            return Err(self.wrong("scenes", "is missing or empty: a scene with its nodes is asked for"));
        }
        let scene = scenes.get(id as usize).ok_or_else(|| self.no_such("scene", id, scenes.len(), &"scene"))?;
        Ok((id as usize, scene))
    }

    /// The nodes of the scene that carry a mesh, a light or a camera, parents before children, each once for each of its
    /// instances. What was decided here is told in `notes`.
    pub(super) fn placed(&self, notes: &mut Vec<String>) -> Result<Vec<Placed>> {
        let roots = self.roots(notes)?;
        let nodes = &self.document.nodes;
        let bytes: usize = self.buffers.iter().map(|buffer| buffer.len()).sum();
        let most = 2 * nodes.len() + bytes.max(LEAST_INSTANCES);
        let mut placed = Vec::new();
        let (mut total, mut hidden, mut together) = (0, 0, 0);
        let mut waiting: Vec<(u32, DAffine3)> =
            roots.into_iter().rev().map(|root| (root, DAffine3::IDENTITY)).collect();
        // Every node has one parent at most and the roots are below none: but for instances no node comes twice, however
        // deep it lies.
        while let Some((id, above)) = waiting.pop() {
            let node = &nodes[id as usize];
            if node.extensions.visibility.as_ref().is_some_and(|visibility| visibility.visible == Some(false)) {
                hidden += 1;
                continue;
            }
            let to_world = above * self.transform(id, node)?;
            let mut places = vec![to_world];
            if let Some(instancing) = &node.extensions.instancing {
                places = self.instances(id, instancing)?.into_iter().map(|instance| to_world * instance).collect();
            }
            total += places.len() * (1 + node.children.len());
            if total > most {
                let text =
                    format!("with those of this node there are more than {most} instances, the most for this file");
                return Err(self.wrong(format_args!("nodes[{id}].extensions.EXT_mesh_gpu_instancing"), text));
            }
            let carries = node.mesh.is_some() || node.camera.is_some() || node.extensions.light.is_some();
            let more = !node.children.is_empty() || node.extensions.light.is_some();
            together += usize::from(node.extensions.instancing.is_some() && more);
            if carries {
                placed.extend(places.iter().map(|&to_world| Placed { id, to_world }));
            }
            for &place in places.iter().rev() {
                waiting.extend(node.children.iter().rev().map(|&child| (child, place)));
            }
        }
        if hidden > 0 {
            notes.push(format!("nodes that the file hides: {hidden}; left out with all below them"));
        }
        if together > 0 {
            notes.push(format!(
                "instanced nodes with lights or children: {together}; those stand at each instance as the mesh does"
            ));
        }
        Ok(placed)
    }

    /// The nodes that the scene names, without those that it shows below others of them.
    fn roots(&self, notes: &mut Vec<String>) -> Result<Vec<u32>> {
        let (scene_id, scene) = self.scene()?;
        let nodes = &self.document.nodes;
        let parents = self.parents()?;
        let mut seen = vec![false; nodes.len()];
        for (i, &root) in scene.nodes.iter().enumerate() {
            let field = format_args!("scenes[{scene_id}].nodes[{i}]");
            let Some(seen) = seen.get_mut(root as usize) else {
                return Err(self.no_such("node", root, nodes.len(), &field));
            };
            if std::mem::replace(seen, true) {
                return Err(self.wrong(field, format_args!("node {root} is named twice")));
            }
        }
        let mut below = vec![false; nodes.len()];
        let mut waiting = scene.nodes.clone();
        while let Some(id) = waiting.pop() {
            for &child in &nodes[id as usize].children {
                if !std::mem::replace(&mut below[child as usize], true) {
                    waiting.push(child);
                }
            }
        }
        let roots: Vec<u32> = scene.nodes.iter().copied().filter(|&root| !below[root as usize]).collect();
        let orphans = roots.iter().filter(|&&root| parents[root as usize] != NONE).count();
        if orphans > 0 {
            notes.push(format!(
                "nodes that the scene names without their parents: {orphans}; shown as viewers do, without the parents' \
                 transforms"
            ));
        }
        if roots.len() < scene.nodes.len() {
            let twice = scene.nodes.len() - roots.len();
            notes.push(format!("nodes that the scene names beside one above them: {twice}; shown once, below it"));
        }
        Ok(roots)
    }

    /// The parent of each node; fails if one has two, or is its own ancestor.
    fn parents(&self) -> Result<Vec<u32>> {
        let nodes = &self.document.nodes;
        let mut parents = vec![NONE; nodes.len()];
        for (id, node) in (0..).zip(nodes.iter()) {
            for &child in &node.children {
                let field = || format!("nodes[{id}].children");
                let Some(parent) = parents.get_mut(child as usize) else {
                    return Err(self.no_such("node", child, nodes.len(), &field()));
                };
                if *parent != NONE {
                    let text = format!("node {child} is a child of node {parent} already; one parent is asked for");
                    return Err(self.wrong(field(), text));
                }
                *parent = id;
            }
        }
        // Upwards from each node, until a root or a node that is known to have one.
        let mut rooted = vec![false; nodes.len()];
        for start in 0..nodes.len() as u32 {
            let upwards =
                || std::iter::successors(Some(start), |&id| Some(parents[id as usize]).filter(|&id| id != NONE));
            let mut steps = 0;
            for id in upwards().take_while(|&id| !rooted[id as usize]) {
                steps += 1;
                if steps > nodes.len() {
                    let text = format!("node {id} is its own ancestor; a tree is asked for");
                    return Err(self.wrong(format_args!("nodes[{id}].children"), text));
                }
            }
            upwards().take(steps).for_each(|id| rooted[id as usize] = true);
        }
        Ok(parents)
    }

    fn transform(&self, id: u32, node: &Node) -> Result<DAffine3> {
        if let Some(m) = &node.matrix {
            if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
                let text = "the last row must be 0, 0, 0, 1: columns follow one another";
                return Err(self.wrong(format_args!("nodes[{id}].matrix"), text));
            }
            let column = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
            return Ok(DAffine3 {
                matrix3: DMat3::from_cols(column(0), column(4), column(8)),
                translation: column(12),
            });
        }
        let rotation = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
        if (rotation.length_squared() - 1.0).abs() > UNIT {
            let text = format!("{rotation} is given; a quaternion of length 1 is asked for");
            return Err(self.wrong(format_args!("nodes[{id}].rotation"), text));
        }
        Ok(DAffine3::from_scale_rotation_translation(
            DVec3::from_array(node.scale.unwrap_or([1.0; 3])),
            rotation.normalize(),
            DVec3::from_array(node.translation.unwrap_or([0.0; 3])),
        ))
    }
}
