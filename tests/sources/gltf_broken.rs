//! Promise: a glTF file whose container, JSON or buffers are broken is refused, by exit code 2, with what is wrong.
#![cfg(feature = "cli")]

use crate::made::glb;
use crate::refused::{check, good, refused};
use citylights::sources::gltf::parse;
use citylights::sources::{Overrides, open};
use serde_json::json;

#[test]
fn broken_containers_are_told() {
    let whole = good().glb();
    let patched = |at: usize, value: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let json_length = u32::from_le_bytes([whole[12], whole[13], whole[14], whole[15]]);
    for (bytes, field, wanted) in [
        (whole[..whole.len() - 1].to_vec(), "header.length", "broken off"),
        (whole[..whole.len() / 2].to_vec(), "header.length", "broken off"),
        (whole[..12].to_vec(), "header.length", "12 are there"),
        (whole[..11].to_vec(), "header", "11 bytes"),
        (Vec::new(), "header", "0 bytes"),
        (patched(0, 0x4654_6C68), "header.magic", "\"hlTF\" is given"),
        (patched(0, 0x0a1a_0d01), "header.magic", "\"\\x01\\r\\x1a\\n\" is given"),
        (patched(4, 1), "header.version", "1 is given; version 2"),
        (patched(8, u32::MAX), "header.length", "4294967295 bytes are announced"),
        (patched(12, u32::MAX), "chunks[0].length", "4294967295 bytes are announced"),
        (patched(12, json_length + 4), "chunks[1].length", "are left"),
        (patched(12, json_length - 4), "chunks[1].length", "are left"),
        (patched(12, 0), "chunks[1]", ""),
        (patched(16, 0), "chunks[0].type", "JSON"),
        (patched(20 + json_length as usize, u32::MAX), "chunks[1].length", "are left"),
        (patched(20 + json_length as usize + 4, 0), "buffers[0].uri", "is missing"),
        (glb(&[], &[]), "", "the file is empty"),
        (glb(b"{]", &[]), "", "key must be a string"),
        (glb(b"\xff\xfe{}", &[]), "", "expected value"),
    ] {
        println!("{field}: {wanted}");
        if field == "chunks[1]" {
            // The rest is read as a chunk's head.
            assert!(refused("bad.glb", &bytes).0.starts_with("chunks["));
            continue;
        }
        check("bad.glb", &bytes, field, wanted);
    }
    let (field, message) = refused("bad.gltf", &whole[..100]);
    assert!(field == "header.length" && message.contains("100 are there"), "a binary file of the other name");
}

#[test]
fn broken_json_is_told_with_its_line() {
    let error =
        |text: &str| parse(text.as_bytes(), "bad.gltf".as_ref(), &Overrides::default()).expect_err("bad").to_string();
    let found = error("{\n  \"asset\": { \"version\": \"2.0\" },\n  \"nodes\": [{ \"mesh\": 1e999 }]\n}");
    assert!(found.starts_with("bad.gltf:3: `nodes[0].mesh`: number out of range"), "{found}");
    let found = error("{\n\n\"asset\": 3}");
    assert!(found.starts_with("bad.gltf:3: `asset`: invalid type: integer `3`, expected struct Asset"), "{found}");
    for (open, close) in [("[", "]"), ("{\"a\":", "}")] {
        let deep = format!("{}1{}", open.repeat(10_000), close.repeat(10_000));
        for place in ["extras", "nodes", "materials", "asset"] {
            let file = good();
            let mut json = file.json.clone();
            json[place] = json!("HERE");
            let text = json.to_string().replace("\"HERE\"", &deep);
            // Passed over where nobody reads it; else an error, never a full stack.
            let result = parse(&glb(text.as_bytes(), &file.bin), "deep.glb".as_ref(), &Overrides::default());
            assert!(result.is_err() || place == "extras", "{place}");
        }
    }
    check("bad.gltf", b"", "", "the file is empty");
    check("bad.gltf", b" \n ", "", "the file is empty");
    check("bad.gltf", b"name = \"a recipe\"", "", "expected ident");
    check("bad.gltf", b"{\"asset\":{\"version\":\"2.0\"}}{", "", "trailing characters");
    check(
        "bad.gltf",
        b"{\"asset\":{\"version\":\"2.0\"},\"asset\":{\"version\":\"2.0\"}}",
        "",
        "duplicate field `asset`",
    );
}

#[test]
fn buffers_that_are_not_there_or_not_for_us_are_told() {
    let uri = "buffers[0].uri";
    for (value, field, wanted) in [
        ("nowhere.bin", uri, "no file"),
        ("", uri, "in the scene's folder"),
        ("../secret.bin", uri, "\"../secret.bin\" is given; the name of a file in the scene's folder"),
        ("a/%2e%2e/%2E./b.bin", uri, "in the scene's folder"),
        ("/etc/hostname", uri, "in the scene's folder"),
        ("file:///etc/hostname", uri, "in the scene's folder"),
        ("https://example.org/a.bin", uri, "without a scheme"),
        ("C:%5Ca.bin", uri, "in the scene's folder"),
        ("a%00.bin", uri, "in the scene's folder"),
        ("a%zz.bin", uri, "in the scene's folder"),
        ("a%f", uri, "in the scene's folder"),
        ("%ff.bin", uri, "in the scene's folder"),
        ("\u{1b}[2J..", uri, "no file"),
        (".", uri, "no file"),
        ("data:application/octet-stream,abc", uri, "not in base64"),
        ("data:application/octet-stream;base64,a*b", uri, "no base64"),
        ("data:;base64,AAAA", "buffers[0].byteLength", "3 are there"),
        ("data:;base64,AAA", "buffers[0].byteLength", "2 are there"),
    ] {
        println!("{value}");
        check("bad.gltf", good().beside(value).as_bytes(), field, wanted);
    }
    let mut file = good();
    file.json["buffers"] = json!([{ "byteLength": 4 }, { "byteLength": 4 }]);
    check("bad.glb", &file.glb(), "buffers[1].uri", "is missing");
    file.json["buffers"] = json!([{ "byteLength": u64::MAX }]);
    check("bad.glb", &file.glb(), "buffers[0].byteLength", "all buffers together may have 2147483648");
    file.json["buffers"] = json!([{ "byteLength": 2_000_000_000 }]);
    check("bad.glb", &file.glb(), "buffers[0].byteLength", "2000000000 bytes are announced");
}

#[test]
fn a_buffer_is_read_no_further_than_it_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut file = good();
    let text = file.beside("long.bin");
    std::fs::write(folder.path().join("a.gltf"), text).expect("written");
    file.bin.extend([0xff; 1000]);
    std::fs::write(folder.path().join("long.bin"), &file.bin).expect("written");
    let scene = open(&folder.path().join("a.gltf"), &Overrides::default());
    assert_eq!(scene.expect("a scene").surfaces().len(), 2);
    std::fs::write(folder.path().join("long.bin"), &file.bin[..40]).expect("written");
    let error = open(&folder.path().join("a.gltf"), &Overrides::default());
    assert!(error.expect_err("too short").to_string().contains("`buffers[0].byteLength`: "));
}

#[test]
fn a_list_longer_than_memory_bears_is_refused() {
    let mut text = String::from("{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}");
    text.push_str(&",{}".repeat(1 << 21));
    text.push_str("]}");
    let (field, message) = refused("long.gltf", text.as_bytes());
    assert_eq!((&*field, message.contains("more than 2097152 entries")), ("nodes", true), "{message}");
}
