//! What would a camera's near and far plane cut away?
//!
//! Here nothing is: a scene is seen from the camera's place on, as far as it goes. Where that shows something that
//! viewers of the file do not, it is told.

use crate::base::polygon::above;
use crate::scene::camera::Camera;
use glam::{DVec3, Vec3};

/// The planes of a camera, in metres before it.
#[derive(Clone, Copy)]
pub(super) struct Planes {
    pub(super) near: f64,
    pub(super) far: f64,
}

impl Planes {
    /// What should be said of triangles that the camera sees before its near or beyond its far plane.
    pub(super) fn note(&self, camera: &Camera, triangles: impl Iterator<Item = [Vec3; 3]>) -> Option<String> {
        let Self { near, far } = *self;
        let (width, height) = camera.resolution();
        let steep = (0.5 * camera.fov().to_radians()).tan();
        let wide = steep * f64::from(width) / f64::from(height);
        let [right, up, forward] = [camera.right(), camera.up(), camera.forward()];
        let (mut before, mut beyond) = (0, 0);
        for corners in triangles {
            let corners = corners.map(|corner| {
                let away = (corner - camera.position()).as_dvec3();
                DVec3::new(away.dot(right), away.dot(up), away.dot(forward))
            });
            let depths = corners.map(|corner| corner.z);
            let (least, most) = (depths[0].min(depths[1]).min(depths[2]), depths[0].max(depths[1]).max(depths[2]));
            if most <= 0.0 || (least >= near && most <= far) {
                continue;
            }
            // Within the picture's edges, which meet in the eye.
            let mut seen = corners.to_vec();
            for edge in [DVec3::new(1.0, 0.0, wide), DVec3::new(-1.0, 0.0, wide)] {
                seen = half(&seen, edge, 0.0);
            }
            for edge in [DVec3::new(0.0, 1.0, steep), DVec3::new(0.0, -1.0, steep)] {
                seen = half(&seen, edge, 0.0);
            }
            before +=
                usize::from(half(&seen, DVec3::NEG_Z, -near).iter().any(|corner| corner.z > 0.0 && corner.z < near));
            beyond += usize::from(far.is_finite() && half(&seen, DVec3::Z, far).iter().any(|corner| corner.z > far));
        }
        let told = [(before, "before", "znear", near), (beyond, "beyond", "zfar", far)];
        let told: Vec<String> = told
            .iter()
            .filter(|(count, ..)| *count > 0)
            .map(|(count, side, name, at)| format!("{count} {side} its `{name}` of {at} m"))
            .collect();
        (!told.is_empty()).then(|| {
            let told = told.join(" and ");
            format!("triangles within the camera's view that viewers of the file cut away: {told}; seen here")
        })
    }
}

/// What of a convex polygon lies where `axis` has at least `least`.
fn half(polygon: &[DVec3], axis: DVec3, least: f64) -> Vec<DVec3> {
    above(polygon, |corner| corner.dot(axis) - least)
}
