//! Files that the runs of a scene depend on.

use std::path::{Path, PathBuf};

use cases::scene::{self, Scene};

use super::plan::StudyPlan;
use super::tasks::Task;
use crate::adapter::{self, Found};

/// Files that a scene names, and the files of the external solvers of a method and of the scene's reference.
/// A change of a mesh or of a solver makes a stored run invalid.
pub(super) fn files(scene: &Scene, method: &scene::Method) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = scene.methods.iter().flat_map(scene::Method::files).collect();
    if let scene::Body::File(file) = &scene.body {
        found.extend(file.paths());
    }
    found.extend(scene.fit.iter().map(|fit| fit.data.path.clone()));
    found.extend(scene.tools.iter().filter_map(|tool| tool.file.clone()));
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
    for adapter in adapters(scene, method) {
        found.extend(
            adapter
                .folder
                .iter()
                .flat_map(|folder| adapter.files().map(|(name, _)| folder.join(name)).collect::<Vec<_>>()),
        );
    }
    let included: Vec<PathBuf> = found.iter().flat_map(|file| mesh_files::included(file)).collect();
    found.extend(included);
    found.sort();
    found.dedup();
    found
}

/// Registers all files that the runs read as inputs, so that no output overwrites them.
pub(crate) fn note_inputs(scene: &Scene) {
    scene.methods.iter().flat_map(|method| files(scene, method)).for_each(|file| disk::input(&file));
}

impl StudyPlan {
    /// Registers all files that the runs read as inputs, so that no output overwrites them.
    pub(crate) fn note_inputs(&self) {
        let of = |task: &Task| files(&self.scenes[task.scene].2, &task.method);
        self.tasks.iter().flat_map(of).for_each(|file| disk::input(&file));
    }
}

/// Versions of the external solvers of a method and of the scene's reference. Another version makes a stored
/// run invalid.
pub(super) fn versions(scene: &Scene, method: &scene::Method) -> Vec<Option<String>> {
    let version = |adapter: &Found| adapter::ready(adapter).ok().and_then(|()| adapter::version(adapter));
    adapters(scene, method).iter().map(version).collect()
}

/// Adapters of a method and of the scene's reference. Files of built-in adapters are part of the program.
fn adapters(scene: &Scene, method: &scene::Method) -> Vec<Found> {
    let reference = match &scene.reference {
        Some(scene::Reference::Method { id, .. }) => scene.method(id),
        _ => None,
    };
    let of = |method: &scene::Method| {
        let scene::Family::External(external) = &method.family else { return None };
        adapter::find(&external.adapter, Some(Path::new(scene.file()))).ok()
    };
    [Some(method), reference].into_iter().flatten().filter_map(of).collect()
}
