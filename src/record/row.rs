//! One line of `runs.csv`: one strategy, one independent run, one budget, one scene.

use crate::base::interval::LARGEST;

/// The columns, in order.
pub(crate) const COLUMNS: [&str; 28] = [
    "scene",
    "strategy",
    "run",
    "passes",
    "setup_cpu_s",
    "cpu_s",
    "wall_s",
    "heap_bytes",
    "mse",
    "rel_mse",
    "rel_mse_trimmed",
    "trimmed_share",
    "largest_0",
    "largest_1",
    "largest_2",
    "largest_3",
    "energy_ratio",
    "decile_0",
    "decile_1",
    "decile_2",
    "decile_3",
    "decile_4",
    "decile_5",
    "decile_6",
    "decile_7",
    "decile_8",
    "decile_9",
    "error",
];

/// One strategy, one run, one budget, one scene. Errors are over receiver pixels against the scene's reference.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// The scene's name.
    pub scene: String,
    /// Name and parameters: `light-tree:arity=8,split=0.5`.
    pub strategy: String,
    /// The independent run, from 0.
    pub run: u32,
    /// Passes so far: the budget.
    pub passes: u32,
    /// CPU seconds of building.
    pub setup_cpu_s: f64,
    /// CPU seconds of sampling all passes so far, without set-up.
    pub cpu_s: f64,
    /// Wall seconds of the same.
    pub wall_s: f64,
    /// Bytes on the heap after building.
    pub heap_bytes: u64,
    /// MSE, in the square of the image's unit.
    pub mse: f64,
    /// relMSE.
    pub rel_mse: f64,
    /// relMSE without the worst 0.1 % of pixels.
    pub rel_mse_trimmed: f64,
    /// The share of relMSE that those pixels hold, within `[0, 1]`.
    pub trimmed_share: f64,
    /// What the worst pixels add to relMSE, the worst first: they say how far its mean can be trusted.
    pub largest: [f64; LARGEST],
    /// Mean of the image over mean of the reference.
    pub energy_ratio: f64,
    /// relMSE by tenths of the reference's luminance, the darkest first; columns `decile_0` to `decile_9`.
    pub deciles: [f64; 10],
    /// Why it failed; its numbers are then NaN here and empty in the file.
    pub error: Option<String>,
}

impl Row {
    /// A row that failed: no numbers, only where and why.
    pub(crate) fn failed(scene: String, strategy: String, run: u32, passes: u32, error: String) -> Self {
        Self { error: Some(error), ..Self::blank(scene, strategy, run, passes) }
    }

    /// CPU seconds from nothing to the image.
    pub(crate) fn total_cpu_s(&self) -> f64 {
        self.setup_cpu_s + self.cpu_s
    }

    /// A row without its numbers yet.
    pub(crate) fn blank(scene: String, strategy: String, run: u32, passes: u32) -> Self {
        let none = f64::NAN;
        Self {
            scene,
            strategy,
            run,
            passes,
            setup_cpu_s: none,
            cpu_s: none,
            wall_s: none,
            heap_bytes: 0,
            mse: none,
            rel_mse: none,
            rel_mse_trimmed: none,
            trimmed_share: none,
            largest: [none; LARGEST],
            energy_ratio: none,
            deciles: [none; 10],
            error: None,
        }
    }

    /// What tells it apart from all others of a comparison: scene, strategy, run and passes.
    pub(crate) fn key(&self) -> (&str, &str, u32, u32) {
        (&self.scene, &self.strategy, self.run, self.passes)
    }

    /// The row's fields in the order of [`COLUMNS`]. Line breaks in texts become spaces: a row is one line.
    pub(super) fn fields(&self) -> [String; COLUMNS.len()] {
        let text = |s: &str| s.replace(['\r', '\n'], " ");
        // `{:?}` is the shortest text that reads back as the same number; it turns to exponents where `{}` would write
        // 300 zeros.
        let number = |v: f64| if self.error.is_some() && v.is_nan() { String::new() } else { format!("{v:?}") };
        let [l0, l1, l2, l3] = self.largest.map(number);
        let [d0, d1, d2, d3, d4, d5, d6, d7, d8, d9] = self.deciles.map(number);
        [
            text(&self.scene),
            text(&self.strategy),
            self.run.to_string(),
            self.passes.to_string(),
            number(self.setup_cpu_s),
            number(self.cpu_s),
            number(self.wall_s),
            self.heap_bytes.to_string(),
            number(self.mse),
            number(self.rel_mse),
            number(self.rel_mse_trimmed),
            number(self.trimmed_share),
            l0,
            l1,
            l2,
            l3,
            number(self.energy_ratio),
            d0,
            d1,
            d2,
            d3,
            d4,
            d5,
            d6,
            d7,
            d8,
            d9,
            text(self.error.as_deref().unwrap_or_default()),
        ]
    }

    /// The row that the fields say, or the name of the column that cannot be used and why.
    pub(super) fn parse(fields: &csv::StringRecord) -> Result<Self, (&'static str, String)> {
        if fields.len() != COLUMNS.len() {
            return Err(("", format!("{} fields where {} are expected", fields.len(), COLUMNS.len())));
        }
        let error = Some(fields[COLUMNS.len() - 1].to_owned()).filter(|e| !e.is_empty());
        let whole =
            |at: usize| fields[at].parse::<u64>().map_err(|_| (COLUMNS[at], complaint(&fields[at], "a whole number")));
        let small =
            |at: usize| fields[at].parse::<u32>().map_err(|_| (COLUMNS[at], complaint(&fields[at], "a whole number")));
        let number = |at: usize| match &fields[at] {
            "" if error.is_some() => Ok(f64::NAN),
            given => given.parse::<f64>().map_err(|_| (COLUMNS[at], complaint(given, "a number"))),
        };
        let mut deciles = [0.0; 10];
        for (i, decile) in deciles.iter_mut().enumerate() {
            *decile = number(17 + i)?;
        }
        Ok(Self {
            scene: fields[0].to_owned(),
            strategy: fields[1].to_owned(),
            run: small(2)?,
            passes: small(3)?,
            setup_cpu_s: number(4)?,
            cpu_s: number(5)?,
            wall_s: number(6)?,
            heap_bytes: whole(7)?,
            mse: number(8)?,
            rel_mse: number(9)?,
            rel_mse_trimmed: number(10)?,
            trimmed_share: number(11)?,
            largest: [number(12)?, number(13)?, number(14)?, number(15)?],
            energy_ratio: number(16)?,
            deciles,
            error,
        })
    }
}

fn complaint(given: &str, expected: &str) -> String {
    format!("`{given}` is not {expected}")
}
