//! What strangers may call is listed, and stays as small as can be learned.
//!
//! `public.txt` is what `cargo public-api` says of the crate. `.ci/run` compares it with the code and shows what differs.

use std::collections::{BTreeMap, BTreeSet};

const LIST: &str = include_str!("public.txt");

/// No more modules, types, traits, functions, methods and constants are public.
const MOST: usize = 350;

/// Rooms that hand on what others define.
const FRONTS: [&str; 3] = ["prelude", "strategy", "record"];

/// What the list says of an item, but for a field, a variant or an implementation: its kind, and its path with neither
/// arguments nor type parameters.
fn item(line: &str) -> Option<(&str, Vec<String>)> {
    let (_, words) = line.split_once("pub ").filter(|(before, _)| before.is_empty() || before.starts_with("#["))?;
    let words = words.trim_start_matches("unsafe ").trim_start_matches("const unsafe ");
    let words = words.strip_prefix("const fn ").map_or(words, |_| &words["const ".len()..]);
    let (kind, rest) = words.split_once(' ')?;
    let known = ["mod", "struct", "enum", "union", "trait", "type", "const", "static", "fn", "macro", "use"];
    if !known.contains(&kind) {
        return None;
    }
    let (mut path, mut depth) = (String::new(), 0);
    for c in rest.chars() {
        match c {
            '<' => depth += 1,
            '>' => depth -= 1,
            '(' | ' ' | '!' if depth == 0 => break,
            c if depth == 0 => path.push(c),
            _ => {}
        }
    }
    Some((kind, path.trim_end_matches(':').split("::").map(str::to_owned).collect()))
}

/// How many there are; what a room hands on counts where it is defined, and what a trait asks of its types with the trait.
fn items(list: &str) -> usize {
    // The paths of each, by what it is called with its type or module.
    let mut all: BTreeMap<String, BTreeSet<Vec<String>>> = BTreeMap::new();
    let mut of_a_trait = false;
    for line in list.lines() {
        if line.starts_with("impl") {
            of_a_trait = line.contains(" for ");
            continue;
        }
        let Some((kind, path)) = item(line) else { continue };
        let owner = path.len().checked_sub(2).map(|i| &path[i]);
        let is_member = owner.is_some_and(|owner| owner.starts_with(|c: char| c.is_uppercase() || c == '&'));
        if !is_member {
            of_a_trait = kind == "trait";
        }
        if !(is_member && of_a_trait) {
            let names = if kind == "mod" { path.len() } else { 1 + usize::from(is_member) };
            all.entry(path[path.len() - names..].join("::")).or_default().insert(path);
        }
    }
    let is_front = |path: &&Vec<String>| path.get(1).is_some_and(|room| FRONTS.contains(&room.as_str()));
    all.values().map(|paths| paths.iter().filter(|path| !is_front(path)).count().max(1)).sum()
}

#[test]
fn no_more_is_public_than_can_be_learned() {
    let all = items(LIST);
    println!("{all} public items");
    assert!(all > 100, "only {all} items: is the list whole?");
    assert!(all <= MOST, "{all} public items, {MOST} at most: can one be `pub(crate)`?");
}

#[test]
fn nothing_public_is_hidden_from_the_list() {
    let hidden = super::floors::sources().into_iter().filter(|(_, text)| text.contains("doc(hidden)"));
    let hidden: Vec<String> = hidden.map(|(file, _)| file).collect();
    assert!(hidden.is_empty(), "{hidden:?}");
}

#[test]
fn an_item_counts_once_wherever_it_can_be_had() {
    let list = "pub mod a\npub mod a::b\n#[repr(C)] pub struct a::b::C<'x>\npub a::b::C::field: u32\nimpl<'x> a::b::C<'x>\n\
                pub fn a::b::C<'x>::new(core::option::Option<u32>) -> Self\nimpl core::fmt::Display for a::b::C<'_>\n\
                pub fn a::b::C<'_>::fmt(&self)\npub trait a::T\npub fn a::T::must(&self)\npub struct a::prelude::C<'x>\n\
                pub const fn a::b::free() -> u32\npub fn a::c::free() -> u32\n";
    // C and new, T, the two modules, and two functions of one name.
    assert_eq!(items(list), 7);
}
