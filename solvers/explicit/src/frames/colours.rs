//! Groups of items that can be processed at the same time.

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
