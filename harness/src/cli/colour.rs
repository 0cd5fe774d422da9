//! Colours of verdicts on a terminal, unless `NO_COLOR` or `--color never` is given.

use std::io;

use anstream::AutoStream;
use anstyle::{AnsiColor, Style};
use clap::ColorChoice;

/// Style of failures.
pub(super) const BAD: Style = AnsiColor::Red.on_default().bold();
/// Style of warnings and of checks that did not run.
pub(super) const DOUBTFUL: Style = AnsiColor::Yellow.on_default();
/// Style of success.
pub(super) const GOOD: Style = AnsiColor::Green.on_default();

/// Sets when output is coloured, for the rest of the program.
pub(super) fn choose(choice: ColorChoice) {
    let choice = match choice {
        ColorChoice::Auto => anstream::ColorChoice::Auto,
        ColorChoice::Always => anstream::ColorChoice::Always,
        ColorChoice::Never => anstream::ColorChoice::Never,
    };
    choice.write_global();
}

/// Returns the text in a style if stdout supports colours.
pub(super) fn out(style: Style, text: &str) -> String {
    painted(AutoStream::choice(&io::stdout()), style, text)
}

/// Returns the text in a style if stderr supports colours.
pub(super) fn err(style: Style, text: &str) -> String {
    painted(AutoStream::choice(&io::stderr()), style, text)
}

fn painted(choice: anstream::ColorChoice, style: Style, text: &str) -> String {
    match choice {
        anstream::ColorChoice::Never => text.into(),
        _ => format!("{style}{text}{style:#}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_style_is_put_on_only_where_it_is_taken() {
        assert_eq!(painted(anstream::ColorChoice::Never, BAD, "FAILED"), "FAILED");
        let red = painted(anstream::ColorChoice::Always, BAD, "FAILED");
        assert!(
            red.starts_with("\u{1b}[") && red.ends_with("\u{1b}[0m") && red.contains("FAILED"),
            "{red:?}"
        );
    }
}
