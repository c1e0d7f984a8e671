fn main() -> std::process::ExitCode {
    citylights::cli::run_with(&systematic::registry(), &citylights::program!())
}
