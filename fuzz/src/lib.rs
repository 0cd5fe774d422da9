//! Fuzz targets: every reader of files that people write or that an interrupted program leaves. A target
//! takes arbitrary bytes. It must not panic, take more than a second or use more than a gigabyte.
//!
//! `corpus/TARGET` holds inputs that once reached new code; `tests/corpus.rs` runs all of them with every
//! `cargo test`. The search for further inputs is in `engine`, a separate workspace because it needs a
//! nightly compiler:
//!
//! ```sh
//! cargo install cargo-fuzz
//! cargo +nightly fuzz run --fuzz-dir fuzz/engine --sanitizer none scene fuzz/corpus/scene
//! ```

mod adapter;
mod expression;
mod import;
mod inputs;
mod mesh;
mod messages;
mod records;
mod reference;
mod scene;
mod study;

/// A reader under test.
#[derive(Clone, Copy)]
pub struct Target {
    /// Name of the target and of its folder in `corpus`.
    pub name: &'static str,
    /// Reads the bytes, and processes the result as the program does before a solution.
    pub run: fn(&[u8]),
}

/// All targets.
pub const TARGETS: [Target; 8] = [
    Target { name: "scene", run: scene::run },
    Target { name: "study", run: study::run },
    Target { name: "expression", run: expression::run },
    Target { name: "mesh", run: mesh::run },
    Target { name: "records", run: records::run },
    Target { name: "reference", run: reference::run },
    Target { name: "adapter", run: adapter::run },
    Target { name: "import", run: import::run },
];
