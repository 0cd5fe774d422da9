//! A cloud as a source of tables: its shape functions over a background mesh for integration.

use std::sync::Arc;

use catalogue::metric::{self, Metric};
use geometry::quadrature::Parts;
use geometry::shapes::Shape;
use geometry::{Cloud, Facet, Mesh, locate};
use shape::{
    DilationGroups, FluxRows, GradRows, Point3, PointRows, Quadrature, RowSource, Rows, SourceError,
    SurfaceRows, TraceRows, Vector3, VolumeRows,
};

use crate::approximation::Approximation;
use crate::basis::Basis;
use crate::error::EfgError;
use crate::facets::{divided_surface_rows, flux_rows, surface_rows};
use crate::gauss::{gauss_regions, gauss_rows};
use crate::grid::grid_rows;
use crate::info::MlsInfo;
use crate::kernel::Kernel;
use crate::node_smoothed::{node_smoothed_regions, node_smoothed_rows, node_smoothed_trace};
use crate::pressure::pressure_rows;
use crate::smoothed::{Smoothing, smoothed_regions, smoothed_rows, smoothed_trace};
use crate::support::Support;

/// The shape functions of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Functions {
    /// Moving least squares.
    MovingLeastSquares {
        /// Kernel.
        kernel: Kernel,
        /// Basis.
        basis: Basis,
        /// Supports.
        support: Support,
    },
    /// Local maximum entropy with this dimensionless locality `gamma = beta h^2`.
    MaximumEntropy {
        /// Locality `gamma`, dimensionless.
        gamma: f64,
    },
}

impl Functions {
    /// Builds the shape functions over a cloud; supports are adapted to the cells of `followed` if it is
    /// given.
    fn over(self, cloud: &Cloud, followed: Option<&Mesh>) -> Result<Approximation, EfgError> {
        let nodes = cloud.points.clone();
        match self {
            Functions::MovingLeastSquares { kernel, basis, support } => match followed {
                Some(mesh) => Approximation::stretched(nodes, support.ellipsoids(mesh)?, kernel, basis),
                None => {
                    let radii = support.radii(&nodes, &cloud.spacing)?;
                    Approximation::new(nodes, radii, kernel, basis)
                }
            },
            Functions::MaximumEntropy { gamma } => {
                Approximation::maximum_entropy(nodes, &cloud.spacing, gamma)
            }
        }
    }
}

/// Integration scheme of a cloud.
#[derive(Clone)]
pub enum Integration {
    /// Gauss points in each background cell.
    Gauss {
        /// Points per tetrahedron.
        points: usize,
    },
    /// Gauss points in the cells of a regular grid, without those outside the body.
    Grid {
        /// Edge of a grid cell, m.
        spacing: f64,
        /// Points along each axis of a cell.
        points: usize,
        /// The body.
        shape: Arc<dyn Shape + Send + Sync>,
    },
    /// Conforming cell smoothing: gradients inside a tetrahedron from values on its faces.
    CellSmoothed {
        /// Gradients inside a tetrahedron: constant or linear.
        smoothing: Smoothing,
        /// Points per triangular face.
        face_points: usize,
    },
    /// Node smoothing: the gradients at a vertex of the background are the mean over the surrounding cells.
    NodeSmoothed {
        /// Fraction of the weight left to the cells.
        stabilisation: f64,
        /// Points per triangular face.
        face_points: usize,
    },
}

impl Integration {
    /// Returns the number of points per background cell if each cell has the same number of points in
    /// sequence, `None` otherwise.
    pub fn points_per_cell(&self) -> Option<usize> {
        match *self {
            Integration::Gauss { points } => Some(points),
            Integration::CellSmoothed { smoothing, .. } => Some(smoothing.points_per_cell()),
            Integration::Grid { .. } | Integration::NodeSmoothed { .. } => None,
        }
    }

    /// Returns the number of face points of smoothed gradients.
    fn smoothed_face_points(&self) -> Option<usize> {
        match *self {
            Integration::CellSmoothed { face_points, .. } | Integration::NodeSmoothed { face_points, .. } => {
                Some(face_points)
            }
            Integration::Gauss { .. } | Integration::Grid { .. } => None,
        }
    }
}

/// Points per background tetrahedron of the error quadrature of clouds (degree 5).
const ERROR_POINTS: usize = 14;

/// Face points of surface integrals with gradients of the shape functions (degree 4). Boundary terms do not
/// limit their accuracy.
const FACE_POINTS: usize = 6;

/// Face points of contact with such gradients: as on linear elements, for which more points change the force
/// by 0.1 %.
const CONTACT_POINTS: usize = 3;

/// Distance from the cells, over the mean spacing of the nodes, beyond which a point takes the value of the
/// nearest point in a cell if its own neighbours do not determine the functions.
const BEYOND: f64 = 0.5;

/// A cloud as a source of tables: its shape functions over a background of linear tetrahedra.
pub struct CloudSource {
    approximation: Approximation,
    /// Number of nodes of the cloud; `spacing` is their mean spacing, m.
    nodes: usize,
    spacing: f64,
    background: Arc<Mesh>,
    integration: Integration,
}

impl CloudSource {
    /// Builds the shape functions of a cloud and their supports over a background of tet4. Supports do not
    /// reach across gaps of the background ([`Approximation::within`]). `integration` selects the quadrature.
    ///
    /// If `followed` is given, moving least squares have ellipsoidal supports adapted to its cells. If
    /// `coupled` is given, these background vertices (ascending) become finite-element nodes. With
    /// `by_region` in addition, nodes contribute only in their own region, and the vertices of borders
    /// between regions also become finite-element nodes. Without `coupled`, `by_region` has no effect.
    ///
    /// # Errors
    /// Invalid supports, and the errors of [`Approximation::new`], [`Approximation::maximum_entropy`],
    /// [`Approximation::within`] and [`Approximation::coupled`].
    pub fn new(
        functions: Functions,
        cloud: &Cloud,
        followed: Option<&Mesh>,
        background: Arc<Mesh>,
        coupled: Option<&[u32]>,
        by_region: bool,
        integration: Integration,
    ) -> Result<CloudSource, EfgError> {
        let mut approximation = functions.over(cloud, followed)?.within(&background)?;
        if let Some(vertices) = coupled {
            approximation = match by_region {
                true => approximation.coupled_by_region(&background, vertices)?,
                false => approximation.coupled(&background, vertices)?,
            };
        }
        let nodes = cloud.points.len();
        let spacing = cloud.spacing.iter().sum::<f64>() / nodes as f64;
        Ok(CloudSource { approximation, nodes, spacing, background, integration })
    }
}

impl CloudSource {
    /// Rows at points, and the number of points beyond the cells that took the value of the nearest point in
    /// a cell. Coarse cells leave out thin parts of a body, in which few nodes are in reach.
    fn near<T>(
        &self,
        points: &[Point3],
        rows: impl Fn(&[Point3]) -> Result<(T, MlsInfo), EfgError>,
    ) -> Result<(T, usize), EfgError> {
        let found = rows(points);
        if found.as_ref().is_ok_and(|(_, info)| info.enlarged == 0) {
            return Ok((found?.0, 0));
        }
        let mut moved = points.to_vec();
        let mut count = 0;
        for (point, place) in moved.iter_mut().zip(locate(&self.background, points)?) {
            if place.outside > BEYOND * self.spacing {
                let corners = self.background.cell_points(place.cell as usize).zip(place.barycentric);
                *point = Point3::from(corners.map(|(corner, part)| corner.coords * part).sum::<Vector3>());
                count += 1;
            }
        }
        match count {
            0 => Ok((found?.0, 0)),
            _ => Ok((rows(&moved)?.0, count)),
        }
    }
}

impl RowSource for CloudSource {
    fn mesh(&self) -> &Mesh {
        &self.background
    }

    fn spacing(&self, _volume: &VolumeRows) -> f64 {
        self.spacing
    }

    fn supports(&self) -> usize {
        self.nodes
    }

    fn volume(&self) -> Result<Quadrature, SourceError> {
        let approximation = &self.approximation;
        let background = &*self.background;
        let mut lost = None;
        let (rows, info) = match &self.integration {
            Integration::Gauss { points } => gauss_rows(approximation, background, *points)?,
            Integration::Grid { spacing, points, shape } => {
                let [min, max] = shape.bounds();
                let inside = |x: &Point3| shape.inside(x);
                let (rows, grid, info) = grid_rows(approximation, inside, (min, max), *spacing, *points)?;
                lost = Some(grid.volume / shape.volume() - 1.0);
                (rows, info)
            }
            Integration::CellSmoothed { smoothing, face_points } => {
                smoothed_rows(approximation, background, *smoothing, *face_points)?
            }
            Integration::NodeSmoothed { stabilisation, face_points } => {
                node_smoothed_rows(approximation, background, *stabilisation, *face_points)?
            }
        };
        let mut diagnostics = diagnostics(&info);
        diagnostics.extend(lost.map(|lost| (&metric::VOLUME_ERROR, lost)));
        Ok(Quadrature { rows, diagnostics })
    }

    /// A grid does not know the region of its points and serves only bodies with a single region.
    fn regions(&self) -> Vec<u16> {
        match self.integration {
            Integration::Gauss { points } => gauss_regions(&self.background, points),
            Integration::Grid { .. } => Vec::new(),
            Integration::CellSmoothed { smoothing, .. } => smoothed_regions(&self.background, smoothing),
            Integration::NodeSmoothed { stabilisation, .. } => {
                node_smoothed_regions(&self.background, stabilisation)
            }
        }
    }

    fn cell_points(&self) -> Option<Vec<usize>> {
        let each = self.integration.points_per_cell()?;
        Some((0..=self.background.cell_count()).map(|cell| each * cell).collect())
    }

    fn cell_dilation(&self) -> Result<Option<DilationGroups>, SourceError> {
        let cells = self.background.cell_count();
        let of_cells = |each| DilationGroups::of_cells(std::iter::repeat_n(each, cells));
        Ok(self.integration.points_per_cell().map(of_cells).transpose()?)
    }

    fn pressure(&self, alike: &[u16], points: &[Point3]) -> Result<Rows, SourceError> {
        let nodes = self.approximation.nodes()[..self.nodes].to_vec();
        Ok(pressure_rows(nodes, &self.background, (&self.regions(), alike), points)?)
    }

    fn fine_volume(&self) -> Result<VolumeRows, SourceError> {
        Ok(gauss_rows(&self.approximation, &self.background, ERROR_POINTS)?.0)
    }

    fn fine_regions(&self) -> Vec<u16> {
        gauss_regions(&self.background, ERROR_POINTS)
    }

    fn surface(&self, facets: &[Facet]) -> Result<SurfaceRows, SourceError> {
        Ok(surface_rows(&self.approximation, &self.background, facets, self.face_points())?.0)
    }

    /// Smoothed gradients need their own face points: a block of smoothed cells between two plates became 3 %
    /// too wide with three contact points on faces with one point.
    fn contact_surface(&self, parts: &[Parts]) -> Result<SurfaceRows, SourceError> {
        let points = self.integration.smoothed_face_points().unwrap_or(CONTACT_POINTS);
        let facets = self.background.boundary();
        Ok(divided_surface_rows(&self.approximation, &self.background, &facets, points, parts)?.0)
    }

    fn outline(&self, facets: &[Facet]) -> Result<PointRows, SourceError> {
        let mesh = &self.background;
        let at = |node: u32| mesh.points()[node as usize];
        let middle = |&facet: &Facet| {
            let nodes = mesh.facet_nodes(facet);
            let count = nodes.len() as f64;
            Point3::from(nodes.map(|node| at(node).coords / count).sum::<Vector3>())
        };
        let nodes = mesh.facet_group_nodes(facets);
        let points: Vec<Point3> =
            nodes.iter().map(|&node| at(node)).chain(facets.iter().map(middle)).collect();
        let cells = || {
            let mut of_nodes = vec![0; mesh.points().len()];
            facets
                .iter()
                .for_each(|&f| mesh.facet_nodes(f).for_each(|node| of_nodes[node as usize] = f.cell));
            nodes.iter().map(|&node| of_nodes[node as usize]).chain(facets.iter().map(|f| f.cell)).collect()
        };
        Ok(self.approximation.point_rows_in(points, Some(&cells))?.0)
    }

    /// Face points of the smoothing, with which the integration constraint holds to rounding.
    fn face_points(&self) -> usize {
        self.integration.smoothed_face_points().unwrap_or(FACE_POINTS)
    }

    fn flux(&self, facets: &[Facet]) -> Result<FluxRows, SourceError> {
        Ok(flux_rows(&self.approximation, &self.background, facets, self.face_points())?.0)
    }

    /// Nitsche's traction is computed from the smoothed gradients.
    fn trace(&self, facets: &[Facet]) -> Result<Option<TraceRows>, SourceError> {
        Ok(match self.integration {
            Integration::CellSmoothed { smoothing, face_points } => {
                Some(smoothed_trace(&self.background, facets, smoothing, face_points)?)
            }
            Integration::NodeSmoothed { stabilisation, face_points } => {
                Some(node_smoothed_trace(&self.background, facets, stabilisation, face_points)?)
            }
            Integration::Gauss { .. } | Integration::Grid { .. } => None,
        })
    }

    fn at_points(&self, points: &[Point3]) -> Result<(PointRows, usize), SourceError> {
        Ok(self.near(points, |points| self.approximation.point_rows(points))?)
    }

    fn gradients_at(&self, points: &[Point3]) -> Result<GradRows, SourceError> {
        Ok(self.near(points, |points| self.approximation.grad_rows(points))?.0)
    }
}

fn diagnostics(info: &MlsInfo) -> Vec<(&'static Metric, f64)> {
    vec![
        (&metric::NEIGHBOURS_MIN, info.neighbours_min as f64),
        (&metric::NEIGHBOURS_MEAN, info.neighbours_mean),
        (&metric::NEIGHBOURS_MAX, info.neighbours_max as f64),
        (&metric::CONDITION_MEDIAN, info.condition_median),
        (&metric::CONDITION_MAX, info.condition_max),
        (&metric::FALLBACKS, info.fallbacks() as f64),
        (&metric::FALLBACKS_ENLARGED, info.enlarged as f64),
        (&metric::FALLBACKS_REGULARISED, info.regularised as f64),
        (&metric::FALLBACKS_REDUCED, info.reduced as f64),
    ]
}
