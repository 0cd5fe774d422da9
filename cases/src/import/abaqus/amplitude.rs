//! `*AMPLITUDE`: factors of loads and motions over time. (CalculiX CrunchiX manual, 7.)

use mesh_files::DeckCard;

use super::sets::{bare, real};
use crate::import::document::{Part, list, quoted};
use crate::import::finding::Findings;
use crate::import::units::{Units, number};

/// A table of times with a factor at each.
pub(super) struct Amplitude {
    /// Name as the deck writes it.
    name: String,
    line: usize,
    points: Vec<[f64; 2]>,
    /// Whether the times count from the first step, not from the current one.
    total: bool,
}

impl Amplitude {
    /// Reads a table; `None` for another kind, which is refused where it is named.
    pub fn read(card: &DeckCard, findings: &Findings) -> Option<Amplitude> {
        let name = card.get("NAME").unwrap_or_default().to_string();
        let total = card.get("TIME").is_some_and(|time| time.eq_ignore_ascii_case("TOTAL TIME"));
        let other = card.parameters.iter().find(|(key, _)| key != "NAME" && (key != "TIME" || !total));
        if let Some((key, value)) = other {
            findings.leave_out(card.line, format!("*AMPLITUDE '{name}' with {key}={value}"));
            return None;
        }
        let words = card.data.iter().flat_map(|(_, words)| words).filter(|word| !bare(word).is_empty());
        let values: Vec<f64> = words.map(|word| real(word)).collect::<Option<_>>()?;
        if !values.len().is_multiple_of(2) || values.is_empty() {
            return None;
        }
        let points: Vec<[f64; 2]> = values.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
        let rises = points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        rises.then_some(Amplitude { name, line: card.line, points, total })
    }

    /// Factor at a time of a step that begins at `start`. The table is constant before and after its points.
    pub fn at(&self, time: f64, start: f64) -> f64 {
        let time = if self.total { start + time } else { time };
        let after = self.points.partition_point(|point| point[0] < time);
        match (after.checked_sub(1).map(|at| self.points[at]), self.points.get(after)) {
            (Some([t0, f0]), Some(&[t1, f1])) => f0 + (f1 - f0) * ((time - t0) / (t1 - t0)),
            (Some([_, f]), None) | (None, Some(&[_, f])) => f,
            (None, None) => 0.0,
        }
    }

    /// The curve over the time of a step that begins at `start`.
    pub fn curve(&self, start: f64, units: Units) -> Part {
        let shift = if self.total { start } else { 0.0 };
        let mut points: Vec<[f64; 2]> = self.points.iter().map(|[t, f]| [t - shift, *f]).collect();
        // A curve has two points; the factor is constant after the last.
        if let [[t, f]] = points[..] {
            points.push([t + 1.0, f]);
        }
        Part::new("[[curve]]")
            .note(format!("*AMPLITUDE {} (line {})", self.name, self.line))
            .key("name", quoted(&self.name))
            .key("time", list(points.iter().map(|[t, _]| units.times(*t))))
            .key("factor", list(points.iter().map(|[_, f]| number(*f))))
    }

    /// Name of the curve.
    pub fn name(&self) -> &str {
        &self.name
    }
}
