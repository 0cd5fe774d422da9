//! A study: read, checked against its scenes, its runs listed.

use cases::scene;
use harness::study::Plan;

pub(crate) fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let file = super::beside("fuzz-study.toml");
    match scene::parse_study(text, &file) {
        Err(errors) => super::sound(&errors, text, &file),
        Ok(study) => {
            if let Ok(plan) = Plan::new(study) {
                assert_eq!(plan.planned().len(), plan.len());
            }
        }
    }
}
