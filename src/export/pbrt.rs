//! A scene for pbrt-v4: what its `.pbrt` file says.
//!
//! Without `power`, with a sensor of `cie1931`, ISO 100 and a shutter open for one second, pbrt's pixels are the
//! radiance in the scene's own unit. One file: triangles stand in it as numbers, surfaces by material, lights by
//! radiance; there each emissive triangle is a light of its own. pbrt's spot falls off as the smoothstep in the
//! cosine; its cones are chosen so that the flux is equal, and what is left is said. Not rendered with pbrt here:
//! a strict reader in `tests/exchange/export.rs` checks the file.
//!
//! Source: pbrt-v4, the input file format; Pharr, Jakob and Humphreys, Physically Based Rendering, 4th edition, 2023,
//! sections 5.4 and 12.

use super::cone::{Cone, Smooth};
use super::files::{Export, SAMPLES};
use super::meshes::{Corners, by_material, by_radiance};
use super::text::{Number, Three, aim, word};
use crate::scene::Scene;
use crate::scene::camera::Camera;
use crate::scene::light::Shape;
use glam::Vec3;
use std::path::Path;

/// The scene as one `.pbrt` file.
pub(super) fn export(scene: &Scene, file: &Path) -> Export {
    let cones = scene.lights().iter().filter_map(|light| Cone::of(&light.shape()));
    let worst = cones.map(|cone| Smooth::of(cone).worst).fold(0.0, f64::max);
    let mut notes = Vec::new();
    if worst > 0.0 {
        let percent = worst * 100.0;
        notes.push(format!(
            "spots have the same flux; their edges are another curve, up to {percent:.1} % of the peak off"
        ));
    }
    let mut out = Writer { text: String::new() };
    out.line("# Written by citylights. Radiance is absolute.");
    for note in &notes {
        out.line(&format!("# Note: {note}."));
    }
    let picture = file.file_stem().map_or_else(|| "scene".into(), |stem| word(&stem.to_string_lossy()));
    out.options(scene.camera(), &picture);
    out.line("WorldBegin");
    for light in scene.lights() {
        out.light(&light.shape());
    }
    for (material, triangles) in by_material(scene) {
        let material = &scene.materials()[material];
        out.line(&format!("# {}", word(&material.name)));
        out.line(&format!("Material \"diffuse\" \"rgb reflectance\" [{}]", Three(material.albedo, " ")));
        out.mesh(&triangles);
    }
    let emitters = by_radiance(scene);
    if !emitters.is_empty() {
        out.line("Material \"diffuse\" \"rgb reflectance\" [0 0 0]");
    }
    for (radiance, triangles) in emitters {
        out.line("AttributeBegin");
        let radiance = Three(radiance, " ");
        out.line(&format!("AreaLightSource \"diffuse\" \"rgb L\" [{radiance}] \"bool twosided\" false"));
        out.mesh(&triangles);
        out.line("AttributeEnd");
    }
    Export { files: vec![(file.to_owned(), out.text.into_bytes())], notes }
}

struct Writer {
    text: String,
}

impl Writer {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Integrator, filter, sampler, film and camera.
    fn options(&mut self, camera: &Camera, picture: &str) {
        let (width, height) = camera.resolution();
        // pbrt's angle is that of the shorter side.
        let portrait = (f64::from(width) / f64::from(height)).min(1.0);
        let fov = 2.0 * ((camera.fov() * 0.5).to_radians().tan() * portrait).atan().to_degrees();
        let (from, up) = (camera.position(), camera.up().as_vec3());
        let to = aim(from, camera.forward());
        self.line("Integrator \"path\" \"integer maxdepth\" [1] \"string lightsampler\" \"bvh\"");
        self.line("PixelFilter \"box\" \"float xradius\" [0.5] \"float yradius\" [0.5]");
        self.line(&format!("Sampler \"independent\" \"integer pixelsamples\" [{SAMPLES}]"));
        self.line(&format!(
            "Film \"rgb\" \"string filename\" \"{picture}.exr\" \"integer xresolution\" [{width}] \
             \"integer yresolution\" [{height}] \"bool savefp16\" false \"string sensor\" \"cie1931\" \"float iso\" [100]"
        ));
        self.line("# pbrt's camera is left-handed.");
        self.line("Scale -1 1 1");
        self.line(&format!("LookAt {}  {}  {}", Three(from, " "), Three(to, " "), Three(up, " ")));
        self.line(&format!(
            "Camera \"perspective\" \"float fov\" [{fov}] \"float shutteropen\" [0] \"float shutterclose\" [1]"
        ));
    }

    fn light(&mut self, shape: &Shape) {
        match *shape {
            Shape::Point { position, intensity } => self.line(&format!(
                "LightSource \"point\" \"point3 from\" [{}] \"rgb I\" [{}]",
                Three(position, " "),
                Three(intensity, " ")
            )),
            Shape::Spot { position, axis, intensity, .. } => {
                let Some(cone) = Cone::of(shape).map(Smooth::of) else { return };
                let (outer, inner) = (cone.outer.acos().to_degrees(), cone.inner.acos().to_degrees());
                self.line(&format!(
                    "LightSource \"spot\" \"point3 from\" [{}] \"point3 to\" [{}] \"rgb I\" [{}] \
                     \"float coneangle\" [{outer}] \"float conedeltaangle\" [{}]",
                    Three(position, " "),
                    Three(aim(position, axis.as_dvec3()), " "),
                    Three(intensity, " "),
                    outer - inner
                ));
            }
            // Its L is the irradiance on what faces it.
            Shape::Directional { towards, irradiance } => self.line(&format!(
                "LightSource \"distant\" \"point3 from\" [{}] \"point3 to\" [0 0 0] \"rgb L\" [{}]",
                Three(towards, " "),
                Three(irradiance, " ")
            )),
            Shape::Triangle { .. } => {}
        }
    }

    fn mesh(&mut self, triangles: &[Corners]) {
        self.text.push_str("Shape \"trianglemesh\" \"point3 P\" [");
        let mut between = "";
        for corner in triangles.iter().flatten() {
            self.text.push_str(between);
            self.push(*corner);
            between = "\n";
        }
        self.text.push_str("] \"integer indices\" [");
        for i in 0..3 * triangles.len() {
            self.text.push_str(&i.to_string());
            self.text.push(' ');
        }
        self.text.push_str("]\n");
    }

    fn push(&mut self, v: Vec3) {
        use std::fmt::Write;
        write!(self.text, "{} {} {}", Number(v.x), Number(v.y), Number(v.z)).expect("a string takes all");
    }
}
