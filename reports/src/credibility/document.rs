//! Parts of the document, and their output as Markdown and HTML.

use super::factors::{CHAPTERS, Factor};
use super::statements::Statements;
use crate::figures::backend::escaped;
use crate::page::Drawn;
use crate::table::Column::Words;
use crate::table::{Cell, Table, markdown};

/// Part of the evidence for a factor.
pub(super) enum Block {
    Text(String),
    Table(Table),
    /// Name of a figure of the report.
    Figure(String),
}

/// Evidence from the records for a factor.
pub(super) struct Evidence {
    pub(super) factor: &'static Factor,
    /// Evidence in one line of the overview; empty without any.
    pub(super) summary: String,
    pub(super) blocks: Vec<Block>,
}

/// Document with the evidence for all factors.
pub(super) struct Document<'a> {
    pub(super) title: String,
    pub(super) lead: Vec<String>,
    pub(super) evidence: Vec<Evidence>,
    pub(super) statements: &'a Statements,
    pub(super) drawn: &'a [Drawn],
}

/// Format of the output.
struct Format {
    heading: fn(usize, &str) -> String,
    text: fn(&str) -> String,
    place: fn(&str) -> String,
    blank: fn(&str, &str) -> String,
    statement: fn(&str) -> String,
    table: fn(&Table) -> String,
    figure: fn(&Drawn) -> String,
}

impl Document<'_> {
    /// The document as Markdown.
    pub(super) fn markdown(&self) -> String {
        self.write(&Format {
            heading: |level, text| format!("{} {}\n\n", "#".repeat(level), markdown(text)),
            text: |text| format!("{}\n\n", markdown(text)),
            place: |text| format!("*{}*\n\n", markdown(text)),
            blank: |name, belongs| format!("> **Blank: {name}.** {}\n\n", markdown(belongs)),
            statement: |text| {
                let lines = text.lines().map(|line| format!("> {}\n", markdown(line)));
                format!("> **Stated by the user:**\n>\n{}\n", lines.collect::<String>())
            },
            table: |table| format!("###{}\n", table.markdown()),
            figure: |drawn| {
                let figure = &drawn.figure;
                let caption = markdown(&figure.caption);
                format!("![{}](figures/{}.svg)\n\n{caption}\n\n", markdown(&figure.title), figure.name)
            },
        })
    }

    /// The document as an HTML page for print.
    pub(super) fn html(&self) -> String {
        let body = self.write(&Format {
            heading: |level, text| format!("<h{level}>{}</h{level}>\n", escaped(text)),
            text: |text| format!("<p>{}</p>\n", escaped(text)),
            place: |text| format!("<p class=\"place\">{}</p>\n", escaped(text)),
            blank: |name, belongs| {
                format!("<p class=\"blank\"><b>Blank: {name}.</b> {}</p>\n", escaped(belongs))
            },
            statement: |text| {
                let paragraphs = text.split("\n\n").map(|text| format!("<p>{}</p>\n", escaped(text)));
                let paragraphs: String = paragraphs.collect();
                format!("<blockquote><p><b>Stated by the user:</b></p>\n{paragraphs}</blockquote>\n")
            },
            table: html_table,
            figure: |Drawn { figure, svg }| {
                format!("<figure>{svg}<figcaption>{}</figcaption></figure>\n", escaped(&figure.caption))
            },
        });
        let title = escaped(&self.title);
        include_str!("credibility.html").replace("{title}", &title).replace("{body}", &body)
    }

    fn write(&self, format: &Format) -> String {
        let mut out = (format.heading)(1, &self.title);
        self.lead.iter().for_each(|text| out += &(format.text)(text));
        out += &(format.table)(&self.overview());
        for (number, chapter) in (1..).zip(&CHAPTERS) {
            out += &(format.heading)(2, &format!("{number} {}", chapter.title));
            for (part, factor) in (1..).zip(chapter.factors) {
                out += &(format.heading)(3, &format!("{number}.{part} {}", factor.name));
                let place = format!("ASME V&V 40-2018: {}. FDA 2023: {}", factor.standard, factor.guidance);
                out += &(format.place)(&place);
                let blocks = self.evidence.iter().filter(|of| of.factor.key == factor.key);
                for block in blocks.flat_map(|of| &of.blocks) {
                    out += &match block {
                        Block::Text(text) => (format.text)(text),
                        Block::Table(table) => (format.table)(table),
                        Block::Figure(name) => {
                            let found = self.drawn.iter().find(|drawn| drawn.figure.name == *name);
                            found.map(|drawn| (format.figure)(drawn)).unwrap_or_default()
                        }
                    };
                }
                out += &match self.statements.about(factor.key) {
                    Some(text) => (format.statement)(text),
                    None => (format.blank)(factor.key, factor.belongs),
                };
            }
        }
        out
    }

    /// Table of all factors: evidence from the records and statements.
    fn overview(&self) -> Table {
        let mut table = Table::new(
            "overview",
            "Overview",
            "Evidence from the records, and statements of the user. A blank is to be filled by the user",
            &[("factor", Words), ("from the records", Words), ("from the user", Words)],
        );
        for (number, chapter) in (1..).zip(&CHAPTERS) {
            for (part, factor) in (1..).zip(chapter.factors) {
                let found = self.evidence.iter().find(|of| of.factor.key == factor.key);
                let records = found.map(|of| of.summary.as_str()).filter(|text| !text.is_empty());
                let stated = if self.statements.about(factor.key).is_some() { "stated" } else { "blank" };
                table.row(&[
                    Cell::Text(&format!("{number}.{part} {}", factor.name)),
                    Cell::Text(records.unwrap_or("none")),
                    Cell::Text(stated),
                ]);
            }
        }
        table
    }
}

/// Words with more characters are broken, so that a hash does not push other columns off the paper.
const LONG: usize = 32;

fn html_table(table: &Table) -> String {
    let of = |column, cell: &str| match column {
        Words if cell.split(' ').any(|word| word.chars().count() > LONG) => " class=\"long\"",
        Words => "",
        _ => " class=\"n\"",
    };
    let columns = || table.header().iter().map(|(_, column)| *column);
    let head =
        table.header().iter().map(|(name, column)| format!("<th{}>{}</th>", of(*column, ""), escaped(name)));
    let results = columns_begin_with_results(table);
    let row = |cells: Vec<&str>| {
        // A failed check has to be seen on paper, too.
        let failed = if results && cells.first() == Some(&"fail") { " class=\"bad\"" } else { "" };
        let cells = cells.iter().zip(columns());
        let cells = cells.map(|(cell, column)| format!("<td{}>{}</td>", of(column, cell), escaped(cell)));
        format!("<tr{failed}>{}</tr>\n", cells.collect::<String>())
    };
    let (title, caption, note) = (escaped(&table.title), escaped(&table.caption), table.note());
    let (head, rows) = (head.collect::<String>(), table.shown().into_iter().map(row).collect::<String>());
    let note = if note.is_empty() { String::new() } else { format!("<p class=\"caption\">{note}</p>\n") };
    format!(
        "<h4>{title}</h4>\n<p class=\"caption\">{caption}.</p>\n<table><thead><tr>{head}</tr></thead>\n\
         <tbody>\n{rows}</tbody></table>\n{note}"
    )
}

fn columns_begin_with_results(table: &Table) -> bool {
    table.header().first().is_some_and(|(name, _)| *name == "result")
}
