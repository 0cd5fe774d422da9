//! Checks that supports prescribe the same displacement at the vertices they share. Otherwise weak and
//! averaged conditions would silently end between the values.

use std::collections::HashMap;

use geometry::{Mesh, Vector3};
use shape::position;

use super::values::at;
use crate::discretise::{node_set, place};
use crate::error::{Failure, Key};
use crate::scenario::setup::Support;

/// Largest difference of prescribed values that counts as rounding, relative to the largest value or the
/// body's size.
const ROUNDING: f64 = 1e-12;

/// Refuses supports that prescribe different values at a mesh vertex.
pub(super) fn check(supports: &[Support], mesh: &Mesh) -> Result<(), Failure> {
    let values = |support: &Support| -> Result<Vec<(u32, Vector3)>, Failure> {
        let vertices = node_set::known(&support.key, &support.place, mesh)?;
        let points: Vec<_> = vertices.iter().map(|&vertex| mesh.points()[vertex as usize]).collect();
        let values = at(support, &points)?;
        Ok(vertices.into_iter().zip(values).collect())
    };
    let values: Vec<_> = supports.iter().map(values).collect::<Result<_, _>>()?;
    let size = place::size(mesh);
    let largest = values.iter().flatten().map(|(_, value)| value.amax()).fold(size, f64::max);
    // Supports and their values, m, by vertex and axis: the first that always acts, and all others.
    let mut prescribed: HashMap<(u32, usize), Vec<(usize, f64)>> = HashMap::new();
    let together = |one: usize, other: usize| match (supports[one].during, supports[other].during) {
        (Some([from, until]), Some([start, end])) => from < end && start < until,
        _ => true,
    };
    let curves_differ = |one: usize, other: usize| supports[one].curve != supports[other].curve;
    for (index, (support, values)) in supports.iter().zip(values).enumerate() {
        for (vertex, value) in values {
            for axis in (0..3).filter(|&axis| support.axes[axis]) {
                let second = value[axis];
                let before = prescribed.entry((vertex, axis)).or_default();
                let &(other, first) =
                    before.iter().find(|(other, _)| together(index, *other)).unwrap_or(&(index, second));
                if other == index {
                    before.push((index, second));
                }
                if first != 0.0 && curves_differ(index, other) {
                    let node = position(&mesh.points()[vertex as usize], size);
                    let problem = format!("moves {node} along another curve than {}", supports[other].key);
                    let help = "let the regions of supports overlap only where their curves agree";
                    return Err(Failure::input(Key::Scene(support.key.clone()), problem, help));
                }
                if (first - second).abs() > ROUNDING * largest {
                    let axis = ["x", "y", "z"][axis];
                    let node = position(&mesh.points()[vertex as usize], size);
                    let problem = format!(
                        "prescribes {:.6e} mm along {axis} at {node}, where {} \
                         prescribes {:.6e} mm",
                        1e3 * second,
                        supports[other].key,
                        1e3 * first
                    );
                    let help = "let the regions of supports overlap only where their values agree";
                    return Err(Failure::input(Key::Scene(support.key.clone()), problem, help));
                }
            }
        }
    }
    Ok(())
}
