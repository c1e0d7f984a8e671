//! Which nodes does the scene show, and where do they stand?

use super::document::{Node, SceneEntry};
use super::reader::Reader;
use crate::base::error::Result;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::fmt::Display;

/// No node.
const NONE: u32 = u32::MAX;
/// How far a rotation's squared length may lie from 1: digits that an exporter cut off.
const UNIT: f64 = 0.01;

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

    /// The nodes of the scene that carry a mesh, a light or a camera, parents before children.
    pub(super) fn placed(&self) -> Result<Vec<Placed>> {
        let (scene_id, scene) = self.scene()?;
        let nodes = &self.document.nodes;
        let parents = self.parents()?;
        let mut seen = vec![false; nodes.len()];
        let mut waiting = Vec::new();
        for (i, &root) in scene.nodes.iter().enumerate().rev() {
            let refuse = |text: &dyn Display| self.wrong(format_args!("scenes[{scene_id}].nodes[{i}]"), text);
            let Some(seen) = seen.get_mut(root as usize) else {
                return Err(self.no_such("node", root, nodes.len(), &format_args!("scenes[{scene_id}].nodes[{i}]")));
            };
            if std::mem::replace(seen, true) {
                return Err(refuse(&format_args!("node {root} is named twice")));
            }
            if parents[root as usize] != NONE {
                let parent = parents[root as usize];
                return Err(refuse(&format_args!(
                    "node {root} is a child of node {parent}; a scene names nodes without a parent"
                )));
            }
            waiting.push((root, DAffine3::IDENTITY));
        }
        let mut placed = Vec::new();
        // Every node has one parent at most and the roots have none: no node comes twice, however deep it lies.
        while let Some((id, above)) = waiting.pop() {
            let node = &nodes[id as usize];
            let to_world = above * self.transform(id, node)?;
            waiting.extend(node.children.iter().rev().map(|&child| (child, to_world)));
            if node.mesh.is_some() || node.camera.is_some() || node.extensions.light.is_some() {
                placed.push(Placed { id, to_world });
            }
        }
        Ok(placed)
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
