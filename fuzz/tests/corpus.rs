//! Runs every stored fuzz input: no panic, less than a second, less than a gigabyte.

use std::path::{Path, PathBuf};

use cpu_time::ProcessTime;
use fuzz::{TARGETS, Target};
use harness::run::MemoryBaseline;

/// Largest CPU time of an input, s; wall time would depend on the load of the machine.
const SECONDS: f64 = 1.0;
/// Largest allocation, bytes.
const BYTES: u64 = 1 << 30;

fn inputs(target: &Target) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target.name);
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// All inputs are in a single test, because time and memory are measured for the process.
#[test]
fn every_input_is_read_or_refused_in_time() {
    for target in TARGETS {
        let files = inputs(&target);
        assert!(files.len() >= 10, "{} has {} inputs", target.name, files.len());
        for file in files {
            let data = std::fs::read(&file).unwrap();
            assert!(data.len() < 1 << 20, "{} is too long", file.display());
            let before = MemoryBaseline::new();
            let start = ProcessTime::now();
            let ended = std::panic::catch_unwind(|| (target.run)(&data));
            assert!(ended.is_ok(), "{} panics", file.display());
            let bytes = before.peak();
            let seconds = start.elapsed().as_secs_f64();
            assert!(bytes < BYTES, "{} takes {bytes} bytes", file.display());
            assert!(seconds < SECONDS, "{} takes {seconds:.2} s", file.display());
        }
    }
}
