//! A check of malformed files with one change each.

/// Asserts that a text with any one of the changes `from` to `to` is rejected with a message that contains
/// all given words. `refusal` returns the message for a text. The assertion lists all failures together.
pub fn assert_refused<'a, const N: usize>(
    text: &str,
    changes: impl IntoIterator<Item = (&'a str, &'a str, [String; N])>,
    refusal: impl Fn(&str) -> Option<String>,
) {
    let mut wrong = Vec::new();
    for (from, to, says) in changes {
        assert!(text.contains(from), "{from}");
        let said = refusal(&text.replacen(from, to, 1)).unwrap_or("nothing".into());
        for words in says.iter().filter(|words| !said.contains(words.as_str())) {
            wrong.push(format!("{from} -> {to}: {said}\n  has no: {words}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
