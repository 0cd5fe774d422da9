//! Checks that a method's mesh file is of the scene's body: same position, extent and volume.

use cases::scene::{Body, MeshFile, Size};
use geometry::{CellKind, Mesh, Point3, Vector3, quality};
use shape::position;

use super::{body, mesh_file};
use crate::discretise::place;
use crate::error::{Failure, Key};

/// Meshes of one curved body differ by more than rounding, because they cut its corners. The outline may
/// differ by this fraction of the body's size, or of a cell's edge on coarse meshes. The volume may differ by
/// this fraction of itself.
const OUTLINE: f64 = 0.02;
const OF_EDGE: f64 = 0.25;
const VOLUME: f64 = 0.05;

/// Number of nodes of the mesh that represents a body in closed form.
const NODES: usize = 1000;

/// Position and size of a mesh, SI units.
struct Extent {
    min: Point3,
    max: Point3,
    volume: f64,
    /// Edge length of a regular cell of the mean volume.
    edge: f64,
}

impl Extent {
    fn of(mesh: &Mesh) -> Extent {
        let volume: f64 = quality::volumes(mesh).iter().sum();
        let (min, max) = place::bounds(mesh);
        let regular = mesh.kind(0).entry().cell.regular_volume;
        Extent { min, max, volume, edge: (volume / mesh.cell_count() as f64 / regular).cbrt() }
    }

    fn size(&self) -> Vector3 {
        self.max - self.min
    }
}

/// Refuses a mesh file of another body than the scene's, or of the same body in another unit of length.
///
/// # Errors
/// Returns an error if extent or volume differ by more than the tolerances, or if the scene's body cannot be
/// meshed.
pub fn check(body: &Body, file: &MeshFile, mesh: &Mesh) -> Result<(), Failure> {
    let of_body = match body {
        Body::File(of_body) if (&of_body.path, of_body.unit) == (&file.path, file.unit) => return Ok(()),
        Body::File(of_body) if !mesh_files::is_surface(&of_body.path) => {
            mesh_file::read(of_body, Key::Scene("body.path".into()))?
        }
        shape => body::unchecked(shape, CellKind::Tet4, &Size::Nodes(NODES), None)?,
    };
    let own = Extent::of(mesh);
    let whole = Extent::of(&of_body);
    let edge = own.edge.max(whole.edge);
    let allowed = (OUTLINE * whole.size().max()).max(OF_EDGE * edge);
    let off = (own.min - whole.min).amax().max((own.max - whole.max).amax());
    // A cell on a surface of curvature radius R cuts off h^2 / (8 R). R = 3 V / A, with A that of a ball.
    let radius = (whole.volume * 0.75 / std::f64::consts::PI).cbrt();
    let cut = 3.0 * edge.powi(2) / (8.0 * radius.powi(2));
    let lost = (own.volume / whole.volume - 1.0).abs();
    if off <= allowed && lost <= VOLUME.max(cut) {
        return Ok(());
    }
    let problem = format!("has the extent {}; the scene's body has {}", describe(&own), describe(&whole));
    Err(Failure::input(Key::Size("file"), problem, &help(own.size().max() / whole.size().max())))
}

fn describe(extent: &Extent) -> String {
    let [low, high] = [extent.min, extent.max].map(|x| position(&x, extent.size().norm()));
    format!("{:.4e} cm^3, from {low} to {high}", 1e6 * extent.volume)
}

/// Returns the help for a mesh `ratio` times as large as the body.
fn help(ratio: f64) -> String {
    let units = [("m", 1e3), ("cm", 10.0), ("um", 1e-3)];
    match units.iter().find(|(_, metres)| (ratio * metres - 1.0).abs() < 0.1) {
        Some((unit, _)) => format!("if the file is in {unit}, add unit = \"{unit}\""),
        None => "give a mesh of the same body at the same position".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::generate::ball_mesh;
    use geometry::surface::Treatment;

    /// A ball has the outline of the cube around it, and pi / 6 = 52 % of its volume.
    #[test]
    fn a_body_of_the_same_outline_is_known_by_its_volume() {
        let cube = Body::Box { min: [-0.02; 3], max: [0.02; 3] };
        let file = MeshFile {
            path: "ball.msh".into(),
            unit: 1.0,
            further: Vec::new(),
            join: false,
            treatment: Treatment::AsGiven,
        };
        let ball = ball_mesh(CellKind::Hex8, 0.02, 8).unwrap();
        let wrong = check(&cube, &file, &ball).unwrap_err().to_string();
        assert!(wrong.contains("6.4000e1 cm^3, from (-20.0, -20.0, -20.0) mm"), "{wrong}");
        check(&Body::Ball { radius: 0.02 }, &file, &ball).unwrap();
    }
}
