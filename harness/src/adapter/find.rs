//! Finds adapters: in the folders the user names, next to the scene, in the working directory, and in the
//! program itself.

use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock};

use catalogue::nearest;
use disk::Kind;

use super::FOLDERS;
use super::builtin::{Files, SHIPPED};
use super::manifest::Manifest;
use crate::error::Failure;

/// Name of a folder of adapters next to a scene.
const BESIDE: &str = "adapters";
const MANIFEST: &str = "adapter.toml";
/// Largest manifest that is read, bytes.
const LARGEST_MANIFEST: u64 = 1 << 20;

/// Adapter folders given on the command line.
static GIVEN: OnceLock<Vec<PathBuf>> = OnceLock::new();
/// Whether only folders named by the user and the program's own adapters are searched.
static NOT_LOCAL: AtomicBool = AtomicBool::new(false);

/// Sets the folders that are searched first. Only the first call counts.
pub(crate) fn add_folders(folders: &[PathBuf]) {
    let _ = GIVEN.set(folders.to_vec());
}

/// Excludes the scene's folder and the working directory from the search.
pub(crate) fn leave_local_out() {
    NOT_LOCAL.store(true, Ordering::Relaxed);
}

/// Whether the scene's folder and the working directory are excluded.
pub(crate) fn leaves_local_out() -> bool {
    NOT_LOCAL.load(Ordering::Relaxed)
}

/// Returns the adapter folders named on the command line and in the environment.
pub(crate) fn given_folders() -> Vec<PathBuf> {
    let environment = std::env::var_os(FOLDERS).unwrap_or_default();
    let of_environment = std::env::split_paths(&environment).filter(|path| !path.as_os_str().is_empty());
    GIVEN.get().into_iter().flatten().cloned().chain(of_environment).collect()
}

/// An adapter and its origin.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub(crate) manifest: Manifest,
    /// The adapter's folder; `None` if the adapter is compiled into this program.
    pub(crate) folder: Option<PathBuf>,
    shipped: Files,
}

impl Found {
    fn shipped(files: Files) -> Result<Found, Failure> {
        let text = files.first().map_or("", |(_, text)| text);
        let manifest = Manifest::parse(text, Path::new(MANIFEST)).map_err(Failure::Input)?;
        Ok(Found { manifest, folder: None, shipped: files })
    }

    fn in_folder(folder: &Path) -> Option<Result<Found, Failure>> {
        let file = folder.join(MANIFEST);
        let text = match disk::read_text(&file, Kind::ADAPTER.at_most(LARGEST_MANIFEST)) {
            Err(bad) if matches!(bad.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => return None,
            Err(bad) => return Some(Err(Failure::Input(format!("{}: {bad}", file.display())))),
            Ok(text) => text,
        };
        let found = |manifest| Found { manifest, folder: Some(folder.to_path_buf()), shipped: &[] };
        Some(Manifest::parse(&text, &file).map(found).map_err(Failure::Input))
    }

    /// Iterates over the adapter's files as pairs of name and contents, sorted by name and read one at a
    /// time. Files in subfolders are left out, and so are files beyond the size limit of a whole adapter.
    pub(crate) fn files(&self) -> impl Iterator<Item = (String, Vec<u8>)> {
        let shipped = self.shipped.iter().map(|(name, text)| (name.to_string(), text.as_bytes().to_vec()));
        let entries = self.folder.iter().flat_map(std::fs::read_dir).flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        let mut left = Kind::ADAPTER.most();
        shipped.chain(paths.into_iter().filter_map(move |path| {
            let bytes = disk::read(&path, Kind::ADAPTER.at_most(left)).ok()?;
            left -= bytes.len() as u64;
            Some((path.file_name()?.to_string_lossy().into_owned(), bytes))
        }))
    }

    /// Prints once per folder where an adapter comes from, unless the adapter is compiled into this program.
    fn announce(&self) {
        static SAID: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
        let Some(folder) = &self.folder else { return };
        let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
        if SAID.lock().is_ok_and(|mut said| said.insert(whole.clone())) {
            eprintln!("using adapter '{}' from {}", self.manifest.name, whole.display());
        }
    }

    /// Returns the adapter's location for messages.
    pub(crate) fn place(&self) -> String {
        self.folder.as_ref().map_or("shipped".into(), |folder| folder.display().to_string())
    }
}

/// Result of a search for adapters.
#[derive(Default)]
pub(crate) struct All {
    /// The first adapter of each name.
    pub(crate) found: Vec<Found>,
    /// Folders with an invalid `adapter.toml`, and the error in each.
    pub(crate) broken: Vec<(PathBuf, Failure)>,
}

/// Returns all adapters available to a scene.
pub(crate) fn all(scene: Option<&Path>) -> All {
    let beside = scene.and_then(Path::parent).map(|folder| folder.join(BESIDE));
    let local = beside.into_iter().chain([PathBuf::from(BESIDE)]).filter(|_| !leaves_local_out());
    let folders = given_folders().into_iter().chain(local);
    let mut all = All::default();
    let add = |all: &mut All, read: Result<Found, Failure>, folder: &Path| match read {
        Ok(new) if all.found.iter().any(|known| known.manifest.name == new.manifest.name) => {}
        Ok(new) => all.found.push(new),
        Err(bad) if all.broken.iter().any(|(known, _)| known == folder) => drop(bad),
        Err(bad) => all.broken.push((folder.to_path_buf(), bad)),
    };
    for folder in folders {
        let entries = std::fs::read_dir(&folder).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        // The folder itself may be an adapter.
        paths.insert(0, folder);
        for path in paths {
            if let Some(read) = Found::in_folder(&path) {
                add(&mut all, read, &path);
            }
        }
    }
    SHIPPED.iter().for_each(|files| add(&mut all, Found::shipped(files), Path::new("shipped")));
    all
}

/// Returns the adapter called `name`.
pub(crate) fn find(name: &str, scene: Option<&Path>) -> Result<Found, Failure> {
    let All { mut found, mut broken } = all(scene);
    // An adapter with an invalid manifest is not replaced by another one of the same name.
    if let Some(at) = broken.iter().position(|(folder, _)| folder.file_name().is_some_and(|own| own == name))
    {
        return Err(broken.swap_remove(at).1);
    }
    if let Some(at) = found.iter().position(|found| found.manifest.name == name) {
        let found = found.swap_remove(at);
        found.announce();
        return Ok(found);
    }
    let names: Vec<&str> = found.iter().map(|found| found.manifest.name.as_str()).collect();
    let near = nearest(name, names.iter().copied());
    let near = near.map_or(String::new(), |near| format!("; did you mean '{near}'?"));
    let help = format!("known adapters are {}{near}; --adapters DIR adds a folder", names.join(", "));
    Err(Failure::Input(format!("no adapter '{name}': {help}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MINE: &str = "name = \"mine\"\ntitle = \"Mine\"\nrun = [\"mine\"]\ncan = []\nelements = []\n";

    #[test]
    fn those_beside_a_scene_come_before_those_of_the_program_and_a_broken_one_stops_only_itself() {
        let dir = tempfile::tempdir().unwrap();
        let scene = dir.path().join("scene.toml");
        let put = |name: &str, text: &str| {
            let folder = dir.path().join("adapters").join(name);
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(folder.join(MANIFEST), text).unwrap();
            folder
        };
        let mine = put("mine", MINE);
        put("other", &MINE.replace("\"mine\"\ntitle", "\"felupe\"\ntitle"));
        put("broken", "name = 3");
        let of = |name: &str| find(name, Some(&scene));
        assert_eq!(of("mine").unwrap().folder, Some(mine));
        assert!(of("felupe").unwrap().folder.is_some() && of("calculix").unwrap().folder.is_none());
        assert!(of("broken").unwrap_err().to_string().contains("broken/adapter.toml"));
        let lost = of("calculx").unwrap_err().to_string();
        assert!(lost.contains("did you mean 'calculix'?") && lost.contains("mine"), "{lost}");
        assert_eq!(all(Some(&scene)).broken.len(), 1);
    }
}
