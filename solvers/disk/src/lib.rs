//! File access: the only code that opens files made by others, and the only code that could overwrite them.
//!
//! A reader takes regular files up to the size limit of their [`Kind`]. It refuses at once a pipe without a
//! writer, an endless device, or a file larger than its kind allows. A writer refuses a file that this
//! process has read as an input, whatever the name or link by which the file is reached.

mod identity;
mod kind;
mod read;
mod write;

pub use identity::{Identity, input, spare};
pub use kind::Kind;
pub use read::{open, read, read_text};
pub use write::{create, create_lock, remove, replace, try_create, write};
