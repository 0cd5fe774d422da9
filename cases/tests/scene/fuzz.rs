use proptest::prelude::*;
use tissuebench_cases::scene::{Expression, parse, parse_study};

use crate::{SCENE, edited};

/// Pieces of text that reach different branches of the reader.
const PIECES: [&str; 24] = [
    "\"",
    "'",
    "[",
    "]",
    "{",
    "}",
    "=",
    "#",
    "\n",
    ".",
    ",",
    "-",
    "1e999",
    "nan",
    "inf",
    "\u{b5}m",
    "\u{0}",
    "^",
    "(((",
    "x",
    "exact",
    " kPa",
    "0",
    "\u{1F980}",
];

fn boundary(text: &str, at: usize) -> usize {
    (0..=at % (text.len() + 1)).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0)
}

/// Checks that every error has a place in the file.
fn judge(text: &str) {
    let lines = text.split('\n').count();
    let scene = parse(text, "fuzz.toml");
    for error in scene.err().into_iter().chain(parse_study(text, "fuzz.toml").err()).flatten() {
        assert!(error.line >= 1 && error.line <= lines && error.column >= 1, "{error} in\n{text}");
        assert!(!error.problem.is_empty() && !error.to_string().contains('\n'), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_cut_scene_never_panics(at in 0..SCENE.len()) {
        judge(&SCENE[..boundary(SCENE, at)]);
    }

    #[test]
    fn a_mangled_scene_never_panics(edits in prop::collection::vec((0usize..4000, 0usize..12, 0usize..24), 1..6)) {
        let mut text = SCENE.to_string();
        for (at, length, piece) in edits {
            let start = boundary(&text, at);
            let end = boundary(&text, (start + length).min(text.len())).max(start);
            text.replace_range(start..end, PIECES[piece]);
        }
        judge(&text);
    }

    #[test]
    fn swapped_lines_never_panic(a in 0usize..80, b in 0usize..80) {
        let mut lines: Vec<&str> = SCENE.lines().collect();
        let n = lines.len();
        lines.swap(a % n, b % n);
        judge(&lines.join("\n"));
    }

    #[test]
    fn any_text_as_expression_never_panics(text in "[-+*/^(),.0-9a-zxyz\u{e9} ]{0,40}") {
        judge(&edited("z^2", &text));
    }

    #[test]
    fn any_text_as_quantity_or_region_never_panics(text in "[-+*/^.0-9a-zA-Z\u{b2}\u{b5} =<>]{0,20}") {
        judge(&edited("20 kPa", &text));
        judge(&edited("z == 0 mm", &text));
    }
}

#[test]
fn deep_nesting_is_refused_without_running_out_of_stack() {
    judge(&edited("z^2", &format!("{}z{}", "(".repeat(100_000), ")".repeat(100_000))));
    judge(&edited("z^2", &format!("z{}", "+z".repeat(100_000))));
    judge(&edited(
        "[\"0 mm\", \"0 mm\", \"5 mm\"]",
        &format!("{}{}", "[".repeat(100_000), "]".repeat(100_000)),
    ));
    judge(&format!("{}\n{SCENE}", "a.".repeat(50_000)));
}

/// The type is part of the interface and must stay usable across threads.
#[test]
fn an_expression_can_be_shared() {
    fn shared<T: Send + Sync>() {}
    shared::<Expression>();
}
