//! The gallery: figures and tables of full runs that the README and the book show.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result};

/// Folder of the gallery, from the root of the workspace.
const FOLDER: &str = "reports/gallery";

/// Largest move, in points, of a mark that leaves a figure as it is.
const MOVED: f64 = 6.0;

/// Largest ratio of two measured values of a table that leaves the table as it is.
const RATIO: f64 = 1.4;

/// Parts of the heads of table columns whose values are measured: times and memory, and figures of both.
const MEASURED: [&str; 11] = [
    "[ms]",
    "[s]",
    "[µs]",
    "[MB]",
    "[KB]",
    "per second",
    "times faster",
    "standard error",
    "assemble",
    "factor",
    "solve",
];

/// Takes from the last results the figures and tables that a text links: those of the verification, and the
/// maps of the stress study. A file that only differs by the noise of measurements stays as it is, and a file
/// that no text links is removed.
pub(crate) fn keep(root: &Path) -> Result<()> {
    let to = root.join(FOLDER);
    std::fs::create_dir_all(&to)?;
    let linked = linked(root)?;
    for old in std::fs::read_dir(&to)? {
        let old = old?.path();
        if !old.file_name().is_some_and(|name| linked.contains(&*name.to_string_lossy())) {
            std::fs::remove_file(old)?;
        }
    }
    for name in &linked {
        let folder = if name.ends_with(".svg") { "figures" } else { "tables" };
        let in_results = |results: &str| root.join(results).join("report").join(folder).join(name);
        let of_stress = in_results("results-stress");
        let stressed = name.starts_with("stability") && of_stress.exists();
        let from = if stressed { of_stress } else { in_results("results") };
        let new = std::fs::read_to_string(&from).with_context(|| format!("no {}", from.display()))?;
        let old = std::fs::read_to_string(to.join(name)).unwrap_or_default();
        let same =
            if name.ends_with(".svg") { is_same_figure(&old, &new) } else { is_same_table(&old, &new) };
        if !same {
            std::fs::write(to.join(name), new)?;
        }
    }
    Ok(())
}

/// Returns the names of the gallery's files that the README and the pages of the book link.
fn linked(root: &Path) -> Result<BTreeSet<String>> {
    let mut texts = vec![root.join("README.md")];
    let mut folders = vec![root.join("docs/src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() { &mut folders } else { &mut texts }.push(path);
        }
    }
    let mut names = BTreeSet::new();
    for path in texts.iter().filter(|path| path.extension().is_some_and(|end| end == "md")) {
        let text = std::fs::read_to_string(path)?;
        for after in text.split("gallery/").skip(1) {
            let is_part = |c: &char| c.is_ascii_alphanumeric() || "-_.".contains(*c);
            let name: String = after.chars().take_while(is_part).collect();
            if name.ends_with(".svg") || name.ends_with(".md") {
                names.insert(name);
            }
        }
    }
    Ok(names)
}

/// Whether two figures have the same text and marks, none of which moved visibly.
fn is_same_figure(old: &str, new: &str) -> bool {
    let [old, new] = [old, new].map(parts);
    old.len() == new.len()
        && old.iter().zip(&new).all(|(old, new)| is_near(old, new, |a, b| (a - b).abs() <= MOVED))
}

/// Whether two tables agree in all but measured values, which may differ by [`RATIO`].
fn is_same_table(old: &str, new: &str) -> bool {
    let mut heads: Vec<&str> = Vec::new();
    let near = |a: f64, b: f64| a == b || a.max(b) <= RATIO * a.min(b);
    old.lines().count() == new.lines().count()
        && old.lines().zip(new.lines()).all(|(old, new)| {
            if !old.starts_with('|') {
                heads.clear();
                return old == new;
            }
            let [old, new] = [old, new].map(|line| line.split(" | ").collect::<Vec<_>>());
            if heads.is_empty() {
                heads.clone_from(&old);
            }
            let plain = |head: &str| head.replace('\\', "");
            old.len() == new.len()
                && old.iter().zip(&new).enumerate().all(|(column, (old, new))| {
                    let head = heads.get(column).map(|head| plain(head)).unwrap_or_default();
                    let measured = MEASURED.iter().any(|part| head.contains(part));
                    old == new
                        || measured && {
                            let [old, new] = [parts(old), parts(new)];
                            old.len() == new.len()
                                && old.iter().zip(&new).all(|(old, new)| is_near(old, new, near))
                        }
                })
        })
}

/// Whether two parts are the same text, or numbers that are near.
fn is_near(old: &str, new: &str, near: impl Fn(f64, f64) -> bool) -> bool {
    old == new || old.parse().ok().zip(new.parse().ok()).is_some_and(|(old, new)| near(old, new))
}

/// Divides a text into numbers and the text between them.
fn parts(text: &str) -> Vec<&str> {
    let digit = |c: char| c.is_ascii_digit() || c == '.';
    let mut parts = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let number = digit(first);
        let end = rest.find(|c| digit(c) != number).unwrap_or(rest.len());
        parts.push(&rest[..end]);
        rest = &rest[end..];
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_of_a_measurement_changes_no_table_and_an_error_does() {
        let table = |error: &str, time: &str| {
            format!(
                "Times.\n\n| method | L2 \\[1\\] | solve \\[ms\\] |\n| --- | ---: | ---: |\n| tet4 | {error} | {time} |\n"
            )
        };
        let old = table("4.366e-2", "1.48 ± 0.06");
        assert!(is_same_table(&old, &table("4.366e-2", "1.61 ± 0.05")));
        assert!(!is_same_table(&old, &table("4.366e-2", "2.61 ± 0.06")));
        assert!(!is_same_table(&old, &table("4.367e-2", "1.48 ± 0.06")));
        assert!(!is_same_table(&old, &table("4.366e-2", "—")));
        assert!(!is_same_table(&old, &format!("{old}| tet10 | 1e-3 | 2.0 |\n")));
    }

    #[test]
    fn a_mark_that_hardly_moves_leaves_a_figure() {
        let figure = |x: &str, text: &str| format!("<circle cx=\"{x}\" cy=\"20\"/><text>{text}</text>");
        assert!(is_same_figure(&figure("10.5", "tet4"), &figure("13", "tet4")));
        assert!(!is_same_figure(&figure("10.5", "tet4"), &figure("30", "tet4")));
        assert!(!is_same_figure(&figure("10.5", "tet4"), &figure("10.5", "tet10 ")));
    }

    #[test]
    fn every_linked_file_is_kept_and_nothing_else() {
        let root = crate::cargo::root();
        let kept = std::fs::read_dir(root.join(FOLDER)).unwrap();
        let kept: BTreeSet<String> =
            kept.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        assert_eq!(kept, linked(&root).unwrap());
    }
}
