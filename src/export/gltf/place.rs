//! Our places and directions in glTF's axes.

use ::gltf::json::scene::UnitQuaternion;
use glam::{DQuat, DVec3, Vec3};

/// A point of ours in glTF's axes, exactly.
pub(super) fn place(p: Vec3) -> [f32; 3] {
    // 0 - y: an exact negation that makes no -0.
    [p.x, p.z, 0.0 - p.y]
}

/// A direction of ours in glTF's axes.
pub(super) fn turned(d: DVec3) -> DVec3 {
    DVec3::new(d.x, d.z, -d.y)
}

/// A turn as the quaternion of a node.
pub(super) fn rotation(turn: DQuat) -> UnitQuaternion {
    UnitQuaternion(turn.normalize().as_quat().to_array())
}
