//! Published parameter sets of tissues: the law, its constants and their source.
//!
//! ```
//! use tissuebench_cases::tissue;
//! let liver = tissue::find("liver/human-venkatesh-2008").expect("known");
//! assert_eq!((liver.law.as_str(), liver.constants()["young"].as_str()), ("linear", "\"6.9 kPa\""));
//! // A mistyped name gets the nearest ones.
//! let wrong = tissue::find("liver/human-venkatesch-2008").unwrap_err();
//! assert!(wrong.to_string().contains("did you mean 'liver/human-venkatesh-2008'?"), "{wrong}");
//! ```

use std::collections::BTreeMap;
use std::sync::LazyLock;

use catalogue::{Problem, nearest};
use serde::Deserialize;
use toml::de::{DeTable, Deserializer};

/// The file of all tissues.
const TEXT: &str = include_str!("tissues.toml");

static FILE: LazyLock<DeTable<'static>> =
    LazyLock::new(|| DeTable::parse(TEXT).expect("a test parses the file").into_inner());

static TISSUES: LazyLock<Vec<Tissue>> = LazyLock::new(|| {
    let keys = Deserializer::parse(TEXT).and_then(Tissues::deserialize);
    keys.expect("a test reads the file").tissue
});

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Tissues {
    tissue: Vec<Tissue>,
}

/// A published parameter set of a tissue.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tissue {
    /// Name in scenes: organ, species, first author and year, such as `liver/human-venkatesh-2008`.
    pub name: String,
    /// Species.
    pub species: String,
    /// Organ and part of it.
    pub organ: String,
    /// Test from which the constants were fitted.
    pub test: String,
    /// Range of strain in which the source tested the tissue.
    pub range: String,
    /// Smallest and largest stretch of that range.
    pub stretch: [f64; 2],
    /// Authors, journal, year and pages.
    pub source: String,
    /// Digital object identifier of the source, if known.
    pub doi: Option<String>,
    /// Name of the law.
    pub law: String,
    /// Shear modulus at small strain as the source states it, with its unit.
    pub shear: Option<String>,
    /// Further facts, such as a conversion from the conventions of the source.
    pub note: Option<String>,
    constants: toml::Table,
    #[serde(default)]
    assumed: toml::Table,
}

impl Tissue {
    /// Constants of the source, as scenes write them.
    pub fn constants(&self) -> BTreeMap<&str, String> {
        written(&self.constants)
    }

    /// Keys that the source does not give, with assumed values, as scenes write them.
    pub fn assumed(&self) -> BTreeMap<&str, String> {
        written(&self.assumed)
    }

    /// The tables `constants` and `assumed` with their spans in the file of all tissues.
    pub(crate) fn tables(&self) -> [DeTable<'static>; 2] {
        let at = TISSUES.iter().position(|tissue| tissue.name == self.name);
        let entry = at.and_then(|at| FILE.get("tissue")?.get_ref().get(at));
        ["constants", "assumed"].map(|key| {
            let table = entry.and_then(|entry| entry.get_ref().get(key));
            table.and_then(|table| table.get_ref().as_table()).cloned().unwrap_or_default()
        })
    }
}

fn written(table: &toml::Table) -> BTreeMap<&str, String> {
    table.iter().map(|(key, value)| (key.as_str(), value.to_string())).collect()
}

/// All tissues, in the order of lists.
pub fn all() -> &'static [Tissue] {
    &TISSUES
}

/// Returns the tissue with that name.
///
/// # Errors
///
/// The name is not known; the help gives the nearest name and the names of the same organ.
pub fn find(name: &str) -> Result<&'static Tissue, Problem> {
    all().iter().find(|tissue| tissue.name == name).ok_or_else(|| {
        let names = all().iter().map(|tissue| tissue.name.as_str());
        let organ = |name: &str| name.split('/').next().unwrap_or_default().to_string();
        let alike: Vec<&str> = names.clone().filter(|known| organ(known) == organ(name)).collect();
        let mut help = nearest(name, names).map_or(String::new(), |near| format!("did you mean '{near}'? "));
        help += &match alike.as_slice() {
            [] => {
                let mut organs: Vec<String> = all().iter().map(|tissue| organ(&tissue.name)).collect();
                organs.dedup();
                format!("there are tissues of {}; `tissuebench list tissues` names them", organs.join(", "))
            }
            alike => format!("there are {}", alike.join(", ")),
        };
        Problem::new("is not a tissue of the catalogue").found(name).help(help)
    })
}

#[cfg(test)]
mod tests;
