//! Files in and out: the only code that opens what others have made, and the only code that writes where they
//! have files.
//!
//! A reader takes regular files up to the size of their [`Kind`]: a pipe that nobody fills, a device without
//! an end or a file larger than any of its kind is refused at once. A writer refuses a file that this process
//! has read as an input, by whatever name or link it is reached.

mod identity;
mod kind;
mod read;
mod write;

pub use identity::{Identity, input, spare};
pub use kind::Kind;
pub use read::{open, read, read_text};
pub use write::{create, create_lock, remove, replace, try_create, write};
