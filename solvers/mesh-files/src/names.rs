//! Names of regions and groups by their indices.

use std::collections::HashMap;

/// Names in order of appearance, with a hash map because a file may have thousands.
#[derive(Clone, Default)]
pub(super) struct Names {
    pub(super) list: Vec<String>,
    places: HashMap<String, usize>,
}

impl Names {
    /// Index of a name in the list; a new name is appended.
    pub(super) fn place(&mut self, name: &str) -> usize {
        if let Some(&place) = self.places.get(name) {
            return place;
        }
        self.list.push(name.into());
        self.places.insert(name.into(), self.list.len() - 1);
        self.list.len() - 1
    }
}

/// Removes regions without cells, from the region index of each cell and the names of all regions. Returns
/// both lists with the regions renumbered.
pub(super) fn without_empty(regions: Vec<u16>, names: Vec<String>) -> (Vec<u16>, Vec<String>) {
    let mut has = vec![false; names.len()];
    regions.iter().for_each(|&r| has[r as usize] = true);
    let mut next = 0;
    let new: Vec<u16> = has
        .iter()
        .map(|&has| {
            if has {
                next += 1;
                next - 1
            } else {
                u16::MAX
            }
        })
        .collect();
    let kept = names.into_iter().zip(has).filter(|(_, has)| *has).map(|(name, _)| name).collect();
    (regions.into_iter().map(|r| new[r as usize]).collect(), kept)
}
