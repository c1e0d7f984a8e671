//! Which direction does each pixel look in?

use crate::base::error::{Error, Result};
use glam::{DQuat, DVec3, Vec3};

/// Most pixels of a film, twice those of 3840 x 2160: a comparison holds several films and about 80 bytes a pixel.
const MOST_PIXELS: u64 = 1 << 24;

/// A pinhole camera that looks through pixel centres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    position: Vec3,
    forward: DVec3,
    right: DVec3,
    down: DVec3,
    width: u32,
    height: u32,
}

impl Camera {
    /// A camera at `position` that looks at `target` with +z up; `fov` is the vertical field of view in degrees.
    ///
    /// # Errors
    /// A position or target that is not finite, or both in one place; an angle that is not between 0 and 180 degrees;
    /// a film of no pixels, or of more than 2^24.
    pub fn new(position: Vec3, target: Vec3, fov: f32, width: u32, height: u32) -> Result<Self> {
        let forward = (target - position).as_dvec3();
        if !position.is_finite() || !target.is_finite() || forward.length() < 1e-6 {
            return Err(Error::Invalid(format!(
                "the camera at {position} needs a finite target away from it, not {target}"
            )));
        }
        // Looking straight up or down, the top of the picture is towards +y.
        let up = if forward.normalize().z.abs() > 0.999_999 { DVec3::Y } else { DVec3::Z };
        Self::oriented(position, forward, up, fov, width, height)
    }

    /// A camera at `position` that looks along `forward`, the top of the picture towards `up`; neither need be a unit
    /// vector, and `up` need not be perpendicular. `fov` is the vertical field of view in degrees.
    ///
    /// # Errors
    /// A position that is not finite; directions that are not finite, 0 or parallel; an angle that is not between 0 and
    /// 180 degrees; a film of no pixels, or of more than 2^24.
    pub fn oriented(position: Vec3, forward: DVec3, up: DVec3, fov: f32, width: u32, height: u32) -> Result<Self> {
        if width == 0 || height == 0 || u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(Error::Invalid(format!(
                "the film is {width} x {height} pixels; it needs at least 1 x 1 and at most 2^24 ({MOST_PIXELS}) in all"
            )));
        }
        if !(fov > 0.0 && fov < 180.0) {
            return Err(Error::Invalid(format!("the field of view is {fov} degrees; it must lie between 0 and 180")));
        }
        let forward = forward.normalize_or_zero();
        let right = forward.cross(up).normalize_or_zero();
        if !position.is_finite() || forward == DVec3::ZERO || right == DVec3::ZERO {
            return Err(Error::Invalid(format!(
                "the camera at {position} needs finite directions forward and up that are not parallel"
            )));
        }
        let half_height = (f64::from(fov).to_radians() * 0.5).tan();
        let down = forward.cross(right) * half_height;
        let right = right * half_height * f64::from(width) / f64::from(height);
        Ok(Self { position, forward, right, down, width, height })
    }

    /// The same view on a film of at most so many pixels, 1 or more.
    pub(crate) fn shrunk(&self, pixels: u32) -> Self {
        let shrink = (f64::from(pixels) / (f64::from(self.width) * f64::from(self.height))).sqrt().min(1.0);
        let [width, height] = [self.width, self.height].map(|side| ((f64::from(side) * shrink) as u32).max(1));
        let aspect = |width: u32, height: u32| f64::from(width) / f64::from(height);
        let right = self.right * (aspect(width, height) / aspect(self.width, self.height));
        Self { width, height, right, ..*self }
    }

    /// The camera of a scene that was turned and moved: at `position`, looking along what `turn` makes of its
    /// directions.
    pub(crate) fn turned(&self, position: Vec3, turn: DQuat) -> Self {
        Self { position, forward: turn * self.forward, right: turn * self.right, down: turn * self.down, ..*self }
    }

    /// Where the camera stands, in scene coordinates.
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Unit vector along which it looks.
    pub fn forward(&self) -> DVec3 {
        self.forward
    }

    /// Unit vector towards the top of the picture.
    pub fn up(&self) -> DVec3 {
        -self.down.normalize()
    }

    /// Unit vector towards the right of the picture.
    pub fn right(&self) -> DVec3 {
        self.right.normalize()
    }

    /// Vertical field of view in degrees.
    pub fn fov(&self) -> f64 {
        2.0 * self.down.length().atan().to_degrees()
    }

    /// Pixels across and down.
    pub fn resolution(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Unit direction through the centre of a pixel; `x` from the left, `y` from the top.
    pub fn direction(&self, x: u32, y: u32) -> DVec3 {
        self.direction_through(f64::from(x) + 0.5, f64::from(y) + 0.5)
    }

    /// Unit direction through a point of the film, in pixels from its upper left corner.
    pub(crate) fn direction_through(&self, x: f64, y: f64) -> DVec3 {
        let across = x / f64::from(self.width) * 2.0 - 1.0;
        let along = y / f64::from(self.height) * 2.0 - 1.0;
        (self.forward + self.right * across + self.down * along).normalize()
    }

    /// The camera's numbers, for hashing.
    pub(crate) fn numbers(&self) -> [f64; 14] {
        let (p, f, r, d) = (self.position.as_dvec3(), self.forward, self.right, self.down);
        [p.x, p.y, p.z, f.x, f.y, f.z, r.x, r.y, r.z, d.x, d.y, d.z, f64::from(self.width), f64::from(self.height)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_look_where_expected() {
        let camera = Camera::new(Vec3::ZERO, Vec3::Y, 90.0, 3, 3).expect("a camera");
        assert!((camera.direction(1, 1) - DVec3::Y).length() < 1e-12);
        let top_right = camera.direction(2, 0);
        assert!(top_right.x > 0.0 && top_right.z > 0.0, "{top_right}");
    }

    #[test]
    fn a_camera_is_made_again_from_what_it_tells() {
        let camera = Camera::new(Vec3::new(3.0, -2.0, 5.0), Vec3::new(0.5, 4.0, 1.0), 50.0, 16, 9).expect("a camera");
        let rolled = camera.turned(camera.position(), DQuat::from_axis_angle(camera.forward(), 0.3));
        for camera in [camera, rolled] {
            let again = Camera::oriented(
                camera.position(),
                camera.forward(),
                camera.up(),
                camera.fov() as f32,
                camera.resolution().0,
                camera.resolution().1,
            )
            .expect("a camera");
            for (x, y) in [(0, 0), (15, 0), (7, 4), (0, 8)] {
                assert!((again.direction(x, y) - camera.direction(x, y)).length() < 1e-6);
            }
            assert!((camera.right() - camera.forward().cross(camera.up())).length() < 1e-12);
        }
    }

    #[test]
    fn impossible_cameras_are_refused() {
        assert!(Camera::new(Vec3::ZERO, Vec3::Y, 90.0, 0, 3).is_err());
        assert!(Camera::new(Vec3::ZERO, Vec3::ZERO, 90.0, 3, 3).is_err());
        assert!(Camera::new(Vec3::ZERO, Vec3::Y, 90.0, 1 << 12, 1 << 12).is_ok());
        let error = Camera::new(Vec3::ZERO, Vec3::Y, 90.0, (1 << 12) + 1, 1 << 12).expect_err("a film too large");
        assert!(error.to_string().contains("4097 x 4096") && error.to_string().contains("2^24"), "{error}");
        assert!(Camera::new(Vec3::ZERO, Vec3::Y, 180.0, 3, 3).is_err());
        assert!(Camera::new(Vec3::NAN, Vec3::Y, 60.0, 3, 3).is_err());
        assert!(Camera::oriented(Vec3::ZERO, DVec3::Y, DVec3::Y * 2.0, 60.0, 3, 3).is_err());
        assert!(Camera::oriented(Vec3::ZERO, DVec3::NAN, DVec3::Y, 60.0, 3, 3).is_err());
    }
}
