//! What does a shadow look like, and where are umbra and penumbra?

use crate::base::random::Stream;
use crate::image::Picture;
use crate::render::exact::shadowed;
use crate::render::picture::picture;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::visibility::stage::Stage;
use crate::visibility::view::Seen;
use glam::{DVec3, Vec3};

/// How much of the lights a receiver sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shadow {
    /// All that is not behind its horizon, or nothing to see.
    Lit,
    /// A part.
    Penumbra,
    /// Nothing of what it faces.
    Umbra,
}

/// Side of the grid of points on each triangle by which shadows are told apart.
const SIDE: u32 = 12;

/// Tells by points spread over the lights.
pub(super) fn shadow(stage: &Stage, at: &Receiver) -> Shadow {
    let mut rng = Stream::keyed(&[u64::from(at.pixel), u64::from_le_bytes(*b"penumbra")]);
    let (mut facing, mut seen) = (0u32, 0u32);
    for light in stage.scene().lights() {
        for cell in 0..SIDE * SIDE {
            let [u, v] = rng.uniform2();
            let step = |cell: u32, u: f32| ((cell as f32 + u) / SIDE as f32).min(1.0 - f32::EPSILON);
            let uv = [step(cell % SIDE, u), step(cell / SIDE, v)];
            if contribution::<0b1111>(LightSampling::Area, light, uv, at).is_ok() {
                facing += 1;
                seen += u32::from(shadowed(stage, LightSampling::Area, at, light, uv, &mut 0) != DVec3::ZERO);
            }
        }
    }
    match seen {
        _ if seen == facing => Shadow::Lit,
        0 => Shadow::Umbra,
        _ => Shadow::Penumbra,
    }
}

/// Colours of the outlines of umbra and penumbra, as displayed.
const BLUE: Vec3 = Vec3::new(0.05, 0.25, 1.0);
const ORANGE: Vec3 = Vec3::new(1.0, 0.35, 0.0);

/// The exact image with the outlines of umbra (blue) and penumbra (orange).
pub(super) fn outlined(stage: &Stage, exact: &[Vec3], shadows: &[Shadow]) -> Vec<[f32; 3]> {
    let mut pixels = picture(stage, exact);
    let (width, height) = stage.view().resolution();
    let of = |x: u32, y: u32| match stage.view().pixels()[(y * width + x) as usize] {
        Seen::Receiver(index) => Some(shadows[index as usize]),
        Seen::Sky | Seen::Emitter(_) | Seen::EmitterBack => None,
    };
    for y in 0..height - 1 {
        for x in 0..width - 1 {
            let Some(own) = of(x, y) else { continue };
            let others = [of(x + 1, y), of(x, y + 1)];
            let border = |kind| others.iter().flatten().any(|other| (own == kind) != (*other == kind));
            let colour = match (border(Shadow::Umbra), border(Shadow::Lit)) {
                (true, _) => BLUE,
                (false, true) => ORANGE,
                (false, false) => continue,
            };
            pixels[(y * width + x) as usize] = (colour / stage.scene().exposure()).to_array();
        }
    }
    pixels
}

/// Pictures of that size, across and down, side by side, row below row.
pub(super) fn sheet(rows: &[Vec<Vec<[f32; 3]>>], size: (u32, u32)) -> Picture {
    let (width, height) = (size.0 as usize, size.1 as usize);
    let columns = rows.first().map_or(0, Vec::len);
    let pixels = rows.iter().flat_map(|row| {
        (0..height).flat_map(move |y| row.iter().flat_map(move |cell| cell[y * width..(y + 1) * width].iter().copied()))
    });
    Picture { width: (columns * width) as u32, height: (rows.len() * height) as u32, pixels: pixels.collect() }
}
