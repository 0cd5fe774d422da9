//! Arrays of elements and nodes, `$ElementData` and `$NodeData`, which are read only if one is requested.

use super::scanner::Scanner;
use crate::content::Content;
use crate::data_array::DataArray;
use crate::error::{Parsed, Problem};

/// Adds all arrays of a file that has been read; only the array `wanted` keeps its values.
pub(super) fn read(bytes: &[u8], wanted: &str, content: &mut Content) -> Parsed<()> {
    // Whether numbers are binary is known only from the head of the file.
    let mut head = Scanner::new(bytes, false);
    let mut binary = false;
    while let Some(line) = head.line() {
        if line == "$MeshFormat" {
            binary = head.line().is_some_and(|line| line.split_whitespace().nth(1) == Some("1"));
            break;
        }
    }
    let mut scanner = Scanner::new(bytes, binary);
    if binary {
        scanner.find(&["$MeshFormat"]);
        scanner.line();
        scanner.byte_order()?;
    }
    while let Some(section) = scanner.find(&["$ElementData", "$NodeData"]) {
        content.arrays.push(array(&mut scanner, wanted, section == 0)?);
        scanner.skip(if section == 0 { "ElementData" } else { "NodeData" })?;
    }
    Ok(())
}

/// Reads the array whose section has just begun: its tags in lines of text, then a number and the components of each
/// item.
fn array(scanner: &mut Scanner, wanted: &str, of_cells: bool) -> Parsed<DataArray> {
    let place = scanner.place();
    let texts = tags(scanner, "the text tags of an array")?;
    tags(scanner, "the real tags of an array")?;
    let counts = tags(scanner, "the integer tags of an array")?;
    let name = texts.first().map_or("", |name| name.trim_matches('"')).to_string();
    let count = |k: usize, expected: &'static str| -> Parsed<usize> {
        let found = counts.get(k).cloned().unwrap_or_default();
        found.parse().or_else(|_| scanner.fail(Problem::Expected { expected, found }))
    };
    let components = count(1, "a number of components")?;
    let items = count(2, "a number of values")?;
    let mut array = DataArray { name, place, of_cells, components, numbers: Vec::new(), values: Vec::new() };
    if array.name == wanted {
        let least = components.saturating_mul(8).saturating_add(4);
        let items = scanner.counted(items as u64, least, "values")?;
        scanner.counted(items.saturating_mul(components) as u64, 8, "values")?;
        scanner.behind_line();
        for _ in 0..items {
            array.numbers.push(scanner.tag(false, "the number of an element or a node")?);
            for _ in 0..components {
                array.values.push(scanner.real("a component")?);
            }
        }
    }
    Ok(array)
}

/// Reads a number of lines, then as many lines.
fn tags(scanner: &mut Scanner, expected: &'static str) -> Parsed<Vec<String>> {
    let found = scanner.line().unwrap_or_default();
    let Ok(count) = found.trim().parse::<u64>() else {
        return scanner.fail(Problem::Expected { expected, found });
    };
    let count = scanner.counted(count, 2, "tags")?;
    (0..count).map(|_| scanner.line().ok_or((scanner.place(), Problem::End { expected }))).collect()
}
