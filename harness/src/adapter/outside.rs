//! The external solver of a method.

use std::collections::BTreeMap;

use cases::scene::Setting;

use super::find::Found;
use crate::process::Limits;

/// The external solver of a method and its problem.
#[derive(Clone, Debug)]
pub(crate) struct Outside {
    pub(crate) adapter: Found,
    pub(crate) about: About,
}

/// Names of a problem written to files, and the settings of its solver.
#[derive(Clone, Debug)]
pub(crate) struct About {
    /// Name of the case.
    pub(crate) case: String,
    /// Id of the method.
    pub(crate) method: String,
    /// Element, by its name in scenes.
    pub(crate) element: &'static str,
    /// Settings that the scene gives the adapter.
    pub(crate) settings: BTreeMap<String, Setting>,
    pub(crate) limits: Limits,
}

/// Returns the adapter's name followed by its settings, for records and messages.
pub(crate) fn label(adapter: &str, settings: &BTreeMap<String, Setting>) -> String {
    let setting = |(name, value): (&String, &Setting)| match value {
        Setting::Flag(flag) => format!(" {name}={flag}"),
        Setting::Number(number) => format!(" {name}={number}"),
        Setting::Text(text) => format!(" {name}={text}"),
    };
    let settings: String = settings.iter().map(setting).collect();
    format!("{adapter}{settings}")
}
