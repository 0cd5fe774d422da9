//! Keywords of Abaqus and CalculiX. A keyword that neither program knows is a typing error that may hide
//! nodes or elements.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::left_out::Kind;

/// Keywords of Abaqus's keyword reference, of CalculiX and of some older versions of both, one per line.
const LIST: &str = include_str!("keywords.txt");

/// Longest keyword for which a correction is suggested.
const LONGEST: usize = 60;

/// Keywords by their letters without blanks and hyphens.
static KNOWN: LazyLock<HashMap<String, &str>> =
    LazyLock::new(|| LIST.lines().map(|keyword| (letters(keyword), keyword)).collect());

/// Removes blanks and hyphens; CalculiX omits blanks.
fn letters(keyword: &str) -> String {
    keyword.chars().filter(|c| !matches!(c, ' ' | '-')).collect()
}

/// Standard spelling, with blanks and hyphens, of an upper-case keyword that may lack them. `None` for an
/// unknown keyword.
pub(super) fn known(keyword: &str) -> Option<&'static str> {
    KNOWN.get(&letters(keyword)).copied()
}

/// Keywords that are read, or whose loss does not affect the body: headings, ends and output requests.
const NO_LOSS: [&str; 31] = [
    "NODE",
    "ELEMENT",
    "ELSET",
    "NSET",
    "SURFACE",
    "SOLID SECTION",
    "INCLUDE",
    "PART",
    "END PART",
    "INSTANCE",
    "END INSTANCE",
    "ASSEMBLY",
    "END ASSEMBLY",
    "HEADING",
    "PREPRINT",
    "END STEP",
    "OUTPUT",
    "NODE OUTPUT",
    "ELEMENT OUTPUT",
    "CONTACT OUTPUT",
    "ENERGY OUTPUT",
    "NODE FILE",
    "EL FILE",
    "NODE PRINT",
    "EL PRINT",
    "CONTACT FILE",
    "CONTACT PRINT",
    "ENERGY PRINT",
    "RESTART",
    "MONITOR",
    "FILE FORMAT",
];

/// Keywords that join nodes or parts, or carry loads in addition to the solids.
const JOINS: [&str; 23] = [
    "TIE",
    "EQUATION",
    "MPC",
    "RIGID BODY",
    "COUPLING",
    "KINEMATIC",
    "DISTRIBUTING",
    "KINEMATIC COUPLING",
    "DISTRIBUTING COUPLING",
    "SHELL TO SOLID COUPLING",
    "CONTACT",
    "CONTACT PAIR",
    "CONTACT INCLUSIONS",
    "EMBEDDED ELEMENT",
    "CYCLIC SYMMETRY MODEL",
    "PRE-TENSION SECTION",
    "SPRING",
    "DASHPOT",
    "CONNECTOR SECTION",
    "SHELL SECTION",
    "MEMBRANE SECTION",
    "BEAM SECTION",
    "TRANSFORM",
];

/// Consequence of the loss of a keyword, `None` if nothing is lost.
pub(super) fn lost(keyword: &str) -> Option<Kind> {
    match keyword {
        _ if NO_LOSS.contains(&keyword) => None,
        _ if JOINS.contains(&keyword) => Some(Kind::Joins),
        _ => Some(Kind::Model),
    }
}

/// Closest known keyword by edit distance, `None` if no keyword is close.
pub(super) fn nearest(keyword: &str) -> Option<&'static str> {
    if keyword.len() > LONGEST {
        return None;
    }
    let found: Vec<char> = letters(keyword).chars().collect();
    let away = |known: &&str| changes(&found, &letters(known).chars().collect::<Vec<char>>());
    let best = LIST.lines().min_by_key(away)?;
    (3 * away(&best) <= found.len()).then_some(best)
}

/// Edit distance: letters to change, insert or remove, or adjacent letters to swap.
fn changes(a: &[char], b: &[char]) -> usize {
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let changed = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = changed.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_of_which_something_is_said_exist() {
        for keyword in NO_LOSS.iter().chain(&JOINS) {
            assert_eq!(known(keyword), Some(*keyword));
        }
    }

    #[test]
    fn the_list_is_in_capitals_and_each_once() {
        assert_eq!(KNOWN.len(), LIST.lines().count());
        let plain = |line: &str| line.bytes().all(|b| b.is_ascii_uppercase() || b"0123456789 -".contains(&b));
        assert!(LIST.lines().all(|line| plain(line) && line.trim() == line && !line.is_empty()));
    }

    #[test]
    fn words_are_found_without_blanks_and_typing_errors_are_near() {
        assert_eq!(known("SOLIDSECTION"), Some("SOLID SECTION"));
        assert_eq!(known("PRE-TENSION SECTION"), known("PRETENSIONSECTION"));
        assert_eq!(known("NODES"), None);
        for (found, meant) in [
            ("NODES", Some("NODE")),
            ("ELEMNT", Some("ELEMENT")),
            ("ELMEENT", Some("ELEMENT")),
            ("SOILD SECTION", Some("SOLID SECTION")),
            ("SURFCE", Some("SURFACE")),
            ("KEYWORD", None),
            ("SOMETHING ELSE", None),
            ("", None),
        ] {
            assert_eq!(nearest(found), meant, "{found}");
        }
        assert_eq!(nearest(&"NODE".repeat(100_000)), None);
    }
}
