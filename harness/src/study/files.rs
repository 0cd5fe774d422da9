//! The files that the runs of a scene depend on.

use std::path::{Path, PathBuf};

use cases::scene::{self, Scene};

use crate::adapter;

/// Files that a scene names, and those of the adapters of its methods: a changed mesh or program is a changed run.
pub(super) fn files(scene: &Scene) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = scene.methods.iter().flat_map(scene::Method::files).collect();
    if let scene::Body::File(file) = &scene.body {
        found.push(file.path.clone());
    }
    for transfer in &scene.output.transfers {
        if let scene::Target::File(file) = &transfer.to {
            found.push(file.path.clone());
        }
    }
    if let Some(scene::Reference::Method { size: Some(size), .. }) = &scene.reference {
        found.extend(size.file());
    }
    if let Some(scene::Reference::Record(path)) = &scene.reference {
        found.push(path.clone());
    }
    found.extend(scene.methods.iter().flat_map(|method| of_adapter(scene, method)));
    let included: Vec<PathBuf> = found.iter().flat_map(|file| geometry::files::included(file)).collect();
    found.extend(included);
    found.sort();
    found.dedup();
    found
}

/// The files of a method's adapter; those of the program are part of the program.
fn of_adapter(scene: &Scene, method: &scene::Method) -> Vec<PathBuf> {
    let scene::Family::External(external) = &method.family else { return Vec::new() };
    let found = adapter::find(&external.adapter, Some(Path::new(scene.file()))).ok();
    let folder = found.and_then(|found| Some((found.folder.clone()?, found.files())));
    folder.map_or(Vec::new(), |(folder, files)| files.iter().map(|(name, _)| folder.join(name)).collect())
}
