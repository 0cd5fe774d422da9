//! Names that occur in several instances: each becomes `INSTANCE.NAME`, as in Abaqus.

use std::collections::HashSet;

use super::super::content::{Content, Named};

/// Names in capitals that occur more than once.
pub(super) struct Shared {
    regions: HashSet<String>,
    surfaces: HashSet<String>,
}

impl Shared {
    /// Of the parts of all instances and what stands outside of them; `assembly` are the surfaces that the assembly itself names.
    pub(super) fn new<'a>(
        contents: impl Iterator<Item = &'a Content> + Clone,
        assembly: impl Iterator<Item = &'a str>,
    ) -> Shared {
        let regions = contents.clone().map(|content| capitals(content.regions()));
        let surfaces = contents.map(|content| capitals(content.surfaces()));
        Shared { regions: repeated(regions), surfaces: repeated(surfaces.chain([capitals(assembly)])) }
    }

    /// The name that a region or a surface of an instance has in the mesh.
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

/// The names that are in more than one of the sets.
fn repeated(sets: impl Iterator<Item = HashSet<String>>) -> HashSet<String> {
    let mut known = HashSet::new();
    sets.flatten().filter(|name| !known.insert(name.clone())).collect()
}
