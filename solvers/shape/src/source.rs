//! Sources of tables: the common interface of all families of methods.

use std::error::Error;

use catalogue::metric::Metric;
use geometry::quadrature::Parts;
use geometry::{Facet, Mesh};

use crate::Point3;
use crate::coarser::Coarser;
use crate::dilation::DilationGroups;
use crate::rows::Rows;
use crate::tables::{FluxRows, GradRows, PointRows, SurfaceRows, VolumeRows};
use crate::trace::TraceRows;

/// Error of filling a table; each family has its own errors.
pub type SourceError = Box<dyn Error + Send + Sync>;

/// Quadrature of a method, with diagnostics of its construction.
pub struct Quadrature {
    /// Values, gradients and weights.
    pub rows: VolumeRows,
    /// Diagnostics of the rows, as pairs of metric and value: neighbours, conditioning, lost volume; may be
    /// empty.
    pub diagnostics: Vec<(&'static Metric, f64)>,
}

impl From<VolumeRows> for Quadrature {
    fn from(rows: VolumeRows) -> Quadrature {
        Quadrature { rows, diagnostics: Vec::new() }
    }
}

/// The shape functions of a method on a body. Finite elements and meshless clouds each implement this trait
/// once; assembly, loads, supports, errors and transfer need nothing else of a method.
///
/// Facets and cells are those of [`mesh`](RowSource::mesh): the elements themselves, or the background of a
/// cloud.
pub trait RowSource: Send + Sync {
    /// Returns the cells that define quadrature, facets and regions.
    fn mesh(&self) -> &Mesh;

    /// Returns a size h (m) that halves if all cells or spacings halve; `volume` is the method's own
    /// quadrature.
    fn spacing(&self, volume: &VolumeRows) -> f64;

    /// Returns the number of nodes whose support had to be determined; zero if the cells define the
    /// neighbours.
    fn supports(&self) -> usize {
        0
    }

    /// Computes the method's own quadrature.
    fn volume(&self) -> Result<Quadrature, SourceError>;

    /// Returns the region of each point of the method's own quadrature.
    fn regions(&self) -> Vec<u16>;

    /// Returns the first point of each cell in the method's own quadrature, and at the end the number of all
    /// points; `None` if the points of a cell are not in sequence.
    fn cell_points(&self) -> Option<Vec<usize>>;

    /// Returns one group of points for each cell; `None` if the quadrature is not based on cells.
    fn cell_dilation(&self) -> Result<Option<DilationGroups>, SourceError>;

    /// Returns the shape values of a pressure field at the `points` (m) of the method's own quadrature. The
    /// field is continuous only within a material; `alike` gives the material of each region.
    fn pressure(&self, alike: &[u16], points: &[Point3]) -> Result<Rows, SourceError>;

    /// Returns a coarser mesh whose functions the method's nodes reproduce exactly; `None` if there is none.
    fn coarser(&self) -> Result<Option<Coarser>, SourceError> {
        Ok(None)
    }

    /// Computes a finer quadrature, for error norms and consistent masses.
    fn fine_volume(&self) -> Result<VolumeRows, SourceError>;

    /// Calls `visit` with the finer quadrature, in blocks if the source can compute it so: all of its rows
    /// take several times the memory of the method's own.
    fn fine_blocks(&self, visit: &mut dyn FnMut(&VolumeRows)) -> Result<(), SourceError> {
        visit(&self.fine_volume()?);
        Ok(())
    }

    /// Returns the region of each point of the finer quadrature.
    fn fine_regions(&self) -> Vec<u16>;

    /// Computes shape values on facets.
    fn surface(&self, facets: &[Facet]) -> Result<SurfaceRows, SourceError>;

    /// Computes shape values on facets for quantities that vary over the facets and need not be smooth.
    fn field_surface(&self, facets: &[Facet]) -> Result<SurfaceRows, SourceError> {
        self.surface(facets)
    }

    /// Computes shape values on the whole outer boundary, which tools may touch, with the points on parts of
    /// the facets: a division for each boundary facet, or an empty list for whole facets.
    fn contact_surface(&self, parts: &[Parts]) -> Result<SurfaceRows, SourceError>;

    /// Computes shape values at the nodes of facets in ascending order, then at the centre of each facet.
    /// They form no quadrature but describe the position of the boundary.
    fn outline(&self, facets: &[Facet]) -> Result<PointRows, SourceError>;

    /// Computes shape values and gradients on facets, for essential conditions by Nitsche's method.
    fn flux(&self, facets: &[Facet]) -> Result<FluxRows, SourceError>;

    /// Expresses gradients smoothed over cells on facets; `None` if the gradients are those of the shape
    /// functions.
    fn trace(&self, _facets: &[Facet]) -> Result<Option<TraceRows>, SourceError> {
        Ok(None)
    }

    /// Returns the number of points on a triangular facet of [`surface`](RowSource::surface).
    fn face_points(&self) -> usize;

    /// Computes shape values at points of the body, and the number of points that lie outside and take the
    /// value of the nearest point.
    fn at_points(&self, points: &[Point3]) -> Result<(PointRows, usize), SourceError>;

    /// Computes shape values and gradients at points, as [`at_points`](RowSource::at_points) does.
    fn gradients_at(&self, points: &[Point3]) -> Result<GradRows, SourceError>;
}
