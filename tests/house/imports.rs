//! Which file of `src` takes what from which other?

use std::collections::{BTreeMap, BTreeSet};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, ItemUse, Macro, Path, UseTree, Visibility};

/// A module's place: `["scene", "light"]`; none for the root.
pub(crate) type Place = Vec<String>;

/// A file as a module.
#[derive(Default)]
pub(crate) struct Module {
    /// Below `src`.
    pub(crate) file: String,
    /// Lines of it.
    pub(crate) lines: usize,
    /// All paths that its code mentions, outside its tests.
    paths: BTreeSet<Vec<String>>,
    /// What it hands on, by the name it gives it.
    handed_on: BTreeMap<String, Vec<String>>,
}

/// The modules of a crate by their places.
#[derive(Default)]
pub(crate) struct House(pub(crate) BTreeMap<Place, Module>);

/// One file takes something from another.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Import {
    pub(crate) from: Place,
    pub(crate) to: Place,
    pub(crate) path: String,
}

impl House {
    /// Adds a file, by its path below `src`.
    pub(crate) fn add(&mut self, file: &str, text: &str) {
        let mut place: Place = file.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
        if ["mod", "lib", "main"].contains(&place[place.len() - 1].as_str()) {
            place.pop();
        }
        let parsed = syn::parse_file(text).unwrap_or_else(|error| panic!("{file}: {error}"));
        let mut reader = Reader::default();
        reader.visit_file(&parsed);
        let Reader { paths, handed_on } = reader;
        self.0.insert(place, Module { file: file.to_owned(), lines: text.lines().count(), paths, handed_on });
    }

    /// Every import between two files; one through a module that hands it on is one from where it is defined.
    pub(crate) fn imports(&self) -> BTreeSet<Import> {
        let mut all = BTreeSet::new();
        for (from, module) in &self.0 {
            for path in &module.paths {
                if let Some(to) = self.resolve(from, path, 0).filter(|to| to != from) {
                    all.insert(Import { from: from.clone(), to, path: path.join("::") });
                }
            }
        }
        all
    }

    /// The module that defines what a path names, seen from a module; none for what other crates define.
    fn resolve(&self, from: &Place, path: &[String], deep: u32) -> Option<Place> {
        let mut at = from.clone();
        let mut rest = path;
        match path[0].as_str() {
            "crate" => at.clear(),
            "self" => {}
            "super" => {
                at.pop();
            }
            first => {
                at.push(first.to_owned());
                if !self.0.contains_key(&at) {
                    return None;
                }
            }
        }
        rest = &rest[1..];
        while let Some(next) = rest.first() {
            if next == "super" {
                at.pop();
            } else if next != "self" {
                let below: Place = at.iter().chain([next]).cloned().collect();
                if !self.0.contains_key(&below) {
                    break;
                }
                at = below;
            }
            rest = &rest[1..];
        }
        let module = self.0.get(&at)?;
        let further = rest.first().and_then(|name| module.handed_on.get(name)).filter(|_| deep < 8);
        further.and_then(|path| self.resolve(&at, path, deep + 1)).or(Some(at))
    }

    /// Files that import one another in a loop, each loop's together.
    pub(crate) fn circles(&self) -> Vec<Vec<Place>> {
        let imports = self.imports();
        let reached = |from: &Place| {
            let (mut seen, mut next) = (BTreeSet::new(), vec![from.clone()]);
            while let Some(place) = next.pop() {
                let further = imports.iter().filter(|import| import.from == place).map(|import| import.to.clone());
                next.extend(further.filter(|to| seen.insert(to.clone())));
            }
            seen
        };
        let all: BTreeMap<&Place, BTreeSet<Place>> = self.0.keys().map(|place| (place, reached(place))).collect();
        let mut circles: Vec<Vec<Place>> = Vec::new();
        for (place, below) in all.iter().filter(|(place, below)| below.contains(**place)) {
            if !circles.iter().flatten().any(|known| known == *place) {
                circles.push(below.iter().filter(|other| all[other].contains(*place)).cloned().collect());
            }
        }
        circles
    }
}

#[derive(Default)]
struct Reader {
    paths: BTreeSet<Vec<String>>,
    handed_on: BTreeMap<String, Vec<String>>,
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Ident>().is_ok_and(|word| word == "test")
    })
}

/// The paths of a tree of `use`, each with the name that it gets.
fn flatten(tree: &UseTree, before: &[String], out: &mut Vec<(Vec<String>, String)>) {
    let with = |name: &dyn ToString| before.iter().cloned().chain([name.to_string()]).collect::<Vec<_>>();
    match tree {
        UseTree::Path(path) => flatten(&path.tree, &with(&path.ident), out),
        UseTree::Name(name) => out.push((with(&name.ident), name.ident.to_string())),
        UseTree::Rename(renamed) => out.push((with(&renamed.ident), renamed.rename.to_string())),
        UseTree::Glob(_) => out.push((before.to_vec(), "*".to_owned())),
        UseTree::Group(group) => group.items.iter().for_each(|tree| flatten(tree, before, out)),
    }
}

impl<'ast> Visit<'ast> for Reader {
    fn visit_item(&mut self, item: &'ast Item) {
        let tests = matches!(item, Item::Mod(module) if is_test(&module.attrs));
        if !tests {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let mut found = Vec::new();
        flatten(&item.tree, &[], &mut found);
        for (path, name) in found {
            if !matches!(item.vis, Visibility::Inherited) {
                self.handed_on.insert(name, path.clone());
            }
            self.paths.insert(path);
        }
    }

    fn visit_path(&mut self, path: &'ast Path) {
        if path.segments.len() > 1 && path.leading_colon.is_none() {
            self.paths.insert(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_visibility(&mut self, _: &'ast Visibility) {}

    fn visit_macro(&mut self, called: &'ast Macro) {
        // Tokens that nobody has parsed: names joined by `::`.
        let text = called.tokens.to_string().replace(" :: ", "::");
        let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
        for word in text.split(|c| !is_path(c)).filter(|word| word.contains("::")) {
            let parts: Vec<String> = word.split("::").map(str::to_owned).collect();
            if parts.iter().all(|part| part.chars().next().is_some_and(|c| c.is_alphabetic() || c == '_')) {
                self.paths.insert(parts);
            }
        }
        visit::visit_macro(self, called);
    }
}
