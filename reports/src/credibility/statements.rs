//! Statements of a user about credibility factors, from a TOML file of `key = "text"`.

use std::collections::BTreeMap;
use std::path::Path;

use catalogue::suggest;
use disk::Kind;
use records::RecordError;
use toml::Spanned;

use super::factors;

/// Texts by the key of their factor.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Statements(BTreeMap<String, String>);

impl Statements {
    /// Statement about a factor.
    pub(crate) fn about(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }
}

/// Reads a file of statements.
///
/// # Errors
/// A file that cannot be read or is not TOML, and a key that is no factor or has no text, with its line.
pub fn read_statements(path: &Path) -> Result<Statements, RecordError> {
    let text = disk::read_text(path, Kind::SCENE).map_err(|bad| bad.to_string());
    text.and_then(|text| parse(&text)).map_err(|reason| RecordError::Content { path: path.into(), reason })
}

fn parse(text: &str) -> Result<Statements, String> {
    type Table = BTreeMap<Spanned<String>, toml::Value>;
    let table: Table = toml::from_str(text).map_err(|bad| bad.to_string().trim_end().to_string())?;
    let keys: Vec<&str> = factors::all().map(|factor| factor.key).collect();
    let mut found = BTreeMap::new();
    for (key, value) in table {
        let line = text[..key.span().start].matches('\n').count() + 1;
        let key = key.into_inner();
        if !keys.contains(&key.as_str()) {
            return Err(format!("line {line}: {key}: is no factor; {}", suggest(&key, &keys)));
        }
        match value.as_str().map(str::trim) {
            Some("") => {
                return Err(format!("line {line}: {key}: is empty; leave it out to keep it a named blank"));
            }
            Some(statement) => found.insert(key, statement.to_string()),
            None => {
                let kind = value.type_str();
                return Err(format!("line {line}: {key}: is a TOML {kind}; give a text in quotes"));
            }
        };
    }
    Ok(Statements(found))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_file_is_refused_with_line_and_key() {
        let good = parse("adequacy = \"\"\"\nIt suffices.\n\nFor now.\"\"\"\n").unwrap();
        assert_eq!(good.about("adequacy"), Some("It suffices.\n\nFor now."));
        assert_eq!(good.about("use_error"), None);
        for (text, says) in [
            (
                "adequacy = \"a\"\nuse_eror = \"b\"",
                "line 2: use_eror: is no factor; did you mean 'use_error'?",
            ),
            ("\nuse_error = \" \"", "line 2: use_error: is empty"),
            ("use_error = 3", "line 1: use_error: is a TOML integer"),
            ("use_error", "line 1"),
            ("use_error = \"a\"\nuse_error = \"b\"", "duplicate key"),
        ] {
            let bad = parse(text).unwrap_err();
            assert!(bad.contains(says), "{says}: {bad}");
        }
    }
}
