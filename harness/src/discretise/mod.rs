//! One method on one body: nodes, cells, and the source of its tables. The interface is the same for finite
//! elements and meshless clouds.

use std::sync::Arc;

use cases::scene::{ConstraintRows, Dilation, Goal};
use catalogue::metric::Metric;
use fem::{Elements, VolumeRule};
use geometry::shapes::Shape;
use geometry::{Cloud, Mesh, Point3};
use material::{AtPoint, Law};
use shape::{DilationGroups, HourglassModulus, Matrix3, RowSource, Rows, SourceError, VolumeRows};

pub(crate) mod enriched;
pub(crate) mod gradients;
pub(crate) mod node_set;
pub(crate) mod place;

use crate::adapter::Outside;
use crate::error::Failure;
use crate::error::Key;
use crate::outcome::{Counters, Plan, StageName};

/// Method of enforcing essential conditions.
#[derive(Clone, Debug, PartialEq)]
pub enum Essential {
    /// Exactly: the parameters at the mesh vertices are displacements.
    Nodal,
    /// Symmetric Nitsche method with this stabilisation factor.
    Nitsche(f64),
    /// Penalty method with this factor.
    Penalty(f64),
    /// Lagrange multipliers on the surface.
    Multipliers,
    /// Elimination of one constraint per node of the surface.
    Elimination(ConstraintRows),
    /// Finite elements along the constrained surface, their nodes constrained exactly.
    Coupling(Coupled),
}

/// Finite-element nodes coupled to a cloud.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupled {
    /// Mesh vertices that are finite-element nodes, ascending; they are the last nodes.
    pub vertices: Vec<u32>,
    /// Number of cloud nodes before them.
    pub free: usize,
}

impl Coupled {
    /// Returns the node index of a mesh vertex.
    pub(crate) fn node(&self, vertex: u32) -> u32 {
        (self.free + self.vertices.partition_point(|&v| v < vertex)) as u32
    }
}

/// Refinement of a cloud.
#[derive(Clone)]
pub struct Refine {
    /// Number of refined clouds after the first.
    pub steps: usize,
    /// Largest ratio of coarsest to finest spacing.
    pub ratio: f64,
    /// Seed of the random generator.
    pub seed: u64,
    /// The body that the clouds fill.
    pub shape: Arc<dyn Shape + Send + Sync>,
    /// The present cloud.
    pub cloud: Cloud,
    /// Builds the method on another cloud.
    pub on: Arc<dyn Fn(Cloud) -> Result<Discretisation, Failure> + Send + Sync>,
}

/// Refinement of a mesh until a number is accurate.
#[derive(Clone)]
pub struct Adapt {
    /// The number.
    pub by: Goal,
    /// Relative error at which the refinement ends.
    pub error: f64,
    /// Largest number of meshes.
    pub rounds: usize,
    /// Builds the method on linear tetrahedra, of which its own cells are parts.
    pub on: Arc<dyn Fn(Mesh) -> Result<Discretisation, Failure> + Send + Sync>,
}

/// Integration points inside the body, as far as they are known before the tables are filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InnerPoints {
    /// Points in each cell; 0 for none.
    pub per_cell: usize,
    /// Whether the mesh vertices are integration points.
    pub vertices: bool,
    /// Whether the points form a grid independent of the cells. A region that cuts the surface then contains
    /// some of them.
    pub grid: bool,
}

/// Makes the source of a method's tables.
pub type MakeSource = Arc<dyn Fn() -> Result<Box<dyn RowSource>, SourceError> + Send + Sync>;

/// One method on one body, before any table is filled.
#[derive(Clone)]
pub struct Discretisation {
    /// Node positions, m.
    pub nodes: Arc<Vec<Point3>>,
    /// The cells with quadrature, facets and regions.
    pub mesh: Arc<Mesh>,
    /// Whether the basis has the Kronecker delta property: nodal parameters are displacements.
    pub interpolates: bool,
    /// Whether shape functions extend across borders between regions.
    pub blends: bool,
    /// Whether supports are so wide that multigrid takes hundreds of iterations.
    pub wide: bool,
    /// Order of the polynomials that the shape functions reproduce: 1 or 2.
    pub order: usize,
    /// Whether the quadrature is reduced: much of the strain between its points has no energy.
    pub reduced: bool,
    /// Method of enforcing essential conditions.
    pub essential: Essential,
    /// Volumetric projection.
    pub dilation: Dilation,
    /// Integration points inside the body.
    pub inner: InnerPoints,
    /// Adaptive refinement of the cloud, if any.
    pub refine: Option<Refine>,
    /// Refinement of the mesh until a number is accurate, if wanted.
    pub adapt: Option<Adapt>,
    /// Description of the support search; `None` if the cells give the neighbours.
    pub supports: Option<String>,
    /// Description of the shape functions and their evaluation points.
    pub shape_functions: String,
    /// Creates the source of the tables.
    pub source: MakeSource,
    /// The external solver; `None` if this program solves the problem.
    pub(crate) outside: Option<Arc<Outside>>,
}

/// The volume tables of a discretisation.
pub struct Volume {
    /// The quadrature.
    pub rows: VolumeRows,
    /// Region of each point; empty if the body has one region.
    pub region: Vec<u16>,
    /// Axes of the material at each point, as columns: fibre, sheet and normal. Empty if no law depends on
    /// them.
    pub axes: Vec<Matrix3>,
    /// Groups of points that share a dilation.
    pub groups: Option<DilationGroups>,
    /// Shape values of the pressure field at the points, if the method has a pressure field.
    pub pressure: Option<Rows>,
    /// Diagnostics of building the rows.
    pub diagnostics: Vec<(&'static Metric, f64)>,
}

impl Volume {
    /// Returns the region of a point.
    pub fn region(&self, q: usize) -> usize {
        region_at(&self.region, q)
    }

    /// Returns the law at a point, of those of the regions, with the active stress of its region (Pa); none if
    /// `active` is empty.
    pub fn law<'a>(&'a self, laws: &'a [Law], active: &[f64], q: usize) -> AtPoint<'a> {
        let region = self.region(q);
        let law = AtPoint::new(&laws[region], self.axes.get(q));
        active.get(region).map_or(law, |active| law.contracting(*active))
    }
}

/// Returns the region of a point from the list of all points, which is empty if the body has one region.
pub(crate) fn region_at(region: &[u16], q: usize) -> usize {
    region.get(q).map_or(0, |&region| usize::from(region))
}

impl Discretisation {
    /// Finite elements with displacements of this order on a mesh.
    pub(crate) fn of_elements(
        mesh: Arc<Mesh>,
        order: usize,
        reduced: bool,
        dilation: Dilation,
    ) -> Discretisation {
        let rule = if reduced { VolumeRule::reduced() } else { VolumeRule::STANDARD };
        Discretisation {
            nodes: Arc::new(mesh.points().to_vec()),
            mesh: mesh.clone(),
            interpolates: true,
            wide: false,
            blends: false,
            order,
            reduced,
            essential: Essential::Nodal,
            dilation,
            inner: InnerPoints { per_cell: 0, vertices: true, grid: false },
            refine: None,
            adapt: None,
            supports: None,
            shape_functions: "one row per Gauss point of each element".into(),
            outside: None,
            source: Arc::new(move || Ok(Box::new(Elements::new(mesh.clone(), rule)))),
        }
    }

    /// Gives hexahedra with one point hourglass control with this coefficient (dimensionless) and
    /// modulus.
    pub(crate) fn controlled(self, coefficient: f64, modulus: HourglassModulus) -> Discretisation {
        let mesh = self.mesh.clone();
        let elements =
            move || Elements::new(mesh.clone(), VolumeRule::reduced()).controlled(coefficient, modulus);
        Discretisation {
            shape_functions: "one row per element, with its mean gradients and hourglass control".into(),
            source: Arc::new(move || Ok(Box::new(elements()))),
            ..self
        }
    }

    /// Returns the node positions, m.
    pub fn nodes(&self) -> &[Point3] {
        &self.nodes
    }

    /// Returns the cells with quadrature, facets and regions.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Whether the body has several regions. If it has one, no region is stored per point.
    pub fn has_regions(&self) -> bool {
        self.mesh.region_names().len() > 1
    }

    /// Finds the supports and fills the volume tables in the plan. `alike` is the material index of each
    /// region.
    ///
    /// # Errors
    /// Returns an error if supports or shape functions cannot be built, if the gradients of a cloud fail
    /// their check, or if the method lacks the required volumetric projection.
    pub(crate) fn volume(
        &self,
        alike: &[u16],
        plan: &Plan,
        counters: &mut Counters,
    ) -> Result<(Box<dyn RowSource>, Volume), Failure> {
        let source = (self.source)()?;
        let quadrature = source.volume()?;
        let (rows, diagnostics) = (quadrature.rows, quadrature.diagnostics);
        if !self.interpolates {
            gradients::check(Key::Method("basis"), self.nodes(), rows.at())?;
        }
        let region = if plan.runs(StageName::Tensors) { source.regions() } else { Vec::new() };
        // Dilation and pressure are discontinuous at the border of two materials.
        let several = alike.iter().any(|&material| material != alike[0]);
        let by_material = |groups: DilationGroups| match several {
            true => {
                let parts: Vec<u16> = region.iter().map(|&r| alike[usize::from(r)]).collect();
                groups.by_part(&parts, rows.weights())
            }
            false => Ok(groups),
        };
        let (mut groups, mut pressure) = (None, None);
        if plan.runs(StageName::Projection) {
            match self.dilation {
                Dilation::Standard => {}
                Dilation::ElementMean => groups = Some(source.cell_dilation()?.ok_or_else(no_cells)?),
                Dilation::NodalMean => groups = Some(by_material(DilationGroups::nodal(&rows)?)?),
                Dilation::NodalNear => groups = Some(by_material(DilationGroups::near(&rows)?)?),
                Dilation::Mixed => pressure = Some(source.pressure(alike, rows.points())?),
            }
        }
        groups.as_ref().map_or(Ok(()), |groups| positive(groups, rows.weights()))?;
        counters.support_radii += source.supports() as u64;
        counters.volume_rows += rows.weights().len() as u64;
        counters.pressure_parameters += pressure.as_ref().map_or(0, Rows::node_count) as u64;
        counters.dilation_groups += groups.as_ref().map_or(0, DilationGroups::len) as u64;
        counters.point_laws += region.len() as u64;
        Ok((source, Volume { rows, region, axes: Vec::new(), groups, pressure, diagnostics }))
    }
}

/// Refuses groups without a positive volume: their mean dilation has no meaning, and negative ones make a
/// body unstable. Functions of second order are negative over most of their support.
fn positive(groups: &DilationGroups, weights: &[f64]) -> Result<(), Failure> {
    let volume = |group: usize| -> f64 {
        let (points, shares) = groups.group(group);
        points.iter().zip(shares).map(|(&point, share)| share * weights[point as usize]).sum()
    };
    // The negation also refuses NaN.
    let Some(bad) = (0..groups.len()).find(|&group| !(volume(group) > 0.0)) else { return Ok(()) };
    let problem = format!(
        "averages over {:.3e} m^3 at node {bad}, where the shape functions are mostly negative; a positive volume is needed",
        volume(bad)
    );
    Err(Failure::unavailable(Key::Method("dilation"), problem, "take \"nodal-near\""))
}

fn no_cells() -> Failure {
    Failure::unavailable(
        Key::Method("dilation"),
        "needs integration points that belong to background cells; those of this rule do not",
        "take dilation = \"nodal-mean\", or rule = \"gauss\" or \"cell-smoothed\"",
    )
}
