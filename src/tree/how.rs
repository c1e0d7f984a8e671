//! Which way of weighing clusters, of those that there are?

/// How clusters are weighed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weighing {
    /// Horizons of the receiver and of the emitters tested against the cluster's box; cosines are means over what of
    /// the box lies above them, its lights spread evenly in it.
    #[default]
    Box,
    /// As Conty Estevez and Kulla 2018 and pbrt-v4: the greatest emission over a cone around the bounding sphere, the
    /// absolute cosine at the receiver. For comparison.
    Classic,
}

/// At which distance a cluster is weighed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distance {
    /// At the geometric mean of the least and the greatest distance of its box.
    #[default]
    Mean,
    /// Half the picks at the least distance of its box, half at the greatest (Lin and Yuksel, I3D 2020).
    MinMax,
}

/// Which emission a cluster is taken to have where its box does not say which way its lights face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// The mean over all directions: what many lights make together.
    #[default]
    Mean,
    /// The root mean square: the weight of least variance for a light of which nothing else is known. A headlight is 7 times
    /// as bright by that, and one that does face the receiver is expected as many times more often.
    Rms,
}

/// How a tree weighs its clusters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct How {
    /// How clusters are weighed.
    pub weighing: Weighing,
    /// At which distance.
    pub distance: Distance,
    /// With which emission where any is possible; [`Weighing::Classic`] takes the greatest.
    pub facing: Facing,
}
