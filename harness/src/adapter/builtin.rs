//! The adapters that are compiled into this program.

/// Files of an adapter, as pairs of name and text.
pub(super) type Files = &'static [(&'static str, &'static str)];

macro_rules! shipped {
    ($($folder:literal: $($file:literal),+;)+) => {
        &[$(&[$(($file, include_str!(concat!("../../shipped/", $folder, "/", $file)))),+]),+]
    };
}

/// All shipped adapters, `adapter.toml` first.
pub(super) static SHIPPED: &[Files] = shipped! {
    "calculix": "adapter.toml", "calculix.py";
    "dolfinx": "adapter.toml", "dolfinx_adapter.py";
    "felupe": "adapter.toml", "felupe_adapter.py";
    "ngsolve": "adapter.toml", "ngsolve_adapter.py";
    "scikit-fem": "adapter.toml", "scikit_fem.py";
    "tissuebench": "adapter.toml";
};

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn every_folder_of_the_project_is_shipped_whole() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("shipped");
        let mut folders = 0;
        for folder in std::fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path()) {
            if !folder.is_dir() {
                continue;
            }
            let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
            let mut files: Vec<String> = files
                .filter(|file| file.is_file())
                .map(|file| file.file_name().unwrap().to_str().unwrap().to_string())
                .collect();
            files.sort();
            let own = std::fs::read_to_string(folder.join("adapter.toml")).unwrap();
            let shipped = SHIPPED.iter().find(|files| files[0].1 == own).expect("it is shipped");
            let mut names: Vec<&str> = shipped.iter().map(|(name, _)| *name).collect();
            names.sort();
            assert_eq!(names, files, "{}", folder.display());
            folders += 1;
        }
        assert_eq!(folders, SHIPPED.len());
    }

    #[test]
    fn a_program_is_at_most_a_hundred_lines() {
        for (name, text) in SHIPPED.iter().flat_map(|files| files.iter()) {
            assert!(text.lines().count() <= 100, "{name}: {} lines", text.lines().count());
        }
    }
}
