//! The prepare phase: all tables for assembly, for one method on one body under one setup.

mod agreement;
mod axes;
mod conditions;
mod contact_tables;
mod foundation_tables;
mod foundations;
mod loads;
mod means;
mod nodal_patch;
mod own_curves;
mod penalty_points;
mod reduced;
pub(crate) mod region_check;
mod sharp;
mod support_forces;
mod support_gap;
pub(crate) mod surfaces;
mod timed;
mod values;
mod wall;

use std::collections::HashMap;

use cases::scene::{ConstraintRows, Place};
use contact::ContactSurface;
use fem::SurfaceRule;
use geometry::{FaceKind, Facet, Mesh, Point3, Vector3};
use shape::{FixedDof, FluxRows, PointRows, RowSource, SurfaceRows, TraceRows, VolumeRows};
use statics::{
    Assembled, ConstraintRow, Factored, FollowingLoad, LinearBody, LinearProblem, Load, PenaltySurface,
    SolveError, Weak, WeakSupport, multiplier_rows,
};

use crate::discretise::place::tolerance;
use crate::discretise::{Discretisation, Essential, Volume, gradients, node_set, place};
use crate::error::{Failure, Key};
use crate::outcome::{Counters, Plan, StageName};
use crate::scenario::setup::{Setup, Support};
use conditions::Held;
use contact_tables::Touch;
use foundation_tables::OwnedFoundation;
use nodal_patch::{mean_rows, nodal_patches, on_facets};
use own_curves::OwnCurves;
use surfaces::values_of;
use values::{Values, at, not_finite};

pub use means::check_means;
pub use reduced::{Reduced, chosen};
pub use support_forces::ConditionForces;

/// A weakly constrained surface with its tables.
struct OwnedWeak {
    flux: FluxRows,
    axes: [bool; 3],
    values: Vec<Vector3>,
    region: Vec<u16>,
    method: Weak,
    trace: Option<TraceRows>,
}

/// A surface constrained by penalty in a static procedure, with its table.
struct OwnedPenalty {
    surface: SurfaceRows,
    axes: [bool; 3],
    values: Vec<Vector3>,
    beta: f64,
}

/// First prescribed value (m) of each vertex, axis, and part of the loading.
type FirstValues = HashMap<(u32, usize, Option<[u64; 2]>), f64>;

/// All tables of one run.
pub struct Prepared {
    /// Source of further tables.
    pub source: Box<dyn RowSource>,
    /// The volume tables.
    pub volume: Volume,
    /// Mean node spacing, m.
    pub spacing: f64,
    surfaces: Vec<(SurfaceRows, Values)>,
    /// Pressures and tractions on the deformed surface.
    following: Vec<FollowingLoad>,
    body_force: Vec<Vec<Vector3>>,
    /// Nodal forces of forces at points, by curve, and of a problem in files, N.
    nodal: Vec<Vec<Vector3>>,
    fixed: Vec<FixedDof>,
    constraints: Vec<ConstraintRow>,
    /// Whether the constraints are eliminated instead of being enforced by multipliers.
    eliminates: bool,
    weak: Vec<OwnedWeak>,
    penalties: Vec<OwnedPenalty>,
    foundations: Vec<OwnedFoundation>,
    /// The conditions that belong to each support.
    held: Vec<Held>,
    /// Contact tables; `None` without tools.
    touch: Option<Touch>,
    own_curves: OwnCurves,
    /// The reduced model, if the method has one.
    pub reduced: Option<Reduced>,
}

/// Fills all tables in the plan.
///
/// # Errors
/// Returns an error if a support or load touches nothing of the body or has a value that is not finite, if
/// supports contradict each other, or if the method cannot enforce or integrate the conditions.
pub fn prepare(
    method: &Discretisation,
    setup: &Setup,
    plan: &Plan,
    counters: &mut Counters,
) -> Result<Prepared, Failure> {
    let (source, mut volume) = method.volume(&setup.alike(), plan, counters)?;
    volume.axes = axes::axes(method, &*source, &volume, setup)?;
    let spacing = source.spacing(&volume.rows);
    let mut prepared = Prepared {
        source,
        volume,
        spacing,
        surfaces: Vec::new(),
        following: Vec::new(),
        body_force: Vec::new(),
        nodal: Vec::new(),
        fixed: Vec::new(),
        constraints: Vec::new(),
        eliminates: matches!(method.essential, Essential::Elimination(_)),
        weak: Vec::new(),
        penalties: Vec::new(),
        foundations: Vec::new(),
        held: Vec::new(),
        touch: None,
        own_curves: OwnCurves::default(),
        reduced: None,
    };
    for load in &setup.loads {
        prepared.load(method, load)?;
        prepared.time_loads(&load.curve);
    }
    prepared.found(method, &setup.foundations)?;
    if plan.runs(StageName::Elimination) || plan.runs(StageName::WeakSupports) {
        prepared.constrain(method, &setup.supports)?;
    }
    prepared.time_all(setup);
    counters.surface_rows += prepared.surfaces.iter().map(|(s, _)| s.weights().len() as u64).sum::<u64>();
    counters.surface_rows += prepared.following.iter().map(|p| p.len() as u64).sum::<u64>();
    counters.flux_rows += prepared.weak.iter().map(|w| w.values.len() as u64).sum::<u64>();
    let constraints = prepared.constraints.len() as u64;
    *(if prepared.eliminates { &mut counters.eliminated_rows } else { &mut counters.multiplier_rows }) +=
        constraints;
    counters.fixed_dofs += prepared.fixed.len() as u64;
    if setup.solves_by_newton() {
        prepared.penalise(setup)?;
    }
    if plan.runs(StageName::Contact) {
        let touch = Touch::new(&*prepared.source, &setup.tools)?;
        let points = touch.surface.weights().len() as u64;
        counters.contact_points += points;
        counters.friction_points +=
            points * setup.tools.iter().filter(|t| t.tool.law().friction() > 0.0).count() as u64;
        prepared.touch = Some(touch);
    }
    Ok(prepared)
}

impl Prepared {
    /// Returns the weak supports for the solver, then the springs.
    pub fn weak(&self) -> Vec<WeakSupport<'_>> {
        self.weak
            .iter()
            .map(|w| WeakSupport {
                flux: &w.flux,
                axes: w.axes,
                values: w.values.clone(),
                region: &w.region,
                method: w.method,
                h: self.spacing,
                trace: w.trace.as_ref(),
            })
            .chain(self.foundations.iter().filter_map(OwnedFoundation::weak))
            .collect()
    }

    /// Returns the contact points, m; none without tools.
    pub fn contact_points(&self) -> &[Point3] {
        self.touch.as_ref().map_or(&[], |touch| touch.surface.points())
    }

    /// Returns the contact surface for the solver; `None` without tools.
    pub fn contact(&self) -> Option<ContactSurface<'_>> {
        self.touch.as_ref().map(Touch::contact)
    }

    /// Returns the prescribed degrees of freedom.
    pub fn fixed(&self) -> &[FixedDof] {
        &self.fixed
    }

    /// Iterates over the prescribed degrees of freedom of supports that act throughout the loading.
    pub fn always_fixed(&self) -> impl Iterator<Item = &FixedDof> {
        let always = |index: usize| !matches!(self.own_curves.fixed_during.get(index), Some(Some(_)));
        self.fixed.iter().enumerate().filter(move |(index, _)| always(*index)).map(|(_, dof)| dof)
    }

    /// Returns the surfaces constrained by penalty in a static procedure, then those on springs and dampers,
    /// for the solver.
    pub fn penalties(&self) -> Vec<PenaltySurface<'_>> {
        self.penalties
            .iter()
            .map(|h| PenaltySurface {
                surface: &h.surface,
                axes: h.axes,
                along_normal: false,
                values: h.values.clone(),
                from: Vec::new(),
                beta: h.beta,
                damping: 0.0,
            })
            .chain(self.foundations.iter().map(OwnedFoundation::penalty))
            .collect()
    }

    /// Returns the whole linear problem.
    pub fn problem<'a>(
        &'a self,
        nodes: &'a [Point3],
        setup: &'a Setup,
        loads: &'a [Load<'a>],
        weak: &'a [WeakSupport<'a>],
    ) -> LinearProblem<'a> {
        let body = LinearBody {
            nodes,
            volume: &self.volume.rows,
            materials: &setup.materials,
            region: &self.volume.region,
            dilation: self.volume.groups.as_ref(),
        };
        LinearProblem { body, loads, fixed: &self.fixed, constraints: &self.constraints, weak }
    }

    /// Factors the assembled problem, with the constraints eliminated or as multipliers.
    ///
    /// # Errors
    /// Returns an error if the matrix is singular or too large.
    pub fn factor<'a>(&self, assembled: Assembled<'a>) -> Result<Factored<'a>, SolveError> {
        if self.eliminates { assembled.factor_eliminated() } else { assembled.factor() }
    }

    /// Whether the problem has constraint rows.
    pub fn has_rows(&self) -> bool {
        !self.constraints.is_empty()
    }

    /// Whether all essential conditions are prescribed at nodes.
    pub fn holds_nodes_alone(&self) -> bool {
        self.constraints.is_empty()
            && self.weak.is_empty()
            && self.penalties.is_empty()
            && self.foundations.is_empty()
    }

    /// Returns a finer quadrature than the method's own, for error norms and consistent masses, and the
    /// region of each point if there are several regions.
    ///
    /// # Errors
    /// Returns an error if the shape functions cannot be evaluated at the finer points.
    pub fn fine_volume(&self) -> Result<(VolumeRows, Vec<u16>), Failure> {
        let regions = self.source.mesh().region_names().len() > 1;
        let region = if regions { self.source.fine_regions() } else { Vec::new() };
        Ok((self.source.fine_volume()?, region))
    }

    /// Returns the linear shape functions of the mesh nodes at the surface points of the facets: a multiplier
    /// basis.
    fn multiplier_basis(&self, facets: &[Facet]) -> Result<SurfaceRows, Failure> {
        let rule = SurfaceRule::STANDARD.with(FaceKind::Tri3, self.source.face_points())?;
        Ok(fem::surface_rows(self.source.mesh(), facets, &rule)?)
    }

    /// Returns the loads on the deformed surface, for the solver.
    pub fn following(&self) -> &[FollowingLoad] {
        &self.following
    }

    /// Applies all supports.
    fn constrain(&mut self, method: &Discretisation, supports: &[Support]) -> Result<(), Failure> {
        agreement::check(supports, method.mesh())?;
        let mut first = HashMap::new();
        for support in supports {
            let from = self.conditions();
            match &method.essential {
                Essential::Nodal => {
                    self.constrain_nodes(method.mesh(), support, &mut first, |vertex| vertex)?;
                }
                Essential::Coupling(coupled) => {
                    self.constrain_nodes(method.mesh(), support, &mut first, |vertex| coupled.node(vertex))?;
                }
                Essential::Multipliers => self.constrain_rows(method, support, None)?,
                Essential::Elimination(rows) => self.constrain_rows(method, support, Some(*rows))?,
                Essential::Nitsche(gamma) => {
                    self.constrain_weakly(method, support, (Weak::Nitsche { gamma: *gamma }, *gamma))?;
                }
                Essential::Penalty(factor) => {
                    self.constrain_weakly(method, support, (Weak::Penalty { factor: *factor }, *factor))?;
                }
            }
            self.hold(support, from);
            self.time_supports(&support.curve, support.during);
        }
        Ok(())
    }

    /// Constrains the mesh vertices in the place of a support; `node` maps a vertex to its node. Among values
    /// that differ by rounding the first is used.
    fn constrain_nodes(
        &mut self,
        mesh: &Mesh,
        support: &Support,
        first: &mut FirstValues,
        node: impl Fn(u32) -> u32,
    ) -> Result<(), Failure> {
        let vertices = node_set::nodes(&support.key, &support.place, mesh)?;
        if vertices.is_empty() {
            return Err(place::empty(&support.key, &support.place, mesh));
        }
        let span = support.during.map(|span| span.map(f64::to_bits));
        for vertex in vertices {
            let value =
                (support.value)(&mesh.points()[vertex as usize]).map_err(not_finite(&support.key, "move"))?;
            for axis in (0..3).filter(|&a| support.axes[a]) {
                let value = *first.entry((vertex, axis, span)).or_insert(value[axis]);
                self.fixed.push(FixedDof { node: node(vertex), axis: axis as u8, value });
            }
        }
        Ok(())
    }

    /// Constrains a cloud by rows: those of multipliers, or eliminated ones if `eliminated` says which
    /// displacements they prescribe. The rows are those of the facets of the place and, if the place has a
    /// volume (a clamped end instead of a clamped face), of the nodes in it.
    fn constrain_rows(
        &mut self,
        method: &Discretisation,
        support: &Support,
        eliminated: Option<ConstraintRows>,
    ) -> Result<(), Failure> {
        let patch = place::patch(&support.key, &support.place, method.mesh())?;
        let before = self.constraints.len();
        if !patch.whole.is_empty() {
            let surface = self.source.surface(&patch.whole)?;
            let patches = || nodal_patches(method.nodes(), &surface);
            match eliminated {
                None => {
                    let basis = self.multiplier_basis(&patch.whole)?;
                    let values = at(support, surface.points())?;
                    self.constraints.extend(multiplier_rows(&surface, basis.rows(), support.axes, &values)?);
                }
                Some(ConstraintRows::Means) => {
                    let values = at(support, surface.points())?;
                    self.constraints.extend(mean_rows(&surface, &patches(), support.axes, &values));
                }
                Some(ConstraintRows::Points) => {
                    let points = on_facets(method.nodes(), &patches(), method.mesh(), &patch.whole);
                    let (rows, _) = self.source.at_points(&points)?;
                    self.constraints.extend(collocated(&rows, support.axes, &at(support, &points)?));
                }
            }
        }
        // A cloud cannot satisfy constraints at all volume points, but at its own nodes it can.
        if let Place::Where(_) = support.place {
            let tolerance = tolerance(method.mesh());
            let inside = method.nodes().iter().filter(|x| place::holds(&support.place, x, tolerance));
            let nodes: Vec<Point3> = inside.copied().collect();
            let (rows, _) = self.source.at_points(&nodes)?;
            let values = at(support, &nodes)?;
            self.constraints.extend(collocated(&rows, support.axes, &values));
        }
        let bare = node_set::points(&support.key, &support.place, method.mesh())?;
        if !bare.is_empty() {
            let (rows, _) = self.source.at_points(&bare)?;
            self.constraints.extend(collocated(&rows, support.axes, &at(support, &bare)?));
        }
        if self.constraints.len() == before {
            return Err(place::empty(&support.key, &support.place, method.mesh()));
        }
        Ok(())
    }

    /// Constrains a cloud by a weak condition on the facets of the place, and by a penalty with the same
    /// factor in its volume if the place has one (a clamped end instead of a clamped face).
    fn constrain_weakly(
        &mut self,
        method: &Discretisation,
        support: &Support,
        (weak, factor): (Weak, f64),
    ) -> Result<(), Failure> {
        let patch = place::patch(&support.key, &support.place, method.mesh())?;
        let before = self.weak.len();
        if !patch.whole.is_empty() {
            let is_nitsche = matches!(weak, Weak::Nitsche { .. });
            if is_nitsche {
                place::outer(&support.key, &support.place, method.mesh(), &patch.whole)?;
            }
            let flux = self.source.flux(&patch.whole)?;
            let trace = if is_nitsche { self.source.trace(&patch.whole)? } else { None };
            // A trace replaces these gradients by those of the volume, which are checked already.
            if is_nitsche && trace.is_none() {
                gradients::check(Key::Method("essential"), method.nodes(), flux.at())?;
            }
            self.constrain_flux(method, support, flux, weak, trace)?;
        }
        if let Some(flux) = self.clamped_volume(method, support)? {
            self.constrain_flux(method, support, flux, Weak::Penalty { factor }, None)?;
        }
        if let Some(flux) = self.at_bare_points(method, support)? {
            self.constrain_flux(method, support, flux, Weak::Penalty { factor }, None)?;
        }
        if self.weak.len() == before {
            return Err(place::empty(&support.key, &support.place, method.mesh()));
        }
        Ok(())
    }

    /// Turns weak supports into penalties of `factor E / h`, as in the linear procedure. Newton's method
    /// supports no other weak condition.
    fn penalise(&mut self, setup: &Setup) -> Result<(), Failure> {
        let young = setup.materials[0].young();
        let penalty = |weak: &OwnedWeak| match weak.method {
            Weak::Penalty { factor } => Some(factor * young / self.spacing),
            Weak::Nitsche { .. } | Weak::Spring { .. } => None,
        };
        let betas: Option<Vec<f64>> = self.weak.iter().map(penalty).collect();
        let Some(betas) = betas.filter(|_| self.constraints.is_empty()) else {
            return Err(Failure::unavailable(
                Key::Method("essential"),
                "is not available for a support in Newton's method",
                "take essential = \"penalty\" or \"coupling\"",
            ));
        };
        for (weak, beta) in self.weak.drain(..).zip(betas) {
            let flux = weak.flux;
            let surface = values_of(&flux)?;
            self.penalties.push(OwnedPenalty { surface, axes: weak.axes, values: weak.values, beta });
        }
        Ok(())
    }

    fn constrain_flux(
        &mut self,
        method: &Discretisation,
        support: &Support,
        flux: FluxRows,
        weak: Weak,
        trace: Option<TraceRows>,
    ) -> Result<(), Failure> {
        let values = at(support, flux.points())?;
        let region = if method.has_regions() {
            return Err(Failure::unavailable(
                Key::Method("essential"),
                "imposes supports weakly, which is not available for clouds on a body of several regions",
                "take one region, or essential = \"coupling\"",
            ));
        } else {
            Vec::new()
        };
        self.weak.push(OwnedWeak { flux, axes: support.axes, values, region, method: weak, trace });
        Ok(())
    }
}

/// Builds one constraint row `u(x_c) = g(x_c)` per point and constrained axis.
fn collocated(rows: &PointRows, axes: [bool; 3], values: &[Vector3]) -> Vec<ConstraintRow> {
    let mut out = Vec::new();
    for (c, value) in values.iter().enumerate() {
        let (nodes, phi) = rows.rows().row(c);
        for axis in (0..3).filter(|&a| axes[a]) {
            let terms = nodes.iter().zip(phi).map(|(&n, &v)| (n, axis as u8, v)).collect();
            out.push(ConstraintRow { terms, value: value[axis] });
        }
    }
    out
}
