//! Conversion of supports and loads.

use crate::scene::field::{Prescribed, ScalarField, VectorField};
use crate::scene::keys::*;
use crate::scene::model::{Load, LoadKind, Place, Support};
use crate::scene::region::Region;
use crate::scene::report::Report;
use crate::scene::units::Dim;
use catalogue::Problem;

use super::names;

pub(super) fn place(
    on: Option<Names>,
    region: Option<Region>,
    key: &str,
    report: &mut Report,
    needed: bool,
) -> Place {
    match (on, region) {
        (Some(on), None) => {
            let on = names(on);
            report.require(
                !on.is_empty(),
                &format!("{key}.on"),
                "names nothing",
                "name a part of the surface",
            );
            Place::On(on)
        }
        (None, Some(region)) => Place::Where(region),
        (Some(_), Some(region)) => {
            let help = "say where with 'on' or with 'where', not both";
            report.add(&format!("{key}.where"), Problem::new("stands beside 'on'").help(help));
            Place::Where(region)
        }
        (None, None) => {
            if needed {
                report
                    .missing(&format!("{key}.where"), "say where: on = \"z-min\", or where = \"z == 0 mm\"");
            }
            Place::Everywhere
        }
    }
}

pub(super) fn support(keys: SupportKeys, index: usize, report: &mut Report) -> Support {
    let key = format!("support[{index}]");
    let place = place(keys.on, keys.place, &key, report, true);
    let zero = || Some(Prescribed::Field(ScalarField::Constant(0.0)));
    let mut motion: [Option<Prescribed>; 3] = [None, None, None];
    if let Some(fix) = &keys.fix {
        let sound = ["x", "y", "z", "xy", "xz", "yz", "xyz"].contains(&fix.as_str());
        let help = "write the axes held at zero in order: x, y, z, xy, xz, yz or xyz";
        report.require(sound, &format!("{key}.fix"), "is not a list of axes", help);
        for axis in 0..3 {
            if fix.contains(['x', 'y', 'z'][axis]) {
                motion[axis] = zero();
            }
        }
    }
    match keys.motion {
        Some(MoveKeys::Exact(_)) => {
            let help = "write move = { x = \"exact\" } for some axes, and fix for others";
            let alone = keys.fix.is_none();
            report.require(alone, &format!("{key}.move"), "moves axes that 'fix' holds", help);
            motion = std::array::from_fn(|_| Some(Prescribed::Exact));
        }
        Some(MoveKeys::Axes(axes)) => {
            let names = ["x", "y", "z"].map(|name| format!("{key}.move.{name}"));
            moved(&mut motion, [axes.x, axes.y, axes.z], &names, report);
        }
        Some(MoveKeys::All(axes)) => {
            let names = [0, 1, 2].map(|axis| format!("{key}.move[{axis}]"));
            moved(&mut motion, axes.map(Some), &names, report);
        }
        None => {}
    }
    if motion.iter().all(Option::is_none) && keys.fix.is_none() {
        report.missing(&format!("{key}.fix"), "write fix = \"xyz\", or move = { z = \"-1 mm\" }");
    }
    Support { place, motion }
}

/// Adds the prescribed displacements along the axes, each at its key.
fn moved(
    motion: &mut [Option<Prescribed>; 3],
    axes: [Option<AxisKeys>; 3],
    keys: &[String; 3],
    report: &mut Report,
) {
    for (axis, given) in axes.into_iter().enumerate() {
        let Some(given) = given else { continue };
        if motion[axis].is_some() {
            let problem = Problem::new("moves an axis that 'fix' holds").help("name each axis once");
            report.add(&keys[axis], problem);
        }
        motion[axis] = Some(match given {
            AxisKeys::Exact(_) => Prescribed::Exact,
            AxisKeys::Field(field) => Prescribed::Field(scalar(field)),
        });
    }
}

fn scalar<D: Dim>(keys: FieldKeys<D>) -> ScalarField {
    match keys {
        FieldKeys::Constant(q) => ScalarField::Constant(q.0),
        FieldKeys::Expression(f) => ScalarField::Expression { of: f.of, factor: f.unit.0 },
    }
}

fn vector<D: Dim>(keys: VectorKeys<D>) -> VectorField {
    match keys {
        VectorKeys::Exact(_) => VectorField::Exact,
        VectorKeys::Components(c) => VectorField::Components(c.map(scalar)),
        VectorKeys::Expressions(v) => {
            let factor = v.unit.0;
            VectorField::Components(v.of.map(|of| ScalarField::Expression { of, factor }))
        }
    }
}

pub(super) fn load(keys: LoadKeys, index: usize, report: &mut Report) -> Option<Load> {
    let key = format!("load[{index}]");
    let kind = match (keys.traction, keys.pressure, keys.body) {
        (Some(t), None, None) => LoadKind::Traction(vector(t)),
        (None, Some(p), None) => LoadKind::Pressure(scalar(p)),
        (None, None, Some(b)) => LoadKind::Body(vector(b)),
        (None, None, None) => {
            report.missing(&key, "give one of traction, pressure and body");
            return None;
        }
        _ => {
            report.add(
                &key,
                Problem::new("has several kinds of load").help("give one of traction, pressure and body"),
            );
            return None;
        }
    };
    let body = matches!(kind, LoadKind::Body(_));
    let place = place(keys.on, keys.place, &key, report, !body);
    let stray = match place {
        Place::On(_) if body => Some("on"),
        Place::Where(_) if body => Some("where"),
        _ => None,
    };
    if let Some(stray) = stray {
        let problem = Problem::new("limits a body force to a place").help("a body force acts everywhere");
        report.add(&format!("{key}.{stray}"), problem);
    }
    Some(Load { place, kind })
}
