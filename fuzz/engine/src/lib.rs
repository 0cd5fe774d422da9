//! One target under libFuzzer, with a limit on what it may allocate at once.

use harness::run::MemoryBaseline;

/// Most bytes for an input of less than a mebibyte.
const MOST: u64 = 1 << 30;

/// Runs the target of that name.
pub fn run(name: &str, data: &[u8]) {
    let target = fuzz::TARGETS.iter().find(|target| target.name == name).expect("a known target");
    let before = MemoryBaseline::new();
    (target.run)(data);
    assert!(before.peak() < MOST, "{} bytes at once", before.peak());
}
