//! Which strategy chooses best: by its probabilities alone, and measured?
//!
//! The first needs no rays and has no noise; it knows nothing of visibility. The second is the error at a fixed number
//! of passes, for each sample and for each second, beside those of `oracle` (which knows visibility) and `intensity`
//! (which knows all but that).

use super::area::{ByArea, by_area};
use super::cells::{cells, claim, measured, remark, unbiased};
use super::columns::{column, interval, plot};
use super::entry::Entry;
use super::quality::{Finding, Quality, quality};
use super::scenes::told_apart;
use super::session::Session;
use super::trial::{Budgets, Tried};
use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::measure::figure::{Figure, error};
use crate::measure::summary::blank;
use crate::measure::target::Target;
use crate::record::study::{Cell, ColumnRecord, Format, Study, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::record::{Interval, store};
use crate::scene::Scene;
use crate::scene::receiver::Receiver;
use crate::sources;
use crate::strategy::{AnySampler, BuildContext, Configured};
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use rayon::prelude::*;

pub(super) const ENTRY: Entry = Entry {
    name: "strategies",
    question: "Which strategy chooses best: by its probabilities alone, and measured?",
    run,
};

/// The scenes: canyons, where visibility decides, and an open square, where it does not.
const SCENES: [&str; 2] = ["scenes/downtown.toml", "scenes/plaza.toml"];

/// Receivers that errors are taken at.
const PIXELS: usize = 512;

/// Strategies beside the registered ones in their default form.
const VARIANTS: &[&str] = &[
    "power:points=random",
    "stochastic-cull:draw=receiver",
    "light-tree:open=0",
    "light-tree:arity=2,importance=classic,open=0",
    "light-tree:arity=2,importance=classic",
    "light-tree:arity=2,importance=classic,points=random",
    "light-tree:arity=2",
    "light-tree:arity=4",
    "light-tree:distance=minmax",
    "light-tree:split=0.5",
    "resampled:visibility=on",
    "resampled:from=power,m=16",
    "restir:combine=1/M",
];

fn run(session: &Session<'_>) -> Result<Study> {
    let strategies = session.strategies(VARIANTS)?;
    let files = session.scenes(&SCENES);
    let scenes: Vec<Scene> =
        files.iter().map(|path| sources::open(path, &session.options.overrides)).collect::<Result<_>>()?;
    told_apart(&scenes)?;
    let mut writer =
        session.open(&scenes, scenes.iter().flat_map(|scene| tables(session, scene, &strategies)).collect())?;
    for scene in scenes {
        by_probability(session, &mut writer, scene.clone(), &strategies)?;
        by_measuring(session, &mut writer, scene, &strategies)?;
    }
    session.finish(writer)
}

fn quality_table(scene: &Scene) -> String {
    format!("quality-{}", store::file_name(scene.name()))
}

fn measured_table(scene: &Scene) -> String {
    format!("measured-{}", store::file_name(scene.name()))
}

fn quality_columns() -> Vec<ColumnRecord> {
    let mut columns = vec![column("strategy", "strategy", Format::Name), column("claim", "claim", Format::Words)];
    columns.extend(interval("mean_variance", "mean", Format::Number));
    columns.push(column("median_variance", "median", Format::Number));
    columns.extend(interval("mean_variance_street", "mean,\nstreet", Format::Number));
    columns.extend(interval("mean_variance_facade", "mean,\nfacade", Format::Number));
    columns.extend(interval("picks", "picks\na call", Format::Number));
    columns.extend([
        column("receivers", "receivers", Format::Whole),
        column("dark_receivers", "of them dark,\nleft out", Format::Whole),
        column("biased_receivers", "of them\nbiased", Format::Whole),
        column("remark", "", Format::Words),
    ]);
    columns
}

fn tables(session: &Session<'_>, scene: &Scene, strategies: &[Configured]) -> [TableRecord; 2] {
    let options = session.options;
    let quality = TableRecord {
        name: quality_table(scene),
        title: format!("{}: variance by probabilities, nothing in between", scene.name()),
        columns: quality_columns(),
        notes: vec![
            "relative variance of one pick: max(1, N) sum f²/n / (sum f)² - 1, where f is a light's unshadowed luminance at its \
             centroid, n its expected number of picks in a call and N = sum n. Exact for a strategy that picks once; k independent \
             picks are brought to one; of lists and splitting it is an upper bound."
                .into(),
            format!("mean and median over {} receivers by area, half on streets, half on facades.", options.receivers),
            "biased: receivers at which a light that contributes is never picked (n = 0): the mean is then infinite.".into(),
        ],
        plots: Vec::new(),
    };
    let biased = strategies.iter().filter(|s| matches!(blank(s).claim, Claim::Biased { .. }));
    let mut error_plot = plot(
        &measured_table(scene),
        &format!("{}: error and time of a sample", scene.name()),
        "strategy",
        ("cpu_s_a_sample", "CPU s a sample"),
        ("rel_mse", "relMSE"),
    );
    error_plot.biased = biased.map(|s| s.name().to_owned()).collect();
    let mut columns = vec![
        column("strategy", "strategy", Format::Name),
        column("claim", "claim", Format::Words),
        column("passes", "passes", Format::Whole),
    ];
    columns.extend(interval("rel_mse", "relMSE", Format::Number));
    columns.extend(interval("rel_bias2", "b²", Format::Number));
    columns.extend(interval("cpu_s_a_sample", "CPU ns\na sample", Format::Nanoseconds));
    columns.extend(interval("error_passes", "relMSE\nx passes", Format::Number));
    columns.extend(interval("error_passes_to_oracle", "to\noracle", Format::Number));
    columns.extend(interval("error_passes_to_intensity", "to\nintensity", Format::Number));
    columns.extend(interval("error_cpu_s", "relMSE\nx CPU s", Format::Number));
    columns.extend(interval("error_cpu_s_to_intensity", "to\nintensity", Format::Number));
    columns.push(column("remark", "", Format::Words));
    let measured = TableRecord {
        name: measured_table(scene),
        title: format!("{}: measured error for each sample and for each second", scene.name()),
        columns,
        notes: vec![
            format!(
                "{} runs of up to {} passes (1, 4, 16 and so on, within {} s of counted work) of all that the camera sees; relMSE at {} of its \
                 receivers. CPU ns a sample: coming to a receiver included, set-up not.",
                options.repeats,
                options.passes,
                options.seconds,
                session.pixels(PIXELS)
            ),
            "relMSE x passes and relMSE x CPU s: lower is better. A biased strategy has none: its error does not fall as 1 / passes."
                .into(),
            "oracle knows what is visible and is not timed: the floor of any error, at 512 receivers at most. intensity is the floor without \
             visibility."
                .into(),
            "to oracle, to intensity: where both did the same number of passes. Set-up is not in the CPU seconds (see `study scaling`)."
                .into(),
        ],
        plots: vec![error_plot],
    };
    [quality, measured]
}

fn by_probability(
    session: &Session<'_>,
    writer: &mut StudyWriter,
    scene: Scene,
    strategies: &[Configured],
) -> Result<()> {
    let table = quality_table(&scene);
    // Receivers by area see what the camera does not: nothing may be left out for its sake.
    let stage = Stage::new(scene, LeaveOut::No, Offset::SCALED);
    let by_area = by_area(stage.scene(), stage.occluders(), session.options.receivers, session.options.seed)?;
    session.watch.begin(&table, strategies.len() as u64);
    let mut unknown = Vec::new();
    for strategy in strategies.iter().filter(|strategy| blank(strategy).claim != Claim::Oracle) {
        session.watch.check()?;
        let key = [("strategy", strategy.name().into())];
        if writer.has(&table, &key, 1) {
            session.watch.advance(1);
            continue;
        }
        let built = strategy.build(BuildContext { stage: &stage, seed: session.options.seed });
        match built.map(|sampler| qualities(&stage, sampler.as_ref(), &by_area.receivers)) {
            Ok(found) if found.contains(&Finding::Unknown) => unknown.push(strategy.name()),
            Ok(found) => writer.put(&table, &key, vec![quality_cells(strategy, &by_area, &found)])?,
            Err(error) => {
                let mut row = vec![strategy.name().into(), claim(&blank(strategy))];
                row.resize(quality_columns().len() - 1, Cell::Missing);
                row.push(format!("failed: {error}").as_str().into());
                writer.put(&table, &key, vec![row])?;
            }
        }
        session.watch.advance(1);
    }
    session.watch.end();
    if !unknown.is_empty() {
        let (scene, names) = (stage.scene().name(), unknown.join(", "));
        writer.note(format!(
            "{scene}: not in the table of variance, since their probabilities cannot be told: {names}."
        ))?;
    }
    Ok(())
}

fn qualities(stage: &Stage, sampler: &dyn AnySampler, receivers: &[Receiver]) -> Vec<Finding> {
    receivers.par_iter().map_init(Vec::new, |counts, at| quality(stage, sampler, at, counts)).collect()
}

fn quality_cells(strategy: &Configured, by_area: &ByArea, found: &[Finding]) -> Vec<Cell> {
    let known = |found: &[Finding]| -> Vec<Quality> {
        let known = |finding: &Finding| if let Finding::Known(quality) = *finding { Some(quality) } else { None };
        found.iter().filter_map(known).collect()
    };
    // Receivers are drawn independently.
    let mean = |of: fn(&Quality) -> f64, found: &[Finding]| {
        cells(Figure::signed_mean(known(found).iter().map(of).collect()).interval())
    };
    let (street, facade) = found.split_at(by_area.streets);
    let all = known(found);
    let mut sorted: Vec<f64> = all.iter().map(|quality| quality.variance).collect();
    sorted.sort_by(f64::total_cmp);
    let mut row = vec![strategy.name().into(), claim(&blank(strategy))];
    row.extend(mean(|quality| quality.variance, found));
    // The lower of two middle ones: between a number and infinity there is no middle.
    row.push(sorted.get(sorted.len().saturating_sub(1) / 2).copied().into());
    row.extend(mean(|quality| quality.variance, street));
    row.extend(mean(|quality| quality.variance, facade));
    row.extend(mean(|quality| quality.picks, found));
    row.extend([
        (found.len() as u64).into(),
        ((found.len() - all.len()) as u64).into(),
        (all.iter().filter(|quality| quality.variance.is_infinite()).count() as u64).into(),
        Cell::Missing,
    ]);
    row
}

fn by_measuring(
    session: &Session<'_>,
    writer: &mut StudyWriter,
    scene: Scene,
    strategies: &[Configured],
) -> Result<()> {
    let table = measured_table(&scene);
    if writer.has(&table, &[], strategies.len()) {
        return Ok(());
    }
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    let (target, reference) = session.reference(&Target::whole(&stage).thinned(session.pixels(PIXELS)))?;
    let kind = if reference.exact_sum { "an exact sum" } else { "stratified" };
    writer.note(format!(
        "{}: {} lights; {} of them can reach the camera's receivers; the reference is {kind}, at {} receivers.",
        stage.scene().name(),
        stage.scene().lights().len(),
        stage.lights().len(),
        target.places.len()
    ))?;
    let found = session.trial(&target, &reference.truth, &strategies.iter().collect::<Vec<_>>(), Budgets::Largest)?;
    let mut rows = Vec::new();
    let of = |strategy: &str| found.iter().find(|one| one.summary.strategy == strategy);
    let (oracle, intensity) = (of("oracle"), of("intensity"));
    for one in &found {
        let summary = &one.summary;
        let mut row = vec![summary.strategy.as_str().into(), claim(summary)];
        row.push(measured(summary).then_some(u64::from(summary.passes)).into());
        row.extend(cells(measured(summary).then_some(summary.rel_mse)));
        row.extend(cells((measured(summary) && !unbiased(summary)).then_some(summary.rel_bias2)));
        row.extend(cells(one.sample_s(target.frame.len())));
        row.extend(cells(one.error_passes().map(|figure| figure.interval())));
        row.extend(cells(one.ratio(oracle, Tried::error_passes)));
        row.extend(cells(one.ratio(intensity, Tried::error_passes)));
        row.extend(cells(one.error_cpu_s().map(|figure| figure.interval())));
        row.extend(cells(one.ratio(intensity, Tried::error_cpu_s)));
        row.push(remark(summary));
        rows.push(row);
    }
    writer.put(&table, &[], rows)
}

impl Tried {
    /// relMSE x passes, where it means something.
    fn error_passes(&self) -> Option<Figure> {
        let s = &self.summary;
        let passes = f64::from(s.passes);
        let figure = || Figure::of(vec![error(&self.at(s.passes))], move |parts| parts[0] * passes);
        (measured(s) && unbiased(s)).then(figure)
    }

    /// relMSE x CPU seconds of sampling the frame.
    fn error_cpu_s(&self) -> Option<Figure> {
        let s = &self.summary;
        let figure = || self.error_times(s.passes, |row| row.cpu_s);
        (measured(s) && unbiased(s) && self.is_timed()).then(figure)
    }

    /// A figure as a multiple of another strategy's at the same number of passes: points spread over passes lower it as
    /// they grow.
    fn ratio(&self, to: Option<&Self>, figure: fn(&Self) -> Option<Figure>) -> Option<Interval> {
        let to = to.filter(|to| to.summary.passes == self.summary.passes)?;
        let (own, other) = (figure(self)?, figure(to)?);
        if std::ptr::eq(self, to) {
            Some(Interval::certain(1.0))
        } else {
            own.over(other).map(|ratio| ratio.interval())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strategy::Registry;

    #[test]
    fn every_variant_differs_from_what_is_registered() {
        for text in VARIANTS {
            let strategy = Registry::standard().parse(text).expect(text);
            assert!(strategy.name().contains(':'), "{text} is {} as it stands", strategy.name());
        }
        Registry::standard().parse_list(&VARIANTS.join(",")).expect("each once");
    }
}
