//! Named groups of triangles; a triangle may be in any number of groups.

use std::collections::HashMap;

/// Groups of triangles by name. Triangles refer to sets of groups, of which a file has few.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Groups {
    names: Vec<String>,
    known: HashMap<String, u32>,
    /// Distinct sets of groups; a triangle without a set is in no group.
    sets: Vec<Vec<u32>>,
    places: HashMap<Vec<u32>, u32>,
    /// Set of each triangle; triangles beyond the end have none.
    of: Vec<u32>,
}

/// Set of a triangle without groups.
const NONE: u32 = u32::MAX;

/// Set of groups for added triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Set(u32);

impl Default for Set {
    fn default() -> Set {
        Set(NONE)
    }
}

impl Groups {
    /// Set of these names, created if it is new. Blanks around a name are removed, and empty names are
    /// ignored.
    pub fn set<'a>(&mut self, names: impl IntoIterator<Item = &'a str>) -> Set {
        let names = names.into_iter().map(kept).filter(|name| !name.is_empty());
        let mut set: Vec<u32> = names.map(|name| self.name(name)).collect();
        set.sort_unstable();
        set.dedup();
        if set.is_empty() {
            return Set(NONE);
        }
        let next = self.sets.len() as u32;
        let place = *self.places.entry(set.clone()).or_insert(next);
        if place == next {
            self.sets.push(set);
        }
        Set(place)
    }

    fn name(&mut self, name: String) -> u32 {
        let next = self.names.len() as u32;
        let place = *self.known.entry(name.clone()).or_insert(next);
        if place == next {
            self.names.push(name);
        }
        place
    }

    /// Assigns a set to the triangles added since the last call; `triangles` is their current number.
    pub fn fill(&mut self, triangles: usize, Set(set): Set) {
        self.of.resize(triangles, set);
    }

    /// Groups restricted to some triangles, in their order.
    pub(super) fn of_triangles(&self, kept: &[usize]) -> Groups {
        let of = kept.iter().map(|&t| self.set_of(t)).collect();
        Groups { of, ..self.clone() }
    }

    /// Assigns the groups of a triangle to another triangle.
    pub(super) fn copy(&mut self, from: usize, to: usize) {
        let set = self.set_of(from);
        self.of.resize(self.of.len().max(to + 1), NONE);
        self.of[to] = set;
    }

    fn set_of(&self, triangle: usize) -> u32 {
        self.of.get(triangle).copied().unwrap_or(NONE)
    }

    /// Names of all groups, in the order of the file.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Groups of a triangle, as indices into the names.
    pub fn of(&self, triangle: usize) -> &[u32] {
        self.sets.get(self.set_of(triangle) as usize).map_or(&[], Vec::as_slice)
    }

    /// The groups without names that no triangle has.
    pub(super) fn without_empty(&self) -> Groups {
        let mut has = vec![false; self.names.len()];
        let mut occurs = vec![false; self.sets.len()];
        self.of.iter().filter(|&&set| set != NONE).for_each(|&set| occurs[set as usize] = true);
        for (set, _) in self.sets.iter().zip(&occurs).filter(|(_, occurs)| **occurs) {
            set.iter().for_each(|&name| has[name as usize] = true);
        }
        let mut kept = Groups::default();
        for (name, _) in self.names.iter().zip(has).filter(|(_, has)| *has) {
            kept.name(name.clone());
        }
        let names =
            |set: &[u32]| -> Vec<&str> { set.iter().map(|&name| &*self.names[name as usize]).collect() };
        let sets: Vec<Set> = (self.sets.iter().zip(occurs))
            .map(|(set, occurs)| if occurs { kept.set(names(set)) } else { Set(NONE) })
            .collect();
        kept.of = self.of.iter().map(|&set| sets.get(set as usize).map_or(NONE, |set| set.0)).collect();
        kept
    }
}

/// A name that every mesh format can represent, as far as it is ASCII. Quotation marks, commas and control
/// characters are replaced.
fn kept(name: &str) -> String {
    let plain = |c: char| if c == '"' || c == ',' || c.is_control() { '_' } else { c };
    name.trim().chars().map(plain).collect()
}
