//! What did tuning find for a recipe: which points of each strategy's grid, and at which price and error of a pass?
//!
//! All of it follows from what tuning left, `tuned.json`, alone.

use super::chart::{Chart, Dot, Scale, Series};
use super::mark::Mark;
use super::markdown;
use super::number::{Estimate, NONE, grouped, short};
use super::page::built;
use super::sheet::{Entry, Head, Line, Sheet};
use crate::base::error::Result;
use crate::record::store::file_name;
use crate::record::tuned::{OnCity, Tuned, TunedPoint, TunedStrategy};
use std::fmt::Write;

/// The files that the page and the plot of a recipe are written to.
pub(super) fn files(family: &str) -> [String; 2] {
    [
        format!("{}.md", file_name(&format!("tuned-{family}"))),
        format!("{}.svg", file_name(&format!("frontier-{family}"))),
    ]
}

/// The page in GitHub's Markdown; `plot` is the address of the plot as seen from there.
pub(super) fn page(family: &str, tuned: &Tuned, plot: &str) -> String {
    let mut text = format!("# {}\n\n", markdown::plain(&title(family)));
    facts(tuned).iter().for_each(|fact| _ = writeln!(text, "- {}", markdown::plain(fact)));
    _ = writeln!(text, "\n![{}: error of a pass against its price]({plot})", markdown::label(family));
    _ = write!(text, "\n{}", sheet(tuned).markdown(2));
    let made = built(tuned.program.as_ref(), &tuned.version, &tuned.revision);
    _ = write!(text, "\n## Made by\n\n- revision: {}\n- seed: {}\n", markdown::plain(&made), tuned.seed);
    text
}

/// The plot as SVG: the error of a pass against its price, with the points joined that no other point of the same strategy
/// beats in both.
///
/// # Errors
/// A plot that cannot be drawn.
pub(super) fn plot(family: &str, tuned: &Tuned) -> Result<String> {
    let scale = |label: &str| Scale { label: label.to_owned(), logarithmic: true };
    let (mut joined, mut loose) = (Vec::new(), Vec::new());
    for (nth, strategy) in tuned.strategies.iter().enumerate() {
        let figures = strategy.points.iter().filter_map(|point| Figures::of(&point.cities));
        let mut points: Vec<Dot> = figures.filter_map(Figures::dot).collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        let is_beaten = |p: &Dot| points.iter().any(|q| q.x <= p.x && q.y <= p.y && (q.x < p.x || q.y < p.y));
        let (beaten, best) = points.iter().copied().partition(is_beaten);
        joined.push(Series { name: strategy.default.clone(), mark: Mark::nth(nth, false), points: best });
        loose.push(Series { name: String::new(), mark: Mark::loose(nth), points: beaten });
    }
    let remarks = ["filled: no point of the same strategy", "is both cheaper and better", "hollow: the other points"];
    Chart {
        title: title(family),
        subtitle: format!(
            "geometric means over {} cities; V, their product, falls to the lower left",
            tuned.cities.len()
        ),
        x: scale("nominal CPU seconds of a pass, with its share of the set-up"),
        y: scale("relMSE x passes"),
        series: loose.into_iter().chain(joined).collect(),
        remarks: remarks.into_iter().zip([34, 19, 25]).map(|(text, step)| (step, text.to_owned())).collect(),
    }
    .svg()
}

fn title(family: &str) -> String {
    format!("{family}: parameters found by tuning")
}

/// What was tuned on what, a line each.
fn facts(tuned: &Tuned) -> Vec<String> {
    let Tuned { condition, time_s, runs, rates, .. } = tuned;
    let seeds: Vec<String> = tuned.cities.iter().map(|city| city.seed.to_string()).collect();
    vec![
        format!(
            "{} (hash {}), about {} lights; receivers: {}",
            condition.recipe,
            condition.hash,
            grouped(condition.lights),
            condition.receivers
        ),
        format!("cities of the seeds {}, none of which is reported", seeds.join(", ")),
        format!("least error in {} nominal CPU seconds, set-up in: work counted at rates {rates}", short(*time_s)),
        format!(
            "{runs} runs on each city for the choice; the best, the next and the default have {runs} fresh ones, that \
                 nothing was chosen by"
        ),
    ]
}

fn sheet(tuned: &Tuned) -> Sheet {
    let heads = ["passes", "nominal s\na pass", "relMSE\nx passes", "V", "V over\nthe best's"].map(Head::right);
    let heads = std::iter::once(Head::left("strategy")).chain(heads).chain([Head::left("left, and why")]);
    let mut lines = Vec::new();
    for (strategy, group) in tuned.strategies.iter().zip(0..) {
        let mut points: Vec<&TunedPoint> = strategy.points.iter().collect();
        let score = |point: &TunedPoint| point.score.unwrap_or(f64::INFINITY);
        points.sort_by(|a, b| score(a).total_cmp(&score(b)));
        lines.extend(points.into_iter().map(|point| Line { cells: cells(strategy, point), group }));
    }
    let below = [
        "nominal s a pass: counted work of a run, set-up in, over its passes. It and relMSE x passes are geometric means over \
         the cities.",
        "V: the time x relMSE of a run x its passes over those, whole or not, that fit into the time beside set-up and arrivals; of \
         a biased strategy relMSE x nominal seconds of a run, the time at least, in which its noise alone would have gone on falling.",
        "V over the best's: of the default it is what tuning gains. ±9 % or -8 +15 %: 95 % intervals over cities, by Student's \
         t on the logarithms; without one, a figure of the runs that chose.",
        "Never tuned on what is reported: the rows of the comparison are of other cities.",
    ];
    Sheet {
        title: "Points of the grids".to_owned(),
        heads: heads.collect(),
        lines,
        below: below.map(str::to_owned).to_vec(),
    }
    .explained()
}

fn cells(strategy: &TunedStrategy, point: &TunedPoint) -> Vec<Entry> {
    let number = |value: Option<f64>| Entry::Figure(Estimate::certain(value.map_or(NONE.to_owned(), short)));
    let figures = Figures::of(&point.cities);
    let is_best = strategy.best.as_ref() == Some(&point.name);
    let is_default = strategy.default == point.name;
    let next = strategy.second.as_ref().filter(|second| second.name == point.name);
    let marks = [(is_best, "best"), (is_default, "default"), (next.is_some(), "next")];
    let marks: Vec<&str> = marks.into_iter().filter_map(|(is, mark)| is.then_some(mark)).collect();
    let interval = if is_default { strategy.gain } else { None }.or(next.map(|next| next.over_best));
    let over_best = match interval {
        Some(interval) => Entry::Figure(Estimate::of(interval)),
        None => number(point.score.zip(best_score(strategy)).map(|(own, best)| own / best)),
    };
    vec![
        Entry::Name(point.name.clone(), marks.join(", ")),
        number(figures.map(|figures| figures.passes)),
        number(figures.map(|figures| figures.price_s)),
        number(figures.map(|figures| figures.error)),
        number(point.score),
        over_best,
        Entry::Text(point.out.clone().unwrap_or_default()),
    ]
}

/// V of the best point.
fn best_score(strategy: &TunedStrategy) -> Option<f64> {
    strategy.points.iter().find(|point| Some(&point.name) == strategy.best.as_ref())?.score
}

/// What a point comes to over all cities: geometric means.
#[derive(Clone, Copy)]
struct Figures {
    passes: f64,
    /// Nominal seconds of a run over its passes.
    price_s: f64,
    /// relMSE times passes.
    error: f64,
}

impl Figures {
    /// None where nothing was measured.
    fn of(cities: &[OnCity]) -> Option<Self> {
        let mean = |value: &dyn Fn(&OnCity) -> f64| {
            (cities.iter().map(|city| value(city).ln()).sum::<f64>() / cities.len() as f64).exp()
        };
        (!cities.is_empty()).then(|| Self {
            passes: mean(&|city| f64::from(city.passes)),
            price_s: mean(&|city| city.work_s / f64::from(city.passes)),
            error: mean(&|city| city.rel_mse * f64::from(city.passes)),
        })
    }

    /// Its place in the plot; none of what the axes cannot show.
    fn dot(self) -> Option<Dot> {
        let Self { price_s: x, error: y, .. } = self;
        let is_shown = [x, y].into_iter().all(|value| value.is_finite() && value > 0.0);
        is_shown.then_some(Dot { x, y, low: f64::NAN, high: f64::NAN })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Interval;
    use crate::record::tuned::{Condition, TUNED_SCHEMA, TuningCity};

    /// A point whose V is the same on both cities, up to a factor of 4.
    fn point(name: &str, passes: u32, v: f64, out: Option<&str>) -> TunedPoint {
        let city = |times: f64| OnCity { passes, work_s: 0.1, runs: 6, rel_mse: 10.0 * times * v, v: times * v };
        TunedPoint {
            name: name.into(),
            score: Some(v),
            chosen_by: None,
            out: out.map(str::to_owned),
            cities: vec![city(0.5), city(2.0)],
        }
    }

    fn tuned() -> Tuned {
        let never = TunedPoint { score: None, cities: Vec::new(), ..point("a:k=9", 1, 1.0, Some("one pass is 9 s")) };
        Tuned {
            schema: TUNED_SCHEMA,
            program: None,
            version: "0.1.0".into(),
            revision: "67eec73".into(),
            rates: 1,
            condition: Condition {
                recipe: "village".into(),
                hash: "abcd".into(),
                lights: 1200,
                receivers: "spread".into(),
            },
            time_s: 0.1,
            runs: 6,
            seed: 1,
            cities: [3, 5].map(|seed| TuningCity { seed, hash: "1".into() }).to_vec(),
            strategies: vec![TunedStrategy {
                default: "a".into(),
                best: Some("a:k=4".into()),
                gain: Some(Interval { mean: 2.0, low: 1.8, high: 2.2 }),
                second: None,
                points: vec![
                    point("a", 8, 0.02, None),
                    never,
                    point("a:k=4", 2, 0.01, None),
                    point("a:k=2", 2, 0.04, Some("left after 2 runs on each city")),
                ],
            }],
        }
    }

    #[test]
    fn points_stand_by_v_with_the_best_and_the_default_marked() {
        let page = page("village", &tuned(), "plot.svg");
        let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| `")).collect();
        assert_eq!(
            rows,
            [
                "| `a:k=4`<br>best | 2.00 | 0.0500 | 0.200 | 0.0100 | 1.00 |  |",
                "| `a`<br>default | 8.00 | 0.0125 | 1.60 | 0.0200 | 2.00 ±10 % |  |",
                "| `a:k=2` | 2.00 | 0.0500 | 0.800 | 0.0400 | 4.00 | left after 2 runs on each city |",
                "| `a:k=9` | – | – | – | – | – | one pass is 9 s |",
            ],
            "{page}"
        );
        for said in ["](plot.svg)", "receivers: spread", "seeds 3, 5, none", "revision: 67eec73", "1,200 lights"] {
            assert!(page.contains(said), "{said}: {page}");
        }
    }

    #[test]
    fn the_plot_names_a_strategy_once_and_is_the_same_each_time() {
        let svg = plot("village", &tuned()).expect("a plot");
        assert_eq!(svg, plot("village", &tuned()).expect("a plot"));
        assert_eq!(svg.matches(">\na\n<").count(), 1, "{svg}");
        assert_eq!(files("a b"), ["tuned-a-b.md", "frontier-a-b.svg"]);
    }
}
