//! Mirror symmetry of a stored reference: the file may have points of the whole body, and a scene may model
//! only the part of the body at one side of its planes of symmetry.

use std::collections::BTreeSet;

use cases::scene::{LoadKind, ScalarField, Scene, Support, VectorField};
use contact::{Leg, Motion, Tool};
use geometry::{Facet, Mesh, Point3, Vector3};

use crate::discretise::place;
use crate::scenario::coarse;

/// Relative rounding of a distance.
const ROUNDING: f64 = 1e-9;

/// Planes of symmetry at which the modelled part of a body ends. Points beyond a plane are replaced by their
/// mirror images.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mirror {
    planes: Vec<Plane>,
}

/// Plane normal to an axis.
#[derive(Clone, Copy, Debug)]
struct Plane {
    axis: usize,
    /// Coordinate along the axis, m.
    at: f64,
    /// 1 if the body is above the plane, -1 if it is below.
    side: f64,
}

impl Mirror {
    /// Finds the planes of symmetry: flat ends of the body whose whole face is held along its normal and free
    /// along the other axes. There is none if no coarse mesh of the body can be made, or under a body force
    /// across the plane.
    pub(crate) fn of(scene: &Scene) -> Mirror {
        let Ok(mesh) = coarse(&scene.body) else { return Mirror::default() };
        let (low, high) = place::bounds(&mesh);
        let ends = (0..3).flat_map(|axis| {
            [Plane { axis, at: low[axis], side: 1.0 }, Plane { axis, at: high[axis], side: -1.0 }]
        });
        Mirror { planes: ends.filter(|plane| plane.is_of_symmetry(scene, &mesh)).collect() }
    }

    /// Returns the point of the modelled body that corresponds to `x`.
    pub(crate) fn place(&self, x: &Point3) -> Point3 {
        let mut image = *x;
        self.crossed(x).for_each(|plane| image[plane.axis] = 2.0 * plane.at - x[plane.axis]);
        image
    }

    /// Converts a displacement between `x` and its corresponding point, in either direction.
    pub(crate) fn displacement(&self, x: &Point3, mut u: Vector3) -> Vector3 {
        self.crossed(x).for_each(|plane| u[plane.axis] = -u[plane.axis]);
        u
    }

    /// Returns the fraction of a tool that acts on the modelled part of a body with these points: half of it
    /// for each plane that cuts the tool.
    pub(crate) fn fraction(&self, tool: &Tool, body: &[Point3]) -> f64 {
        let cuts = |plane: &&Plane| body.iter().any(|x| plane.is_crossed(x)) && plane.halves(tool, body);
        0.5f64.powi(self.planes.iter().filter(cuts).count() as i32)
    }

    /// Planes beyond which `x` lies.
    fn crossed(&self, x: &Point3) -> impl Iterator<Item = &Plane> {
        self.planes.iter().filter(|plane| plane.is_crossed(x))
    }
}

impl Plane {
    fn is_crossed(&self, x: &Point3) -> bool {
        (x[self.axis] - self.at) * self.side < 0.0
    }

    /// Whether the tool is its own mirror image at every closure, as far as these points show.
    fn halves(&self, tool: &Tool, points: &[Point3]) -> bool {
        let size = points.iter().map(|x| x.coords.amax()).fold(0.0, f64::max);
        let is_same = |x: &Point3| {
            let mut image = *x;
            image[self.axis] = 2.0 * self.at - x[self.axis];
            (tool.gap(0.0, x) - tool.gap(0.0, &image)).abs() <= ROUNDING * size
        };
        // A turn is its own image if its axis is normal to the plane.
        let is_mirrored = |leg: &Leg| match leg.motion() {
            Motion::Along(along) => along[self.axis].abs() <= ROUNDING,
            Motion::About(turn) => turn.axis[self.axis].abs() >= 1.0 - ROUNDING,
        };
        tool.legs().all(|(_, leg)| is_mirrored(leg)) && points.iter().all(is_same)
    }

    fn is_of_symmetry(&self, scene: &Scene, mesh: &Mesh) -> bool {
        let tolerance = place::tolerance(mesh);
        let is_here = |x: &Point3| (x[self.axis] - self.at).abs() <= tolerance;
        let face: BTreeSet<Facet> = (mesh.boundary().into_iter())
            .filter(|&facet| place::corners(mesh, facet).iter().all(is_here))
            .collect();
        let holds_face = |support: &&Support| {
            let held = place::patch("support", &support.place, mesh).map(|patch| patch.whole);
            held.is_ok_and(|held| face.is_subset(&held.into_iter().collect()))
        };
        let holding: Vec<&Support> = scene.supports.iter().filter(holds_face).collect();
        let holds = |axis: usize| holding.iter().any(|support| support.motion[axis].is_some());
        let normal_alone = (0..3).all(|axis| holds(axis) == (axis == self.axis));
        // Gravity across the plane has no mirror image.
        let is_forced = scene.loads.iter().any(|load| match &load.kind {
            LoadKind::Body(VectorField::Components(force)) => {
                !matches!(force[self.axis], ScalarField::Constant(0.0))
            }
            LoadKind::Body(VectorField::Exact) => true,
            // A force at a point of the plane itself acts on both halves.
            LoadKind::Points { .. } => true,
            LoadKind::Traction(_) | LoadKind::Pressure(_) | LoadKind::Force(_) => false,
        });
        // Springs need not be symmetric.
        let is_forced = is_forced || !scene.foundations.is_empty();
        !face.is_empty() && normal_alone && !is_forced && !holding.iter().any(|support| support.moves())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gravity_along_a_plane_is_symmetric_and_across_it_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("half.toml");
        let planes = |force: &str| {
            let text = format!(
                "title = \"half a block\"\n\
                 body = {{ shape = \"box\", size = [\"20 mm\", \"20 mm\", \"20 mm\"] }}\n\
                 material = {{ law = \"linear\", young = \"20 kPa\", poisson = 0.3 }}\n\
                 support = [{{ on = \"z-min\", fix = \"xyz\" }}, {{ on = \"x-min\", fix = \"x\" }}]\n\
                 load = [{{ body = [{force}] }}]\n\
                 method = [{{ id = \"hex8\", family = \"fem\", element = \"hex8\", size = {{ level = 1 }} }}]\n"
            );
            std::fs::write(&path, text).unwrap();
            let mirror = Mirror::of(&cases::scene::load(&path).unwrap());
            mirror.planes.iter().map(|plane| plane.axis).collect::<Vec<_>>()
        };
        assert_eq!(planes("\"0 N/m^3\", \"0 N/m^3\", \"-9810 N/m^3\""), [0]);
        assert_eq!(planes("\"9810 N/m^3\", \"0 N/m^3\", \"0 N/m^3\""), [0; 0]);
    }
}
