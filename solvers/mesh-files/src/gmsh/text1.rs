//! Reader of version 1: `$NOD` and `$ELM`. The physical region of an element is its group, which has no name.

use super::groups::Names;
use super::order::{element, known};
use super::text2::{add, begin, count, read_nodes};
use crate::content::Content;
use crate::error::{Parsed, Problem};
use crate::lines::Lines;
use crate::rows::Row;

pub(super) fn parse(text: &str) -> Parsed<Content> {
    let mut lines = Lines::new(text);
    let mut content = Content::default();
    content.repeat_cells();
    begin(&mut lines, "$NOD")?;
    read_nodes(&mut lines, &mut content, "$ENDNOD")?;
    lines.exactly("$ELM")?;
    let names = Names::default();
    let mut list = Vec::new();
    for _ in 0..count(&mut lines, "the number of elements")? {
        let line = lines.need("an element")?;
        let mut tokens = line.split_whitespace();
        let number: u64 = lines.number(tokens.next(), "an element number")?;
        let kind: u64 = lines.number(tokens.next(), "an element type")?;
        let group: i64 = lines.number(tokens.next(), "a physical region")?;
        let _: i64 = lines.number(tokens.next(), "an elementary region")?;
        let nodes: usize = lines.number(tokens.next(), "a number of nodes")?;
        let Some(element) = element(kind) else {
            let kind = kind.to_string();
            return lines.fail(Problem::UnknownType { element: number, kind, known: known() });
        };
        let found = line.split_whitespace().count();
        let expected = 5 + element.node_count();
        if found != expected || nodes != element.node_count() {
            let kind = kind.to_string();
            return lines.fail(Problem::Length { element: number, kind, found, expected });
        }
        list.clear();
        for _ in 0..nodes {
            list.push(lines.number(tokens.next(), "a node number")?);
        }
        let row = Row { place: lines.place(), tag: number };
        add(&mut content, &names, row, element, &[group.unsigned_abs()], &list)?;
    }
    lines.exactly("$ENDELM")?;
    match lines.next() {
        Some(line) => lines.fail(Problem::Expected { expected: "the end of the file", found: line.into() }),
        None if content.cell_count() == 0 => lines.fail(Problem::NoCells),
        None => Ok(content),
    }
}
