//! Where tables come from: the one question every family of methods answers.

use std::error::Error;

use catalogue::metric::Metric;
use geometry::quadrature::Parts;
use geometry::{Facet, Mesh};

use crate::{
    Coarser, DilationGroups, FluxRows, GradRows, Point3, PointRows, Rows, SurfaceRows, TraceRows, VolumeRows,
};

/// Why a table can't be filled; each family has errors of its own.
pub type SourceError = Box<dyn Error + Send + Sync>;

/// The quadrature of a method, with what was met as it was made.
pub struct Quadrature {
    /// Values, gradients and weights.
    pub rows: VolumeRows,
    /// Numbers about the rows: neighbours, conditioning, lost volume.
    pub diagnostics: Vec<(&'static Metric, f64)>,
}

impl From<VolumeRows> for Quadrature {
    fn from(rows: VolumeRows) -> Quadrature {
        Quadrature { rows, diagnostics: Vec::new() }
    }
}

/// The shape functions of one method on one body, ready to be evaluated. Finite elements and meshless clouds implement it once
/// each; assembly, loads, supports, errors and transfer ask nothing else of a method.
///
/// Facets and cells are those of [`mesh`](RowSource::mesh): the elements themselves, or the background that a cloud is integrated
/// over.
pub trait RowSource: Send + Sync {
    /// The cells that carry quadrature, facets and regions.
    fn mesh(&self) -> &Mesh;

    /// Size h (m) such that halving every cell or spacing halves it; `volume` is the method's own quadrature.
    fn spacing(&self, volume: &VolumeRows) -> f64;

    /// Nodes whose support had to be found; none where the cells give the neighbours.
    fn supports(&self) -> usize {
        0
    }

    /// The method's own quadrature.
    fn volume(&self) -> Result<Quadrature, SourceError>;

    /// Region of each point of that quadrature.
    fn regions(&self) -> Vec<u16>;

    /// Points of that quadrature in each cell, where it goes by cells of one kind: those of a cell stand together.
    fn points_per_cell(&self) -> Option<usize>;

    /// One group of points for each cell; `None` where the quadrature does not go by cells.
    fn cell_dilation(&self) -> Result<Option<DilationGroups>, SourceError>;

    /// A pressure field, linear between corners, at the points of that quadrature; `None` where the family
    /// has none. It is continuous in each material alone; `alike` names that of each region.
    fn pressure(&self, alike: &[u16]) -> Result<Option<Rows>, SourceError>;

    /// A coarser mesh whose functions the method's nodes hold exactly; `None` where there is none.
    fn coarser(&self) -> Result<Option<Coarser>, SourceError> {
        Ok(None)
    }

    /// A finer quadrature, for error norms and consistent masses.
    fn fine_volume(&self) -> Result<VolumeRows, SourceError>;

    /// Region of each point of the finer quadrature.
    fn fine_regions(&self) -> Vec<u16>;

    /// Values on facets.
    fn surface(&self, facets: &[Facet]) -> Result<SurfaceRows, SourceError>;

    /// Values on facets for what varies over them and need not be smooth.
    fn field_surface(&self, facets: &[Facet]) -> Result<SurfaceRows, SourceError> {
        self.surface(facets)
    }

    /// Values on the whole outer boundary, where tools may touch, with the points on parts of the facets:
    /// parts for each facet of the boundary, or none for whole facets.
    fn contact_surface(&self, parts: &[Parts]) -> Result<SurfaceRows, SourceError>;

    /// Values at the nodes of facets in ascending order, then at the middle of each; they carry no quadrature, but tell where the
    /// boundary is.
    fn outline(&self, facets: &[Facet]) -> Result<PointRows, SourceError>;

    /// Values and gradients on facets, for weak supports.
    fn flux(&self, facets: &[Facet]) -> Result<FluxRows, SourceError>;

    /// What gradients smoothed over cells are on facets; `None` where the gradients are those of the shape functions.
    fn trace(&self, _facets: &[Facet]) -> Result<Option<TraceRows>, SourceError> {
        Ok(None)
    }

    /// Points on a triangular facet of [`surface`](RowSource::surface).
    fn face_points(&self) -> usize;

    /// Values at points of the body, and how many of the points lie outside and took the value of the nearest point.
    fn at_points(&self, points: &[Point3]) -> Result<(PointRows, usize), SourceError>;

    /// Values and gradients at points, as [`at_points`](RowSource::at_points).
    fn gradients_at(&self, points: &[Point3]) -> Result<GradRows, SourceError>;
}
