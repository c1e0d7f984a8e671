//! Promise: a reference is exact and says how exact, keeps to its bound of work, and loses nothing when it is interrupted.
use crate::promises::common::{ground, panel, point, sixteen, stage};
use citylights::base::error::Error;
use citylights::base::rel_mse::RelMse;
use citylights::base::statistics::{Moments, student_quantile};
use citylights::measure::observer::{Observer, Unobserved};
use citylights::measure::reference::{FEWEST, Reference, Wanted};
use citylights::measure::target::Target;
use citylights::render::exact::exact;
use citylights::render::refined::{Price, refined};
use citylights::scene::camera::Camera;
use citylights::scene::receiver::Receiver;
use citylights::visibility::stage::Stage;
use glam::Vec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Lights of all kinds, and a row of windows each of which adds little, seen by so many pixels across.
fn windows(across: u32) -> Stage {
    let mut parts = sixteen();
    let camera = Camera::new(Vec3::new(0.3, -18.0, 14.0), Vec3::new(0.0, 1.0, 0.0), 60.0, across, across * 3 / 4);
    parts.camera = camera.expect("a camera");
    for i in 0..40 {
        let corner = Vec3::new(i as f32 * 0.3 - 6.0, 8.0, 0.5 + (i % 3) as f32);
        parts.lights.extend(panel(corner, Vec3::X * 0.1, Vec3::Z * 0.15, 20.0));
    }
    stage(parts)
}

/// An observer that wants to stop after some steps.
struct Impatient {
    steps: AtomicU64,
    most: u64,
}

impl Impatient {
    fn after(most: u64) -> Self {
        Self { steps: AtomicU64::new(0), most }
    }
}

impl Observer for Impatient {
    fn advance(&self, steps: u64) {
        self.steps.fetch_add(steps, Ordering::Relaxed);
    }

    fn stopped(&self) -> bool {
        self.steps.load(Ordering::Relaxed) >= self.most
    }
}

#[test]
fn halves_are_independent_and_right_on_average_at_every_price() {
    let stage = windows(40);
    let receivers: Vec<&Receiver> = stage.receivers().iter().step_by(173).collect();
    let seeds = 4_000;
    for a_ray in [1e-2, 1e-4, 1e-6] {
        let price = Price { relative: RelMse::about(&[Vec3::splat(0.5)]), a_ray };
        for at in &receivers {
            // Four estimates of 160,000 points each are nearly without noise beside those of the test.
            let brute = Moments::of((0..4).map(|seed| exact(&stage, at, 160_000, seed).mean().y));
            let one = |seed| refined(&stage, at, price, seed).halves.map(|half| half.y);
            let found: Vec<[f64; 2]> = (0..seeds).into_par_iter().map(one).collect();
            let sum = exact(&stage, at, 0, 0).sum.y;
            let [a, b] = [0, 1].map(|half| Moments::of(found.iter().map(|halves| halves[half] + sum)));
            // 18 receivers at most, three prices, two halves and a correlation: 1e-5 each is 0.2 % in all.
            let limit = student_quantile(1.0 - 0.5e-5, seeds as usize - 1);
            for half in [a, b] {
                let error = half.standard_error().hypot(brute.standard_error()).max(1e-9 * brute.mean);
                let t = (half.mean - brute.mean) / error;
                assert!(t.abs() < limit, "price {a_ray}, pixel {}: t = {t:.2}, limit {limit:.2}", at.pixel);
            }
            let products = Moments::of(found.iter().map(|[x, y]| (x + sum - a.mean) * (y + sum - b.mean)));
            let t = products.mean / products.standard_error();
            assert!(
                t.is_nan() || t.abs() <= limit,
                "price {a_ray}, pixel {}: halves are correlated, t = {t:.2}",
                at.pixel
            );
        }
    }
}

#[test]
fn lights_without_extent_are_summed_to_the_same_bits_at_any_price() {
    let stage = stage(sixteen());
    for at in stage.receivers().iter().step_by(97) {
        for a_ray in [1.0, 1e-5] {
            let price = Price { relative: RelMse::default(), a_ray };
            assert_eq!(refined(&stage, at, price, 3).sum, exact(&stage, at, 64, 5).sum);
        }
    }
}

#[test]
fn a_bound_is_kept_by_measuring_fewer_receivers_as_exactly() {
    let (stage, cache) = (windows(120), tempfile::tempdir().expect("a folder"));
    let whole = Target::whole(&stage);
    let free = Wanted { work_s: f64::INFINITY, ..Wanted::new(1e-6) };
    let bounded = |wanted| Reference::bounded(&whole, wanted, cache.path(), &Unobserved).expect("a reference");
    let (all, unbounded) = bounded(free);
    assert!(!all.is_subset() && unbounded.notes(&all, free).is_empty());
    assert!(unbounded.truth.own_rel_mse() <= 1e-6);
    let tight = Wanted { work_s: 0.6 * unbounded.work_s, ..free };
    let (some, reference) = bounded(tight);
    let count = some.places.len();
    assert!((FEWEST..whole.places.len()).contains(&count), "{count} receivers");
    assert_eq!(reference.truth.mean().len(), count);
    assert!(reference.work_s <= 1.2 * tight.work_s, "{} of {} s", reference.work_s, tight.work_s);
    // Some receivers are not all: what few say of the price may be a little off.
    assert!(reference.truth.own_rel_mse() <= 1.25e-6, "{}", reference.truth.own_rel_mse());
    let notes = reference.notes(&some, tight).join("\n");
    assert!(notes.contains(&format!("at {count} of {} receivers", whole.places.len())), "{notes}");
}

#[test]
fn where_even_the_fewest_receivers_are_too_many_the_image_is_less_exact_and_that_is_said() {
    let (stage, cache) = (windows(40), tempfile::tempdir().expect("a folder"));
    let whole = Target::whole(&stage);
    let wanted = Wanted { work_s: 1.0, ..Wanted::new(1e-13) };
    let (some, reference) = Reference::bounded(&whole, wanted, cache.path(), &Unobserved).expect("a reference");
    assert_eq!(some.places.len(), FEWEST);
    assert!(reference.work_s <= 1.2 * wanted.work_s, "{} of {} s", reference.work_s, wanted.work_s);
    assert!(reference.work_s > 0.3 * wanted.work_s, "{} of {} s: it could be better", reference.work_s, wanted.work_s);
    let notes = reference.notes(&some, wanted).join("\n");
    assert!(notes.contains("where 1.0e-13 was wanted"), "{notes}");
}

#[test]
fn a_picture_has_all_its_pixels_whatever_the_bound() {
    let (stage, cache) = (windows(40), tempfile::tempdir().expect("a folder"));
    let whole = Target::whole(&stage);
    let wanted = Wanted { own_rel_mse: 1e-9, work_s: 0.5, fewest: usize::MAX };
    let (all, reference) = Reference::bounded(&whole, wanted, cache.path(), &Unobserved).expect("a reference");
    assert_eq!(all.places.len(), whole.places.len());
    assert!(reference.work_s <= 1.2 * wanted.work_s, "{} of {} s", reference.work_s, wanted.work_s);
}

#[test]
fn exact_sums_are_bounded_too() {
    let lights = (0..200).map(|i| point(Vec3::new((i % 20) as f32 - 10.0, (i / 20) as f32 - 5.0, 4.0), 20.0)).collect();
    let (stage, cache) = (stage(ground(12.0, lights)), tempfile::tempdir().expect("a folder"));
    let whole = Target::whole(&stage);
    let all = Reference::compute(&whole, 1e-9, cache.path(), &Unobserved).expect("a reference");
    assert!(all.exact_sum && all.truth.own_rel_mse() == 0.0);
    let wanted = Wanted { work_s: 0.5 * all.work_s, ..Wanted::new(1e-9) };
    let (some, half) = Reference::bounded(&whole, wanted, cache.path(), &Unobserved).expect("a reference");
    assert!(some.is_subset() && half.work_s <= 1.2 * wanted.work_s);
    for (&i, &found) in some.places.iter().zip(half.truth.mean()) {
        assert_eq!(found, exact(&stage, &stage.receivers()[i], 0, 0).sum.as_vec3(), "to the last bit");
    }
}

#[test]
fn what_is_said_of_its_own_noise_is_so() {
    let (stage, cache) = (windows(40), tempfile::tempdir().expect("a folder"));
    let whole = Target::whole(&stage);
    let at = |own| Reference::compute(&whole, own, cache.path(), &Unobserved).expect("a reference").truth;
    let (rough, fine) = (at(1e-4), at(1e-8));
    let found = fine.errors(rough.mean()).rel_mse;
    let said = rough.own_rel_mse();
    assert!((0.7..1.4).contains(&(found / said)), "relMSE {found:.2e} against {said:.2e}");
}

#[test]
fn an_interrupted_reference_goes_on_and_comes_to_the_same() {
    let stage = windows(40);
    let whole = Target::whole(&stage);
    let [straight, resumed] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let wanted = Wanted::new(1e-5);
    let (_, expected) = Reference::bounded(&whole, wanted, straight.path(), &Unobserved).expect("a reference");
    // The first few receivers, and a part of what follows.
    let most = FEWEST as u64 * 4;
    let stopped = Reference::bounded(&whole, wanted, resumed.path(), &Impatient::after(most));
    assert!(matches!(stopped.err(), Some(Error::Interrupted)));
    let patient = Impatient::after(u64::MAX);
    let (_, found) = Reference::bounded(&whole, wanted, resumed.path(), &patient).expect("a reference");
    assert_eq!(found.truth, expected.truth);
    assert_eq!((found.rays, found.work_s), (expected.rays, expected.work_s));
    let again = Impatient::after(u64::MAX);
    let (_, cached) = Reference::bounded(&whole, wanted, resumed.path(), &again).expect("a reference");
    assert!(cached.cached && again.steps.into_inner() == 0);
    assert!(patient.steps.into_inner() > 0);
}
