//! How many lights have the scenes of a series that grows?

/// Powers of ten from `fewest` to `most`, and `most` itself where it is less than `fewest`.
pub(super) fn sizes(fewest: u64, most: u64) -> Vec<u64> {
    let powers = (0..).map(|power| fewest * 10u64.pow(power)).take_while(|&lights| lights <= most);
    let powers: Vec<u64> = powers.collect();
    if powers.is_empty() { vec![most] } else { powers }
}
