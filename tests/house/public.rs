//! What strangers may call is listed, and stays as small as can be learned.
//!
//! `public.txt` is what `cargo public-api` says of the crate. `.ci/run` compares it with the code and shows what differs.

use std::collections::BTreeSet;

const LIST: &str = include_str!("public.txt");

/// No more modules, types, traits, functions, methods and constants are public.
const MOST: usize = 350;

/// The kind of a public item and its path, with neither arguments nor type parameters; none of a field, a variant or an
/// implementation.
fn item(line: &str) -> Option<(&str, Vec<String>)> {
    let words = line.strip_prefix("pub ")?.trim_start_matches("unsafe ");
    let words = words.strip_prefix("const fn ").map_or(words, |_| &words["const ".len()..]);
    let (kind, rest) = words.split_once(' ')?;
    let known = ["mod", "struct", "enum", "trait", "type", "const", "fn", "macro"];
    if !known.contains(&kind) {
        return None;
    }
    let (mut path, mut depth) = (String::new(), 0);
    for c in rest.chars() {
        match c {
            '<' => depth += 1,
            '>' => depth -= 1,
            '(' | ' ' if depth == 0 => break,
            c if depth == 0 => path.push(c),
            _ => {}
        }
    }
    Some((kind, path.trim_end_matches(':').trim_end_matches('!').split("::").map(str::to_owned).collect()))
}

/// Every public item once, by the last of its names: what the prelude hands on counts where it is defined. What a trait
/// asks of its types counts with the trait.
fn items(list: &str) -> BTreeSet<String> {
    let (mut all, mut of_a_trait) = (BTreeSet::new(), false);
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
            all.insert(path[path.len() - names..].join("::"));
        }
    }
    all
}

#[test]
fn no_more_is_public_than_can_be_learned() {
    let all = items(LIST);
    println!("{} public items", all.len());
    assert!(all.len() > 100, "only {} items: is the list whole?", all.len());
    assert!(all.len() <= MOST, "{} public items, {MOST} at most: can one be `pub(crate)`?", all.len());
}

#[test]
fn an_item_counts_once_wherever_it_can_be_had() {
    let list = "pub mod a\npub mod a::b\npub struct a::b::C<'x>\npub a::b::C::field: u32\nimpl<'x> a::b::C<'x>\n\
                pub fn a::b::C<'x>::new(core::option::Option<u32>) -> Self\nimpl core::fmt::Display for a::b::C<'_>\n\
                pub fn a::b::C<'_>::fmt(&self)\npub trait a::T\npub fn a::T::must(&self)\npub struct a::prelude::C<'x>\n\
                pub const fn a::free() -> u32\n";
    let all: Vec<String> = items(list).into_iter().collect();
    assert_eq!(all, ["C", "C::new", "T", "a", "a::b", "free"]);
}
