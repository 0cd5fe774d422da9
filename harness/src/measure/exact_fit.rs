//! Whether an exact solution is one of the scene: its displacement where supports hold the body, its traction everywhere else.
//!
//! The equations inside are the solution's own business; what a scene can get wrong are a load left out, a support too many and
//! numbers that differ. Errors would then be distances between two problems.

use std::collections::{HashMap, HashSet};

use cases::exact::Exact;
use cases::scene::Procedure;
use fem::SurfaceRule;
use geometry::{Facet, Mesh, Point3, Vector3};
use shape::SurfaceRows;

use super::Solved;
use crate::Failure;
use crate::discretise::place::{self, Patch, Place};
use crate::scenario::setup::{Applied, Setup};

/// Where a scene and its exact solution differ most.
pub(super) struct Misfit {
    /// Root mean square difference on the surface over the largest root mean square value on any.
    pub relative: f64,
    /// What of it flat facets in place of a curved surface may make: their turn from one to the next.
    pub turn: f64,
    /// The surface.
    pub surface: String,
    /// What differs there.
    pub what: &'static str,
    /// Root mean square values on the surface: the scene's and the exact solution's, m or Pa.
    pub sizes: [f64; 2],
}

/// What a support or a load covers: facets as a whole, and whether it cuts others.
struct Covered {
    whole: HashSet<Facet>,
    cuts: bool,
}

/// Sums of squares over a surface: of the scene, of the exact solution, of the difference.
#[derive(Clone, Copy, Default)]
struct Sums([f64; 3]);

/// Part of the stress, as a displacement across the body, and of the displacement, as a stress, that is
/// rounding of the other.
const ROUNDING: f64 = 1e-12;

/// What is known of one surface.
struct OnSurface {
    name: String,
    /// m^2.
    area: f64,
    turn: f64,
    displacement: Sums,
    traction: Sums,
    /// Sums of squares of the exact displacement and traction, along all axes.
    all: [f64; 2],
}

impl Sums {
    fn add(&mut self, weight: f64, scene: f64, exact: f64) {
        for (sum, value) in self.0.iter_mut().zip([scene, exact, scene - exact]) {
            *sum += weight * value * value;
        }
    }
}

/// The worst misfit of a linear scene; `None` without an exact solution, or where a place cuts facets.
pub(super) fn worst(run: &Solved) -> Result<Option<Misfit>, Failure> {
    let Solved { method, setup, .. } = *run;
    let fits = matches!(setup.procedure, Procedure::Linear { .. }) && !setup.relaxes();
    let Some(exact) = setup.exact.as_deref().filter(|exact| fits && exact.contact().is_none()) else {
        return Ok(None);
    };
    let mesh = method.mesh();
    let covered = |key: &str, at: &Place| -> Result<Covered, Failure> {
        let Patch { whole, cut } = place::patch(key, at, mesh)?;
        Ok(Covered { whole: whole.into_iter().collect(), cuts: !cut.is_empty() })
    };
    let held: Vec<Covered> =
        setup.supports.iter().map(|s| covered(&s.key, &s.place)).collect::<Result<_, _>>()?;
    let loaded: Vec<Covered> =
        setup.loads.iter().map(|l| covered(&l.key, &l.place)).collect::<Result<_, _>>()?;
    if held.iter().chain(&loaded).any(|c| c.cuts) {
        return Ok(None);
    }
    let each = surfaces(mesh).into_iter();
    let each = each.map(|(name, facets)| OnSurface::new(name, run, exact, &facets, [&held, &loaded]));
    let each: Vec<OnSurface> = each.collect::<Result<_, _>>()?;
    // Values compared with zero are relative to the largest of the body: a support that holds one axis of a
    // plane has exactly none.
    let largest = |k: usize| each.iter().map(|s| (s.all[k] / s.area).sqrt()).fold(0.0, f64::max);
    let (low, high) = place::bounds(mesh);
    let stiffness = setup.materials.iter().map(|m| m.young()).fold(0.0, f64::max) / (high - low).norm();
    let (u, t) = (largest(0), largest(1));
    let of_kind = [
        misfit(&each, "displacement", u.max(ROUNDING * t / stiffness), |s| &s.displacement),
        misfit(&each, "traction", t.max(ROUNDING * u * stiffness), |s| &s.traction),
    ];
    Ok(of_kind.into_iter().flatten().max_by(|a, b| a.relative.total_cmp(&b.relative)))
}

/// The worst of one kind, `None` where all of it is zero.
fn misfit(
    each: &[OnSurface],
    what: &'static str,
    largest: f64,
    of: impl Fn(&OnSurface) -> &Sums,
) -> Option<Misfit> {
    let mean = |surface: &OnSurface| of(surface).0.map(|sum| (sum / surface.area).sqrt());
    let scale = each.iter().flat_map(|s| mean(s).into_iter().take(2)).fold(largest, f64::max);
    let worst = each.iter().max_by(|a, b| mean(a)[2].total_cmp(&mean(b)[2]))?;
    let [scene, exact, off] = mean(worst);
    let (surface, turn) = (worst.name.clone(), worst.turn);
    (scale > 0.0).then(|| Misfit { relative: off / scale, turn, surface, what, sizes: [scene, exact] })
}

/// The named surfaces of a mesh, and the rest of its boundary; no walls inside.
fn surfaces(mesh: &Mesh) -> Vec<(String, Vec<Facet>)> {
    let outer: HashSet<Facet> = mesh.boundary().into_iter().collect();
    let mut rest = outer.clone();
    let mut all = Vec::new();
    for name in mesh.group_names() {
        let named = mesh.group(name).unwrap_or_default().iter().copied();
        let facets: Vec<Facet> = named.filter(|facet| outer.contains(facet)).collect();
        rest.retain(|facet| !facets.contains(facet));
        all.push((name.to_string(), facets));
    }
    let mut rest: Vec<Facet> = rest.into_iter().collect();
    rest.sort_unstable();
    all.push(("the rest of the surface".into(), rest));
    all.retain(|(_, facets)| !facets.is_empty());
    all
}

impl OnSurface {
    /// Displacements along held axes and tractions along the others.
    fn new(
        name: String,
        run: &Solved,
        exact: &dyn Exact,
        facets: &[Facet],
        [held, loaded]: [&[Covered]; 2],
    ) -> Result<OnSurface, Failure> {
        let surface = fem::surface_rows(run.method.mesh(), facets, &SurfaceRule::STANDARD)?;
        let points_each = surface.weights().len() / facets.len();
        let area = surface.weights().iter().sum();
        let turn = turn(run.method.mesh(), facets, &surface);
        let (displacement, traction) = (Sums::default(), Sums::default());
        let mut sums = OnSurface { name, area, turn, displacement, traction, all: [0.0; 2] };
        for (q, &w) in surface.weights().iter().enumerate() {
            let (facet, x, n) = (&facets[q / points_each], &surface.points()[q], &surface.normals()[q]);
            let (u, t) = (exact.displacement(x), exact.traction(x, n));
            sums.all[0] += w * u.norm_squared();
            sums.all[1] += w * t.norm_squared();
            let applied = applied(run.setup, loaded, facet, x, n).map_err(Failure::Run)?;
            for axis in 0..3 {
                let mut supports = run.setup.supports.iter().zip(held);
                match supports.find(|(s, covered)| s.axes[axis] && covered.whole.contains(facet)) {
                    Some((s, _)) => {
                        let prescribed = (s.value)(x).map_err(Failure::Run)?;
                        sums.displacement.add(w, prescribed[axis], u[axis]);
                    }
                    None => sums.traction.add(w, applied[axis], t[axis]),
                }
            }
        }
        Ok(sums)
    }
}

/// Root mean square angle (rad) between the normal of a facet and the mean normal of those around its corners: 0 of a plane.
fn turn(mesh: &Mesh, facets: &[Facet], surface: &SurfaceRows) -> f64 {
    let each = surface.weights().len() / facets.len();
    let of_facet =
        |k: usize| (each * k..each * (k + 1)).map(|q| surface.normals()[q] * surface.weights()[q]).sum();
    let normals: Vec<Vector3> = (0..facets.len()).map(of_facet).collect();
    let mut of_corners: HashMap<u32, Vector3> = HashMap::new();
    for (facet, normal) in facets.iter().zip(&normals) {
        mesh.facet_nodes(*facet).for_each(|node| *of_corners.entry(node).or_default() += normal);
    }
    let (mut sum, mut area) = (0.0, 0.0);
    for (facet, normal) in facets.iter().zip(&normals) {
        for node in mesh.facet_nodes(*facet) {
            sum += normal.norm() * (normal.normalize() - of_corners[&node].normalize()).norm_squared();
            area += normal.norm();
        }
    }
    (sum / area).sqrt()
}

/// All loads at a point of a facet, Pa.
fn applied(
    setup: &Setup,
    loaded: &[Covered],
    facet: &Facet,
    x: &Point3,
    n: &Vector3,
) -> Result<Vector3, String> {
    let mut sum = Vector3::zeros();
    for (load, _) in setup.loads.iter().zip(loaded).filter(|(_, covered)| covered.whole.contains(facet)) {
        sum += match &load.applied {
            Applied::Traction(field) => field(x, n)?,
            Applied::Pressure(field) => -n * field(x)?,
            Applied::Body(_) => Vector3::zeros(),
        };
    }
    Ok(sum)
}
