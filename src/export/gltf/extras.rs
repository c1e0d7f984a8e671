//! What glTF has no word for.

use serde_json::value::RawValue;

/// JSON for an `extras` field.
pub(super) fn extras(text: &str) -> Box<RawValue> {
    RawValue::from_string(text.to_owned()).expect("the text is JSON")
}
