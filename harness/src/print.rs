//! Printing that never panics, and never hands a terminal what others would have it do. The macros of the
//! standard library panic where stdout or stderr takes no more, which would cost the results that are still
//! to be written, and pass on every character of a title or of a file's name. These take their place in the
//! whole crate.

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

/// Why stdout took no more; nothing is written to it from then on.
static LOST: Mutex<Option<io::Error>> = Mutex::new(None);

/// The colours of this program, and their end, where a terminal takes any.
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

/// Writes to stderr; nobody is left to hear that it takes nothing.
pub(crate) fn note(text: Arguments) {
    let stderr = io::stderr();
    let coloured = AutoStream::choice(&stderr) != ColorChoice::Never;
    let _ = stderr.lock().write_all(shown(&text.to_string(), coloured).as_bytes());
}

/// Stdout for those who write bytes of text.
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

/// Whether a terminal shows a character and does nothing else: control characters move, erase and send,
/// others turn the direction of writing, so that a text reads as another one.
fn is_plain(c: char) -> bool {
    match c {
        '\n' | '\t' => true,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => false,
        c => !c.is_control(),
    }
}

/// The text with characters that are not plain written as `\u001b`, which is how JSON has them: within its
/// strings they stay the same.
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

/// The exit code of a command that ends with `code`: 5 where all held but stdout has not all of it. A reader that closes early
/// (`| head`) has what it wants.
pub(crate) fn code(code: u8) -> u8 {
    let flushed = io::stdout().lock().flush().err();
    let lost = LOST.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take();
    match lost.or(flushed) {
        Some(bad) if bad.kind() != ErrorKind::BrokenPipe => {
            eprintln!("tissuebench: stdout can't be written: {bad}; what was printed there is not whole");
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
