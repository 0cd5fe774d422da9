//! What can be said against a run before it starts: of the scene and its mesh alone.

use cases::scene::{self, Scene};
use catalogue::warning;
use geometry::Mesh;

use crate::discretise::place::{self, tolerance};
use crate::outcome::Warning;

/// Warnings about the scene on this mesh.
pub(crate) fn warnings(scene: &Scene, mesh: &Mesh) -> Vec<Warning> {
    let mut found = Vec::new();
    if !scene.is_moved() {
        let message =
            "nothing moves this body: it has no load, no tool and no support that moves".to_string();
        found.push(Warning::new(&warning::NOTHING_MOVES, 0.0, "", message));
    }
    found.extend(scene.regions.iter().enumerate().filter_map(|(index, region)| cut(index, region, mesh)));
    found
}

/// Cells of which some corners lie inside the place of a region and some outside.
fn cut(index: usize, region: &scene::MaterialRegion, mesh: &Mesh) -> Option<Warning> {
    let scene::Place::Where(_) = &region.place else { return None };
    let tolerance = tolerance(mesh);
    let is_cut = |&cell: &usize| {
        // On the border is neither.
        let holds = |x| [tolerance, -tolerance].map(|by| place::holds(&region.place, x, by));
        let sides: Vec<[bool; 2]> = mesh.cell_points(cell).map(holds).collect();
        sides.contains(&[true; 2]) && sides.contains(&[false; 2])
    };
    let (cells, all) = ((0..mesh.cell_count()).filter(is_cut).count(), mesh.cell_count());
    if cells == 0 {
        return None;
    }
    let share = cells as f64 / all as f64;
    let message = format!(
        "the border of '{}' runs through {cells} of {all} cells ({:.1} %), each of which is of the material at its centre: the \
         border is that of the cells",
        region.name,
        100.0 * share
    );
    Some(Warning::new(&warning::REGION_CUT, share, format!("region[{index}].where"), message))
}
