//! Lists of numbers, one after another.

/// Lists by number, in compressed rows.
pub(super) struct Lists {
    /// Start of each list, lists + 1 entries.
    pub offsets: Vec<u32>,
    pub items: Vec<u32>,
}

impl Lists {
    /// Turns pairs of a list's number, below `count`, and an item into lists; each keeps the order of its
    /// pairs.
    pub fn new(count: usize, pairs: impl Iterator<Item = (u32, u32)> + Clone) -> Lists {
        let mut offsets = vec![0u32; count + 1];
        pairs.clone().for_each(|(list, _)| offsets[list as usize + 1] += 1);
        for k in 0..count {
            offsets[k + 1] += offsets[k];
        }
        let (mut next, mut items) = (offsets.clone(), vec![0; offsets[count] as usize]);
        for (list, item) in pairs {
            items[next[list as usize] as usize] = item;
            next[list as usize] += 1;
        }
        Lists { offsets, items }
    }

    /// Items of a list.
    pub fn of(&self, list: usize) -> &[u32] {
        &self.items[self.offsets[list] as usize..self.offsets[list + 1] as usize]
    }
}
