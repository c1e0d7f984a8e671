//! Which stream of random numbers belongs to which part?

/// What the streams of the parts are keyed by, beside the seed and a place: no two parts share one.
#[derive(Clone, Copy)]
#[repr(u64)]
pub(super) enum Tag {
    StreetsX = 1,
    StreetsY,
    Block,
    Lamps,
    Windows,
    Palette,
    Shops,
    Signs,
    Traffic,
    Floodlights,
    Views,
}
