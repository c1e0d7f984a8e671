//! Which surfaces are placed by hand, and of what material?

use super::place::{inside, near};
use super::toml_table::Table;
use crate::base::error::{Error, Result};
use crate::base::names;
use crate::scene::{Material, Surface};
use crate::sources::city::{Grown, Solid, builtin_materials};
use crate::sources::limits::FARTHEST;
use glam::DVec3;

/// Materials are found by going through all of them: with more, a large file would take minutes.
const MOST_MATERIALS: usize = 1_000;

/// Surfaces in the recipe's frame, in f64.
pub(super) struct Surfaces {
    triangles: Vec<([DVec3; 3], u32)>,
    boxes: Vec<[DVec3; 2]>,
    materials: Vec<Material>,
}

impl Surfaces {
    /// Reads materials, ground, boxes, quads and triangles; a city brings its materials with it.
    pub(super) fn read(top: &Table, city: Option<&Grown>) -> Result<Self> {
        let materials = city.map(|city| city.materials.clone()).unwrap_or_default();
        let mut out = Self { triangles: Vec::new(), boxes: Vec::new(), materials };
        if let Some(table) = top.table("materials")? {
            let count = table.keys().count();
            if count > MOST_MATERIALS {
                let text = format!("{count} materials are given; at most {MOST_MATERIALS} are allowed");
                return Err(top.wrong("materials", text));
            }
            for name in table.keys() {
                out.read_material(name, &table.needed_table(name)?)?;
            }
        }
        if let Some(table) = top.table("ground")? {
            table.only(&["size", "centre", "height", "material"])?;
            let (ground, material) = (ground(&table)?, out.material(&table)?);
            out.quad(ground, material);
        }
        for table in top.tables("box")? {
            table.only(&["low", "high", "material"])?;
            let low = table.needed_vector("low", FARTHEST)?;
            let high = table.needed_vector("high", FARTHEST)?;
            if !high.cmpgt(low).all() {
                return Err(
                    table.wrong("high", format!("{high} is given; every coordinate must exceed that of `low`, {low}"))
                );
            }
            let material = out.material(&table)?;
            out.solid(low, high, material);
        }
        for table in top.tables("quad")? {
            table.only(&["corners", "material"])?;
            let (corners, material) = (table.needed_corners("corners", FARTHEST)?, out.material(&table)?);
            out.quad(corners, material);
        }
        for table in top.tables("triangle")? {
            table.only(&["corners", "material"])?;
            let (corners, material) = (table.needed_corners("corners", FARTHEST)?, out.material(&table)?);
            out.triangles.push((corners, material));
        }
        Ok(out)
    }

    fn read_material(&mut self, name: &str, table: &Table) -> Result<()> {
        table.only(&["albedo", "street"])?;
        let known = self.materials.iter().position(|material| material.name == name);
        let builtin = builtin_materials().into_iter().find(|material| material.name == name);
        let before = known.map(|i| self.materials[i].clone()).or(builtin);
        let albedo = match (table.colour("albedo", 1.0)?, &before) {
            (Some(albedo), _) => albedo.as_vec3(),
            (None, Some(before)) => before.albedo,
            (None, None) => {
                return Err(table.wrong("albedo", "is missing; [red, green, blue] within 0 and 1 is asked for"));
            }
        };
        let street = table.flag("street")?.unwrap_or(before.is_some_and(|before| before.street));
        let material = Material { name: name.to_owned(), albedo, street };
        match known {
            Some(i) => self.materials[i] = material,
            None => self.materials.push(material),
        }
        Ok(())
    }

    /// The number of the material that a table names.
    fn material(&mut self, table: &Table) -> Result<u32> {
        let name = table.needed_text("material", "the name of a material")?;
        if let Some(i) = self.materials.iter().position(|material| material.name == name) {
            return Ok(i as u32);
        }
        let mut builtin = builtin_materials();
        if let Some(i) = builtin.iter().position(|material| material.name == name) {
            self.materials.push(builtin.swap_remove(i));
            return Ok(self.materials.len() as u32 - 1);
        }
        let known = self.materials.iter().chain(&builtin).map(|material| material.name.as_str());
        let hint = names::hint(&name, known);
        Err(table.wrong("material", format!("no material is called \"{}\"{hint}", name.escape_debug())))
    }

    fn quad(&mut self, [a, b, c, d]: [DVec3; 4], material: u32) {
        self.triangles.extend([([a, b, c], material), ([a, c, d], material)]);
    }

    fn solid(&mut self, low: DVec3, high: DVec3, material: u32) {
        let ring = [low, low.with_x(high.x), high.with_z(low.z), low.with_y(high.y)];
        for i in 0..4 {
            let (a, b) = (ring[i], ring[(i + 1) % 4]);
            self.quad([a, b, b.with_z(high.z), a.with_z(high.z)], material);
        }
        self.quad(ring.map(|p| p.with_z(high.z)), material);
        self.quad([ring[0], ring[3], ring[2], ring[1]], material);
        self.boxes.push([low, high]);
    }

    /// Fails if the camera stands in a box.
    pub(super) fn keep_out(&self, camera: &Table, eye: DVec3) -> Result<()> {
        let found = self.boxes.iter().position(|[low, high]| eye.cmpgt(*low).all() && eye.cmplt(*high).all());
        found.map_or(Ok(()), |i| {
            let [low, high] = self.boxes[i];
            let solid = Solid { low: low.as_vec3(), high: high.as_vec3() };
            Err::<(), Error>(inside(camera, &format!("box[{i}]"), solid))
        })
    }

    /// The middle of all surfaces.
    pub(super) fn centre(&self) -> DVec3 {
        let corners = self.triangles.iter().flat_map(|(corners, _)| corners);
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = corners.fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
        if self.triangles.is_empty() { DVec3::ZERO } else { 0.5 * (low + high) }
    }

    /// The surfaces in f32 relative to `shift`, and all materials.
    pub(super) fn finish(self, shift: DVec3) -> (Vec<Surface>, Vec<Material>) {
        let surfaces = self.triangles.iter().map(|(corners, material)| Surface {
            corners: corners.map(|corner| near(corner, shift)),
            material: *material,
        });
        (surfaces.collect(), self.materials)
    }
}

fn ground(table: &Table) -> Result<[DVec3; 4]> {
    let sides = 0.1..=FARTHEST;
    // A single number is a square; whatever else is wrong is told as for two.
    let size = match table.number("size", sides.clone(), "metres") {
        Ok(Some(side)) => glam::DVec2::splat(side),
        _ => table.needed_pair("size", sides, "metres")?,
    };
    let centre = table.pair("centre", -FARTHEST..=FARTHEST, "metres")?.unwrap_or_default();
    let z = table.number("height", -FARTHEST..=FARTHEST, "metres")?.unwrap_or(0.0);
    let (low, high) = (centre - 0.5 * size, centre + 0.5 * size);
    Ok([[low.x, low.y], [high.x, low.y], [high.x, high.y], [low.x, high.y]].map(|[x, y]| DVec3::new(x, y, z)))
}
