//! Groups of items that can be processed at the same time.

/// Lists by number, in compressed rows.
pub(super) struct Lists {
    offsets: Vec<u32>,
    items: Vec<u32>,
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

/// Distributes items over colours so that neighbours have different ones: each item in turn takes the first
/// colour that none of its neighbours has. Returns the items of each colour, ascending.
pub(super) fn colours(count: usize, mut neighbours: impl FnMut(u32, &mut dyn FnMut(u32))) -> Vec<Vec<u32>> {
    let mut of_item = vec![u32::MAX; count];
    let mut taken: Vec<u32> = Vec::new();
    let mut colours: Vec<Vec<u32>> = Vec::new();
    for item in 0..count as u32 {
        neighbours(item, &mut |other| {
            let colour = of_item[other as usize];
            if colour != u32::MAX {
                taken[colour as usize] = item;
            }
        });
        let found = taken.iter().position(|&by| by != item);
        let colour = found.unwrap_or_else(|| {
            taken.push(u32::MAX);
            colours.push(Vec::new());
            taken.len() - 1
        });
        of_item[item as usize] = colour as u32;
        colours[colour].push(item);
    }
    colours
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_have_different_colours_and_every_item_has_one() {
        // A ring of seven: odd, so that two colours do not suffice.
        let beside = |item: u32| [(item + 1) % 7, (item + 6) % 7];
        let found = colours(7, |item, see| beside(item).into_iter().for_each(see));
        assert_eq!(found.len(), 3);
        let of = |item: u32| found.iter().position(|colour| colour.contains(&item)).unwrap();
        for item in 0..7 {
            assert!(beside(item).into_iter().all(|other| of(other) != of(item)));
        }
        assert_eq!(found.iter().map(Vec::len).sum::<usize>(), 7);
    }
}
