//! One table, three ways of writing it.

/// One CSV line (RFC 4180): cells with a comma, quote or line break are quoted.
pub(crate) fn csv_line(cells: &[&str]) -> String {
    let quoted: Vec<String> = cells
        .iter()
        .map(|cell| {
            if cell.contains([',', '"', '\n', '\r']) {
                format!("\"{}\"", cell.replace('"', "\"\""))
            } else {
                cell.to_string()
            }
        })
        .collect();
    quoted.join(",") + "\n"
}
