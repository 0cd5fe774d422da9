//! Printing that never panics. The macros of the standard library do where stdout or stderr takes no more, and a panic would
//! cost the results that are still to be written. These take their place in the whole crate.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::sync::Mutex;

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

/// Writes to stdout.
pub(crate) fn out(text: Arguments) {
    let mut lost = LOST.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if lost.is_none() {
        *lost = io::stdout().lock().write_fmt(text).err();
    }
}

/// Writes to stderr; nobody is left to hear that it takes nothing.
pub(crate) fn note(text: Arguments) {
    let _ = io::stderr().lock().write_fmt(text);
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
