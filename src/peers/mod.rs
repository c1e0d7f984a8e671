//! How do other renderers do on the same scene?
//!
//! A [`Peer`] is a renderer and a small Python script of ours that drives it (`src/peers/scripts/`, where the contract between
//! the two stands). The scene is exported, the script renders it at a few sample counts and seeds, and its images become
//! rows beside those of the strategies: the same reference, the same errors, marked external ([`measure`]).
//!
//! What is compared is light, not edges: only receivers whose pixel is [clear](mask) of emitters and silhouettes. A peer
//! that is not installed, fails or hangs is a row that says so, and never the end of a comparison.

pub(crate) mod agreement;
mod group;
pub(crate) mod mask;
pub(crate) mod measure;
mod script;

#[cfg(feature = "cli")]
pub(crate) use group::end_all;

use crate::base::error::{Error, Result};
use crate::export::Renderer as Format;
use crate::strategy::Arguments;

/// A renderer that can be named.
struct Kind {
    name: &'static str,
    /// What the scene is exported to, and the name of its file.
    scene: (Format, &'static str),
    /// The script, and the name of its file.
    script: (&'static str, &'static str),
    /// Reads its parameters; gives what they add to the script's command line.
    configure: fn(&mut Arguments) -> Result<Vec<String>>,
}

const KINDS: [Kind; 2] = [
    Kind {
        name: "cycles",
        scene: (Format::Gltf, "scene.glb"),
        script: ("cycles_peer.py", include_str!("scripts/cycles_peer.py")),
        configure: |arguments| {
            const SWITCH: [&str; 2] = ["on", "off"];
            let tree = arguments.choice("light-tree", 0, &SWITCH, "whether lights are chosen by a tree")?;
            Ok(vec!["--light-tree".to_owned(), SWITCH[tree].to_owned()])
        },
    },
    Kind {
        name: "mitsuba",
        scene: (Format::Mitsuba, "scene.xml"),
        script: ("mitsuba_peer.py", include_str!("scripts/mitsuba_peer.py")),
        configure: |_| Ok(Vec::new()),
    },
];

/// What every script imports, and the name of its file.
const CONTRACT: (&str, &str) = ("contract.py", include_str!("scripts/contract.py"));

/// A renderer with its parameters settled.
pub(crate) struct Peer {
    name: String,
    kind: &'static Kind,
    arguments: Vec<String>,
}

impl Peer {
    /// Reads `name` or `name:parameter=value`, as strategies are read.
    ///
    /// # Errors
    /// An unknown name or parameter, with those that come near it; a value that is not allowed, with those that are;
    /// a parameter without a value, or given twice.
    pub(crate) fn parse(text: &str) -> Result<Self> {
        let (name, rest) = text.trim().split_once(':').unwrap_or((text.trim(), ""));
        let Some(kind) = KINDS.iter().find(|kind| kind.name == name) else {
            return Err(Error::unknown("peer", name, KINDS.iter().map(|kind| kind.name)));
        };
        let mut arguments = Arguments::new(name, rest)?;
        let added = (kind.configure)(&mut arguments)?;
        let parameters = arguments.finish()?;
        let changed: Vec<String> =
            parameters.iter().filter(|p| p.value != p.default).map(|p| format!("{}={}", p.name, p.value)).collect();
        let name = if changed.is_empty() { name.to_owned() } else { format!("{name}:{}", changed.join(",")) };
        Ok(Self { name, kind, arguments: added })
    }

    /// Its name with the parameters that differ from their defaults: `cycles:light-tree=off`.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }
}
