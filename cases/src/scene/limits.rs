//! Limits on the size of scene and study files: checks compare the parts of a file with each other, at
//! quadratic cost.

use std::ops::Range;

use catalogue::Problem;
use toml::Spanned;
use toml::de::DeValue;

use super::conform::join;

/// Longest file, bytes. The study of the verification has 40,000 bytes; a value takes some 20 bytes.
pub(crate) const MOST_BYTES: usize = 1 << 22;
/// Most entries of a list or table.
const MOST_ENTRIES: usize = 10_000;
/// Most values of a file.
const MOST_VALUES: usize = 200_000;

/// A part of a file beyond a limit: span, key and problem.
pub(crate) type Excess = (Range<usize>, String, Problem);

/// Finds the first list or table that is too long, or the first value beyond the limit.
pub(crate) fn excess(root: &Spanned<DeValue<'_>>) -> Option<Excess> {
    below(root, "", &mut 0)
}

fn below(value: &Spanned<DeValue<'_>>, path: &str, count: &mut usize) -> Option<Excess> {
    *count += 1;
    let wrong = |problem: String, help: String| {
        Some((value.span(), path.to_string(), Problem::new(problem).help(help)))
    };
    if *count > MOST_VALUES {
        return wrong("is one value too many".into(), format!("a file has at most {MOST_VALUES}"));
    }
    let entries = match value.get_ref() {
        DeValue::Table(table) => table.len(),
        DeValue::Array(array) => array.len(),
        _ => return None,
    };
    if entries > MOST_ENTRIES {
        return wrong(format!("has {entries} entries"), format!("give {MOST_ENTRIES} or less"));
    }
    match value.get_ref() {
        DeValue::Table(table) => {
            table.iter().find_map(|(key, value)| below(value, &join(path, key.get_ref()), count))
        }
        DeValue::Array(array) => {
            array.iter().enumerate().find_map(|(i, value)| below(value, &format!("{path}[{i}]"), count))
        }
        _ => None,
    }
}
