//! Text cells of CSV. A spreadsheet interprets a text that begins with `=`, `+`, `-` or `@` as a formula and
//! evaluates it.

use std::borrow::Cow;

/// Prefix of a guarded text; a spreadsheet shows only the rest.
const GUARD: char = '\'';

/// Whether a spreadsheet would interpret the text, without its leading guards, as a formula.
fn is_formula(text: &str) -> bool {
    text.trim_start_matches(GUARD).starts_with(['=', '+', '-', '@', '\t', '\r'])
}

/// Text as a cell, guarded if it is a formula. Numbers are unchanged.
pub fn guarded(text: &str) -> Cow<'_, str> {
    let safe = !is_formula(text) || text.parse::<f64>().is_ok();
    if safe { text.into() } else { format!("{GUARD}{text}").into() }
}

/// Text of a cell, without its guard.
pub(crate) fn unguarded(cell: &str) -> &str {
    cell.strip_prefix(GUARD).filter(|text| is_formula(text)).unwrap_or(cell)
}

/// A line of CSV (RFC 4180): cells with a comma, quote or line break are quoted, and formulas are guarded.
pub fn csv_line(cells: &[&str]) -> String {
    let quoted: Vec<String> = cells
        .iter()
        .map(|cell| guarded(cell))
        .map(|cell| match cell.contains([',', '"', '\n', '\r']) {
            true => format!("\"{}\"", cell.replace('"', "\"\"")),
            false => cell.into_owned(),
        })
        .collect();
    quoted.join(",") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_is_guarded_and_every_text_comes_back() {
        for (text, cell) in [
            ("=1+1", "'=1+1"),
            ("+cmd", "'+cmd"),
            ("-2+3", "'-2+3"),
            ("@SUM(A1)", "'@SUM(A1)"),
            ("\t=1", "'\t=1"),
            ("'=1", "''=1"),
            ("''-x", "'''-x"),
            ("-1.5e-3", "-1.5e-3"),
            ("+2", "+2"),
            ("'quoted'", "'quoted'"),
            ("tet4-nodal", "tet4-nodal"),
            ("", ""),
            ("'", "'"),
        ] {
            assert_eq!(guarded(text), cell);
            assert_eq!(unguarded(cell), text);
        }
    }
}
