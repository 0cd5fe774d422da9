//! A study: read, checked against its scenes, and its runs listed.

use std::path::Path;

use cases::scene;
use harness::study::{StudyPlan, VerifyArgs};

use crate::inputs::beside;
use crate::messages::sound;

pub(crate) fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let file = beside("fuzz-study.toml");
    match scene::parse_study(text, &file) {
        Err(errors) => sound(&errors, text, &file),
        Ok(study) => {
            if let Ok(plan) = StudyPlan::new(study) {
                assert_eq!(plan.planned(&VerifyArgs::of(Path::new(&file))).len(), plan.len());
            }
        }
    }
}
