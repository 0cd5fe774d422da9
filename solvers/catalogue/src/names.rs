//! Nearest known name of a mistyped name.

/// Returns the known name nearest to `name`, counting insertions, deletions, substitutions and swaps (Damerau
/// 1964). Of equally near names the first is returned. Returns `None` if every name needs more than one
/// change plus one per three of its letters.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // The cost grows with the product of the lengths; no known name is half as long as this limit.
    let name: String = name.chars().take(80).collect();
    known
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(&name, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= 1 + candidate.len() / 3)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Returns `did you mean 'x'?` if a known name is near, and the list of known names.
pub fn suggest(name: &str, known: &[&str]) -> String {
    let list = format!("known here: {}", known.join(", "));
    match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean '{near}'? ({list})"),
        None => list,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typo_finds_its_word_and_another_word_none() {
        for (name, found) in [("dept", Some("depth")), ("lenght", Some("length")), ("curvature", None)] {
            assert_eq!(nearest(name, ["length", "depth", "width"]), found, "{name}");
        }
        assert_eq!(nearest("x", []), None);
        assert_eq!(suggest("wdith", &["width"]), "did you mean 'width'? (known here: width)");
    }
}
