//! Files that people and other programs write for external solvers: `adapter.toml`, `result.json`, `.npy`,
//! claims, and statements about credibility.

use harness::try_readers;
use reports::{read_claims, read_statements};

/// Numbers of nodes and load steps of the problem to which the files belong.
const NODES: usize = 4;
const STEPS: usize = 3;

pub(crate) fn run(data: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    for name in ["adapter.toml", "result.json", "displacement.npy", "claims.toml"] {
        std::fs::write(folder.path().join(name), data).expect("a temporary file can be written");
    }
    for read in try_readers(folder.path(), NODES, STEPS) {
        assert!(read.err().is_none_or(|reason| !reason.is_empty()));
    }
    // The claims serve as statements, too: both are read as TOML.
    let _ = read_statements(&folder.path().join("claims.toml"));
    if let Ok(claims) = read_claims(&folder.path().join("claims.toml")) {
        for claim in claims {
            let _ = claim.judge(&records::RunSet::default());
        }
    }
}
