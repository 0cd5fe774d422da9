//! Kinds of files, with the largest size that is read of each.

use std::fs::Metadata;

const MIB: u64 = 1 << 20;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Its name in messages.
    pub(crate) name: &'static str,
    /// Most bytes that are read of it.
    pub(crate) most: u64,
    /// Whether no output may replace it. What a command both reads and writes, such as results that it
    /// resumes, is replaced.
    pub(crate) input: bool,
}

impl Kind {
    /// Scenes, studies, shared methods, claims: written by hand.
    pub const SCENE: Kind = Kind::input("a scene, study or list", 4 * MIB);
    /// Meshes, surfaces, decks and what they include, positions of nodes.
    pub const MESH: Kind = Kind::input("a mesh or a list of points", 1_000_000_000);
    /// Stored references.
    pub const REFERENCE: Kind = Kind::input("a reference", 128 * MIB);
    /// The files of an adapter, together.
    pub const ADAPTER: Kind = Kind::input("the files of an adapter", 256 * MIB);
    /// The text of a problem for another solver, and of its answer.
    pub const MESSAGE: Kind = Kind { name: "a problem or an answer", most: MIB, input: false };
    /// Arrays of a problem for another solver, and of its answer.
    pub const ARRAY: Kind = Kind { name: "an array", ..Kind::MESH };
    /// A file of a history.
    pub const HISTORY: Kind = Kind::input("a file of a history", 16 * MIB);
    /// Accepted numbers.
    pub const BASELINE: Kind = Kind { name: "a baseline", most: 16 * MIB, input: false };
    /// A file of results.
    pub const RESULTS: Kind = Kind { name: "a file of results", most: 256 * MIB, input: false };

    const fn input(name: &'static str, most: u64) -> Kind {
        Kind { name, most, input: true }
    }

    /// A file of the same kind whose size is known better.
    pub fn at_most(self, bytes: u64) -> Kind {
        Kind { most: bytes.min(self.most), ..self }
    }

    /// Most bytes that are read of it.
    pub fn most(self) -> u64 {
        self.most
    }
}

/// Name of a kind of file that is not regular.
pub(crate) fn irregular(of: &Metadata) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        let kind = of.file_type();
        if kind.is_fifo() {
            return "a pipe";
        } else if kind.is_socket() {
            return "a socket";
        } else if kind.is_char_device() || kind.is_block_device() {
            return "a device";
        }
    }
    if of.is_dir() { "a folder" } else { "no regular file" }
}
