//! Guards of the XML parser, and lines of XML files.

use crate::error::{Parsed, Place, Problem};
use crate::text::line_of;

/// Line of an XML error; for a missing element, the last line.
pub(crate) fn line_of_fault(bad: &roxmltree::Error, text: &str) -> usize {
    use roxmltree::Error::{NoRootNode, UnclosedRootNode, UnexpectedEndOfStream};
    match bad {
        NoRootNode | UnclosedRootNode | UnexpectedEndOfStream => text.lines().count(),
        _ => bad.pos().row as usize,
    }
}

/// Largest size in bytes of a tag with its attributes, each of which the parser compares with all others.
const LONGEST_TAG: usize = 1 << 14;

/// Position of the first tag that is too long.
fn long_tag(text: &str) -> Option<usize> {
    let (mut open, mut quote) = (None, None);
    for (at, byte) in text.bytes().enumerate() {
        match (open, quote) {
            (None, _) if byte == b'<' => {
                let is_tag = !matches!(text.as_bytes().get(at + 1), Some(b'!' | b'?'));
                open = is_tag.then_some(at);
            }
            (Some(start), _) if at - start > LONGEST_TAG => return Some(start),
            (Some(_), Some(end)) if byte == end => quote = None,
            (Some(_), None) if matches!(byte, b'"' | b'\'') => quote = Some(byte),
            (Some(_), None) if byte == b'>' => open = None,
            _ => {}
        }
    }
    None
}

/// Refuses a text with a tag so long that its attributes would take the parser too long.
pub(crate) fn refuse_long_tags(text: &str) -> Parsed<()> {
    let Some(at) = long_tag(text) else { return Ok(()) };
    let problem = Problem::TooMany { what: "bytes of an XML tag", count: LONGEST_TAG };
    Err((Place::Line(line_of(text.as_bytes(), at)), problem))
}

/// Line numbers of the nodes of a document, found without reading the text again for each.
pub struct Lines(Vec<usize>);

impl Lines {
    /// Finds the ends of the lines of a text.
    pub fn of(text: &str) -> Lines {
        Lines(text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at).collect())
    }

    /// Line, from 1, at which a node of the document begins.
    pub fn at(&self, node: roxmltree::Node) -> usize {
        let start = node.range().start;
        1 + self.0.partition_point(|&end| end < start)
    }
}
