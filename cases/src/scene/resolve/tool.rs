//! Tools.

use crate::scene::keys::ToolKeys;
use crate::scene::report::Report;
use crate::scene::tool::{Drive, Friction, Tool};
use crate::scene::vocabulary::{build, settings};
use catalogue::Problem;

use super::{positive, raw};

pub(super) fn tool(keys: ToolKeys, index: usize, report: &mut Report) -> Option<Tool> {
    let key = format!("tool[{index}]");
    let positive =
        |value: f64, name: &str, report: &mut Report| positive(value, &format!("{key}.{name}"), report);
    let (word, keys, given) = (keys.shape, keys.beside, keys.settings);
    let values = settings(&word, given, &key, report);
    let at = format!("{key}.shape");
    let shape = values.as_ref().and_then(|values| build(word.0, values, (&key, &at), report));
    let drive = match (keys.drive.closure, keys.drive.force, keys.drive.pressure) {
        (Some(q), None, None) => Drive::Closure(q.0),
        (None, Some(q), None) => Drive::Force(positive(q.0, "drive.force", report)),
        (None, None, Some(q)) => Drive::Pressure(positive(q.0, "drive.pressure", report)),
        _ => {
            let help = "give one of closure, force and pressure";
            report.add(&format!("{key}.drive"), Problem::new("is not one drive").help(help));
            return None;
        }
    };
    let along = unit(keys.along, &format!("{key}.along"), report)?;
    let (shape, values) = (shape?, values?);
    let axis = match values.list("axis") {
        Some(&[x, y, z]) => Some(unit([x, y, z], &format!("{key}.axis"), report)?),
        _ => shape.axis(along.into()).map(Into::into),
    };
    let penalty = self::positive(keys.penalty.0, &format!("{key}.penalty"), report);
    let friction = friction(keys.friction, keys.stick.map(|q| q.0), &key, report);
    Some(Tool {
        name: keys.name,
        shape,
        at: raw(keys.at),
        along,
        axis,
        drive,
        over: keys.drive.over.map(|q| q.0),
        penalty,
        friction,
    })
}

fn friction(
    coefficient: Option<f64>,
    stick: Option<f64>,
    key: &str,
    report: &mut Report,
) -> Option<Friction> {
    let at = |name: &str| format!("{key}.{name}");
    let coefficient = coefficient.unwrap_or(0.0);
    report.require(coefficient >= 0.0, &at("friction"), "is negative", "give a coefficient of 0 or more");
    let stick = stick.map(|stick| positive(stick, &at("stick"), report));
    match (coefficient > 0.0, stick) {
        (true, Some(stick)) => Some(Friction { coefficient, stick }),
        (true, None) => {
            let help =
                "friction needs the slope of the traction while the surfaces stick: stick = \"0.1 MPa/mm\"";
            report.missing(&at("stick"), help);
            None
        }
        (false, Some(_)) => {
            let problem =
                Problem::new("goes with friction only").help("leave it out, or give friction = 0.15");
            report.add(&at("stick"), problem);
            None
        }
        (false, None) => None,
    }
}

/// A direction as a unit vector.
fn unit(direction: [f64; 3], key: &str, report: &mut Report) -> Option<[f64; 3]> {
    let norm = direction.iter().map(|a| a * a).sum::<f64>().sqrt();
    report.require(norm > 0.0, key, "has no direction", "give a direction such as [0, 0, -1]");
    (norm > 0.0).then(|| direction.map(|a| a / norm))
}
