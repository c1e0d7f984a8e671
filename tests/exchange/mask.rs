//! Pixels in which renderers may see another surface than ours are not compared.

use citylights::peers::mask;
use citylights::sources::{Overrides, recipe};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use citylights::visibility::view::Seen;

const LAMP: &str = include_str!("../data/lamp.toml");

fn stage(text: &str) -> Stage {
    let scene = recipe::parse(text, "mask.toml".as_ref(), &Overrides::default()).expect("a scene");
    Stage::new(scene, LeaveOut::Yes, Offset::SCALED)
}

/// Which pixels are compared, row by row.
fn compared(stage: &Stage) -> Vec<bool> {
    let receivers = stage.receivers();
    let mut compared = vec![false; stage.view().pixels().len()];
    mask::clear(stage, receivers).into_iter().for_each(|i| compared[receivers[i].pixel as usize] = true);
    compared
}

#[test]
fn pixels_beside_emitters_are_not_compared() {
    let scene = recipe::load("scenes/first-night.toml".as_ref(), &Overrides::default()).expect("a scene");
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    let (width, height) = stage.view().resolution();
    let (compared, pixels) = (compared(&stage), stage.view().pixels());
    let emitter = |x: i64, y: i64| {
        let inside = (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y);
        inside && matches!(pixels[(y * i64::from(width) + x) as usize], Seen::Emitter(_) | Seen::EmitterBack)
    };
    let (mut beside, mut left_out) = (0, 0);
    for (i, seen) in pixels.iter().enumerate() {
        let (x, y) = (i as i64 % i64::from(width), i as i64 / i64::from(width));
        let is_beside = (-1..=1).any(|dy| (-1..=1).any(|dx| emitter(x + dx, y + dy)));
        assert!(!(is_beside && compared[i]), "pixel {x}, {y}");
        assert!(matches!(seen, Seen::Receiver(_)) || !compared[i]);
        beside += usize::from(is_beside && matches!(seen, Seen::Receiver(_)));
        left_out += usize::from(matches!(seen, Seen::Receiver(_)) && !compared[i]);
    }
    println!("{beside} beside emitters, {left_out} left out of {}", stage.receivers().len());
    assert!(beside > 50 && left_out > beside && left_out - beside < stage.receivers().len() / 20);
}

#[test]
fn an_edge_through_the_centre_of_pixels_is_not_compared() {
    // The edge of the box at x = 0 stands in the middle of the film, where an odd width has the centres of a column.
    let text = LAMP.replace("[32, 18]", "[33, 18]").replace("low = [1.0", "low = [0.0");
    let stage = stage(&text);
    let compared = compared(&stage);
    let column = |x: usize| (0..18).filter(|y| !compared[y * 33 + x]).count();
    let on_the_box = 5;
    assert!(column(16) >= on_the_box, "{} pixels of the edge left out", column(16));
    // The diagonals of its sides and of the ground are no edges: two pixels beside it all but a few are compared.
    assert!(column(14) <= 3 && column(18) <= 3, "{}, {}", column(14), column(18));
}
