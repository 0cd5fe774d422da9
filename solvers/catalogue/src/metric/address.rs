//! Addresses of the numbers of a metric: `rms-x` is the component x of `rms`, and `tool-force-2` the
//! `tool-force` of the second tool.

use std::fmt;

use super::definition::{Metric, Shape};
use super::entries::METRICS;
use crate::names::nearest;
use crate::problem::Problem;

/// Components of a vector, in the order of coordinates.
const COMPONENTS: [&str; 3] = ["x", "y", "z"];
/// Components of a symmetric tensor, in the order of tables.
const TENSOR: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];

/// One number of a metric in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address {
    /// Metric.
    pub metric: &'static Metric,
    /// Component of a vector (`x`, `y` or `z`) or of a symmetric tensor (`xx` to `zx`); empty for the
    /// magnitude of a vector and for a scalar.
    pub component: &'static str,
    /// Number of the tool, support, face or point, from 1; `None` if the metric is that of the whole run.
    pub index: Option<u64>,
}

impl Metric {
    /// Returns the address of the number of the run, of the magnitude of a vector, or of the first tool.
    pub const fn whole(&'static self) -> Address {
        let index = if self.is_numbered() { Some(1) } else { None };
        Address { metric: self, component: "", index }
    }

    /// Returns the addresses of the components x, y and z.
    pub const fn components(&'static self) -> [Address; 3] {
        let [x, y, z] = COMPONENTS;
        let whole = self.whole();
        [
            Address { component: x, ..whole },
            Address { component: y, ..whole },
            Address { component: z, ..whole },
        ]
    }

    /// Returns the addresses of the components x, y and z and of the magnitude.
    pub const fn parts(&'static self) -> [Address; 4] {
        let [x, y, z] = self.components();
        [x, y, z, self.whole()]
    }

    /// Returns the addresses of the components xx, yy, zz, xy, yz and zx.
    pub fn tensor(&'static self) -> [Address; 6] {
        TENSOR.map(|component| Address { component, ..self.whole() })
    }

    /// Returns the addresses that this metric has in a run with one tool, support, face or point.
    pub fn addresses(&'static self) -> impl Iterator<Item = Address> {
        let all = [self.whole()].into_iter().chain(self.components()).chain(self.tensor());
        all.filter(|of| match (self.shape, of.component.len()) {
            (Shape::Scalar, length) => length == 0,
            (Shape::Vector, length) => length < 2,
            (Shape::Components, length) => length == 1,
            (Shape::Tensor, length) => length == 2,
        })
    }

    /// Returns the address of the number of one tool, support, face or point, whose position in its list counts
    /// from 0.
    pub const fn at(&'static self, position: usize) -> Address {
        self.whole().at(position)
    }
}

impl Address {
    /// Returns the same address for one tool, support, face or point, whose position in its list counts from 0.
    pub const fn at(self, position: usize) -> Address {
        Address { index: Some(position as u64 + 1), ..self }
    }

    /// Returns the label of a column or an axis, without the unit.
    pub fn label(&self) -> String {
        match self.component {
            "" => self.metric.label.into(),
            component if component.len() > 1 => format!("{} {component}", self.metric.label),
            component => format!("{} along {component}", self.metric.label),
        }
    }
}

impl From<&'static Metric> for Address {
    fn from(metric: &'static Metric) -> Address {
        metric.whole()
    }
}

impl fmt::Display for Address {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.pad(&address(self.metric.name, self.component, self.index))
    }
}

/// Returns an address in one word: the name of the metric, its component if there is one, and the number of
/// its tool, support, face or point from 2 on.
pub fn address(metric: &str, component: &str, index: Option<u64>) -> String {
    let component = if component.is_empty() { String::new() } else { format!("-{component}") };
    let index = index.filter(|index| *index > 1).map_or(String::new(), |index| format!("-{index}"));
    format!("{metric}{component}{index}")
}

/// Reads an address as [`Address`] is displayed; `None` if no metric has such numbers.
pub fn find(name: &str) -> Option<Address> {
    let (rest, index) = match name.rsplit_once('-') {
        Some((rest, end)) if number(end) > 1 => (rest, number(end)),
        _ => (name, 1),
    };
    let (bare, component) = match rest.rsplit_once('-') {
        Some((bare, end)) if COMPONENTS.contains(&end) || TENSOR.contains(&end) => (bare, end),
        _ => (rest, ""),
    };
    let metric = METRICS.iter().copied().find(|metric| metric.name == bare)?;
    let first = metric.addresses().find(|of| of.component == component)?;
    match index {
        1 => Some(first),
        _ => metric.is_numbered().then_some(Address { index: Some(index), ..first }),
    }
}

/// Reads a whole number in its only spelling; 0 if the text is none.
fn number(text: &str) -> u64 {
    text.parse().ok().filter(|number: &u64| number.to_string() == text).unwrap_or(0)
}

/// Renamed metrics: old and new name.
const RENAMED: [(&str, &str); 2] = [("estimated-error", "stress-jump"), ("condition", "condition-max")];

/// Reads an address as [`find`] does.
///
/// # Errors
///
/// The name is unknown or was renamed; the help gives the nearest or the new name.
pub fn named(name: &str) -> Result<Address, Problem> {
    find(name).ok_or_else(|| {
        if let Some((_, new)) = RENAMED.iter().find(|(old, _)| *old == name) {
            return Problem::new(format!("is called '{new}' now")).found(name);
        }
        let known: Vec<String> =
            METRICS.iter().flat_map(|metric| metric.addresses()).map(|known| known.to_string()).collect();
        let near = nearest(name, known.iter().map(String::as_str));
        let near = near.map_or(String::new(), |near| format!("did you mean '{near}'? "));
        let help = format!("{near}`tissuebench list metrics` explains all of them");
        Problem::new("is not a known metric").found(name).help(help)
    })
}

#[cfg(test)]
mod tests {
    use super::super::{PROBE_STRESS, REACTION, RMS, TOOL_FORCE};
    use super::*;

    #[test]
    fn a_metric_under_its_old_name_is_refused_with_the_new_one() {
        assert!(RENAMED.iter().all(|(old, new)| find(old).is_none() && find(new).is_some()));
        assert!(named("estimated-error").unwrap_err().to_string().contains("'stress-jump'"));
    }

    #[test]
    fn every_address_is_read_as_it_is_written() {
        for metric in METRICS.iter() {
            for one in metric.addresses() {
                for address in [one, if metric.is_numbered() { one.at(11) } else { one }] {
                    assert_eq!(find(&address.to_string()), Some(address), "{address}");
                }
            }
        }
        let written = [
            RMS.whole(),
            RMS.components()[0],
            TOOL_FORCE.at(1),
            REACTION.components()[1].at(2),
            PROBE_STRESS.tensor()[3].at(1),
        ]
        .map(|address| address.to_string());
        assert_eq!(written, ["rms", "rms-x", "tool-force-2", "reaction-y-3", "probe-stress-xy-2"]);
    }

    #[test]
    fn no_number_has_two_addresses() {
        for none in [
            "tool-force-1",
            "tool-force-02",
            "tool-force-+2",
            "rms-2",
            "rms-w",
            "rms-xx",
            "probe-stress",
            "probe-stress-x",
            "reaction",
            "l2-x",
            "force",
            "",
        ] {
            assert_eq!(find(none), None, "{none}");
        }
        assert_eq!(named("tool-farce").unwrap_err().help.unwrap().split(' ').nth(3), Some("'tool-force'?"));
        assert_eq!(named("rms-w").unwrap_err().help.unwrap().split(' ').nth(3), Some("'rms-x'?"));
    }
}
