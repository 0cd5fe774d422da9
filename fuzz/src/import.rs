//! Models of other programs: imported, and their scenes read as TOML.

use cases::import::{Units, import_bytes};

pub(crate) fn run(data: &[u8]) {
    for units in [Units::Metres, Units::Millimetres] {
        match import_bytes(data, "fuzz.model", "fuzz.model", units, None) {
            Err(findings) => {
                assert!(!findings.is_empty());
                assert!(findings.iter().all(|finding| !finding.to_string().is_empty()));
            }
            Ok(imported) => {
                let table = imported.scene.parse::<toml::Table>();
                assert!(table.is_ok_and(|table| table.contains_key("method")), "{}", imported.scene);
            }
        }
    }
}
