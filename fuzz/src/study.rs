//! A study: read, checked against its scenes, and its runs listed.

use std::path::Path;

use cases::scene;
use harness::study::{Plan, VerifyArgs};

pub(crate) fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let file = super::beside("fuzz-study.toml");
    match scene::parse_study(text, &file) {
        Err(errors) => super::sound(&errors, text, &file),
        Ok(study) => {
            if let Ok(plan) = Plan::new(study) {
                assert_eq!(plan.planned(&VerifyArgs::of(Path::new(&file))).len(), plan.len());
            }
        }
    }
}
