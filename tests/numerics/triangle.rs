//! Promise: what a receiver sees of a triangle is right to the last digits that matter, and points on it follow their
//! density.

use citylights::base::random::Stream;
use citylights::base::statistics::sidak;
use citylights::base::triangle::{Projected, Seen, SolidAngle};
use citylights::stability::precise;
use citylights::stability::triangles::{FAMILIES, Posed};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::PI;

/// A triangle of one of the families.
fn family(name: &str, seed: u64) -> Posed {
    let (_, draw) = FAMILIES.iter().find(|(known, _)| *known == name).expect("a family");
    draw(&mut Stream::keyed(&[seed]))
}

/// The density of a map from the square, in square units for each of barycentric area, by differences in `u`.
fn spread(sample: impl Fn([f64; 2]) -> [f64; 2], u: [f64; 2]) -> f64 {
    let step = 1e-4;
    let along = |axis: usize| {
        let at = |offset: f64| {
            let mut moved = u;
            moved[axis] += offset * step;
            sample(moved)
        };
        // Five points: the error is of fourth order.
        let [m2, m1, p1, p2] = [-2.0, -1.0, 1.0, 2.0].map(at);
        [0, 1].map(|i| (8.0 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12.0 * step))
    };
    let (x, y) = (along(0), along(1));
    (x[0] * y[1] - x[1] * y[0]).abs()
}

/// Triangles over the origin of a given solid angle, about, and a normal that sees all of them or half.
fn sized(solid_angle: f64, stream: &mut Stream) -> [DVec3; 3] {
    // A triangle of the plane z = height; the height by bisection.
    let corners = [DVec3::new(-1.1, -0.7, 0.0), DVec3::new(1.0, -0.8, 0.0), DVec3::new(0.1, 1.2, 0.0)]
        .map(|corner| corner + DVec3::new(stream.uniform64(), stream.uniform64(), 0.0) * 0.2);
    let at = |height: f64| corners.map(|corner| corner + DVec3::Z * height);
    let (mut low, mut high) = (1e-9f64, 1e9f64);
    for _ in 0..200 {
        let middle = (low * high).sqrt();
        if Seen::new(at(middle)).solid_angle().abs() > solid_angle { low = middle } else { high = middle }
    }
    at(high)
}

#[test]
fn the_density_is_one_over_the_solid_angle_from_a_billionth_to_half_the_sphere() {
    let mut stream = Stream::keyed(&[41]);
    for solid_angle in
        [1e-12, 1e-9, 1e-7, 1e-5, 3e-4, 1e-3, 0.1, 1.0, 3.0, PI, 4.0, 6.0, 6.2, 2.0 * PI - 3e-3, 2.0 * PI - 1e-4]
    {
        let seen = Seen::new(sized(solid_angle, &mut stream));
        let exact = precise::solid_angle(seen_corners(&seen)).abs();
        assert!((exact / solid_angle - 1.0).abs() < 1e-6, "{exact} for {solid_angle}");
        let sampler = SolidAngle::new(&seen).expect("a solid angle");
        assert!((sampler.solid_angle() / exact - 1.0).abs() < 1e-9, "{solid_angle} sr");
        for _ in 0..50 {
            let u = [0.02 + 0.96 * stream.uniform64(), 0.02 + 0.96 * stream.uniform64()];
            let steradians = seen.steradians_per_area(sampler.sample(u)) * spread(|u| sampler.sample(u), u);
            assert!((steradians / exact - 1.0).abs() < 1e-4, "{steradians} for {exact} sr at {u:?}");
        }
    }
}

fn seen_corners(seen: &Seen) -> [[f64; 3]; 3] {
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|weights| seen.point(weights).to_array())
}

#[test]
fn the_projected_density_is_the_cosine_over_the_irradiance() {
    let mut stream = Stream::keyed(&[43]);
    let mut cut = 0;
    for solid_angle in [1e-9, 1e-6, 1e-3, 0.1, 1.0, 3.0, 6.0, 2.0 * PI - 3e-3] {
        for normal in [DVec3::Z, DVec3::new(0.6, 0.0, 0.8), DVec3::X, DVec3::new(0.0, -0.8, -0.6)] {
            // Off the axis, so that a horizon may cut the small ones: the normal is tilted until it does.
            let corners = sized(solid_angle, &mut stream);
            let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
            let seen = Seen::new(corners);
            let tilted = (normal - centre * (normal.dot(centre) / centre.length_squared()) * 0.999_999).normalize();
            for normal in [normal, tilted] {
                let exact = precise::irradiance(seen_corners(&seen), normal.to_array());
                let Some(sampler) = Projected::new(&seen, normal) else {
                    assert!(exact < 1e-30, "{exact}");
                    continue;
                };
                cut += usize::from(corners.iter().any(|corner| normal.dot(*corner) < 0.0));
                assert!((sampler.irradiance() / exact - 1.0).abs() < 1e-6, "{} for {exact}", sampler.irradiance());
                assert_eq!(sampler.irradiance(), seen.irradiance(normal));
                for _ in 0..20 {
                    let u = [0.02 + 0.96 * stream.uniform64(), 0.02 + 0.96 * stream.uniform64()];
                    // The map may be torn where one part of the triangle ends and the other begins.
                    let moved = [-2e-4, 2e-4].map(|by| sampler.sample([u[0] + by, u[1]]));
                    if (moved[0][0] - moved[1][0]).abs() + (moved[0][1] - moved[1][1]).abs() > 0.1 {
                        continue;
                    }
                    let at = sampler.sample(u);
                    let cosine = seen.point(at).normalize().dot(normal);
                    assert!(cosine >= -1e-9, "{cosine} below the horizon");
                    let light = cosine * seen.steradians_per_area(at) * spread(|u| sampler.sample(u), u);
                    assert!((light / exact - 1.0).abs() < 1e-4, "{light} for {exact} of {solid_angle} sr at {u:?}");
                }
            }
        }
    }
    assert!(cut > 20, "the horizon cut {cut} triangles alone");
}

/// The quarters of a triangle halved along each edge.
fn quarters([a, b, c]: &[[f64; 2]; 3]) -> [[[f64; 2]; 3]; 4] {
    let middle = |p: &[f64; 2], q: &[f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
    [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]
}

/// Barycentric corners of the parts of a triangle halved `depth` times along each edge.
fn parts(depth: u32) -> Vec<[[f64; 2]; 3]> {
    let mut parts = vec![[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]];
    for _ in 0..depth {
        parts = parts.iter().flat_map(quarters).collect();
    }
    parts
}

/// Which quarter of the whole triangle a point lies in, in the order of [`parts`], and where within that quarter.
fn quarter([x, y]: [f64; 2]) -> (usize, [f64; 2]) {
    let (x, y) = (2.0 * x, 2.0 * y);
    if x > 1.0 {
        (1, [x - 1.0, y])
    } else if y > 1.0 {
        (2, [x, y - 1.0])
    } else if x + y > 1.0 {
        // The middle one: its corners are those of ab, bc, ca.
        let (x, y) = (1.0 - x, 1.0 - y);
        (3, [1.0 - x - y, x])
    } else {
        (0, [x, y])
    }
}

/// A triangle cut into cells of which none holds much of a density, however near to one point most of it lies.
struct Cells {
    /// The corners' weights and the share of the density; the first of its four quarters where it is cut further.
    nodes: Vec<([[f64; 2]; 3], f64, Option<usize>)>,
}

impl Cells {
    /// Cuts the heaviest cell into quarters until there are 64, and none has more than a twentieth.
    fn new(share: impl Fn([[f64; 2]; 3]) -> f64) -> Self {
        const CUTS: usize = 500;
        let whole = parts(0)[0];
        let mut nodes = vec![(whole, share(whole), None)];
        for cut in 0..CUTS {
            let leaves = (0..nodes.len()).filter(|i| nodes[*i].2.is_none());
            let heaviest = leaves.max_by(|i, j| nodes[*i].1.total_cmp(&nodes[*j].1)).expect("a leaf");
            if cut >= 21 && nodes[heaviest].1 <= 0.05 {
                return Self { nodes };
            }
            nodes[heaviest].2 = Some(nodes.len());
            let quarters = quarters(&nodes[heaviest].0);
            nodes.extend(quarters.map(|corners| (corners, share(corners), None)));
        }
        panic!("{CUTS} cuts leave a cell that is too heavy");
    }

    /// The cell of a point.
    fn of(&self, mut at: [f64; 2]) -> usize {
        let mut node = 0;
        while let Some(first) = self.nodes[node].2 {
            let (index, within) = quarter(at);
            (node, at) = (first + index, within);
        }
        node
    }
}

#[test]
fn a_point_lies_in_its_cell() {
    // Nearly all lies at a point inside, and at a corner.
    for heavy in [[0.3, 0.45], [0.0, 0.0], [1.0, 0.0]] {
        let cells = Cells::new(|corners| {
            let centre = [0, 1].map(|x| corners.iter().map(|corner| corner[x]).sum::<f64>() / 3.0);
            let off = (centre[0] - heavy[0]).powi(2) + (centre[1] - heavy[1]).powi(2);
            let [a, b, c] = corners;
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            // About the integral.
            area.abs() / (off + 1e-9) / 122.0
        });
        assert!(cells.nodes.len() >= 85);
        for (i, (corners, _, _)) in cells.nodes.iter().enumerate().filter(|(_, node)| node.2.is_none()) {
            let at = [0, 1].map(|x| 0.5 * corners[0][x] + 0.3 * corners[1][x] + 0.2 * corners[2][x]);
            assert_eq!(cells.of(at), i, "{corners:?}");
        }
    }
}

/// Chi-squared of a sampler's points against the share of the density that each cell of the triangle should get, and
/// its degrees of freedom.
fn chi_squared(
    sample: impl Fn([f64; 2]) -> [f64; 2],
    share: impl Fn([[f64; 3]; 3]) -> f64,
    seen: &Seen,
    seed: u64,
) -> (f64, f64) {
    const DRAWS: u32 = 100_000;
    let cells = Cells::new(|corners| share(corners.map(|weights| seen.point(weights).to_array())));
    let mut stream = Stream::keyed(&[seed]);
    let mut counts = vec![0u32; cells.nodes.len()];
    for _ in 0..DRAWS {
        counts[cells.of(sample([stream.uniform64(), stream.uniform64()]))] += 1;
    }
    // Cells that expect fewer than ten points are taken together.
    let (mut statistic, mut used, mut rest, mut total) = (0.0, 0, (0.0, 0.0), 0.0);
    let mut add = |expected: f64, count: f64| {
        statistic += (count - expected).powi(2) / expected;
        used += 1;
    };
    for ((_, share, _), count) in cells.nodes.iter().zip(&counts).filter(|((_, _, cut), _)| cut.is_none()) {
        let expected = f64::from(DRAWS) * share;
        total += share;
        if expected >= 10.0 {
            add(expected, f64::from(*count));
        } else {
            rest = (rest.0 + expected, rest.1 + f64::from(*count));
        }
    }
    assert!((total - 1.0).abs() < 1e-6, "the cells hold {total} of the density");
    if rest.0 >= 1.0 {
        add(rest.0, rest.1);
    } else {
        assert!(rest.1 <= 12.0, "{} points where {} are due", rest.1, rest.0);
    }
    (statistic, f64::from(used - 1))
}

#[test]
fn points_follow_their_density_in_every_part() {
    const EACH: u64 = 3;
    let families = ["ordinary", "distant", "sliver", "vertex", "touching", "micro"];
    let level = sidak(1e-3, families.len() * EACH as usize * 3);
    let judge = |what: &str, (statistic, freedom): (f64, f64)| {
        // No cell has more than a twentieth.
        assert!(freedom >= 19.0, "{what}: {freedom} degrees of freedom say little");
        let limit = ChiSquared::new(freedom).expect("degrees of freedom").inverse_cdf(1.0 - level);
        (statistic >= limit).then(|| format!("{what}: {statistic} of {freedom} degrees of freedom"))
    };
    let (mut tested, mut cut, mut failed) = (0, 0, Vec::new());
    for name in families {
        for seed in 0..EACH {
            let posed = family(name, 1000 + seed);
            let (seen, normal) = (posed.seen(), posed.normal.as_dvec3().normalize());
            let sampler = SolidAngle::new(&seen).expect("an area");
            let whole = precise::solid_angle(seen_corners(&seen)).abs();
            let share = |part| precise::solid_angle(part).abs() / whole;
            failed.extend(judge(&format!("{name} {seed}"), chi_squared(|u| sampler.sample(u), share, &seen, seed)));
            tested += 1;
            for normal in [normal, -normal] {
                let Some(sampler) = Projected::new(&seen, normal) else { continue };
                cut += usize::from(seen_corners(&seen).iter().any(|c| normal.dot(DVec3::from_array(*c)) < 0.0));
                let whole = precise::irradiance(seen_corners(&seen), normal.to_array());
                let share = |part| precise::irradiance(part, normal.to_array()) / whole;
                let found = chi_squared(|u| sampler.sample(u), share, &seen, seed);
                failed.extend(judge(&format!("{name} {seed}, projected"), found));
                tested += 1;
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    assert!(tested > 36 && cut > 5, "{tested} histograms, {cut} of triangles cut by the horizon");
}

/// The integral over barycentric weights by the midpoints of [`parts`], extrapolated from two depths.
fn integral(f: impl Fn([f64; 2]) -> f64) -> f64 {
    let sum = |depth: u32| {
        let parts = parts(depth);
        let area = 0.5 / parts.len() as f64;
        parts.iter().map(|[a, b, c]| area * f([0, 1].map(|x| (a[x] + b[x] + c[x]) / 3.0))).sum::<f64>()
    };
    (4.0 * sum(8) - sum(7)) / 3.0
}

#[test]
fn densities_integrate_to_one() {
    for (seed, distance) in [(1, 0.5), (2, 1.0), (3, 3.0), (4, 40.0), (5, 1e4)] {
        let mut stream = Stream::keyed(&[seed]);
        let mut point = || DVec3::new(stream.uniform64(), stream.uniform64(), stream.uniform64());
        let seen = Seen::new([point(), point(), point()].map(|corner| corner + DVec3::Z * distance));
        let total = integral(|at| seen.steradians_per_area(at) / seen.solid_angle().abs());
        assert!((total - 1.0).abs() < 1e-6, "solid angle at {distance}: {total}");
        let normal = DVec3::new(0.36, -0.48, 0.8);
        assert!(seen_corners(&seen).iter().all(|corner| normal.dot(DVec3::from_array(*corner)) > 0.0));
        let cosine = |at| seen.point(at).normalize().dot(normal);
        let total = integral(|at| cosine(at) * seen.steradians_per_area(at) / seen.irradiance(normal));
        assert!((total - 1.0).abs() < 1e-6, "projected at {distance}: {total}");
    }
}

#[test]
fn a_triangle_cut_by_the_horizon_sends_what_is_above() {
    for seed in 0..20 {
        let posed = family("ordinary", seed);
        let (seen, normal) = (posed.seen(), posed.normal.as_dvec3());
        let cosine = |at| seen.point(at).normalize().dot(normal).max(0.0);
        let wanted = integral(|at| cosine(at) * seen.steradians_per_area(at));
        let found = seen.irradiance(normal);
        // Midpoints know a kink and a receiver that is near to half a thousandth.
        assert!((found - wanted).abs() < 5e-4 * (1.0 + wanted), "{found} for {wanted}, seed {seed}");
    }
}

/// A triangle that moves with a number from 0 to 1.
type Path = Box<dyn Fn(f64) -> [DVec3; 3]>;

#[test]
fn no_switch_between_methods_makes_a_step() {
    // Paths along which a triangle passes every switch: from afar to touching, through its plane, past an edge, over
    // the horizon, from long and thin to round. A step anywhere would be an error there.
    let base = [DVec3::new(-0.3, -0.2, 0.0), DVec3::new(0.7, -0.1, 0.1), DVec3::new(0.1, 0.9, -0.2)];
    let by = move |offset: DVec3| base.map(|corner| corner + offset);
    let normal = DVec3::new(0.48, 0.64, 0.6);
    let paths: [(&str, Path); 7] = [
        ("distance", Box::new(move |t| by(DVec3::Z * 10f64.powf(9.0 * t - 4.0)))),
        ("through the plane", Box::new(move |t| by(DVec3::new(2.0, 0.0, t * 1e-5)))),
        ("through the inside", Box::new(move |t| by(DVec3::new(-0.1, -0.1, (t - 0.5) * 1e-2)))),
        ("past an edge", Box::new(move |t| by(DVec3::new(0.02, 0.1 + 0.1 * t, -0.03)))),
        ("over the horizon", Box::new(move |t| by(DVec3::new(2.0, 3.0, -4.0 * t - 1.0)))),
        ("over the horizon, far away", Box::new(move |t| by(DVec3::new(0.8, -0.6, 0.0) * 1e6 + normal * (t - 0.5)))),
        (
            "thickness",
            Box::new(move |t| {
                let [a, b, c] = by(DVec3::new(0.0, 1.0, 2.0));
                [a, b, a + (c - a) * 10f64.powf(-12.0 * t)]
            }),
        ),
    ];
    const STEPS: u32 = 20_000;
    for (name, path) in &paths {
        let mut last: Option<[f64; 2]> = None;
        for step in 0..=STEPS {
            let corners = path((f64::from(step) + 0.3) / f64::from(STEPS));
            let (seen, plain) = (Seen::new(corners), corners.map(|corner| corner.to_array()));
            let (found, exact) = (seen.solid_angle(), precise::solid_angle(plain));
            assert!((found - exact).abs() <= 1e-7 * exact.abs(), "{name} {step}: {found} for {exact} sr");
            let (found, exact) = (seen.irradiance(normal), precise::irradiance(plain, normal.to_array()));
            // Far away up to 1e-19 arrives; ours is off by 4e-29, with edges of plain a x b it would be by 3e-23.
            let (relative, floor) = if name.ends_with("far away") { (1e-7, 1e-26) } else { (1e-9, 1e-15) };
            assert!((found - exact).abs() <= relative * exact + floor, "{name} {step}: {found} for {exact}");
            // The point for one pair of numbers moves along with the triangle.
            let Some(sampler) = SolidAngle::new(&seen) else { continue };
            let at = sampler.sample([0.37, 0.61]);
            if let Some(last) = last.filter(|_| *name != "through the inside") {
                let moved = (at[0] - last[0]).hypot(at[1] - last[1]);
                assert!(moved < 5e-3, "{name} {step}: the point jumps by {moved}");
            }
            last = Some(at);
        }
    }
}

/// Coordinates that do damage: powers of ten, exact cancellations, zeros, the ends of what f32 holds.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -2.0f32..2.0,
        2 => (-38i32..38, -1.0f32..1.0).prop_map(|(power, x)| x * 10f32.powi(power)),
        1 => prop::sample::select(vec![0.0f32, -0.0, 1.0, -1.0, 0.5, 1.0 + f32::EPSILON, -1.0 - f32::EPSILON, 1e-45, f32::MIN_POSITIVE, 3e38, -3e38]),
    ]
}

fn vector() -> impl Strategy<Value = Vec3> {
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

/// Any triangle, also of corners that are mixtures of one another.
fn adversarial() -> impl Strategy<Value = [Vec3; 3]> {
    let mixed = (vector(), vector(), -2.0f32..2.0, -2.0f32..2.0).prop_map(|(a, b, s, t)| [a, b, a * s + b * t]);
    let opposite = (vector(), vector(), -2.0f32..0.0).prop_map(|(a, c, s)| [a, a * s, c]);
    let any = (vector(), vector(), vector()).prop_map(|(a, b, c)| [a, b, c]);
    prop_oneof![any, mixed, opposite].prop_filter("finite", |corners| corners.iter().all(|c| c.is_finite()))
}

fn unit() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.0..1.0f64, 1 => prop::sample::select(vec![0.0, 1e-300, 1e-17, 0.5, 1.0 - f64::EPSILON / 2.0])]
}

fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0f64, 0.0..2.0 * PI).prop_map(|(z, turn)| {
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    })
}

/// Whatever the triangle, results are within their ranges and points on it.
fn within_ranges(seen: &Seen, normal: DVec3, u: [f64; 2]) -> Result<(), TestCaseError> {
    let solid_angle = seen.solid_angle();
    prop_assert!(solid_angle.abs() <= 2.0 * PI, "{} sr", solid_angle);
    let irradiance = seen.irradiance(normal);
    prop_assert!((0.0..=PI + 1e-12).contains(&irradiance), "irradiance {}", irradiance);
    let on_triangle = |[b1, b2]: [f64; 2]| b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0 + 1e-15;
    if let Some(sampler) = SolidAngle::new(seen) {
        prop_assert_eq!(sampler.solid_angle(), solid_angle.abs());
        let at = sampler.sample(u);
        prop_assert!(on_triangle(at), "{:?} by solid angle", at);
    }
    if let Some(sampler) = Projected::new(seen, normal) {
        let at = sampler.sample(u);
        prop_assert!(on_triangle(at), "{:?} by irradiance {}", at, sampler.irradiance());
    }
    Ok(())
}

/// A triangle of a family, of which the exact values are known.
fn exact(family: usize, seed: u64, u: [f64; 2]) -> Result<(), TestCaseError> {
    let (name, draw) = FAMILIES[family];
    let posed = draw(&mut Stream::keyed(&[seed, family as u64]));
    let (seen, plain, normal) = (posed.seen(), posed.coordinates(), posed.normal.as_dvec3());
    within_ranges(&seen, normal, u)?;
    let (found, exact) = (seen.solid_angle(), precise::solid_angle(plain));
    prop_assert!((found - exact).abs() <= 1e-7 * exact.abs(), "{}: {} for {} sr", name, found, exact);
    let (found, light) = (seen.irradiance(normal), precise::irradiance(plain, normal.to_array()));
    prop_assert!((found - light).abs() <= 1e-6 * light.max(1e-7 * PI), "{}: irradiance {} for {}", name, found, light);
    if let Some(sampler) = SolidAngle::new(&seen) {
        // Lines of corners that are one for f64 have no cut to speak of.
        if name != "degenerate" {
            let shares = precise::shares(plain, sampler.sample(u));
            let off = (shares[0] - u[0]).abs().max((shares[1] - u[1]).abs());
            prop_assert!(off <= 1e-3, "{}: shares {:?} for {:?}", name, shares, u);
        }
    }
    Ok(())
}

fn run(cases: u32) {
    // The same triangles each time.
    let runner = || {
        let config = Config { cases, failure_persistence: None, ..Config::default() };
        TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[4; 32]))
    };
    let any = (0..FAMILIES.len(), any::<u64>(), 1e-3..0.999f64, 1e-3..0.999f64);
    runner().run(&any, |(family, seed, u, v)| exact(family, seed, [u, v])).unwrap_or_else(|error| panic!("{error}"));
    let any = (adversarial(), direction(), unit(), unit());
    runner()
        .run(&any, |(corners, normal, u, v)| within_ranges(&Seen::new(corners.map(Vec3::as_dvec3)), normal, [u, v]))
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn ten_thousand_triangles_are_seen_right() {
    run(5_000);
}

#[test]
#[ignore = "a minute: a million triangles"]
fn a_million_triangles_are_seen_right() {
    run(500_000);
}
