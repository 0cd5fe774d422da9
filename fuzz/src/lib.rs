//! What is fuzzed: every reader of files that people write or that a stopped program leaves. A target takes any bytes, and
//! nothing of it may panic, take more than a second or more than a gigabyte.
//!
//! `corpus/TARGET` holds inputs that once led somewhere new; `tests/corpus.rs` runs them all with every `cargo test`. The
//! search for more is in `engine`, a workspace of its own, as it needs a nightly compiler:
//!
//! ```sh
//! cargo install cargo-fuzz
//! cargo +nightly fuzz run --fuzz-dir fuzz/engine --sanitizer none scene fuzz/corpus/scene
//! ```

mod adapter;
mod expression;
mod mesh;
mod records;
mod reference;
mod scene;
mod study;

/// A reader under test.
#[derive(Clone, Copy)]
pub struct Target {
    /// Its name, that of its folder in `corpus`.
    pub name: &'static str,
    /// Reads the bytes, and does with what is read what the program does before it solves.
    pub run: fn(&[u8]),
}

/// All targets.
pub const TARGETS: [Target; 7] = [
    Target { name: "scene", run: scene::run },
    Target { name: "study", run: study::run },
    Target { name: "expression", run: expression::run },
    Target { name: "mesh", run: mesh::run },
    Target { name: "records", run: records::run },
    Target { name: "reference", run: reference::run },
    Target { name: "adapter", run: adapter::run },
];

/// Files that fuzzed scenes and studies name.
const INPUTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/inputs");

/// A file of that name beside these files; it need not exist.
fn beside(name: &str) -> String {
    format!("{INPUTS}/{name}")
}

/// Every message is one line about a place that the text has.
fn sound(errors: &[cases::scene::SceneError], text: &str, file: &str) {
    let lines = text.split('\n').count();
    for error in errors {
        let message = error.to_string();
        assert!(!message.contains('\n') && !error.problem.is_empty(), "{message}");
        let own = error.file != file || (1..=lines).contains(&error.line);
        assert!(own, "line {} of {lines}: {message}", error.line);
    }
}
