//! What a caller sets in place of a file's own words.

use super::city::View;

/// What a caller sets in place of the file's own words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The seed of a recipe's city.
    pub seed: Option<u64>,
    /// Pixels across and down.
    pub resolution: Option<(u32, u32)>,
    /// Exposure value at ISO 100.
    pub ev100: Option<f32>,
    /// Lights of a recipe's generated city, at the recipe's density: its extent grows with them about the same middle.
    pub lights: Option<u64>,
    /// A view that the generator of a recipe's city places, in place of the recipe's camera; its angle and resolution stay.
    pub view: Option<View>,
    /// The camera of a glTF file, by the name of its node or its own.
    pub camera: Option<String>,
    /// What the punctual lights of a glTF file are divided by: 683 for those that Blender's exporter wrote as it does by
    /// default.
    pub lamps_divided_by: Option<f32>,
}
