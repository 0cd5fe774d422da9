//! Kinds of files, with the largest size that is read of each kind.

use std::fs::Metadata;

const MIB: u64 = 1 << 20;

/// Kind of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Name in messages.
    pub(crate) name: &'static str,
    /// Largest number of bytes that are read.
    pub(crate) most: u64,
    /// Whether outputs must not replace the file. Files that a command both reads and writes, such as results
    /// that it resumes, may be replaced.
    pub(crate) input: bool,
}

impl Kind {
    /// Scenes, studies, shared methods, claims and statements, written by hand.
    pub const SCENE: Kind = Kind::input("a scene, study or list", 4 * MIB);
    /// Meshes, surfaces, decks with their included files, and node positions.
    pub const MESH: Kind = Kind::input("a mesh or a list of points", 1_000_000_000);
    /// Measured curves.
    pub const CURVE: Kind = Kind::input("a measured curve", 4 * MIB);
    /// Stored references.
    pub const REFERENCE: Kind = Kind::input("a reference", 128 * MIB);
    /// Files of an adapter, together.
    pub const ADAPTER: Kind = Kind::input("the files of an adapter", 256 * MIB);
    /// Text of a problem for another solver, or of its answer.
    pub const MESSAGE: Kind = Kind { name: "a problem or an answer", most: MIB, input: false };
    /// Arrays of a problem for another solver, or of its answer.
    pub const ARRAY: Kind = Kind { name: "an array", ..Kind::MESH };
    /// File of a history.
    pub const HISTORY: Kind = Kind::input("a file of a history", 16 * MIB);
    /// Accepted values.
    pub const BASELINE: Kind = Kind { name: "a baseline", most: 16 * MIB, input: false };
    /// File of results.
    pub const RESULTS: Kind = Kind { name: "a file of results", most: 256 * MIB, input: false };
    /// File of a folder of results that is only hashed, whatever its size.
    pub const HASHED: Kind = Kind { name: "a file to be hashed", most: u64::MAX, input: false };

    const fn input(name: &'static str, most: u64) -> Kind {
        Kind { name, most, input: true }
    }

    /// Returns the same kind with a tighter size limit, bytes.
    pub fn at_most(self, bytes: u64) -> Kind {
        Kind { most: bytes.min(self.most), ..self }
    }

    /// Returns the largest number of bytes that are read.
    pub fn most(self) -> u64 {
        self.most
    }
}

/// Returns the name of a file type that is not regular.
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
    if of.is_dir() { "a folder" } else { "a special file" }
}
