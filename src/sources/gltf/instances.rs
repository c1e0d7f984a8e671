//! Where does a node that is instanced stand?
//!
//! `EXT_mesh_gpu_instancing`: the node, and here all that is below it, once for each of its transforms, which come
//! before its own.

use super::accessor::{Numbers, ROTATIONS, VECTORS};
use super::document::Instancing;
use super::reader::Reader;
use crate::base::error::Result;
use glam::{DAffine3, DQuat, DVec3, Vec3};

impl Reader<'_> {
    /// The transforms of a node's instances.
    pub(super) fn instances(&self, id: u32, instancing: &Instancing) -> Result<Vec<DAffine3>> {
        let attributes = &instancing.attributes;
        let field = |name: &str| format!("nodes[{id}].extensions.EXT_mesh_gpu_instancing.attributes.{name}");
        let read = |name: &str, accessor: Option<u32>, form| {
            accessor.map(|accessor| self.numbers(accessor, &field(name), form)).transpose()
        };
        let translations = read("TRANSLATION", attributes.translation, &VECTORS)?;
        let rotations = read("ROTATION", attributes.rotation, &ROTATIONS)?;
        let scales = read("SCALE", attributes.scale, &VECTORS)?;
        let all = [("TRANSLATION", &translations), ("ROTATION", &rotations), ("SCALE", &scales)];
        let counts = all.map(|(name, of)| of.as_ref().map(|of| (name, of.len())));
        let Some((_, count)) = counts.into_iter().flatten().next() else {
            return Err(self.wrong(field(""), "is empty: TRANSLATION, ROTATION or SCALE is asked for"));
        };
        if let Some((name, other)) = counts.into_iter().flatten().find(|(_, other)| *other != count) {
            let text = format_args!("{other} of them are given beside {count}; as many of each are asked for");
            return Err(self.wrong(field(name), text));
        }
        let vector = |of: &Option<Numbers>, name: &str, i: usize, default: Vec3| {
            let vector = of.as_ref().map_or(default, |of| Vec3::from_array(of.get(i)));
            if vector.is_finite() {
                return Ok(vector.as_dvec3());
            }
            Err(self.wrong(field(name), format_args!("number {i} is {vector}; finite numbers are asked for")))
        };
        let transform = |i: usize| -> Result<DAffine3> {
            let [x, y, z, w] = rotations.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |of| of.get(i)).map(f64::from);
            let rotation = DQuat::from_xyzw(x, y, z, w);
            // Shorts and bytes are no unit vectors to the last digit.
            if !(rotation.length_squared() > 0.9 && rotation.length_squared() < 1.1) {
                let text = format_args!("number {i} is {rotation}; a quaternion of length 1 is asked for");
                return Err(self.wrong(field("ROTATION"), text));
            }
            let scale: DVec3 = vector(&scales, "SCALE", i, Vec3::ONE)?;
            let translation = vector(&translations, "TRANSLATION", i, Vec3::ZERO)?;
            Ok(DAffine3::from_scale_rotation_translation(scale, rotation.normalize(), translation))
        };
        (0..count).map(transform).collect()
    }
}
