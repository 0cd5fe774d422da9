//! Reference of a scene, solved at the first comparison and kept for later comparisons.

use std::borrow::Cow;
use std::sync::{Arc, Mutex, PoisonError};

use cases::scene::Scene;
use harness::Failure;
use harness::outcome::Watch;
use harness::run::{Group, Repeats};

/// A scene with its reference.
pub(crate) struct Referenced {
    scene: Arc<Scene>,
    group: Mutex<Option<Group<'static>>>,
}

impl Referenced {
    pub(crate) fn new(scene: Arc<Scene>) -> Arc<Referenced> {
        Arc::new(Referenced { scene, group: Mutex::default() })
    }

    /// Runs work with the scene and its reference, one call at a time. A reference that ended early is a
    /// failure, and is solved again for the next call. The same applies after a panic of the work.
    pub(crate) fn with<T>(
        &self,
        repeats: Repeats,
        watch: &Arc<Watch>,
        work: impl FnOnce(&Group<'static>) -> T,
    ) -> Result<T, Failure> {
        let mut kept = self.group.lock().unwrap_or_else(PoisonError::into_inner);
        let mut group = match kept.take() {
            Some(group) => group,
            None => {
                let scene = Cow::Owned((*self.scene).clone());
                let group = Group::watched(scene, None, repeats, Some(watch.clone()))?;
                if let Some(stalled) = group.reference_stalled() {
                    return Err(stalled.clone());
                }
                group
            }
        };
        group.follow(repeats, Some(watch.clone()));
        let done = work(&group);
        group.follow(repeats, None);
        *kept = Some(group);
        Ok(done)
    }
}
