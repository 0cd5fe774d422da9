//! Check that an exact solution solves the scene: its displacement on the supports, and its traction on the
//! rest of the surface.
//!
//! The equations inside the body are the responsibility of the solution. A scene can omit a load, have an
//! additional support, or use other numbers. Errors would then be distances between two problems.

use std::collections::{HashMap, HashSet};
use std::iter::repeat_n;

use cases::exact::Exact;
use cases::scene::{Place, Procedure};
use fem::SurfaceRule;
use geometry::{Facet, Mesh, Point3, Vector3};
use shape::SurfaceRows;

use super::solved::Solved;
use crate::discretise::place;
use crate::discretise::place::Patch;
use crate::error::Failure;
use crate::scenario::setup::{Applied, Load, Setup, SurfaceLoad};

/// Surface on which a scene and its exact solution differ most.
pub(super) struct Misfit {
    /// Root-mean-square difference on the surface, relative to the largest root-mean-square value on any
    /// surface.
    pub relative: f64,
    /// Part of the difference that flat facets of a curved surface may cause: the angle from facet to facet,
    /// rad.
    pub turn: f64,
    /// Name of the surface.
    pub surface: String,
    /// Quantity that differs: displacement or traction.
    pub what: &'static str,
    /// Root-mean-square values of the scene and of the exact solution on the surface, m or Pa.
    pub sizes: [f64; 2],
}

/// Part of the surface covered by a support or a load: whole facets, and whether other facets are cut.
struct Covered {
    whole: HashSet<Facet>,
    /// Area over which a total force is spread, m^2; 0 for other loads and supports.
    area: f64,
    cuts: bool,
}

/// Sums of squares over a surface: scene, exact solution, difference.
#[derive(Clone, Copy, Default)]
struct Sums([f64; 3]);

/// Relative level of rounding. Displacements are relative to the displacement that the stress causes across
/// the body, and stresses to the stress that the displacement causes.
const ROUNDING: f64 = 1e-12;

/// Sums over a surface of the mesh.
struct OnSurface {
    name: String,
    /// Area, m^2.
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

/// Largest misfit of a linear scene; `None` without an exact solution, or if a region cuts facets.
pub(super) fn worst(run: &Solved) -> Result<Option<Misfit>, Failure> {
    let Solved { method, setup, .. } = *run;
    // The force of springs depends on the solution.
    let fits = matches!(setup.procedure, Procedure::Linear { .. })
        && !setup.relaxes()
        && setup.foundations.is_empty();
    let Some(exact) = setup.exact.as_deref().filter(|exact| fits && exact.contact().is_none()) else {
        return Ok(None);
    };
    let mesh = method.mesh();
    let covered = |key: &str, at: &Place, is_spread: bool| -> Result<Covered, Failure> {
        let Patch { whole, cut } = place::patch(key, at, mesh)?;
        let area = match is_spread {
            true => fem::surface_rows(mesh, &whole, &SurfaceRule::STANDARD)?.weights().iter().sum(),
            false => 0.0,
        };
        Ok(Covered { whole: whole.into_iter().collect(), area, cuts: !cut.is_empty() })
    };
    let held: Vec<Covered> =
        setup.supports.iter().map(|s| covered(&s.key, &s.place, false)).collect::<Result<_, _>>()?;
    let is_spread = |load: &Load| matches!(load.applied, Applied::Surface(SurfaceLoad::Force(_)));
    let loaded: Vec<Covered> =
        setup.loads.iter().map(|l| covered(&l.key, &l.place, is_spread(l))).collect::<Result<_, _>>()?;
    if held.iter().chain(&loaded).any(|c| c.cuts) {
        return Ok(None);
    }
    let each = surfaces(mesh).into_iter();
    let each = each.map(|(name, facets)| OnSurface::new(name, run, exact, &facets, [&held, &loaded]));
    let each: Vec<OnSurface> = each.collect::<Result<_, _>>()?;
    // Values that should be zero are relative to the largest on the body: a support along the normal of a
    // plane has a displacement of exactly zero.
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

/// Largest misfit of a quantity; `None` if the quantity vanishes everywhere.
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
    let surface = worst.name.clone();
    let turn = worst.turn;
    (scale > 0.0).then(|| Misfit { relative: off / scale, turn, surface, what, sizes: [scene, exact] })
}

/// Named surfaces of a mesh, and the rest of its boundary, without walls inside the body.
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
    /// Sums displacements along constrained axes and tractions along the others.
    fn new(
        name: String,
        run: &Solved,
        exact: &dyn Exact,
        facets: &[Facet],
        [held, loaded]: [&[Covered]; 2],
    ) -> Result<OnSurface, Failure> {
        let surface = fem::surface_rows(run.method.mesh(), facets, &SurfaceRule::STANDARD)?;
        let of_point: Vec<Facet> =
            facets.iter().flat_map(|&f| repeat_n(f, points(run.method.mesh(), f))).collect();
        let area = surface.weights().iter().sum();
        let turn = turn(run.method.mesh(), facets, &surface);
        let (displacement, traction) = (Sums::default(), Sums::default());
        let mut sums = OnSurface { name, area, turn, displacement, traction, all: [0.0; 2] };
        for (q, &w) in surface.weights().iter().enumerate() {
            let facet = &of_point[q];
            let x = &surface.points()[q];
            let n = &surface.normals()[q];
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

/// Number of points on a facet.
fn points(mesh: &Mesh, facet: Facet) -> usize {
    SurfaceRule::STANDARD.points(mesh.facet_kind(facet))
}

/// Root-mean-square angle (rad) between the normal of a facet and the mean normals at its corners; 0 for a
/// plane.
fn turn(mesh: &Mesh, facets: &[Facet], surface: &SurfaceRows) -> f64 {
    let mut start = 0;
    let of_facet = |&facet: &Facet| {
        let own = start..start + points(mesh, facet);
        start = own.end;
        own.map(|q| surface.normals()[q] * surface.weights()[q]).sum()
    };
    let normals: Vec<Vector3> = facets.iter().map(of_facet).collect();
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

/// Sum of all loads at a point of a facet, Pa.
fn applied(
    setup: &Setup,
    loaded: &[Covered],
    facet: &Facet,
    x: &Point3,
    n: &Vector3,
) -> Result<Vector3, String> {
    let mut sum = Vector3::zeros();
    for (load, covered) in setup.loads.iter().zip(loaded).filter(|(_, covered)| covered.whole.contains(facet))
    {
        sum += match &load.applied {
            Applied::Surface(SurfaceLoad::Traction(field)) => field(x, n)?,
            Applied::Surface(SurfaceLoad::Pressure(field)) => -n * field(x)?,
            Applied::Surface(SurfaceLoad::Force(force)) => force / covered.area,
            Applied::Body(_) | Applied::Points { .. } => Vector3::zeros(),
        };
    }
    Ok(sum)
}
