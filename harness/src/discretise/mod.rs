//! One method on one body: nodes, cells, and the source of its tables. From here on finite elements and meshless clouds look the
//! same.

use std::sync::Arc;

use cases::scene::ConstraintRows;
use catalogue::metric::Metric;
use geometry::shapes::Shape;
use geometry::{Cloud, Mesh, Point3};
use shape::{DilationGroups, RowSource, Rows, SourceError, VolumeRows};

pub(crate) mod gradients;
pub(crate) mod place;

use crate::Failure;
use crate::adapter::Outside;
use crate::error::Key;
use crate::outcome::{Counters, Plan, StageName};

/// Which quadrature points share a dilation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dilation {
    /// Every point its own: the plain displacement method.
    Standard,
    /// One per element or integration cell.
    Element,
    /// One per node and material, weighted by the shape values.
    Nodal,
    /// The same, each point among the four nodes with the largest values alone.
    Near,
    /// A pressure field of its own in each material, linear between the corners.
    Mixed,
}

/// How essential conditions are enforced.
#[derive(Clone, Debug, PartialEq)]
pub enum Essential {
    /// Exactly: the parameters at the vertices of the mesh are displacements.
    Nodal,
    /// Symmetric Nitsche with this factor.
    Nitsche(f64),
    /// Penalty with this factor.
    Penalty(f64),
    /// Lagrange multipliers on the surface.
    Multipliers,
    /// Elimination of one constraint per node of the surface.
    Elimination(ConstraintRows),
    /// Finite elements along the constrained surface, their nodes constrained exactly.
    Coupling(Coupled),
}

/// What a cloud is coupled to.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupled {
    /// Vertices of the mesh that are nodes of finite elements, ascending; they come last among the nodes.
    pub vertices: Vec<u32>,
    /// Nodes of the cloud that are left before them.
    pub free: usize,
}

impl Coupled {
    /// The node of a vertex.
    pub(crate) fn node(&self, vertex: u32) -> u32 {
        (self.free + self.vertices.partition_point(|&v| v < vertex)) as u32
    }
}

/// Clouds after the first, and what they are placed by.
#[derive(Clone)]
pub struct Refine {
    /// How many.
    pub steps: usize,
    /// Coarsest over finest spacing at most.
    pub ratio: f64,
    /// Seed of the generator.
    pub seed: u64,
    /// The body they fill.
    pub shape: Arc<dyn Shape + Send + Sync>,
    /// The present cloud.
    pub cloud: Cloud,
    /// The method on another cloud.
    pub on: Arc<dyn Fn(Cloud) -> Result<Discretisation, Failure> + Send + Sync>,
}

/// Where a method integrates inside the body, as far as that is known before its tables are filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InnerPoints {
    /// Points in each cell; 0 for none.
    pub per_cell: usize,
    /// Whether the vertices of the mesh are among them.
    pub vertices: bool,
    /// Whether cells are no guide: wherever a surface is cut some points are near.
    pub grid: bool,
}

/// Makes the source of a method's tables.
pub type MakeSource = Arc<dyn Fn() -> Result<Box<dyn RowSource>, SourceError> + Send + Sync>;

/// One method on one body, before any table is filled.
#[derive(Clone)]
pub struct Discretisation {
    /// Positions that nodal parameters belong to, m.
    pub nodes: Arc<Vec<Point3>>,
    /// The cells that carry quadrature, facets and regions.
    pub mesh: Arc<Mesh>,
    /// Whether the basis is Kronecker: nodal parameters are displacements.
    pub interpolates: bool,
    /// Whether shape functions reach across borders between regions.
    pub blends: bool,
    /// Order of the polynomials that the shape functions hold: 1 or 2.
    pub order: usize,
    /// Whether it integrates at so few points that much of the strain between them has no energy.
    pub reduced: bool,
    /// Essential conditions.
    pub essential: Essential,
    /// Volumetric projection.
    pub dilation: Dilation,
    /// Where it integrates.
    pub inner: InnerPoints,
    /// How the cloud follows an error, if it does.
    pub refine: Option<Refine>,
    /// How supports are found; `None` where the cells give the neighbours.
    pub supports: Option<String>,
    /// How shape functions are made and where they are evaluated.
    pub shape_functions: String,
    /// Makes the source of its tables.
    pub source: MakeSource,
    /// Who solves it, where that is not this program.
    pub(crate) outside: Option<Arc<Outside>>,
}

/// The volume tables of a discretisation.
pub struct Volume {
    /// The quadrature.
    pub rows: VolumeRows,
    /// Region of each point; empty where the body is of one.
    pub region: Vec<u16>,
    /// Points that share a dilation.
    pub groups: Option<DilationGroups>,
    /// Shape values of the pressure field at the points, where the method has one.
    pub pressure: Option<Rows>,
    /// What was met as the rows were made.
    pub diagnostics: Vec<(&'static Metric, f64)>,
}

impl Discretisation {
    /// Positions that nodal parameters belong to, m.
    pub fn nodes(&self) -> &[Point3] {
        &self.nodes
    }

    /// The cells that carry quadrature, facets and regions.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Whether the body has several regions; where it has one, none is looked up for any point.
    pub fn has_regions(&self) -> bool {
        self.mesh.region_names().len() > 1
    }

    /// Finds the supports and fills the volume tables that the plan has; `alike` names the material of each
    /// region.
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
        // A dilation, and a pressure, jump at the border of two materials.
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
                Dilation::Element => groups = Some(source.cell_dilation()?.ok_or_else(no_cells)?),
                Dilation::Nodal => groups = Some(by_material(DilationGroups::nodal(&rows)?)?),
                Dilation::Near => groups = Some(by_material(DilationGroups::near(&rows)?)?),
                Dilation::Mixed => pressure = Some(source.pressure(alike)?.ok_or_else(no_pressure)?),
            }
        }
        counters.support_radii += source.supports() as u64;
        counters.volume_rows += rows.weights().len() as u64;
        counters.pressure_parameters += pressure.as_ref().map_or(0, Rows::node_count) as u64;
        counters.dilation_groups += groups.as_ref().map_or(0, DilationGroups::len) as u64;
        counters.point_laws += region.len() as u64;
        Ok((source, Volume { rows, region, groups, pressure, diagnostics }))
    }
}

fn no_cells() -> Failure {
    Failure::unavailable(
        Key::Method("dilation"),
        "wants points that go by background cells, which this integration's do not",
        "take dilation = \"nodal-mean\", or rule = \"gauss\" or \"cell-smoothed\"",
    )
}

fn no_pressure() -> Failure {
    let help = "\"element-mean\", \"nodal-mean\" and \"nodal-near\" are";
    Failure::unavailable(
        Key::Method("dilation"),
        "wants a pressure field, which this family has none of",
        help,
    )
}
