//! Physical groups of Gmsh: their names, and their conversion to regions and groups of facets and nodes.

use std::collections::HashMap;

use crate::content::Content;
use crate::error::{Parsed, Place, Problem};
use crate::lines::Lines;

/// Names of physical groups by dimension and tag.
#[derive(Default)]
pub(super) struct Names(HashMap<(u64, u64), String>);

impl Names {
    /// Adds the name of a physical group, given with its dimension and tag. The name of a solid also becomes
    /// a region, so regions keep the order of the names.
    ///
    /// # Errors
    /// A second name for the same dimension and tag.
    pub(super) fn add(
        &mut self,
        content: &mut Content,
        place: Place,
        (dimension, tag, name): (u64, u64, String),
    ) -> Parsed<()> {
        if dimension == 3 {
            content.region(place, &name)?;
        }
        match self.0.insert((dimension, tag), name) {
            Some(_) => Err((place, Problem::Duplicate { what: "physical tag", number: tag })),
            None => Ok(()),
        }
    }

    /// Index of the region of a solid's physical tag. The tag 0 gives the region "body", a tag without a name
    /// "region-TAG".
    pub(super) fn region(&self, content: &mut Content, place: Place, tag: u64) -> Parsed<u16> {
        match self.0.get(&(3, tag)) {
            _ if tag == 0 => content.region(place, "body"),
            Some(name) => content.region(place, name),
            None => content.region(place, &format!("region-{tag}")),
        }
    }

    /// Name of the group of nodes of a physical tag of points (`dimension` 0) or curves (1); a tag without a
    /// name gives "point-TAG" or "curve-TAG".
    pub(super) fn curve(&self, dimension: u64, tag: u64) -> String {
        let kind = if dimension == 0 { "point" } else { "curve" };
        self.0.get(&(dimension, tag)).cloned().unwrap_or_else(|| format!("{kind}-{tag}"))
    }

    /// Index of the facet group of a surface's physical tag; a tag without a name gives "surface-TAG".
    pub(super) fn group(&self, content: &mut Content, tag: u64) -> usize {
        match self.0.get(&(2, tag)) {
            Some(name) => content.group(name),
            None => content.group(&format!("surface-{tag}")),
        }
    }
}

/// Parses `DIMENSION TAG "NAME"`.
pub(super) fn named(lines: &Lines, line: &str) -> Parsed<(u64, u64, String)> {
    let mut tokens = line.splitn(3, char::is_whitespace);
    let dimension = lines.number(tokens.next(), "the dimension of a physical name")?;
    let tag = lines.number(tokens.next(), "the tag of a physical name")?;
    let rest = tokens.next().unwrap_or("").trim();
    match rest.strip_prefix('"').and_then(|r| r.strip_suffix('"')).filter(|n| !n.is_empty()) {
        Some(name) => Ok((dimension, tag, name.into())),
        None => lines.fail(Problem::Expected { expected: "a name in quotes", found: rest.into() }),
    }
}
