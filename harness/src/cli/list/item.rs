//! An item that a scene can name, and how it is printed.

use catalogue::{Entry, Kind, Parameter, Range, short};

/// Longest line, in characters.
const WIDTH: usize = 110;

/// A word with its value type and meaning. Its settings are items too.
#[derive(Clone)]
pub struct Item {
    pub name: String,
    /// Dimension or type of the value; empty if the item has none.
    pub value: String,
    pub meaning: String,
    pub settings: Vec<Item>,
}

impl Item {
    pub fn new(name: &str, value: &str, meaning: &str) -> Item {
        // Meanings are sentences in source comments and clauses in the catalogue.
        let meaning = meaning.replace('`', "").split_whitespace().collect::<Vec<_>>().join(" ");
        let meaning = meaning.strip_suffix('.').unwrap_or(&meaning).to_string();
        Item { name: name.into(), value: value.into(), meaning, settings: Vec::new() }
    }

    /// Returns the entries of a catalogue with their parameters.
    pub fn of_entries<B>(entries: &[Entry<B>]) -> Vec<Item> {
        let item = |entry: &Entry<B>| {
            let source = if entry.source.is_empty() { String::new() } else { format!(" [{}]", entry.source) };
            let settings = entry.parameters.iter().map(Item::of_parameter).collect();
            Item { settings, ..Item::new(entry.name, "", &format!("{}{source}", entry.meaning)) }
        };
        entries.iter().map(item).collect()
    }

    fn of_parameter(parameter: &Parameter) -> Item {
        let one = parameter.dimension.name();
        let value = match parameter.kind {
            Kind::Number => one.to_string(),
            Kind::Count => "whole number".into(),
            Kind::Flag => "true or false".into(),
            Kind::Vector => format!("3 of: {one}"),
            Kind::List => format!("list of: {one}"),
        };
        let mut meaning = parameter.meaning.to_string();
        if parameter.range != Range::Any && parameter.kind != Kind::Flag {
            meaning += &format!("; {}", parameter.range.text());
        }
        if let (Some(default), false) = (parameter.default, parameter.kind == Kind::Flag) {
            let unit = if parameter.dimension.is_plain() { "" } else { parameter.dimension.si_unit() };
            let value = format!("{} {}", short(default), unit.trim_start_matches('1'));
            meaning += &format!("; {} unless given", value.trim_end());
        }
        Item::new(&optional(parameter.name, parameter.required), &value, &meaning)
    }
}

/// Puts the name of an optional setting in brackets.
pub fn optional(name: &str, required: bool) -> String {
    if required { name.into() } else { format!("[{name}]") }
}

/// Formats items below each other, each followed by its settings.
pub fn print(items: &[Item]) -> String {
    let mut text = String::new();
    let columns = columns(items);
    for item in items {
        line(&mut text, 2, columns, item);
        let columns = self::columns(&item.settings);
        item.settings.iter().for_each(|setting| line(&mut text, 6, columns, setting));
    }
    text
}

/// Returns the widths of the name and value columns.
fn columns(items: &[Item]) -> [usize; 2] {
    let widest =
        |of: fn(&Item) -> &String| items.iter().map(|item| of(item).chars().count()).max().unwrap_or(0);
    [widest(|item| &item.name), widest(|item| &item.value)]
}

/// Appends name, value and meaning, with the meaning broken into lines.
fn line(text: &mut String, indent: usize, [names, values]: [usize; 2], item: &Item) {
    let mut head = format!("{:indent$}{:names$}", "", item.name);
    if values > 0 {
        head += &format!("  {:values$}", item.value);
    }
    let start = head.chars().count() + 2;
    let mut line = format!("{head}  ");
    for word in item.meaning.split_whitespace() {
        if line.chars().count() + word.chars().count() > WIDTH && line.chars().count() > start {
            text.push_str(line.trim_end());
            text.push('\n');
            line = " ".repeat(start);
        }
        line += word;
        line.push(' ');
    }
    text.push_str(line.trim_end());
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_meanings_are_broken_below_themselves() {
        let long = "word ".repeat(40);
        let items = [Item::new("a", "", &long), Item::new("longer", "", "short.")];
        let text = print(&items);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.iter().all(|line| line.len() <= WIDTH), "{text}");
        assert!(lines[1].starts_with("          word") && lines.last() == Some(&"  longer  short"), "{text}");
    }
}
