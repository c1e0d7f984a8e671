//! Which triangles belong together?

use crate::scene::Scene;
use crate::scene::light::Shape;
use glam::Vec3;
use std::collections::HashMap;

/// A triangle's corners, in metres.
pub(super) type Corners = [Vec3; 3];

/// The surfaces of each material that has any, by its index.
pub(super) fn by_material(scene: &Scene) -> Vec<(usize, Vec<Corners>)> {
    let mut meshes: Vec<(usize, Vec<Corners>)> = (0..scene.materials().len()).map(|i| (i, Vec::new())).collect();
    for surface in scene.surfaces() {
        meshes[surface.material as usize].1.push(surface.corners);
    }
    meshes.retain(|(_, triangles)| !triangles.is_empty());
    meshes
}

/// The triangle lights of each distinct radiance, in the order of the table.
pub(super) fn by_radiance(scene: &Scene) -> Vec<(Vec3, Vec<Corners>)> {
    let mut meshes: Vec<(Vec3, Vec<Corners>)> = Vec::new();
    let mut known = HashMap::new();
    for light in scene.lights() {
        let Shape::Triangle { corners, radiance } = light.shape() else { continue };
        let mesh = *known.entry(radiance.to_array().map(f32::to_bits)).or_insert_with(|| {
            meshes.push((radiance, Vec::new()));
            meshes.len() - 1
        });
        meshes[mesh].1.push(corners);
    }
    meshes
}

/// The name of each light's group; `lights` where it has none.
pub(super) fn groups(scene: &Scene) -> Vec<&str> {
    let mut names = vec!["lights"; scene.lights().len()];
    for group in scene.groups() {
        names[group.range.start as usize..group.range.end as usize].fill(&group.name);
    }
    names
}
