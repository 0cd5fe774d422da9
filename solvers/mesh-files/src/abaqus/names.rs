//! Names that occur in several instances; each becomes `INSTANCE.NAME`, as in Abaqus.

use std::collections::HashSet;

use crate::content::{Content, Named};

/// Upper-case names that occur more than once.
pub(super) struct Shared {
    regions: HashSet<String>,
    surfaces: HashSet<String>,
}

impl Shared {
    /// Finds repeated names in the parts of all instances and outside of them; `assembly` lists the surface
    /// names of the assembly itself.
    pub(super) fn new<'a>(
        contents: impl Iterator<Item = &'a Content> + Clone,
        assembly: impl Iterator<Item = &'a str>,
    ) -> Shared {
        let regions = contents.clone().map(|content| capitals(content.regions()));
        let surfaces = contents.map(|content| capitals(content.surfaces()));
        Shared { regions: repeated(regions), surfaces: repeated(surfaces.chain([capitals(assembly)])) }
    }

    /// Name that a region or surface of an instance gets in the mesh: `INSTANCE.NAME` if the name occurs more
    /// than once, `NAME` otherwise.
    pub(super) fn full(&self, instance: &str, of: Named, name: &str) -> String {
        let shared = match of {
            Named::Region => &self.regions,
            Named::Surface => &self.surfaces,
        };
        let is_shared = shared.contains(&name.to_ascii_uppercase());
        if is_shared { format!("{instance}.{name}") } else { name.into() }
    }
}

fn capitals<'a>(names: impl Iterator<Item = &'a str>) -> HashSet<String> {
    names.map(str::to_ascii_uppercase).collect()
}

/// Names contained in more than one of the sets.
fn repeated(sets: impl Iterator<Item = HashSet<String>>) -> HashSet<String> {
    let mut known = HashSet::new();
    sets.flatten().filter(|name| !known.insert(name.clone())).collect()
}
