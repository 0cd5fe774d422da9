//! Colours of the words that tell good from bad: on a terminal, unless `NO_COLOR` or `--color never` says no.

use anstyle::{AnsiColor, Style};
use clap::ColorChoice;

/// Something failed.
pub(super) const BAD: Style = AnsiColor::Red.on_default().bold();
/// Something did not run, or is said against a number.
pub(super) const DOUBTFUL: Style = AnsiColor::Yellow.on_default();
/// Something held.
pub(super) const GOOD: Style = AnsiColor::Green.on_default();

/// Sets what `anstream` prints with, from here on.
pub(super) fn choose(choice: ColorChoice) {
    let choice = match choice {
        ColorChoice::Auto => anstream::ColorChoice::Auto,
        ColorChoice::Always => anstream::ColorChoice::Always,
        ColorChoice::Never => anstream::ColorChoice::Never,
    };
    choice.write_global();
}

/// The text in a style; `anstream` takes it off again where no colours are wanted.
pub(super) fn painted(style: Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}
