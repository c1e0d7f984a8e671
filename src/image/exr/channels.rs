//! Which channels of an EXR file are the picture?
//!
//! 1. `R`, `G`, `B`: what nearly all tools write.
//! 2. Else those of the one layer that has them, or of several the one called `Combined`: `ViewLayer.Combined.R` is
//!    the picture in Blender's multilayer files, beside `ViewLayer.Noisy Image.R` and others.
//! 3. Else `Y` alone, as grey.
//!
//! Where a step finds several, or none of them finds any, nothing is guessed.

use ::exr::meta::header::Header;
use std::collections::BTreeSet;

/// Where the colours of a picture stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Chosen {
    /// The part of the file.
    pub(super) part: usize,
    /// Places of red, green and blue in the part's list of channels; all the same for grey.
    pub(super) rgb: [usize; 3],
}

impl Chosen {
    /// Whether one channel stands for all three.
    pub(super) fn is_grey(&self) -> bool {
        self.rgb[0] == self.rgb[1]
    }
}

/// How many channels a message lists.
const LISTED: usize = 40;

/// The picture among these parts, or what is wrong.
pub(super) fn choose(parts: &[Header]) -> Result<Chosen, String> {
    let names: Vec<Vec<String>> = parts.iter().map(names).collect();
    let every = || names.iter().enumerate();
    let mut found: Vec<Chosen> = every().filter_map(|(part, names)| triple(part, names, "")).collect();
    if found.is_empty() {
        found = every()
            .flat_map(|(part, names)| layers(names).into_iter().filter_map(move |layer| triple(part, names, layer)))
            .collect();
        let combined = |chosen: &Chosen| is_combined(&names[chosen.part][chosen.rgb[0]]);
        if found.iter().any(combined) {
            found.retain(combined);
        }
    }
    if found.is_empty() {
        found = every().filter_map(|(part, names)| luminance(part, names)).collect();
    }
    match found.as_slice() {
        [one] => Ok(*one),
        [] => Err(format!("no channels R, G and B, in no layer, and no Y alone. {}", list(parts))),
        several => {
            Err(format!("{} of its layers could be the picture: save one alone. {}", several.len(), list(parts)))
        }
    }
}

/// The channel names of a part, in its order.
fn names(part: &Header) -> Vec<String> {
    part.channels.list.iter().map(|channel| channel.name.to_string()).collect()
}

/// The channels R, G and B after `prefix`.
fn triple(part: usize, names: &[String], prefix: &str) -> Option<Chosen> {
    let place = |colour: &str| names.iter().position(|name| name.strip_prefix(prefix) == Some(colour));
    Some(Chosen { part, rgb: [place("R")?, place("G")?, place("B")?] })
}

/// What stands before the R of each layer, its dot included.
fn layers(names: &[String]) -> BTreeSet<&str> {
    names.iter().filter_map(|name| name.strip_suffix('R')).filter(|prefix| prefix.ends_with('.')).collect()
}

/// Whether the layer of this red channel is called `Combined`, with whatever before it.
fn is_combined(red: &str) -> bool {
    red == "Combined.R" || red.ends_with(".Combined.R")
}

/// The channel Y where it is luminance alone: neither part of XYZ, nor with the colour differences RY and BY.
fn luminance(part: usize, names: &[String]) -> Option<Chosen> {
    let has = |wanted: &str| names.iter().any(|name| name == wanted);
    let alone = !["X", "Z", "RY", "BY"].into_iter().any(has);
    let place = names.iter().position(|name| name == "Y").filter(|_| alone)?;
    Some(Chosen { part, rgb: [place; 3] })
}

/// The channels there are, for a message.
fn list(parts: &[Header]) -> String {
    let mut all = Vec::new();
    for part in parts {
        let layer = part.own_attributes.layer_name.as_ref().map_or_else(String::new, ToString::to_string);
        // Blender's names of channels say their part already.
        let full = |name: String| if name.starts_with(&layer) { name } else { format!("{layer}: {name}") };
        all.extend(names(part).into_iter().map(full));
    }
    let more = all.len().saturating_sub(LISTED);
    all.truncate(LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("Its channels: {}{more}", all.join(", "))
}
