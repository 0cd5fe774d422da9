//! Runs a target under libFuzzer, with a limit on its peak allocation.

use harness::run::MemoryBaseline;

/// Largest allocation, bytes, for an input of less than a mebibyte.
const MOST: u64 = 1 << 30;

/// Runs the target with this name.
pub fn run(name: &str, data: &[u8]) {
    let target = fuzz::TARGETS.iter().find(|target| target.name == name).expect("a known target");
    let before = MemoryBaseline::new();
    (target.run)(data);
    assert!(before.peak() < MOST, "{} bytes at once", before.peak());
}
