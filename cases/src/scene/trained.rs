//! The scenes of training runs.

use super::altered::altered;
use super::error::{ErrorKind, SceneError};
use super::sample::left_out;
use super::scene::Scene;

impl Scene {
    /// The scene of a training run, numbered from 0, of the method `id`, which is not reduced there.
    ///
    /// # Errors
    /// All findings about the scene with these values.
    pub fn at_training(&self, id: &str, index: usize) -> Result<Scene, Vec<SceneError>> {
        let set = self.training[index].set.iter().map(|(key, value)| (key.as_str(), Some(value.as_str())));
        let full = [("method[].pod", None), ("training", None)].into_iter();
        let settings: Vec<_> = left_out(self, |_| false, false).into_iter().chain(full).chain(set).collect();
        altered(self, &[id.into()], &settings, &format!("{}, training[{index}]", self.file()))
    }
}

/// Checks that the scene can be trained as it says, and that a method of it is.
///
/// # Errors
/// All findings about the scenes of the training runs.
pub(crate) fn trainable(scene: &Scene) -> Result<(), Vec<SceneError>> {
    match scene.methods.iter().find(|method| method.pod.is_some()) {
        Some(method) => {
            (0..scene.training.len()).try_for_each(|index| scene.at_training(&method.id, index).map(drop))
        }
        None if scene.training.is_empty() => Ok(()),
        None => {
            let help = "give a method pod = { modes = 20 }, or leave it out";
            Err(vec![scene.error(ErrorKind::Invalid, "training", "trains nothing", Some(help))])
        }
    }
}
