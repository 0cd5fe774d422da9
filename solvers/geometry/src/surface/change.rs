//! Changes that a repair or a wrap makes, with their positions.

use std::fmt;

use super::digits::point;
use crate::Point3;

/// Number of positions listed of each change.
const LISTED: usize = 3;

/// A kind of change to a surface, how often it was made, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Kind, in words.
    pub what: String,
    /// Number of all places.
    pub count: usize,
    /// The first places, in the unit of the file.
    pub places: Vec<Point3>,
}

impl Change {
    /// A change at these places; `None` without a place.
    pub(super) fn at(what: &str, places: impl IntoIterator<Item = Point3>) -> Option<Change> {
        let (mut count, mut first) = (0, Vec::new());
        for place in places {
            count += 1;
            if first.len() < LISTED {
                first.push(place);
            }
        }
        (count > 0).then(|| Change { what: what.into(), count, places: first })
    }

    /// The kind and the number, without places.
    pub fn brief(&self) -> String {
        format!("{}: {}", self.what, self.count)
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let places: Vec<String> = self.places.iter().map(point).collect();
        let more = match self.count - self.places.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        write!(f, "{}, near {}{more}", self.brief(), places.join(", "))
    }
}
