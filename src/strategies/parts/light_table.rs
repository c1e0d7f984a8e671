//! Lights drawn by fixed weights.

use crate::base::discrete::AliasTable;
use crate::base::error::Result;
use crate::scene::light::{Light, LightId};
use crate::visibility::stage::Stage;

/// Lights with an alias table over fixed weights: each draw takes constant time.
pub struct LightTable {
    lights: Vec<LightId>,
    /// `None` where no light has any weight.
    table: Option<AliasTable>,
}

impl LightTable {
    /// The lights of a stage, each with the weight that `weight` gives it: 0 or more.
    ///
    /// # Errors
    /// A weight that is negative, infinite or no number.
    pub fn new(stage: &Stage, weight: impl Fn(&Light) -> f64) -> Result<Self> {
        let lights = stage.lights().to_vec();
        let table = stage.scene().lights();
        let weights: Vec<f64> = lights.iter().map(|&id| weight(&table[id as usize])).collect();
        let table = weights.iter().any(|&w| w != 0.0).then(|| AliasTable::new(&weights)).transpose()?;
        Ok(Self { lights, table })
    }

    /// The light that 64 uniform bits choose, and its probability; `None` where no light has any weight.
    #[inline]
    pub fn pick(&self, bits: u64) -> Option<(LightId, f32)> {
        let table = self.table.as_ref()?;
        let index = table.pick(bits);
        Some((self.lights[index], table.pmf(index)))
    }

    /// All lights with their probabilities.
    pub fn pmf(&self) -> impl Iterator<Item = (LightId, f32)> {
        let table = self.table.as_ref();
        self.lights.iter().enumerate().filter_map(move |(i, &light)| Some((light, table?.pmf(i))))
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.lights[..]) + self.table.as_ref().map_or(0, AliasTable::heap_bytes)
    }
}
