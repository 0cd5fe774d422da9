//! Files that fuzzed scenes and studies refer to.

/// Folder of files that fuzzed scenes and studies refer to.
const INPUTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/inputs");

/// Returns the path of a file with this name in the folder of inputs; the file need not exist.
pub(crate) fn beside(name: &str) -> String {
    format!("{INPUTS}/{name}")
}
