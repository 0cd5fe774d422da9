//! Selection of a part of the body, by names or by comparisons.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::region::Region;
use super::report::Report;
use super::units::{Length, Q};

/// Selection of a part of the body.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// Named parts.
    On(Vec<String>),
    /// Points that satisfy comparisons.
    Where(Region),
    /// Nodes that several named parts of the surface share: an edge or a corner.
    Edge(Vec<String>),
    /// Points, in metres.
    At(Vec<[f64; 3]>),
    /// Everywhere (body forces).
    Everywhere,
}

/// Keys of the place of a support.
pub(crate) struct PlaceKeys {
    pub on: Option<Names>,
    pub place: Option<Region>,
    pub edge: Option<Names>,
    pub at: Option<Vec<[Q<Length>; 3]>>,
}

/// A name or a list of names
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum Names {
    One(String),
    Several(Vec<String>),
}

impl From<Names> for Vec<String> {
    fn from(names: Names) -> Vec<String> {
        match names {
            Names::One(name) => vec![name],
            Names::Several(names) => names,
        }
    }
}

impl Place {
    /// Reads the keys `on` and `where`; everywhere if neither is given.
    pub(crate) fn read(on: Option<Names>, region: Option<Region>, report: &Report) -> Place {
        match (on.map(Vec::from), region) {
            (on, Some(region)) => {
                if on.is_some() {
                    let help = "give a region with 'on' or with 'where', not both";
                    report.add("where", Problem::new("can't be combined with 'on'").help(help));
                }
                Place::Where(region)
            }
            (Some(on), None) => {
                report.require(!on.is_empty(), "on", "names nothing", "name a part of the surface");
                Place::On(on)
            }
            (None, None) => Place::Everywhere,
        }
    }

    /// Reads the keys of a support's place: `on`, `where`, `edge` or `at`, one of which is required.
    pub(crate) fn of_support(keys: PlaceKeys, report: &Report) -> Place {
        let PlaceKeys { on, place, edge, at } = keys;
        let help = "give one of on, where, edge and at";
        let several = [on.is_some() || place.is_some(), edge.is_some(), at.is_some()];
        if several.iter().filter(|given| **given).count() > 1 {
            let key = if at.is_some() { "at" } else { "edge" };
            report.add(key, Problem::new("gives a second place").help(help));
        }
        if let Some(edge) = edge {
            let names = Vec::from(edge);
            let help =
                "name the surfaces that share it: edge = [\"x-min\", \"z-min\"], or a curve of a mesh file";
            report.require(!names.is_empty(), "edge", "names nothing", help);
            return Place::Edge(names);
        }
        if let Some(at) = at {
            report.require(!at.is_empty(), "at", "names no point", "give one or more points");
            return Place::At(at.into_iter().map(|x| x.map(|q| q.0)).collect());
        }
        let found = Place::read(on, place, report);
        if found == Place::Everywhere {
            let help = "give a region: on = \"z-min\", or where = \"z == 0 mm\"; or edge, or at";
            report.missing("where", help);
        }
        found
    }

    /// Reads the keys `on` and `where`, one of which is required.
    pub(crate) fn required(on: Option<Names>, region: Option<Region>, report: &Report) -> Place {
        let place = Place::read(on, region, report);
        if place == Place::Everywhere {
            report.missing("where", "give a region: on = \"z-min\", or where = \"z == 0 mm\"");
        }
        place
    }
}
