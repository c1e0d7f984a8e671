//! Files that are refused, by the library and by the program alike.

use crate::made::File;
use assert_cmd::Command;
use citylights::base::error::Error;
use citylights::sources::Overrides;
use citylights::sources::gltf::parse;
use serde_json::json;
use std::path::Path;

/// A ground, a child node, an emitter and two lamps.
pub(crate) fn good() -> File {
    let mut file = File::ground();
    file.emitter([[0.0, 3.0, 0.0], [0.0, 3.0, -1.0], [1.0, 3.0, 0.0]], 40.0, false, json!({ "name": "sign" }));
    let child = file.push("nodes", json!({ "name": "child" }));
    file.lamp(json!({ "type": "point", "intensity": 90 }), json!({ "translation": [1, 4, 2], "children": [child] }));
    file.lamp(json!({ "type": "spot", "spot": {} }), json!({ "translation": [1, 4, 2] }));
    file
}

/// Reads a file in memory; its error's field and message.
pub(crate) fn refused(name: &str, bytes: &[u8]) -> (String, String) {
    let (held, result) = crate::peak::most(|| parse(bytes, name.as_ref(), &Overrides::default()));
    // Two million nodes of three bytes each take sixty times as much.
    assert!(held < 100 * bytes.len() + (1 << 20), "{name}: {held} bytes for {} of the file", bytes.len());
    match result {
        Err(Error::Input { file, field, message, .. }) => {
            assert_eq!(file, Path::new(name));
            (field, message)
        }
        other => panic!("{other:?}"),
    }
}

/// Through the library and through the program: the field and the message say `wanted`.
pub(crate) fn check(name: &str, bytes: &[u8], field: &str, wanted: &str) {
    let (found, message) = refused(name, bytes);
    assert_eq!(found, field, "{message}");
    assert!(message.contains(wanted), "`{field}`: {message}\nlacks: {wanted}");
    assert!(!message.contains(char::is_control), "{message:?}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    let assert = Command::cargo_bin("citylights").expect("the binary").arg("inspect").arg(&path).assert();
    let output = assert.code(2).stdout("").get_output().clone();
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(said.contains(&format!("{name}: ")) || said.contains(&format!("{name}:1: ")), "{said}");
    assert!(field.is_empty() || said.contains(&format!("`{field}`: ")), "{said} lacks {field}");
}
