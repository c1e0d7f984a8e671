//! What do all cities and views of a recipe say together?
//!
//! Each scene that is a replicate of a family gives one figure a strategy: relMSE times CPU seconds, both at the largest
//! budget, set-up included. Ratios to a base strategy are taken within each replicate, and their spread over
//! replicates says how far another city may be from them.

use super::facts::parameters;
use super::markdown;
use super::number::{Estimate, NONE, grouped, short};
use super::order::measured;
use super::page::made_by;
use super::ratios::{Bar, ratios};
use super::sheet::{Entry, Head, Line, Sheet, broken};
use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::base::ranking::Place;
use crate::base::replicates::{Ratio, Replicates};
use crate::record::{Interval, RunRecord, SceneRecord, Summary, store};
use std::fmt::Write;

/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.95;
/// The chance that any pair of equal rows is told apart.
const LEVEL: f64 = 0.05;

/// Two replicates or more of one scene, and what was measured on them.
pub(super) struct Family<'a> {
    /// The scene that they are replicates of.
    pub(super) name: &'a str,
    scenes: Vec<&'a SceneRecord>,
    /// The strategy that others are held against.
    base: &'a str,
    /// How the strategies' parameters were chosen.
    parameters: Option<String>,
    /// The unbiased strategies, best first; those that are not measured everywhere after those that are.
    rows: Vec<Row<'a>>,
}

/// A strategy over all replicates.
struct Row<'a> {
    strategy: &'a str,
    /// In how many replicates it has a figure.
    measured: usize,
    /// Its ratio to the base.
    ratio: Option<Ratio>,
    place: Option<Place>,
    /// Its ratio in each replicate that has one.
    dots: Vec<(usize, f64)>,
}

/// The families of a comparison that have two replicates or more, in the order of their first scenes.
pub(super) fn families(run: &RunRecord) -> Vec<Family<'_>> {
    let Some(base) = run.base.as_deref() else { return Vec::new() };
    let names = distinct(run.scenes.iter().filter_map(|scene| scene.family.as_deref()));
    let scenes = |name: &str| run.scenes.iter().filter(|scene| scene.family.as_deref() == Some(name)).collect();
    let all = names.into_iter().map(|name| (name, scenes(name)));
    all.filter(|(_, scenes): &(_, Vec<_>)| scenes.len() > 1)
        .map(|(name, scenes)| Family { parameters: parameters(run, name), ..Family::of(name, scenes, base) })
        .collect()
}

/// The tables of all families in plain text, at most so many columns wide.
pub(crate) fn texts(run: &RunRecord, width: usize) -> Vec<String> {
    families(run).iter().map(|family| family.text(width)).collect()
}

impl<'a> Family<'a> {
    fn of(name: &'a str, scenes: Vec<&'a SceneRecord>, base: &'a str) -> Self {
        let unbiased = scenes.iter().flat_map(|scene| &scene.summaries).filter(|s| s.claim == Claim::Unbiased);
        let strategies = distinct(unbiased.map(|summary| summary.strategy.as_str()));
        let figures = |strategy: &&str| scenes.iter().map(|scene| figure(scene, strategy)).collect();
        let replicates = Replicates::of(strategies.iter().map(figures).collect());
        let base_row = strategies.iter().position(|strategy| *strategy == base);
        let places = replicates.places(LEVEL);
        let row = |(at, (strategy, place)): (usize, (&&'a str, Option<Place>))| Row {
            strategy,
            measured: replicates.measured(at),
            ratio: base_row.and_then(|base| replicates.over(at, base, CONFIDENCE)),
            place,
            dots: base_row.map(|base| replicates.ratios(at, base).collect()).unwrap_or_default(),
        };
        let mut rows: Vec<Row<'_>> = strategies.iter().zip(places).enumerate().map(row).collect();
        let mean = |row: &Row<'_>| row.ratio.map_or(f64::INFINITY, |ratio| ratio.mean);
        rows.sort_by(|a, b| (a.place.is_none(), mean(a)).partial_cmp(&(b.place.is_none(), mean(b))).expect("no NaN"));
        Self { name, scenes, base, parameters: None, rows }
    }

    /// The files that the family's page and plot are written to.
    pub(super) fn files(&self) -> [String; 2] {
        ["md", "svg"].map(|end| format!("{}.{end}", store::file_name(&format!("replicates-{}", self.name))))
    }

    /// Whether a scene is one of its replicates.
    pub(super) fn holds(&self, scene: &SceneRecord) -> bool {
        scene.family.as_deref() == Some(self.name)
    }

    /// What it is: `downtown: 20 replicates`.
    fn title(&self) -> String {
        format!("{}: {} replicates", self.name, self.scenes.len())
    }

    /// What the replicates differ in, a line each.
    fn facts(&self) -> Vec<String> {
        let mut seeds: Vec<u64> = self.scenes.iter().map(|scene| scene.seed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        let cities = match &seeds[..] {
            [seed] => format!("one city, seed {seed}"),
            [first, .., last] => format!("{} cities, seeds {first} to {last}", seeds.len()),
            [] => String::new(),
        };
        let replicates = format!("{cities}; views: {}", self.views().join(", "));
        std::iter::once(replicates).chain(self.parameters.clone()).collect()
    }

    /// The views that there are, in the order of the scenes.
    fn views(&self) -> Vec<&'a str> {
        distinct(self.scenes.iter().map(|scene| view_of(scene)))
    }

    fn sheet(&self) -> Sheet {
        let heads = ["rank,\nletters", "ratio", "least", "greatest"].map(Head::right);
        let heads = std::iter::once(Head::left("strategy")).chain(heads);
        let heads = heads.chain([Head::left("worst case"), Head::right("measured in")]);
        let lines = self.rows.iter().map(|row| {
            let worst = row.ratio.map_or("", |ratio| &self.scenes[ratio.greatest.1].name);
            let end = |end: fn(&Ratio) -> (f64, usize)| {
                Entry::Figure(Estimate::certain(row.ratio.map_or(NONE.to_owned(), |ratio| short(end(&ratio).0))))
            };
            let cells = vec![
                Entry::Name(row.strategy.to_owned(), if row.strategy == self.base { "base" } else { "" }.to_owned()),
                Entry::Figure(Estimate::rank(
                    row.place.as_ref().map(|p| p.rank),
                    row.place.as_ref().map_or("", |p| &p.letters),
                )),
                Entry::Figure(row.ratio.map_or(Estimate::certain(NONE), |ratio| Estimate::of(interval(&ratio)))),
                end(|ratio| ratio.least),
                end(|ratio| ratio.greatest),
                // Of the base all cases are alike.
                Entry::Text(if row.strategy == self.base { "" } else { worst }.to_owned()),
                Entry::Figure(Estimate::certain(format!("{} of {}", row.measured, self.scenes.len()))),
            ];
            Line { cells, group: u32::from(row.place.is_none()) }
        });
        let (title, lines) = (format!("Ratio to {}", self.base), lines.collect());
        Sheet { title, heads: heads.collect(), lines, below: self.below() }.explained()
    }

    /// What the table means, an idea a line.
    fn below(&self) -> Vec<String> {
        let base = self.base;
        let mut below = vec![
            format!(
                "ratio: relMSE x CPU seconds over that of `{base}` in the same replicate; the geometric mean over replicates. \
                 Less is better."
            ),
            "Both are means over runs at a row's largest budget, set-up included (V in the tables of a scene leaves set-up \
             out)."
                .to_owned(),
            "±9 % or -8 +15 %: 95 % intervals over replicates, by Student's t on the logarithms. Each city and view counts as \
             a replicate of its own."
                .to_owned(),
            "worst case: the replicate with the greatest ratio.".to_owned(),
        ];
        if self.rows.iter().any(|row| row.place.is_some()) {
            below.push("A rank of 2-4 may be any from the 2nd to the 4th, as far as the replicates tell.".to_owned());
            below.push(
                "Rows that share a letter were not told apart (paired t tests over replicates; Holm over all pairs, 5 % in \
                 all)."
                    .to_owned(),
            );
        }
        for row in &self.rows {
            let missing = self.missing(row.strategy);
            if !missing.is_empty() {
                below.push(format!("`{}` has no rank: {}.", row.strategy, missing.join("; ")));
            }
        }
        below
    }

    /// Where a strategy has no figure, and why.
    fn missing(&self, strategy: &str) -> Vec<String> {
        let why = |scene: &&SceneRecord| match summary(scene, strategy) {
            _ if figure(scene, strategy).is_some() => None,
            None => Some(format!("not asked for in {}", scene.name)),
            Some(Summary { error: Some(_), .. }) => Some(format!("failed in {}", scene.name)),
            Some(Summary { skipped: Some(_), .. }) => Some(format!("not run in {}", scene.name)),
            Some(_) => Some(format!("without a figure in {}", scene.name)),
        };
        self.scenes.iter().filter_map(why).collect()
    }

    /// The table in plain text, at most so many columns wide.
    fn text(&self, width: usize) -> String {
        let mut text = format!("{}\n", self.title());
        let lines = self.facts().into_iter().flat_map(|line| broken(&line, width - 2));
        lines.for_each(|line| _ = writeln!(text, "  {line}"));
        text + "\n" + &self.sheet().text(width)
    }

    /// The page in GitHub's Markdown.
    pub(super) fn page(&self, run: &RunRecord) -> String {
        let [_, plot] = self.files();
        let mut text = self.body(1, &plot);
        _ = write!(text, "\n## Replicates\n\n");
        for scene in &self.scenes {
            let (name, page) = (markdown::label(&scene.name), store::file_name(&scene.name));
            let (lights, hash) = (grouped(scene.lights), markdown::plain(&scene.hash));
            _ = writeln!(text, "- [{name}]({page}.md): {lights} lights, hash {hash}");
        }
        text + &made_by(run)
    }

    /// The same in short, for a page that people write; `plot` is the address of the plot as seen from there.
    pub(super) fn section(&self, run: &RunRecord, plot: &str) -> String {
        let place = format!("({}, revision {}, {})", run.date, run.revision, run.machine.cpu);
        let made = format!("\nMade by {} {}.\n", markdown::code(&run.command), markdown::plain(&place));
        self.body(2, plot) + &made
    }

    fn body(&self, level: usize, plot: &str) -> String {
        let mut text = format!("{} {}\n\n", "#".repeat(level), markdown::plain(&self.title()));
        self.facts().iter().for_each(|fact| _ = writeln!(text, "- {}", markdown::plain(fact)));
        let name = markdown::label(self.name);
        _ = write!(text, "\n![{name}: ratios over replicates]({plot})\n\n{}", self.sheet().markdown(level + 1));
        text
    }

    /// The plot as SVG.
    ///
    /// # Errors
    /// A plot that cannot be drawn.
    pub(super) fn plot(&self) -> Result<String> {
        let views = self.views();
        let of = |at: usize| views.iter().position(|view| *view == view_of(self.scenes[at])).unwrap_or(0);
        let bars = self.rows.iter().filter_map(|row| {
            let dots = row.dots.iter().map(|&(at, ratio)| (ratio, of(at))).collect();
            Some(Bar { name: row.strategy.to_owned(), interval: interval(&row.ratio?), dots })
        });
        let subtitle = format!(
            "relMSE x CPU seconds over that of {}; a dot a replicate, geometric means with 95 % intervals",
            self.base
        );
        ratios(&self.title(), &subtitle, &bars.collect::<Vec<_>>(), &views)
    }
}

/// What a scene is seen by.
fn view_of(scene: &SceneRecord) -> &str {
    scene.view.as_deref().unwrap_or("the file's camera")
}

/// Each name once, in the order of its first place.
fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found = Vec::new();
    names.for_each(|name| {
        if !found.contains(&name) {
            found.push(name);
        }
    });
    found
}

fn interval(ratio: &Ratio) -> Interval {
    Interval { mean: ratio.mean, low: ratio.low, high: ratio.high }
}

fn summary<'a>(scene: &'a SceneRecord, strategy: &str) -> Option<&'a Summary> {
    scene.summaries.iter().find(|summary| summary.strategy == strategy)
}

/// relMSE times CPU seconds at the largest budget, set-up included; none of what was not measured, or is exact.
fn figure(scene: &SceneRecord, strategy: &str) -> Option<f64> {
    let last = summary(scene, strategy).filter(|summary| measured(summary))?.curve.last()?;
    Some(last.rel_mse.mean * last.cpu_s.mean).filter(|figure| figure.is_finite() && *figure > 0.0)
}
