//! Supports and loads as linear functions on whole faces.

use std::collections::BTreeMap;

use cases::scene::{Place, Relation};
use fem::{FaceNumbers, face_moments};
use geometry::{Facet, Mesh, Point3, Vector3};
use shape::FixedDof;

use super::anchors::anchors;
use super::result::Bounded;
use crate::discretise::node_set;
use crate::discretise::place::{self, Patch};
use crate::error::{Failure, Key};
use crate::prepare::region_check::loaded;
use crate::scenario::setup::{Applied, Load, Setup, Support, SurfaceLoad};

/// Difference from a linear function above which a field is not linear, relative to its largest value.
const LINEAR: f64 = 1e-13;

/// Conditions at the nodes of the faces.
#[derive(Default)]
pub(super) struct OnFaces {
    /// Prescribed displacements, m.
    pub fixed: Vec<FixedDof>,
    /// Degrees of freedom that stop the rigid motions which supports on faces leave free.
    pub anchors: Vec<FixedDof>,
    /// Moments of the tractions of each cause, N: none for the motion of the supports, then the loads, then
    /// the unit load of each component of each mean.
    pub loads: Vec<Vec<Vector3>>,
    /// Numbers and displacements (m) of the supports that move; `None` for a displacement that varies.
    moved: Vec<(usize, Option<Vector3>)>,
    /// Tractions (Pa) of the loads with the area (m^2) of their faces; `None` for a traction that varies.
    tractions: Vec<Option<(Vector3, f64)>>,
}

impl OnFaces {
    /// Evaluates the supports and loads.
    ///
    /// # Errors
    /// A support or load that is not linear on whole faces.
    pub fn new(faces: &FaceNumbers, mesh: &Mesh, setup: &Setup) -> Result<OnFaces, Failure> {
        let none = vec![Vector3::zeros(); 3 * faces.faces().len()];
        let mut all = OnFaces { loads: vec![none.clone(), none], ..OnFaces::default() };
        let mut prescribed = BTreeMap::new();
        for (index, support) in setup.supports.iter().enumerate() {
            all.support(index, support, faces, mesh, &mut prescribed)?;
        }
        all.fixed =
            prescribed.into_iter().map(|((node, axis), value)| FixedDof { node, axis, value }).collect();
        all.anchors = anchors(&all.fixed, faces, mesh);
        for load in &setup.loads {
            all.load(load, faces, mesh)?;
        }
        for (index, place) in setup.output.means.iter().enumerate() {
            all.mean(&format!("output.means[{index}]"), place, faces, mesh)?;
        }
        if !all.moves() && !all.is_loaded() {
            let problem = "has nothing to enclose: no support moves and no load acts";
            return Err(Failure::input(Key::Scene("output.bounds".into()), problem, ""));
        }
        Ok(all)
    }

    /// Whether a support moves.
    pub fn moves(&self) -> bool {
        !self.moved.is_empty()
    }

    /// Whether a load acts.
    pub fn is_loaded(&self) -> bool {
        self.loads[1].iter().any(|force| *force != Vector3::zeros())
    }

    /// Whether a cause acts.
    pub fn acts(&self, cause: usize) -> bool {
        match cause {
            0 => self.moves(),
            1 => self.is_loaded(),
            _ => true,
        }
    }

    /// Result that does all the work, and the motion (m) or force (N) on which it does so.
    pub fn conjugate(&self) -> Option<(Bounded, f64)> {
        match (&self.moved[..], &self.tractions[..]) {
            ([(support, Some(d))], _) if !self.is_loaded() => {
                Some((Bounded::Force { support: *support, along: d.normalize() }, d.norm()))
            }
            ([], [Some((traction, area))]) => Some((Bounded::Displacement, traction.norm() * area)),
            _ => None,
        }
    }

    fn support(
        &mut self,
        index: usize,
        support: &Support,
        faces: &FaceNumbers,
        mesh: &Mesh,
        prescribed: &mut BTreeMap<(u32, u8), f64>,
    ) -> Result<(), Failure> {
        let Support { key, place, axes, value, .. } = support;
        let patch = whole(place::patch(key, place, mesh)?, key, place)?;
        let nodes = node_set::nodes(key, place, mesh)?;
        let at = |x: &Point3| -> Result<Vector3, Failure> {
            let u = value(x).map_err(|bad| Failure::input(Key::Scene(format!("{key}.move")), bad, ""))?;
            Ok(Vector3::from_fn(|axis, _| if axes[axis] { u[axis] } else { 0.0 }))
        };
        if patch.is_empty() && is_bare(place) {
            for &node in &nodes {
                if at(&mesh.points()[node as usize])? != Vector3::zeros() {
                    let problem = "moves points or edges, which takes no force in the exact solution";
                    return Err(Failure::input(place::key(place, key), problem, "move a surface"));
                }
            }
            return Ok(());
        }
        let on_patch = mesh.facet_group_nodes(&patch);
        if let Some(bare) = nodes.iter().find(|node| on_patch.binary_search(node).is_err()) {
            let x = mesh.points()[*bare as usize];
            let problem = format!(
                "constrains nodes that are on none of its faces, such as the one at {}; bounds need supports on whole faces",
                shape::position(&x, place::size(mesh))
            );
            return Err(Failure::input(place::key(place, key), problem, "support a surface"));
        }
        let fields: Vec<[Vector3; 3]> =
            patch.iter().map(|&facet| linear(mesh, facet, &at)).collect::<Result<_, _>>()?;
        let curved = deviation(mesh, &patch, &fields, &at)?;
        refuse_curved(curved, largest(&fields), || Key::Scene(format!("{key}.move")))?;
        for (&facet, field) in patch.iter().zip(&fields) {
            for (node, u) in face_nodes(faces, mesh, facet).into_iter().zip(field) {
                for axis in (0..3).filter(|&axis| axes[axis]) {
                    prescribed.entry((node, axis as u8)).or_insert(u[axis]);
                }
            }
        }
        if largest(&fields) > 0.0 {
            self.moved.push((index, uniform(&fields)));
        }
        Ok(())
    }

    fn load(&mut self, load: &Load, faces: &FaceNumbers, mesh: &Mesh) -> Result<(), Failure> {
        let Load { key, place, applied, .. } = load;
        let refuse = |problem: &str, help: &str| Failure::input(Key::Scene(key.clone()), problem, help);
        let field = match applied {
            Applied::Surface(field) => field,
            Applied::Body(_) => {
                return Err(refuse(
                    "acts in the volume, where the stress of the bounds has no divergence",
                    "",
                ));
            }
            Applied::Points { .. } => {
                return Err(refuse("acts at points, where the exact energy is infinite", "load a surface"));
            }
        };
        let patch = whole(loaded(load, mesh)?, key, place)?;
        let areas: Vec<Vector3> = patch.iter().map(|&facet| area(mesh, facet)).collect();
        let whole_area: f64 = areas.iter().map(|area| area.norm()).sum();
        let mut fields = Vec::new();
        let mut curved: f64 = 0.0;
        for (&facet, area) in patch.iter().zip(&areas) {
            let normal = area.normalize();
            let at = |x: &Point3| -> Result<Vector3, Failure> {
                let value = match field {
                    SurfaceLoad::Traction(field) => field(x, &normal),
                    SurfaceLoad::Pressure(field) => field(x).map(|p| -p * normal),
                    SurfaceLoad::Force(force) => Ok(force / whole_area),
                };
                value.map_err(|bad| refuse(&bad, ""))
            };
            let of_facet = linear(mesh, facet, &at)?;
            curved = curved.max(deviation(mesh, &[facet], &[of_facet], &at)?);
            fields.push(of_facet);
        }
        refuse_curved(curved, largest(&fields), || Key::Scene(key.clone()))?;
        for ((&facet, field), area) in patch.iter().zip(&fields).zip(&areas) {
            let moments = face_moments(field, area.norm());
            for (node, moment) in face_nodes(faces, mesh, facet).into_iter().zip(moments) {
                self.loads[1][node as usize] += moment;
            }
        }
        if largest(&fields) > 0.0 {
            self.tractions.push(uniform(&fields).map(|traction| (traction, whole_area)));
        }
        Ok(())
    }

    /// Adds the unit loads whose work is the mean displacement over a place.
    fn mean(&mut self, key: &str, place: &Place, faces: &FaceNumbers, mesh: &Mesh) -> Result<(), Failure> {
        let patch = whole(place::patch(key, place, mesh)?, key, place)?;
        let areas: Vec<f64> = patch.iter().map(|&facet| area(mesh, facet).norm()).collect();
        let all: f64 = areas.iter().sum();
        for axis in 0..3 {
            let mut load = vec![Vector3::zeros(); 3 * faces.faces().len()];
            for (&facet, area) in patch.iter().zip(&areas) {
                let moments = face_moments(&[Vector3::ith(axis, 1.0); 3], area / all);
                for (node, moment) in face_nodes(faces, mesh, facet).into_iter().zip(moments) {
                    load[node as usize] += moment;
                }
            }
            self.loads.push(load);
        }
        Ok(())
    }
}

/// Whether a place consists of points or straight edges. A support there stops rigid motions only: without a
/// force of loads on it, the exact solution is that without the support.
fn is_bare(place: &Place) -> bool {
    match place {
        Place::Edge(_) | Place::At(_) => true,
        Place::Where(region) => {
            let fixes = |axis: usize| {
                region.comparisons.iter().any(|c| c.axis == axis && c.relation == Relation::Equal)
            };
            (0..3).filter(|&axis| fixes(axis)).count() > 1
        }
        Place::On(_) | Place::Everywhere => false,
    }
}

/// The whole faces of a place.
fn whole(patch: Patch, key: &str, place: &Place) -> Result<Vec<Facet>, Failure> {
    if patch.cut.is_empty() {
        return Ok(patch.whole);
    }
    let problem = "ends within faces of the mesh; bounds need supports and loads on whole faces";
    let help = "take a mesh whose faces end at the border of the place";
    Err(Failure::input(place::key(place, key), problem, help))
}

/// Corners of a facet in ascending order of their numbers, that of the nodes of its face.
fn corners(mesh: &Mesh, facet: Facet) -> [u32; 3] {
    let mut corners: Vec<u32> = mesh.facet_corners(facet).collect();
    corners.sort_unstable();
    corners.try_into().expect("a facet of a tetrahedron has three corners")
}

fn face_nodes(faces: &FaceNumbers, mesh: &Mesh, facet: Facet) -> [u32; 3] {
    let face = faces.of(mesh, facet) as u32;
    [0, 1, 2].map(|k| 3 * face + k)
}

/// Area (m^2) times the outward normal.
fn area(mesh: &Mesh, facet: Facet) -> Vector3 {
    let x = place::corners(mesh, facet);
    (x[1] - x[0]).cross(&(x[2] - x[0])) / 2.0
}

/// A field at a point, m or Pa.
type Field<'a> = &'a dyn Fn(&Point3) -> Result<Vector3, Failure>;

/// Values of a field at the corners of a facet.
fn linear(mesh: &Mesh, facet: Facet, at: Field) -> Result<[Vector3; 3], Failure> {
    let mut values = [Vector3::zeros(); 3];
    for (value, corner) in values.iter_mut().zip(corners(mesh, facet)) {
        *value = at(&mesh.points()[corner as usize])?;
    }
    Ok(values)
}

/// Largest distance of a field from the linear function of its values at the corners of the facets, found at
/// seven points of each.
fn deviation(mesh: &Mesh, patch: &[Facet], fields: &[[Vector3; 3]], at: Field) -> Result<f64, Failure> {
    const WEIGHTS: [[f64; 3]; 7] = [
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.5],
        [0.5, 0.0, 0.5],
        [0.25, 0.25, 0.5],
        [0.25, 0.5, 0.25],
        [0.5, 0.25, 0.25],
        [0.75, 0.2, 0.05],
    ];
    let mut largest: f64 = 0.0;
    for (&facet, field) in patch.iter().zip(fields) {
        let x = corners(mesh, facet).map(|node| mesh.points()[node as usize].coords);
        for weights in WEIGHTS {
            let mean = |of: &[Vector3; 3]| -> Vector3 { of.iter().zip(weights).map(|(v, w)| v * w).sum() };
            largest = largest.max((at(&mean(&x).into())? - mean(field)).amax());
        }
    }
    Ok(largest)
}

fn refuse_curved(deviation: f64, largest: f64, key: impl Fn() -> Key) -> Result<(), Failure> {
    if deviation <= LINEAR * largest {
        return Ok(());
    }
    let problem = format!(
        "is not linear on each face: it differs by {:.2e} of its largest value; bounds need linear supports and loads",
        deviation / largest
    );
    Err(Failure::input(key(), problem, "take a linear function of position"))
}

fn largest(fields: &[[Vector3; 3]]) -> f64 {
    fields.iter().flatten().map(|value| value.amax()).fold(0.0, f64::max)
}

/// The common value of fields, if there is one.
fn uniform(fields: &[[Vector3; 3]]) -> Option<Vector3> {
    let first = *fields.first()?.first()?;
    let same = |value: &Vector3| (value - first).amax() <= LINEAR * first.amax();
    fields.iter().flatten().all(same).then_some(first)
}
