//! A table and its output formats: CSV, Markdown, LaTeX and HTML cells.

use records::cell::csv_line;
use records::text::{scientific, significant, spread};

/// A cell and its number format. CSV always contains every digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell<'a> {
    /// Text, borrowed while a row is built.
    Text(&'a str),
    /// A whole number.
    Count(u64),
    /// Four significant digits, `1.234e-3`.
    Scientific(Option<f64>),
    /// A given number of significant digits, in plain notation if this is readable.
    Digits(Option<f64>, usize),
    /// A number shown as a word; CSV contains the number.
    Named(&'a str, f64),
    /// Median and spread, `1.23 ± 0.04`; two columns in CSV.
    Spread(Option<f64>, Option<f64>),
}

/// Kind of content of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Column {
    /// Text, aligned left.
    Words,
    /// Numbers, aligned right.
    Number,
    /// A median and its spread, aligned right.
    Spread,
}

#[derive(Clone, Debug)]
struct Entry {
    shown: String,
    exact: Vec<String>,
}

impl Entry {
    fn exact(&self) -> &str {
        self.exact.first().map_or("", String::as_str)
    }
}

/// A titled table with units in its header. A dash, explained below the table, marks missing values.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) name: &'static str,
    pub(crate) title: String,
    pub(crate) caption: String,
    header: Vec<(String, Column)>,
    rows: Vec<Vec<Entry>>,
    absent: bool,
}

const DASH: &str = "—";

impl Table {
    /// Creates a table; each column is `(heading with its unit, kind of content)`.
    pub(crate) fn new(name: &'static str, title: &str, caption: &str, header: &[(&str, Column)]) -> Table {
        Table {
            name,
            title: title.into(),
            caption: caption.into(),
            header: header.iter().map(|(h, column)| (h.to_string(), *column)).collect(),
            rows: Vec::new(),
            absent: false,
        }
    }

    /// Adds a row unless a row with the same text exists.
    pub(crate) fn row_once(&mut self, cells: &[Cell]) {
        self.row(cells);
        if let Some((last, before)) = self.rows.split_last() {
            let same = |row: &Vec<Entry>| row.iter().map(|e| &e.shown).eq(last.iter().map(|e| &e.shown));
            if before.iter().any(same) {
                self.rows.pop();
            }
        }
    }

    /// Adds a row; a number that is not finite counts as missing.
    pub(crate) fn row(&mut self, cells: &[Cell]) {
        debug_assert_eq!(cells.len(), self.header.len(), "table {}", self.name);
        let mut row = Vec::with_capacity(cells.len());
        for cell in cells {
            let finite = |v: Option<f64>| v.filter(|v| v.is_finite());
            let exact = |v: Option<f64>| finite(v).map(|v| format!("{v:e}")).unwrap_or_default();
            let (shown, exact) = match *cell {
                Cell::Text(text) => (Some(text.to_string()), vec![text.to_string()]),
                Cell::Count(count) => (Some(count.to_string()), vec![count.to_string()]),
                Cell::Scientific(v) => (finite(v).map(scientific), vec![exact(v)]),
                Cell::Digits(v, digits) => (finite(v).map(|v| significant(v, digits)), vec![exact(v)]),
                Cell::Named(word, v) => (Some(word.to_string()), vec![exact(Some(v))]),
                Cell::Spread(v, around) => {
                    // A spread of exactly zero comes from a single repeat and has no meaning.
                    let around = around.filter(|s| *s > 0.0);
                    let text = |v| {
                        let spread = finite(around).map(|s| format!(" ± {}", spread(s, v)));
                        significant(v, 3) + &spread.unwrap_or_default()
                    };
                    (finite(v).map(text), vec![exact(v), exact(around)])
                }
            };
            self.absent |= shown.is_none();
            row.push(Entry { shown: shown.unwrap_or_else(|| DASH.into()), exact });
        }
        self.rows.push(row);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Headings with the kind of their columns.
    pub(crate) fn header(&self) -> &[(String, Column)] {
        &self.header
    }

    /// Rows as displayed.
    pub(crate) fn shown(&self) -> Vec<Vec<&str>> {
        self.rows.iter().map(|row| row.iter().map(|e| e.shown.as_str()).collect()).collect()
    }

    /// Rows with exact values; a median with its spread gives the median.
    pub(crate) fn exact(&self) -> Vec<Vec<&str>> {
        self.rows.iter().map(|row| row.iter().map(Entry::exact).collect()).collect()
    }

    /// Explanation of the dash, empty if no value is missing.
    pub(crate) fn note(&self) -> &'static str {
        if self.absent { "— : not measured, not defined or not stated." } else { "" }
    }

    /// The table as CSV (RFC 4180) with all digits; missing values are empty cells.
    pub(crate) fn csv(&self) -> String {
        let mut head: Vec<String> = Vec::new();
        for (heading, column) in &self.header {
            head.push(heading.clone());
            if *column == Column::Spread {
                head.push(format!("spread of {heading}"));
            }
        }
        let mut out = csv_line(&head.iter().map(String::as_str).collect::<Vec<_>>());
        for row in &self.rows {
            out.push_str(&csv_line(
                &row.iter().flat_map(|e| e.exact.iter().map(String::as_str)).collect::<Vec<_>>(),
            ));
        }
        out
    }

    /// The table in GitHub Markdown, with a heading.
    pub(crate) fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut out = format!("# {}\n\n{}\n\n", markdown(&self.title), markdown(&self.caption));
        out.push_str(&line(self.header.iter().map(|(h, _)| markdown(h)).collect()));
        out.push_str(&line(
            self.header
                .iter()
                .map(|(_, c)| if *c == Column::Words { "---" } else { "---:" }.to_string())
                .collect(),
        ));
        for row in &self.rows {
            out.push_str(&line(row.iter().map(|e| markdown(&e.shown)).collect()));
        }
        if self.absent {
            out.push_str(&format!("\n{}\n", self.note()));
        }
        out
    }

    /// The table in LaTeX, with `booktabs` and `longtable`, for `\input` into a paper.
    pub(crate) fn latex(&self) -> String {
        let columns: String =
            self.header.iter().map(|(_, c)| if *c == Column::Words { 'l' } else { 'r' }).collect();
        let line = |cells: Vec<String>| format!("{} \\\\\n", cells.join(" & "));
        let head = line(self.header.iter().map(|(h, _)| latex(h)).collect());
        let mut out =
            format!("% needs \\usepackage{{booktabs,longtable}}\n\\begin{{longtable}}{{{columns}}}\n");
        out.push_str(&format!(
            "\\caption{{{}. {}}}\\label{{tab:{}}}\\\\\n",
            latex(&self.title),
            latex(&self.caption),
            self.name
        ));
        out.push_str(&format!("\\toprule\n{head}\\midrule\n\\endfirsthead\n\\toprule\n{head}\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n"));
        for row in &self.rows {
            out.push_str(&line(row.iter().map(|e| latex(&e.shown)).collect()));
        }
        out.push_str("\\end{longtable}\n");
        if self.absent {
            out.push_str(&format!("\\noindent{{\\footnotesize {}}}\n", latex(self.note())));
        }
        out
    }
}

/// Count that may be missing.
pub(crate) fn whole<'a>(value: Option<f64>) -> Cell<'a> {
    match value {
        Some(v) if v >= 0.0 && v.fract() == 0.0 => Cell::Count(v as u64),
        other => Cell::Digits(other, 3),
    }
}

/// Value in thousandths of its unit, such as millimetres.
pub(crate) fn thousandths(value: Option<f64>) -> Option<f64> {
    value.map(|v| v * 1e3)
}

/// Escapes Markdown markup in a table cell; a line break becomes a space.
pub(crate) fn markdown(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '\\' | '|' | '*' | '_' | '`' | '[' | ']' | '#' => out.extend(['\\', c]),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '\n' | '\r' => out.push(' '),
            other => out.push(other),
        }
    }
    out
}

/// Escapes LaTeX markup, and replaces some symbols by commands.
pub(crate) fn latex(text: &str) -> String {
    let mut out = String::new();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        if let Some(first) = power(c) {
            let mut digits = String::from(first);
            while let Some(next) = chars.peek().copied().and_then(power) {
                digits.push(next);
                chars.next();
            }
            out.push_str(&format!("$^{{{digits}}}$"));
            continue;
        }
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', c]),
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '<' => out.push_str("\\textless{}"),
            '>' => out.push_str("\\textgreater{}"),
            '|' => out.push_str("\\textbar{}"),
            '"' => out.push_str("\\textquotedbl{}"),
            '—' => out.push_str("---"),
            '×' => out.push_str("$\\times$"),
            '±' => out.push_str("$\\pm$"),
            '≤' => out.push_str("$\\le$"),
            '≥' => out.push_str("$\\ge$"),
            'ν' => out.push_str("$\\nu$"),
            'κ' => out.push_str("$\\kappa$"),
            'µ' => out.push_str("$\\mu$"),
            '\n' | '\r' => out.push(' '),
            other => out.push(other),
        }
    }
    out
}

/// Plain character of a superscript.
fn power(c: char) -> Option<char> {
    let plain = ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9', '-'];
    "⁰¹²³⁴⁵⁶⁷⁸⁹⁻".chars().position(|s| s == c).map(|at| plain[at])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Table {
        let mut table = Table::new(
            "sample",
            "Errors_& more",
            "50 % of |u|",
            &[("method", Column::Words), ("RMS [mm]", Column::Number)],
        );
        table.row(&[Cell::Text("a|b_c, \"q\" <i>"), Cell::Scientific(Some(0.00123456))]);
        table.row(&[Cell::Text("none"), Cell::Scientific(Some(f64::NAN))]);
        table
    }

    #[test]
    fn markdown_escapes_pipes_and_tags() {
        let text = sample().markdown();
        assert!(text.contains("| a\\|b\\_c, \"q\" &lt;i&gt; | 1.235e-3 |"), "{text}");
        assert!(text.contains("| none | — |") && text.contains("— : not measured"), "{text}");
    }

    #[test]
    fn latex_escapes_specials() {
        let text = sample().latex();
        assert!(
            text.contains(
                "a\\textbar{}b\\_c, \\textquotedbl{}q\\textquotedbl{} \\textless{}i\\textgreater{} & 1.235e-3"
            ),
            "{text}"
        );
        assert!(text.contains("Errors\\_\\& more. 50 \\% of \\textbar{}u\\textbar{}"), "{text}");
        assert_eq!(latex("2×10⁻¹² \\ {x}"), "2$\\times$10$^{-12}$ \\textbackslash{} \\{x\\}");
    }

    #[test]
    fn csv_quotes_and_keeps_every_digit() {
        assert_eq!(sample().csv(), "method,RMS [mm]\n\"a|b_c, \"\"q\"\" <i>\",1.23456e-3\nnone,\n");
    }

    #[test]
    fn a_single_repeat_has_no_spread_and_a_row_comes_once() {
        let mut table = Table::new("t", "t", "t", &[("time [ms]", Column::Spread)]);
        for spread in [0.0, 0.004, 0.0041] {
            table.row_once(&[Cell::Spread(Some(4.46), Some(spread))]);
        }
        assert_eq!(table.shown(), [["4.46"], ["4.46 ± 0.004"]]);
        assert_eq!(table.csv(), "time [ms],spread of time [ms]\n4.46e0,\n4.46e0,4e-3\n");
    }

    #[test]
    fn no_nan_reaches_a_reader() {
        let table = sample();
        for text in [table.csv(), table.markdown(), table.latex()] {
            assert!(!text.contains("NaN"));
        }
    }
}
