//! `citylights inspect`: what is in a scene?

use super::outcome::Outcome;
use super::scene::SceneOptions;
use super::terminal::{print, width};
use super::threads::{pool, threads};
use super::waiting::while_long;
use crate::inspect::{Inspection, Part, inspect};
use clap::Args;
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Args)]
pub(super) struct Arguments {
    /// The scene file: a recipe (.toml) or glTF (.glb, .gltf)
    scene: PathBuf,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Threads; all cores by default
    #[arg(long, value_parser = threads)]
    threads: Option<u32>,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    pool(arguments.threads)?.install(|| {
        let stage = arguments.scene_options.stage(&arguments.scene)?;
        let what = format!("{}: being inspected", stage.scene().name());
        let inspection = while_long(&what, || inspect(&stage));
        if arguments.json {
            print(&format!("{}\n", serde_json::to_string_pretty(&inspection)?))?;
        } else {
            print(&text(&inspection)?)?;
        }
        Ok(Outcome::Done)
    })
}

fn text(i: &Inspection) -> Result<String, std::fmt::Error> {
    let mut out = String::new();
    let [x, y, z] = i.size;
    let (width, height) = i.resolution;
    let exposure = i.ev100.map_or_else(|| "exposure 1".to_owned(), |ev| format!("EV100 {ev}"));
    writeln!(out, "{} ({})", i.name, i.hash)?;
    writeln!(
        out,
        "{x:.0} x {y:.0} x {z:.0} m, {width} x {height} pixels, {exposure}, {} surface triangles\n",
        i.surfaces
    )?;
    writeln!(out, "{}\n", parts("kind", &i.kinds))?;
    if !i.groups.is_empty() {
        writeln!(out, "{}\n", parts("part", &i.groups))?;
    }
    let r = i.in_range;
    writeln!(
        out,
        "lights in range of a visible point (0.5/255, linear): mean {:.1}; 5 % {:.0}, 50 % {:.0}, 95 % {:.0}",
        r.mean, r.p5, r.p50, r.p95
    )?;
    writeln!(
        out,
        "lights that reach no visible surface: {} provably, by facing; {} are seen from none of {} points",
        i.unreaching, i.unseen, i.pixels.receivers_sampled
    )?;
    let p = i.pixels;
    if let (Some(lx), Some(above)) = (p.street_lx, p.street_above_step_share) {
        writeln!(out, "visible street: mean {lx:.1} lx; {:.0} % of it above one display step", above * 100.0)?;
    }
    writeln!(
        out,
        "pixels: {:.2} % clipped, {:.1} % sky, {:.1} % emitters (from {} receivers)",
        p.clipped_share * 100.0,
        p.sky_share * 100.0,
        p.emitter_share * 100.0,
        p.receivers_sampled
    )?;
    let m = i.memory;
    writeln!(
        out,
        "bytes a light: table {:.0}, influence hierarchy {:.0}; occluders {:.1} MB",
        m.table_bytes_per_light,
        m.influence_bytes_per_light,
        m.occluder_bytes as f64 * 1e-6
    )?;
    i.left_out.iter().try_for_each(|text| writeln!(out, "left out: {text}"))?;
    i.notes.iter().try_for_each(|text| writeln!(out, "note: {text}"))?;
    Ok(out)
}

fn parts(head: &str, parts: &[Part]) -> Table {
    let mut table = Table::new();
    table.load_style(TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'))).set_header([
        head,
        "lights",
        "flux klm",
        "share of flux",
    ]);
    // Long names fold where the terminal is narrow.
    table.set_content_arrangement(ContentArrangement::Dynamic).set_width(width() as u16);
    for part in parts {
        table.add_row([
            part.name.clone(),
            part.lights.to_string(),
            format!("{:.1}", part.flux_lm * 1e-3),
            format!("{:.1} %", part.flux_share * 100.0),
        ]);
    }
    table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    table
}
