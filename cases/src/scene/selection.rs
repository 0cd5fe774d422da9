//! Selection of a part of the body, by names or by comparisons.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::region::Region;
use super::report::Report;

/// Selection of a part of the body.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// Named parts.
    On(Vec<String>),
    /// Points that satisfy comparisons.
    Where(Region),
    /// Everywhere (body forces).
    Everywhere,
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

    /// Reads the keys `on` and `where`, one of which is required.
    pub(crate) fn required(on: Option<Names>, region: Option<Region>, report: &Report) -> Place {
        let place = Place::read(on, region, report);
        if place == Place::Everywhere {
            report.missing("where", "give a region: on = \"z-min\", or where = \"z == 0 mm\"");
        }
        place
    }
}
