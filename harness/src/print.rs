//! Printing that never panics and never passes control characters to a terminal.
//!
//! The standard library's macros panic if stdout or stderr cannot be written, which would lose results that
//! are not written yet. They also pass on every character of a title or file name. The macros here replace
//! them in the whole crate.

use std::borrow::Cow;
use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::sync::Mutex;

use anstream::{AutoStream, ColorChoice};

macro_rules! print {
    ($($text:tt)*) => { $crate::print::out(format_args!($($text)*)) };
}

macro_rules! println {
    ($($text:tt)*) => { $crate::print::out(format_args!("{}\n", format_args!($($text)*))) };
}

macro_rules! eprintln {
    ($($text:tt)*) => { $crate::print::note(format_args!("{}\n", format_args!($($text)*))) };
}

/// The first error of writing to stdout; nothing is written to stdout after it.
static LOST: Mutex<Option<io::Error>> = Mutex::new(None);

/// Escape sequences of the program's own colours and their reset, which a terminal with colours receives.
const COLOURS: [&str; 5] = ["\u{1b}[1m", "\u{1b}[31m", "\u{1b}[32m", "\u{1b}[33m", "\u{1b}[0m"];

/// Writes to stdout.
pub(crate) fn out(text: Arguments) {
    let mut lost = LOST.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if lost.is_none() {
        let stdout = io::stdout();
        let coloured = AutoStream::choice(&stdout) != ColorChoice::Never;
        *lost = stdout.lock().write_all(shown(&text.to_string(), coloured).as_bytes()).err();
    }
}

/// Writes to stderr. Errors are ignored: there is nowhere left to report them.
pub(crate) fn note(text: Arguments) {
    let stderr = io::stderr();
    let coloured = AutoStream::choice(&stderr) != ColorChoice::Never;
    let _ = stderr.lock().write_all(shown(&text.to_string(), coloured).as_bytes());
}

/// Stdout as a byte writer for text.
pub(crate) struct Stdout;

impl Write for Stdout {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        out(format_args!("{}", String::from_utf8_lossy(bytes)));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stdout().flush()
    }
}

/// Whether a terminal only displays this character. Control characters can move the cursor, erase text and
/// send input; bidirectional marks can disguise a text.
fn is_plain(c: char) -> bool {
    match c {
        '\n' | '\t' => true,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => false,
        c => !c.is_control(),
    }
}

/// Returns `text` with characters that are not plain written as `\u001b`, the form of JSON: within JSON
/// strings the text keeps its meaning. The program's own colours are kept if `coloured`.
pub(crate) fn shown(text: &str, coloured: bool) -> Cow<'_, str> {
    let Some(first) = text.find(|c| !is_plain(c)) else { return text.into() };
    let (plain, mut rest) = text.split_at(first);
    let mut shown = plain.to_string();
    while let Some(c) = rest.chars().next() {
        let own = COLOURS.iter().find(|colour| coloured && rest.starts_with(**colour));
        match own {
            Some(colour) => shown += colour,
            None if is_plain(c) => shown.push(c),
            None => shown += &format!("\\u{:04x}", u32::from(c)),
        }
        rest = &rest[own.map_or(c.len_utf8(), |colour| colour.len())..];
    }
    shown.into()
}

/// Returns the exit code of a command that ends with `code`: 5 if the command succeeded but stdout could not
/// be written completely. A reader that closes the pipe early (`| head`) is no error.
pub(crate) fn code(code: u8) -> u8 {
    let flushed = io::stdout().lock().flush().err();
    let lost = LOST.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take();
    match lost.or(flushed) {
        Some(bad) if bad.kind() != ErrorKind::BrokenPipe => {
            eprintln!("tissuebench: stdout can't be written: {bad}; the printed output is incomplete");
            if code == 0 { 5 } else { code }
        }
        _ => code,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_gets_what_it_shows_and_colours_of_ours() {
        let plain = "Größe\t5 µm — ok\n";
        assert!(matches!(shown(plain, false), Cow::Borrowed(same) if same == plain));
        let hostile = "a\u{1b}[2J\u{7}\r\u{9b}1m\u{202e}b\u{2066}";
        assert_eq!(shown(hostile, true), "a\\u001b[2J\\u0007\\u000d\\u009b1m\\u202eb\\u2066");
        let painted = "\u{1b}[1m\u{1b}[31mFAILED\u{1b}[0m \u{1b}[5m";
        assert_eq!(shown(painted, true), painted.replace("\u{1b}[5m", "\\u001b[5m"));
        assert_eq!(shown(painted, false).find('\u{1b}'), None);
    }

    #[test]
    fn json_says_the_same() {
        let text = "a\\\u{202e}\u{85}\"\u{1}";
        let json = serde_json::to_string(text).unwrap();
        assert_eq!(serde_json::from_str::<String>(&shown(&json, false)).unwrap(), text);
    }
}
