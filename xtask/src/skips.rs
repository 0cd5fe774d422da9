//! Steps omitted because a tool is missing. Each is reported, and with `CI=true` fails unless `.ci/skips`
//! names the tool.

use std::path::Path;

use anyhow::{Context, Result};

/// Reports that a step is omitted. Returns the exit code: 0, or 1 if continuous integration requires the
/// tool.
pub(crate) fn skipped(root: &Path, tool: &str, why: &str) -> Result<u8> {
    eprintln!("xtask: skipped: {why}");
    let path = root.join(".ci/skips");
    let list = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    if std::env::var("CI").as_deref() != Ok("true") || may_lack(&list, tool) {
        return Ok(0);
    }
    eprintln!("xtask: CI=true, and .ci/skips has no line '{tool}: ...': install it, or add the line");
    Ok(1)
}

/// Whether a list has a line for the tool.
fn may_lack(list: &str, tool: &str) -> bool {
    list.lines()
        .any(|line| line.split_once(':').is_some_and(|(name, why)| name == tool && !why.trim().is_empty()))
}

#[cfg(test)]
mod tests {
    use super::may_lack;

    #[test]
    fn a_tool_may_be_missing_where_its_line_says_what_is_left_out() {
        let list = "# valgrind: not this line\nnode: the page\nvtk:\n";
        let tools = ["node", "vtk", "valgrind", "no", "the page"];
        assert_eq!(tools.map(|tool| may_lack(list, tool)), [true, false, false, false, false]);
    }
}
