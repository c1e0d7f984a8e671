//! A scene for Mitsuba 3: what its `.xml` says.
//!
//! In the variants that end in `_rgb` every number passes unchanged. Triangles lie in one `serialized` file beside the
//! scene: surfaces by material, lights by radiance, since each emissive shape there is one emitter, from which points
//! are drawn by area. The cone of a spot is a bitmap, as Mitsuba's own ramp is linear in the angle.
//!
//! Source: Mitsuba 3.9 documentation of `direct`, `perspective`, `hdrfilm`, `area`, `point`, `spot`, `directional`.

use super::cone::{Cone, Table};
use super::files::{Export, SAMPLES};
use super::meshes::{by_material, by_radiance};
use super::serialized;
use super::text::{Three, aim, word};
use crate::base::error::{Error, Result};
use crate::scene::Scene;
use crate::scene::light::Shape;
use glam::{DVec3, Vec3};
use std::collections::HashMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Name of the file with all meshes.
const MESHES: &str = "meshes.serialized";

/// The scene as an `.xml` file and a folder of the same name.
pub(super) fn export(scene: &Scene, file: &Path) -> Result<Export> {
    let folder = file.with_extension("");
    let name = folder.file_name().and_then(|name| name.to_str());
    let Some(name) = name.filter(|name| !name.contains(['<', '>', '&', '"', '$'])) else {
        return Err(Error::Invalid(format!(
            "`{}` is no name for a Mitsuba scene: it stands in the file itself, without < > & $ and quotes",
            file.display()
        )));
    };
    let tables = Tables::of(scene);
    let mut out = Writer { folder: name.to_owned(), xml: String::new(), shapes: 0 };
    out.text("<!-- Written by citylights. Radiance is absolute: load it in a variant ending in _rgb. -->");
    out.text("<scene version=\"3.0.0\">");
    out.view(scene);
    let (surfaces, emitters) = (by_material(scene), by_radiance(scene));
    for (material, _) in &surfaces {
        let material = &scene.materials()[*material];
        out.surface(&material.name, material.albedo);
    }
    if !emitters.is_empty() {
        out.text("<bsdf type=\"diffuse\" id=\"emitter\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>");
    }
    for (radiance, _) in &emitters {
        out.emitter(*radiance);
    }
    for i in 0..tables.cones.len() {
        out.text(&format!(
            "<texture type=\"bitmap\" id=\"cone-{i}\"><string name=\"filename\" value=\"{name}/cone-{i}.pfm\"/>\
             <boolean name=\"raw\" value=\"true\"/><string name=\"wrap_mode\" value=\"clamp\"/></texture>"
        ));
    }
    for light in scene.lights() {
        out.light(&light.shape(), &tables);
    }
    out.text("</scene>");

    let meshes = surfaces.iter().map(|(_, t)| &t[..]).chain(emitters.iter().map(|(_, t)| &t[..]));
    let mut files: Vec<(PathBuf, Vec<u8>)> = vec![(folder.join(MESHES), serialized::encode(meshes))];
    files.extend(tables.cones.iter().enumerate().map(|(i, t)| (folder.join(format!("cone-{i}.pfm")), t.pfm())));
    files.push((file.to_owned(), out.xml.into_bytes()));
    Ok(Export { files, notes: tables.notes() })
}

/// The cones of a scene's spots, tabulated, each once.
struct Tables {
    cones: Vec<Table>,
    known: HashMap<Cone, usize>,
}

impl Tables {
    fn of(scene: &Scene) -> Self {
        let mut known = HashMap::new();
        let mut cones = Vec::new();
        for light in scene.lights() {
            let Some(cone) = Cone::of(&light.shape()) else { continue };
            known.entry(cone).or_insert_with(|| {
                cones.push(cone);
                cones.len() - 1
            });
        }
        let side = Table::side(cones.len());
        Self { cones: cones.iter().map(|cone| cone.table(side)).collect(), known }
    }

    fn notes(&self) -> Vec<String> {
        let worst = self.cones.iter().map(|table| table.worst).fold(0.0, f64::max);
        let flux = self.cones.iter().map(|table| table.flux_error).fold(0.0, f64::max);
        if self.cones.is_empty() {
            return Vec::new();
        }
        vec![format!(
            "the edges of spots are tabulated: flux to {:.1e}, profile within {:.2} % of the peak",
            flux,
            worst * 100.0
        )]
    }
}

struct Writer {
    folder: String,
    xml: String,
    shapes: usize,
}

impl Writer {
    fn text(&mut self, line: &str) {
        self.xml.push_str(line);
        self.xml.push('\n');
    }

    /// Integrator, camera, sampler and film.
    fn view(&mut self, scene: &Scene) {
        let camera = scene.camera();
        let (width, height) = camera.resolution();
        let (low, high) = scene.bounds();
        // Everything lies nearer; the default of 10 km would cut the largest scenes.
        let far = (high - low).length() + camera.position().distance(0.5 * (low + high));
        let mut put = |text: &str| self.text(text);
        put("<integrator type=\"direct\">");
        put("  <integer name=\"emitter_samples\" value=\"1\"/><integer name=\"bsdf_samples\" value=\"0\"/>");
        put("</integrator>");
        put("<sensor type=\"perspective\">");
        put(&format!("  <string name=\"fov_axis\" value=\"y\"/><float name=\"fov\" value=\"{}\"/>", camera.fov()));
        put(&format!(
            "  <float name=\"near_clip\" value=\"0.001\"/><float name=\"far_clip\" value=\"{}\"/>",
            far.max(1e4)
        ));
        put(&format!("  {}", to_world(camera.position(), camera.forward(), camera.up())));
        put(&format!("  <sampler type=\"independent\"><integer name=\"sample_count\" value=\"{SAMPLES}\"/></sampler>"));
        put("  <film type=\"hdrfilm\">");
        put(&format!("    <integer name=\"width\" value=\"{width}\"/><integer name=\"height\" value=\"{height}\"/>"));
        put("    <string name=\"pixel_format\" value=\"rgb\"/><string name=\"component_format\" value=\"float32\"/>");
        put("    <rfilter type=\"box\"/>");
        put("  </film>");
        put("</sensor>");
    }

    /// The next mesh as a reflector.
    fn surface(&mut self, name: &str, albedo: Vec3) {
        let reflector = format!(
            "<bsdf type=\"twosided\" id=\"{}-{}\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"{}\"/>\
             </bsdf></bsdf>",
            self.shapes,
            word(name),
            Three(albedo, ", ")
        );
        self.shape(&reflector);
    }

    /// The next mesh as a light.
    fn emitter(&mut self, radiance: Vec3) {
        self.shape(&format!(
            "<ref id=\"emitter\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"{}\"/></emitter>",
            Three(radiance, ", ")
        ));
    }

    fn shape(&mut self, within: &str) {
        let (folder, i) = (&self.folder, self.shapes);
        let text = format!(
            "<shape type=\"serialized\"><string name=\"filename\" value=\"{folder}/{MESHES}\"/>\
             <integer name=\"shape_index\" value=\"{i}\"/><boolean name=\"face_normals\" value=\"true\"/>{within}\
             </shape>"
        );
        self.text(&text);
        self.shapes += 1;
    }

    fn light(&mut self, shape: &Shape, tables: &Tables) {
        let text = match *shape {
            Shape::Point { position, intensity } => format!(
                "<emitter type=\"point\">{}<rgb name=\"intensity\" value=\"{}\"/></emitter>",
                triple("point", "position", position),
                Three(intensity, ", ")
            ),
            Shape::Spot { position, axis, intensity, .. } => {
                let i = tables.known[&Cone::of(shape).expect("a spot has a cone")];
                let across = axis.any_orthonormal_vector().as_dvec3();
                // Full to the cut-off, where the table ends.
                let angle = tables.cones[i].cutoff().to_degrees();
                format!(
                    "<emitter type=\"spot\">{}<rgb name=\"intensity\" value=\"{}\"/>\
                     <float name=\"cutoff_angle\" value=\"{angle}\"/><float name=\"beam_width\" value=\"{angle}\"/>\
                     <ref name=\"texture\" id=\"cone-{i}\"/></emitter>",
                    to_world(position, axis.as_dvec3(), across),
                    Three(intensity, ", ")
                )
            }
            Shape::Directional { towards, irradiance } => format!(
                "<emitter type=\"directional\">{}<rgb name=\"irradiance\" value=\"{}\"/></emitter>",
                triple("vector", "direction", -towards),
                Three(irradiance, ", ")
            ),
            Shape::Triangle { .. } => return,
        };
        self.text(&text);
    }
}

/// A transform that looks from `from` along `axis`.
fn to_world(from: Vec3, axis: DVec3, up: DVec3) -> String {
    format!(
        "<transform name=\"to_world\"><lookat origin=\"{}\" target=\"{}\" up=\"{}\"/></transform>",
        Three(from, ", "),
        Three(aim(from, axis), ", "),
        Three(up.as_vec3(), ", ")
    )
}

/// A point or a vector.
fn triple(tag: &str, name: &str, v: Vec3) -> String {
    let mut out = format!("<{tag} name=\"{name}\"");
    for (axis, value) in ["x", "y", "z"].into_iter().zip(v.to_array()) {
        write!(out, " {axis}=\"{}\"", super::text::Number(value)).expect("writing to a string cannot fail");
    }
    out.push_str("/>");
    out
}
