//! Methods of external solvers: finite elements on our meshes, solved by a program that an adapter calls.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::{Dilation, JitterKeys, SizeKeys};
use super::element::Element;
use super::fem::Fem;
use crate::scene::report::Report;
use crate::scene::units::{Bytes, Q, Time};

/// Time limit of a run of an external solver if the file gives none, s.
const TIME_LIMIT: f64 = 600.0;
/// Memory limit of all its processes together if the file gives none, bytes: 4 GB.
const MEMORY_LIMIT: u64 = 4_000_000_000;

/// Settings of a method of an external solver.
#[derive(Clone, Debug, PartialEq)]
pub struct External {
    /// Name of the adapter.
    pub adapter: String,
    /// Elements of the method; errors are measured with our shape functions of the same name.
    pub elements: Fem,
    /// Settings passed to the adapter together with the problem.
    pub settings: BTreeMap<String, Setting>,
    /// Time limit of a run, s.
    pub time_limit: f64,
    /// Memory limit of all its processes together, bytes.
    pub memory_limit: u64,
}

/// A setting of an adapter: a truth value, a number or a text
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Setting {
    /// A truth value.
    Flag(bool),
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

#[derive(Deserialize, JsonSchema)]
pub(crate) struct ExternalKeys {
    /// Name of the adapter, as `tissuebench adapter list` prints it
    adapter: String,
    element: Element,
    size: SizeKeys,
    jitter: Option<JitterKeys>,
    /// Settings for the adapter; its page lists them
    #[serde(default)]
    settings: BTreeMap<String, Setting>,
    /// Time limit of a run; 600 s unless given
    time_limit: Option<Q<Time>>,
    /// Memory limit of all processes of a run together, such as "500 MB"; "4 GB" unless given
    memory_limit: Option<Q<Bytes>>,
}

impl ExternalKeys {
    pub fn read(self, report: &Report) -> Option<External> {
        report.require(is_adapter(&self.adapter), "adapter", NO_ADAPTER, ADAPTERS);
        let size = self.size.read(&report.at("size"));
        let jitter = self.jitter.map(|jitter| jitter.read(report));
        let time_limit = self.time_limit.map_or(TIME_LIMIT, |q| report.positive("time_limit", q.0));
        let memory_limit =
            self.memory_limit.map_or(MEMORY_LIMIT, |q| report.positive("memory_limit", q.0) as u64);
        let element = self.element;
        let dilation = Dilation::Standard;
        let elements =
            Fem { element, dilation, reduced: false, hourglass: None, size: size?, jitter, adapt: None };
        Some(External { adapter: self.adapter, elements, settings: self.settings, time_limit, memory_limit })
    }
}

impl External {
    /// The same elements, solved by an external solver with default limits; `None` unless they are plain
    /// finite elements, which other solvers have too.
    pub(super) fn twin(elements: &Fem, adapter: &str) -> Option<External> {
        let plain = elements.dilation == Dilation::Standard && !elements.reduced;
        plain.then(|| External {
            adapter: adapter.into(),
            elements: elements.clone(),
            settings: BTreeMap::new(),
            time_limit: TIME_LIMIT,
            memory_limit: MEMORY_LIMIT,
        })
    }
}

/// Message for an invalid adapter name, and the help that goes with it.
pub(crate) const NO_ADAPTER: &str = "is not the name of an adapter";
pub(crate) const ADAPTERS: &str = "`tissuebench adapter list` prints all adapters";

/// Whether a text is a valid adapter name.
pub(crate) fn is_adapter(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::method::Family;

    const SCENE: &str = r#"title = "A block"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ where = "z == 0 mm", fix = "xyz" }]
load = [{ on = "z-max", pressure = "1 kPa" }]
method = [{ id = "other", family = "external", adapter = "dummy", element = "tet10", size = { level = 1 }, MORE }]
"#;

    #[test]
    fn plain_elements_have_a_twin_of_another_solver() {
        let ours = |element: &str| {
            let keys = format!("family = \"fem\", {element}");
            let other = "family = \"external\", adapter = \"dummy\", element = \"tet10\"";
            let scene = SCENE.replace(other, &keys).replace(", MORE", "").replace("\"other\"", "\"own\"");
            crate::scene::parse(&scene, "block.toml").unwrap().methods.remove(0)
        };
        let own = ours("element = \"tet10\"");
        let twin = own.solved_by("calculix").unwrap();
        assert_eq!((twin.id.as_str(), twin.series.as_str()), ("own-calculix", "own-calculix"));
        assert_eq!((twin.size(), twin.family_name()), (own.size(), "external"));
        assert!(twin.solved_by("felupe").is_none(), "a twin has none");
        assert!(twin.is_twin_of(&own) && !own.is_twin_of(&twin) && !own.is_twin_of(&own));
        assert!(ours("element = \"tet10\", dilation = \"mixed\"").solved_by("calculix").is_none());
        assert!(ours("element = \"hex20\", reduced = true").solved_by("calculix").is_none());
    }

    #[test]
    fn a_method_has_limits_whether_they_are_given_or_not() {
        let read = |more: &str| crate::scene::parse(&SCENE.replace("MORE", more), "block.toml");
        let of = |more: &str| match &read(more).unwrap().methods[0].family {
            Family::External(external) => external.clone(),
            other => panic!("{other:?}"),
        };
        let plain = of("");
        assert_eq!((plain.time_limit, plain.memory_limit), (TIME_LIMIT, MEMORY_LIMIT));
        let given = of(
            "time_limit = \"2 s\", memory_limit = \"10 MB\", settings = { mode = \"nan\", n = 2, fast = true }",
        );
        assert_eq!((given.time_limit, given.memory_limit), (2.0, 10_000_000));
        assert_eq!(given.settings["mode"], Setting::Text("nan".into()));
        assert_eq!(
            (&given.settings["n"], &given.settings["fast"]),
            (&Setting::Number(2.0), &Setting::Flag(true))
        );
        for (more, key) in [
            ("time_limit = \"0 s\"", "method[0].time_limit"),
            ("memory_limit = \"much\"", "method[0].memory_limit"),
            ("dilation = \"mixed\"", "method[0].dilation"),
        ] {
            assert_eq!(read(more).unwrap_err()[0].key, key);
        }
    }
}
