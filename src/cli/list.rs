//! `citylights list`: which strategies, scenes, studies and chapters of the lecture are there?

use super::home::Home;
use super::outcome::Outcome;
use super::terminal::print;
use crate::base::error::Error;
use crate::lecture::{CHAPTERS, Chapter};
use crate::strategy::Configured;
use crate::study::{Entry, STUDIES};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::Path;

#[derive(Args)]
pub(super) struct Arguments {
    /// What to list
    #[arg(value_enum)]
    what: What,
    /// As JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum What {
    Strategies,
    Scenes,
    Studies,
    Lecture,
}

pub(super) fn run(arguments: &Arguments, home: &Home<'_>) -> anyhow::Result<Outcome> {
    let list = match arguments.what {
        What::Strategies => home.registry.all()?.iter().map(strategy).collect(),
        What::Scenes => scenes(Path::new("scenes"))?,
        What::Studies => studies(),
        What::Lecture => CHAPTERS.iter().map(chapter).collect(),
    };
    if arguments.json {
        print(&format!(
            "{}\n",
            serde_json::to_string_pretty(&list.iter().map(|item| &item.json).collect::<Vec<_>>())?
        ))?;
    } else {
        list.iter().try_for_each(|item| print(&item.text))?;
    }
    Ok(Outcome::Done)
}

struct Item {
    text: String,
    json: Value,
}

fn strategy(configured: &Configured) -> Item {
    let (name, info) = (configured.name(), configured.info());
    let word = info.claim.word();
    let claim = info.claim.bias().map_or_else(|| word.to_owned(), |why| format!("{word}: {why}"));
    let mut text = format!("{name}\n    {}\n    {claim}\n    source: {}\n", info.summary, info.source);
    for p in configured.parameters() {
        text.push_str(&format!("    {}={} ({}): {}\n", p.name, p.default, p.allowed, p.meaning));
    }
    let parameters: Vec<Value> = configured
        .parameters()
        .iter()
        .map(|p| json!({ "name": p.name, "default": p.default, "allowed": p.allowed, "meaning": p.meaning }))
        .collect();
    let json = json!({ "name": name, "summary": info.summary, "source": info.source, "claim": claim, "parameters": parameters });
    Item { text, json }
}

fn studies() -> Vec<Item> {
    let item = |study: &Entry| Item {
        text: format!("{}\n    {}\n", study.name, study.question),
        json: json!({ "name": study.name, "question": study.question }),
    };
    STUDIES.iter().map(item).collect()
}

fn chapter(chapter: &Chapter) -> Item {
    let Chapter { number, name, question, scene, .. } = chapter;
    Item {
        text: format!("{name}\n    {question}\n    chapter {number}, scene: {scene}\n"),
        json: json!({ "number": number, "name": name, "question": question, "scene": scene }),
    }
}

/// The recipes of a folder; what a scene is for stands in the comment at its head.
fn scenes(folder: &Path) -> Result<Vec<Item>, Error> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .map_err(Error::io("read", folder))?
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    let item = |path: &std::path::PathBuf| {
        let text = std::fs::read_to_string(path).map_err(Error::io("read", path))?;
        let head: Vec<&str> = text.lines().map_while(|line| line.strip_prefix('#')).map(str::trim).collect();
        let purpose = head.join(" ");
        Ok(Item {
            text: format!("{}\n    {purpose}\n", path.display()),
            json: json!({ "file": path.display().to_string(), "purpose": purpose }),
        })
    };
    files.iter().map(item).collect()
}
