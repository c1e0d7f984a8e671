fn main() -> citylights::prelude::Result<()> {
    citylights::bench::strategies(&systematic::registry(), &["../../scenes/first-night.toml".as_ref()])
}
