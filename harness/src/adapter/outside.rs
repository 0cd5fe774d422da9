//! A method of a solver outside this program, as far as it goes with a mesh.

use std::collections::BTreeMap;

use cases::scene::Setting;

use super::find::Found;
use crate::process::Limits;

/// Who solves a method that this program does not, and how.
#[derive(Clone, Debug)]
pub(crate) struct Outside {
    pub(crate) adapter: Found,
    pub(crate) about: About,
}

/// What a problem in files is called, and what its solver gets beside it.
#[derive(Clone, Debug)]
pub(crate) struct About {
    /// Name of the case.
    pub(crate) case: String,
    /// Id of the method.
    pub(crate) method: String,
    /// Elements, by their name in scenes.
    pub(crate) element: &'static str,
    /// What the scene gives the adapter beside the problem.
    pub(crate) settings: BTreeMap<String, Setting>,
    pub(crate) limits: Limits,
}

/// An adapter with its settings, as records and people have it.
pub(crate) fn label(adapter: &str, settings: &BTreeMap<String, Setting>) -> String {
    let setting = |(name, value): (&String, &Setting)| match value {
        Setting::Flag(flag) => format!(" {name}={flag}"),
        Setting::Number(number) => format!(" {name}={number}"),
        Setting::Text(text) => format!(" {name}={text}"),
    };
    let settings: String = settings.iter().map(setting).collect();
    format!("{adapter}{settings}")
}
