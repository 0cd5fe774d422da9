//! Reading of texts as mesh files, and a check of malformed files with one change each.

#![allow(dead_code)] // each test file uses its part

use std::path::Path;

use geometry::Mesh;
use tissuebench_mesh_files as files;

/// Reads the content of a mesh file of this name.
pub fn read(name: &str, content: impl AsRef<[u8]>) -> Result<Mesh, String> {
    let read = files::read_bytes(content.as_ref(), Path::new(name), 1.0);
    read.map(|(mesh, _)| mesh).map_err(|bad| bad.to_string())
}

/// Asserts that a mesh file with any one of the changes `from` to `to` is rejected with a message that has
/// the given words. Words with `...` between them may be apart.
pub fn assert_refused<'a>(
    name: &str,
    text: &str,
    changes: impl IntoIterator<Item = (&'a str, &'a str, impl AsRef<str>)>,
) {
    assert_refused_by(|text| read(name, text).err(), text, changes);
}

/// The same assertion for another reader: `refusal` returns its message for a text. The assertion lists all
/// failures together.
pub fn assert_refused_by<'a>(
    refusal: impl Fn(&str) -> Option<String>,
    text: &str,
    changes: impl IntoIterator<Item = (&'a str, &'a str, impl AsRef<str>)>,
) {
    let mut wrong = Vec::new();
    for (from, to, says) in changes {
        assert!(text.contains(from), "{from}");
        let said = refusal(&text.replacen(from, to, 1)).unwrap_or("nothing".into());
        for words in says.as_ref().split("...").filter(|words| !said.contains(words)) {
            wrong.push(format!("{from} -> {to}: {said}\n  has no: {words}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
