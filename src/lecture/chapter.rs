//! Which chapters are there, and what does each draw?

use super::asked::Asked;
use super::plate::Plate;
use super::{area_lights, draw, many_lights, offsets, picks, points, range, samples, shadow_rays, solid_angle};
use crate::base::error::{Error, Result};

/// A chapter of `docs/LECTURE.md`.
pub(crate) struct Chapter {
    /// Its number, from 1.
    pub(crate) number: u32,
    /// Its name, as typed.
    pub(crate) name: &'static str,
    /// What it asks.
    pub(crate) question: &'static str,
    /// The scene that it takes where no other is given, in a clone of the repository.
    pub(crate) scene: &'static str,
    /// Pixels of its pictures where no others are asked for.
    pub(crate) resolution: (u32, u32),
    draw: fn(&Asked<'_>) -> Result<Plate>,
}

const LAMPS: &str = "scenes/lecture/lamps.toml";
const PANEL: &str = "scenes/lecture/panel.toml";
const SIGN: &str = "scenes/lecture/sign.toml";
const STREET: &str = "scenes/first-night.toml";
const PLAZA: &str = "scenes/plaza.toml";

/// All chapters in order.
pub(crate) const CHAPTERS: [Chapter; 9] = [
    Chapter {
        number: 1,
        name: "shadow-rays",
        question: "What is a shadow ray, where does it end, and when is none needed?",
        scene: LAMPS,
        resolution: (288, 162),
        draw: shadow_rays::draw,
    },
    Chapter {
        number: 2,
        name: "offsets",
        question: "Where does a shadow ray start, so that its own surface does not block it?",
        scene: LAMPS,
        resolution: (240, 135),
        draw: offsets::draw,
    },
    Chapter {
        number: 3,
        name: "area-lights",
        question: "Why does a larger light cast a softer shadow?",
        scene: PANEL,
        resolution: (288, 192),
        draw: area_lights::draw,
    },
    Chapter {
        number: 4,
        name: "points",
        question: "Which point of a triangle do two random numbers stand for?",
        scene: SIGN,
        resolution: (192, 108),
        draw: points::draw,
    },
    Chapter {
        number: 5,
        name: "solid-angle",
        question: "How large does an area light look, and how far does the formula reach?",
        scene: SIGN,
        resolution: (288, 162),
        draw: solid_angle::draw,
    },
    Chapter {
        number: 6,
        name: "samples",
        question: "How many shadow rays does a soft shadow take?",
        scene: PANEL,
        resolution: (140, 94),
        draw: samples::draw,
    },
    Chapter {
        number: 7,
        name: "many-lights",
        question: "Of many lights, how many matter at a point?",
        scene: STREET,
        resolution: (288, 162),
        draw: many_lights::draw,
    },
    Chapter {
        number: 8,
        name: "range",
        question: "What is lost where each light ends at the distance at which it alone can no longer be seen?",
        scene: PLAZA,
        resolution: (192, 108),
        draw: range::draw,
    },
    Chapter {
        number: 9,
        name: "picks",
        question: "By which chance should a light be picked?",
        scene: STREET,
        resolution: (160, 90),
        draw: picks::draw,
    },
];

impl Chapter {
    /// Its labelled picture as SVG.
    ///
    /// # Errors
    /// A scene that has nothing to show of it; a pixel that sees no surface.
    pub(crate) fn svg(&self, asked: &Asked<'_>) -> Result<String> {
        draw::svg(&(self.draw)(asked)?)
    }

    /// The file that it goes to where none is named.
    pub(crate) fn file(&self) -> String {
        format!("lecture/{:02}-{}.svg", self.number, self.name)
    }
}

/// The chapter of that name or number.
///
/// # Errors
/// An unknown one, with those that come near it.
pub(crate) fn find(name: &str) -> Result<&'static Chapter> {
    let is = |chapter: &&Chapter| chapter.name == name || chapter.number.to_string() == name;
    let unknown = || Error::unknown("chapter", name, CHAPTERS.iter().map(|chapter| chapter.name));
    CHAPTERS.iter().find(is).ok_or_else(unknown)
}
