//! The known name that a mistyped one most likely meant.

/// Number of single-character insertions, deletions and substitutions between two names (Levenshtein 1966).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

/// The known name nearest to `name`, the first of equals; `None` only when nothing is known.
pub fn nearest(name: &str, known: &[&'static str]) -> Option<&'static str> {
    known.iter().copied().min_by_key(|k| distance(&name.to_lowercase(), k))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_counted_as_in_the_textbook_example() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("same", "same"), 0);
    }

    #[test]
    fn a_typo_finds_its_word() {
        assert_eq!(nearest("dept", &["length", "depth", "width"]), Some("depth"));
        assert_eq!(nearest("x", &[]), None);
    }
}
