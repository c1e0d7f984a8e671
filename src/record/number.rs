//! Floating-point numbers in JSON, which knows neither infinity nor NaN: these become the words `inf`, `-inf` and
//! `nan`.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Number<'a> {
    Finite(f64),
    Other(std::borrow::Cow<'a, str>),
}

#[derive(Serialize, Deserialize)]
#[serde(transparent)]
struct Wrapped(#[serde(with = "super::number")] f64);

/// The same for a value per channel.
pub(super) mod channels {
    use crate::record::number::Wrapped;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(in super::super) fn serialize<S: Serializer>(values: &[f64; 3], to: S) -> Result<S::Ok, S::Error> {
        values.map(Wrapped).serialize(to)
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 3], D::Error> {
        <[Wrapped; 3]>::deserialize(from).map(|values| values.map(|v| v.0))
    }
}

/// The same for a list.
pub(super) mod list {
    use crate::record::number::Wrapped;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(in super::super) fn serialize<S: Serializer>(values: &[f64], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(values.iter().map(|&value| Wrapped(value)))
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
        Ok(Vec::<Wrapped>::deserialize(from)?.into_iter().map(|value| value.0).collect())
    }
}

pub(super) fn serialize<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
    let number = match *value {
        v if v.is_finite() => Number::Finite(v),
        v if v.is_nan() => Number::Other("nan".into()),
        v if v > 0.0 => Number::Other("inf".into()),
        _ => Number::Other("-inf".into()),
    };
    number.serialize(to)
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    match Number::deserialize(from) {
        Ok(Number::Finite(v)) => Ok(v),
        Ok(Number::Other(word)) if word == "nan" => Ok(f64::NAN),
        Ok(Number::Other(word)) if word == "inf" => Ok(f64::INFINITY),
        Ok(Number::Other(word)) if word == "-inf" => Ok(f64::NEG_INFINITY),
        _ => Err(serde::de::Error::custom("expected a number, \"inf\", \"-inf\" or \"nan\"")),
    }
}
