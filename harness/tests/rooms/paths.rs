//! The paths that a file names.

use std::collections::BTreeSet;

/// A path that a module names, and the name by which it uses the last part.
pub struct Named {
    pub path: String,
    pub name: String,
}

/// Text of a module without its unit tests and comments.
pub fn code_of(text: &str) -> String {
    let mut code = String::new();
    let mut lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    while let Some(line) = lines.next() {
        if line.trim_start() != "#[cfg(test)]" {
            code += line;
            code.push('\n');
            continue;
        }
        // A test ends with a semicolon or, as rustfmt writes it, with the brace at its own indentation.
        let close = format!("{}}}", &line[..line.len() - line.trim_start().len()]);
        let item = lines.by_ref().find(|line| !line.trim_start().starts_with('#')).unwrap_or_default();
        if !item.ends_with(['}', ';']) {
            lines.by_ref().find(|line| *line == close);
        }
    }
    code
}

fn parent(module: &str) -> &str {
    module.rsplit_once("::").map_or("", |(above, _)| above)
}

/// Whole paths in the code of a module that begin with `crate`, `super`, `self` or a file of its folder,
/// alone or in a list.
pub fn paths(module: &str, code: &str, children: &BTreeSet<&str>) -> Vec<Named> {
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(end) = rest.find("::") {
        let start = rest[..end].trim_end_matches(|c: char| c.is_alphanumeric() || c == '_').len();
        let word = &rest[start..end];
        let inside = rest[..start].ends_with(['$', ':', '.']);
        rest = &rest[end + 2..];
        let base = match word {
            _ if inside => continue,
            "crate" => "crate".to_string(),
            "super" => parent(module).to_string(),
            "self" => module.to_string(),
            child if children.contains(child) => format!("{module}::{child}"),
            _ => continue,
        };
        rest = branch(rest, &base, &mut found);
    }
    found
}

/// Reads a path, or a list of paths, below `base`; returns the text behind it.
fn branch<'t>(text: &'t str, base: &str, found: &mut Vec<Named>) -> &'t str {
    let text = text.trim_start();
    if let Some(mut rest) = text.strip_prefix('{') {
        loop {
            rest = branch(rest, base, found);
            let Some(end) = rest.find([',', '}']) else { return "" };
            let closes = rest[end..].starts_with('}');
            rest = rest[end + 1..].trim_start();
            if closes {
                return rest;
            }
            if let Some(behind) = rest.strip_prefix('}') {
                return behind;
            }
        }
    }
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    let (word, rest) = text.split_at(end);
    let path = match word {
        "super" => parent(base).to_string(),
        "self" => base.to_string(),
        _ => format!("{base}::{word}"),
    };
    if let Some(below) = rest.strip_prefix("::").filter(|below| !below.starts_with('<')) {
        return branch(below, &path, found);
    }
    // Behind a function there may be its types, and behind a name another name.
    if !word.is_empty() || rest.starts_with('*') {
        let other = rest.strip_prefix(" as ").and_then(|rest| rest.split([',', ';', '}']).next());
        found.push(Named { path, name: other.unwrap_or(word).to_string() });
    }
    rest
}
