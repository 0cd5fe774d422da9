//! Node or element numbers of a file, and their indices.

use std::collections::HashMap;

/// Map from numbers to indices. Most files count 1, 2, 3, ..., and such a sequence needs no table.
#[derive(Clone, Default)]
pub(super) struct Numbers {
    first: u64,
    run: u64,
    others: HashMap<u64, u32>,
}

impl Numbers {
    /// Adds a number with the next index; returns `false` if it is known.
    pub(super) fn add(&mut self, number: u64, place: u32) -> bool {
        if self.run == 0 && self.others.is_empty() {
            (self.first, self.run) = (number, 1);
            return place == 0 || self.moved(number, place);
        }
        if self.get(number).is_some() {
            return false;
        }
        if self.others.is_empty()
            && u64::from(place) == self.run
            && number.checked_sub(self.first) == Some(self.run)
        {
            self.run += 1;
        } else {
            self.others.insert(number, place);
        }
        true
    }

    /// Adds a first number whose index is not 0, which starts no sequence.
    fn moved(&mut self, number: u64, place: u32) -> bool {
        self.run = 0;
        self.others.insert(number, place).is_none()
    }

    /// Index of a number, `None` for an unknown number.
    pub(super) fn get(&self, number: u64) -> Option<u32> {
        match number.checked_sub(self.first) {
            Some(place) if place < self.run => Some(place as u32),
            _ => self.others.get(&number).copied(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_others_are_found_alike() {
        let mut numbers = Numbers::default();
        let given = [7, 8, 9, 3, 10, u64::MAX, 0];
        for (place, number) in given.into_iter().enumerate() {
            assert!(numbers.add(number, place as u32), "{number}");
            assert!(!numbers.add(number, place as u32), "{number}");
        }
        for (place, number) in given.into_iter().enumerate() {
            assert_eq!(numbers.get(number), Some(place as u32));
        }
        assert_eq!((numbers.get(6), numbers.get(11)), (None, None));
    }
}
