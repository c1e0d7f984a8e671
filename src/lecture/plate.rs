//! What is on a labelled picture?

use super::dots::Dots;
use crate::report::{Chart, Mark};

/// A labelled picture: panels and charts under one title.
pub(super) struct Plate {
    /// What it is of.
    pub(super) title: String,
    /// The scene, and how it was taken.
    pub(super) subtitle: String,
    /// From the top.
    pub(super) rows: Vec<Row>,
}

/// What stands side by side.
pub(super) enum Row {
    /// Panels of equal width.
    Panels(Vec<Panel>),
    /// Curves, over the full width.
    Chart(Chart),
    /// Bars, over the full width.
    Bars(Bars),
}

/// A picture with words.
pub(super) struct Panel {
    /// Which it is.
    pub(super) title: String,
    /// What is shown.
    pub(super) drawing: Drawing,
    /// What there is to see, in figures.
    pub(super) caption: String,
}

/// What a panel shows.
pub(super) enum Drawing {
    /// What the camera sees.
    Bitmap(Bitmap),
    /// Points in a triangle.
    Dots(Dots),
}

/// Pixels, as shown.
#[derive(Clone)]
pub(super) struct Bitmap {
    /// Columns.
    pub(super) width: u32,
    /// Rows.
    pub(super) height: u32,
    /// 8-bit sRGB, row by row from the top.
    pub(super) texels: Vec<[u8; 3]>,
    /// What the colours mean, where they are false.
    pub(super) bar: Option<ColourBar>,
    /// A pixel that a cross marks, from the left and the top.
    pub(super) cross: Option<[u32; 2]>,
    /// Two pixels that a line joins.
    pub(super) line: Option<[[u32; 2]; 2]>,
}

/// What false colours mean.
#[derive(Clone)]
pub(super) struct ColourBar {
    /// The quantity with its unit.
    pub(super) label: String,
    /// Values along the bar: place from 0 to 1, and text.
    pub(super) ticks: Vec<(f64, String)>,
}

/// Groups of bars, one bar for each name.
pub(super) struct Bars {
    /// What they are.
    pub(super) title: String,
    /// What the vertical axis is, in per cent.
    pub(super) label: String,
    /// What the bars of each group stand for, with their colours.
    pub(super) names: Vec<(String, Mark)>,
    /// The groups from the left: lines of text below, and a share for each name.
    pub(super) groups: Vec<([String; 2], Vec<f64>)>,
}
