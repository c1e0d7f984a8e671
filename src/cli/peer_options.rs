//! Options that say which other renderers are compared, and with what they run.

use super::values::seconds;
use crate::base::error::{Error, Result};
use crate::peers::Peer;
use clap::Args;
use std::path::PathBuf;

/// Options of other renderers.
#[derive(Args)]
pub(super) struct PeerOptions {
    /// Another renderer, on the exported scene, in the same table: mitsuba, cycles, cycles:light-tree=off; more than once
    /// for more than one. src/peers/scripts/README.md says how to install them
    #[arg(long = "peer", value_name = "NAME")]
    peers: Vec<String>,
    /// The Python that has the peers; by default what CITYLIGHTS_PYTHON names, else src/peers/scripts/.venv/bin/python where
    /// that is, else python3
    #[arg(long, value_name = "FILE")]
    peer_python: Option<PathBuf>,
    /// Seconds that a peer may take from one image to the next
    #[arg(long, value_name = "S", default_value = "1800", value_parser = seconds)]
    pub(super) peer_patience: f64,
}

impl PeerOptions {
    /// The renderers that are named.
    ///
    /// # Errors
    /// A name that is no renderer's, or that stands twice; any where receivers move, which no renderer's do.
    pub(super) fn peers(&self, receivers_move: bool) -> Result<Vec<Peer>> {
        let peers = self.peers.iter().map(|text| Peer::parse(text)).collect::<Result<Vec<_>>>()?;
        let twice =
            peers.iter().enumerate().find(|(i, peer)| peers[..*i].iter().any(|other| other.name() == peer.name()));
        if let Some((_, peer)) = twice {
            return Err(Error::Invalid(format!("the peer `{}` is named twice", peer.name())));
        }
        if receivers_move && !peers.is_empty() {
            let text =
                "a peer renders what pixels see through their centres: leave out --peer, or take --receivers centre";
            return Err(Error::Invalid(text.into()));
        }
        Ok(peers)
    }

    /// The Python that peers are run with.
    pub(super) fn python(&self) -> PathBuf {
        let own = || Some(PathBuf::from("src/peers/scripts/.venv/bin/python")).filter(|file| file.exists());
        let named = self.peer_python.clone().or_else(|| std::env::var_os("CITYLIGHTS_PYTHON").map(PathBuf::from));
        named.or_else(own).unwrap_or_else(|| "python3".into())
    }
}
