//! Scenes from TOML files.
