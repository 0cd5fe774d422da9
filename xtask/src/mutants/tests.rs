//! Switches in a text, and the list against the sources.

use super::*;

fn mutant(name: &str, find: &str, replace: &str) -> Mutant {
    let [name, find, replace] = [name, find, replace].map(String::from);
    Mutant { name, what: String::new(), file: "a.rs".into(), find, replace, test: String::new() }
}

#[test]
fn a_fault_stands_beside_what_is_right() {
    let text = "fn f(x: f64) -> f64 { x + 1.0 }";
    let [minus, twice] = [mutant("minus", "x + 1.0", "x - 1.0"), mutant("twice", "x + 1.0", "x + 2.0")];
    let spoiled = with_faults(text, &[&minus, &twice]).unwrap();
    assert!(
        spoiled.starts_with("fn f(x: f64) -> f64 { (if ") && spoiled.ends_with("else { x + 1.0 }) }) }"),
        "{spoiled}"
    );
    assert!(
        spoiled.contains("on == \"minus\"")
            && spoiled.contains("{ x - 1.0 }")
            && spoiled.contains("{ x + 2.0 }")
    );
}

/// The sources change, and the list must match them.
#[test]
fn the_list_fits_the_sources() {
    let root = crate::root();
    let all = read(&root.join("tests/mutants.toml")).unwrap();
    for file in all.iter().map(|m| &m.file).collect::<BTreeSet<_>>() {
        let faults: Vec<&Mutant> = all.iter().filter(|m| m.file == *file).collect();
        let text = std::fs::read_to_string(root.join(file)).unwrap_or_else(|bad| panic!("{file}: {bad}"));
        with_faults(&text, &faults).unwrap();
    }
    for mutant in &all {
        target(&mutant.test).unwrap();
        assert!(mutant.find != mutant.replace && mutant.what.ends_with('.'), "{}", mutant.name);
        for text in [&mutant.find, &mutant.replace] {
            if let Err(bad) = syn::parse_str::<syn::Expr>(text) {
                panic!("{}: `{text}` is not an expression: {bad}", mutant.name);
            }
        }
    }
}

#[test]
fn a_fault_needs_one_place_of_its_own() {
    let text = "a + b + c + a";
    for (faults, says) in [
        ([mutant("m", "a", "b"), mutant("n", "b", "a")], "2 times"),
        ([mutant("m", "d", "b"), mutant("n", "b", "a")], "0 times"),
        ([mutant("m", "a + b", "b"), mutant("n", "b + c", "a")], "overlap"),
    ] {
        let refused = with_faults(text, &[&faults[0], &faults[1]]).unwrap_err().to_string();
        assert!(refused.contains(says), "{refused}");
    }
}
