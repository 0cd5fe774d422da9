//! Requirements of every message.

use cases::scene::SceneError;

/// Checks that every message is a single line and refers to an existing line of the text.
pub(crate) fn sound(errors: &[SceneError], text: &str, file: &str) {
    let lines = text.split('\n').count();
    for error in errors {
        let message = error.to_string();
        assert!(!message.contains('\n') && !error.problem.is_empty(), "{message}");
        let own = error.file != file || (1..=lines).contains(&error.line);
        assert!(own, "line {} of {lines}: {message}", error.line);
    }
}
