//! One method on one body: nodes, cells, and the tables they fill. From here on finite elements and meshless clouds
//! look the same.

use std::sync::Arc;

use cases::scene::ConstraintRows;
use efg::{Approximation, Basis, EfgError, Kernel, MlsInfo, Smoothing, Support};
use fem::{SurfaceRule, VolumeRule};
use geometry::shapes::Shape;
use geometry::{Cloud, FaceKind, Facet, Mesh, Point3};
use shape::{DilationGroups, FluxRows, GradRows, PointRows, Rows, SurfaceRows, TraceRows, VolumeRows};

pub(crate) mod place;

use crate::Failure;
use crate::error::Key;
use crate::outcome::Counters;

/// Which quadrature points share a dilation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dilation {
    /// Every point its own: the plain displacement method.
    Standard,
    /// One per element or integration cell.
    Element,
    /// One per node, shared out by the shape values.
    Nodal,
    /// A pressure field of its own, linear between the corners.
    Mixed,
}

/// How a cloud is integrated over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// Gauss points in each background cell.
    Gauss {
        /// Points per tetrahedron.
        points: usize,
    },
    /// Gauss points in the cells of a regular grid, those outside the body dropped.
    Grid {
        /// Edge of a grid cell, m.
        spacing: f64,
        /// Points along each axis of a cell.
        points: usize,
    },
    /// Conforming cell smoothing: gradients inside a tetrahedron from values on its faces.
    CellSmoothed {
        /// Gradients inside a tetrahedron: constant or linear.
        smoothing: Smoothing,
        /// Points per triangular face.
        face_points: usize,
    },
    /// Node smoothing: gradients at each vertex of the background, the mean of those of the cells around.
    NodeSmoothed {
        /// Share of the weight that the cells keep.
        stabilisation: f64,
        /// Points per triangular face.
        face_points: usize,
    },
}

/// How a cloud is held.
#[derive(Clone, Debug, PartialEq)]
pub enum Essential {
    /// Symmetric Nitsche with this factor.
    Nitsche(f64),
    /// Penalty with this factor.
    Penalty(f64),
    /// Lagrange multipliers on the surface.
    Multipliers,
    /// Elimination of one constraint per node of the surface.
    Elimination(ConstraintRows),
    /// Finite elements along what is held, their nodes held exactly.
    Coupling(Coupled),
}

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
    /// Local maximum entropy with this `beta h^2`.
    MaximumEntropy {
        /// Locality.
        gamma: f64,
    },
}

impl Functions {
    /// Shape functions over a cloud; their supports follow the cells of `followed`, where that is given.
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

/// Finite elements on a mesh.
#[derive(Clone)]
pub struct Fem {
    /// The mesh; its nodes are the method's.
    pub mesh: Mesh,
    /// Volumetric projection.
    pub dilation: Dilation,
    /// Quadrature.
    pub rule: VolumeRule,
}

/// Element-free Galerkin on a cloud.
#[derive(Clone)]
pub struct Efg {
    /// The nodes with their spacing.
    pub cloud: Cloud,
    /// Linear tetrahedra that fill the body.
    pub background: Mesh,
    /// The body in closed form, where it has one.
    pub shape: Option<Arc<dyn Shape + Send + Sync>>,
    /// How the cloud follows an error, if it does.
    pub refine: Option<Refine>,
    /// The mesh whose nodes the cloud is, where supports are ellipsoids that follow its cells.
    pub followed: Option<Box<Mesh>>,
    /// Shape functions.
    pub functions: Functions,
    /// Integration.
    pub integration: Integration,
    /// Essential conditions.
    pub essential: Essential,
    /// Volumetric projection.
    pub dilation: Dilation,
}

/// What a cloud is coupled to.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupled {
    /// Vertices of the background that are nodes of finite elements, ascending.
    pub vertices: Vec<u32>,
    /// Positions of all nodes, m: those left of the cloud, then the vertices.
    pub nodes: Vec<Point3>,
}

/// One method on one body.
#[derive(Clone)]
#[allow(clippy::large_enum_variant, reason = "a run has one, never an array of them")]
pub enum Discretisation {
    /// Finite elements.
    Fem(Fem),
    /// Element-free Galerkin.
    Efg(Efg),
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
    /// The cloud's approximation; `None` for elements.
    pub approximation: Option<Approximation>,
    /// What moving least squares met; `None` for elements.
    pub mls: Option<MlsInfo>,
    /// Volume that the grid rule lost or gained, relative; `None` for other rules.
    pub volume_error: Option<f64>,
}

impl Discretisation {
    /// Positions that nodal parameters belong to, m.
    pub fn nodes(&self) -> &[Point3] {
        match self {
            Discretisation::Fem(fem) => fem.mesh.points(),
            Discretisation::Efg(efg) => efg.coupled().map_or(&efg.cloud.points, |c| &c.nodes),
        }
    }

    /// The mesh that carries facets and regions: the elements, or the background cells.
    pub fn mesh(&self) -> &Mesh {
        match self {
            Discretisation::Fem(fem) => &fem.mesh,
            Discretisation::Efg(efg) => &efg.background,
        }
    }

    /// Size h of the discretisation, m, such that halving every cell halves it: for elements the edge of a cube of the
    /// mean cell's volume (six tetrahedra to a cube), for a cloud its mean spacing. A size from the number of nodes would
    /// not do: on coarse meshes it falls more slowly than the cells and flatters the observed order by up to 15 %.
    pub fn spacing(&self, volume: &VolumeRows) -> f64 {
        match self {
            Discretisation::Fem(fem) => {
                let cubes: f64 = (0..fem.mesh.cell_count())
                    .map(|c| if fem.mesh.kind(c).is_tet() { 1.0 / 6.0 } else { 1.0 })
                    .sum();
                (volume.weights().iter().sum::<f64>() / cubes).cbrt()
            }
            Discretisation::Efg(efg) => {
                efg.cloud.spacing.iter().sum::<f64>() / efg.cloud.spacing.len() as f64
            }
        }
    }

    /// Fills the volume tables (and, for a cloud, builds the supports first).
    pub fn volume(&self, counters: &mut Counters) -> Result<Volume, Failure> {
        let volume = match self {
            Discretisation::Fem(fem) => {
                let rows = fem::volume_rows(&fem.mesh, &fem.rule)?;
                let groups = match fem.dilation {
                    Dilation::Standard | Dilation::Mixed => None,
                    Dilation::Element => Some(fem::element_dilation(&fem.mesh, &fem.rule)?),
                    Dilation::Nodal => Some(DilationGroups::nodal(&rows)?),
                };
                let pressure = match fem.dilation {
                    Dilation::Mixed => Some(fem::pressure_rows(&fem.mesh, &fem.rule)?),
                    _ => None,
                };
                let region = of_regions(&fem.mesh, |mesh| fem::regions(mesh, &fem.rule));
                Volume { rows, region, groups, pressure, approximation: None, mls: None, volume_error: None }
            }
            Discretisation::Efg(efg) => efg.volume(counters)?,
        };
        counters.volume_rows += volume.rows.weights().len() as u64;
        counters.pressure_parameters += volume.pressure.as_ref().map_or(0, Rows::node_count) as u64;
        counters.dilation_groups += volume.groups.as_ref().map_or(0, DilationGroups::len) as u64;
        counters.point_laws += volume.region.len() as u64;
        Ok(volume)
    }

    /// Points in each cell, where the quadrature goes by cells of one kind: those of a cell stand together.
    pub fn points_per_cell(&self, volume: &Volume) -> Option<usize> {
        let by_cells = match self {
            Discretisation::Fem(fem) => fem.mesh.uniform_kind().is_some(),
            Discretisation::Efg(efg) => efg.by_cells(),
        };
        by_cells.then(|| volume.rows.weights().len() / self.mesh().cell_count())
    }

    /// Values on facets, with the method's own surface rule.
    pub fn surface(&self, volume: &Volume, facets: &[Facet]) -> Result<SurfaceRows, Failure> {
        match (self, &volume.approximation) {
            (Discretisation::Efg(efg), Some(approximation)) => {
                Ok(efg::surface_rows(approximation, &efg.background, facets, efg.face_points())?.0)
            }
            _ => Ok(fem::surface_rows(self.mesh(), facets, &SurfaceRule::FINE)?),
        }
    }

    /// Values on the whole outer boundary, where tools may touch: 3 points per linear triangle and 2 x 2 per quadrilateral
    /// (on a kidney of 1331 nodes between two jaws, more change the force by 0.1 %), 16 and 5 x 5 per quadratic face (with
    /// 3 x 3 on hex20 of 3519 nodes the force was 1.1 % lower where the jaw's edge crosses the faces). Smoothed gradients want their own face points there: a
    /// block of smoothed cells between two plates came out 3 % too wide with three contact points on faces of one.
    pub fn contact_surface(&self, volume: &Volume) -> Result<SurfaceRows, Failure> {
        let facets = self.mesh().boundary();
        match (self, &volume.approximation) {
            (Discretisation::Efg(efg), Some(approximation)) => {
                let points = match efg.integration {
                    Integration::CellSmoothed { face_points, .. }
                    | Integration::NodeSmoothed { face_points, .. } => face_points,
                    _ => SurfaceRule::STANDARD.points(FaceKind::Tri3),
                };
                Ok(efg::surface_rows(approximation, &efg.background, &facets, points)?.0)
            }
            _ => {
                let quadratic = self.mesh().uniform_kind().is_some_and(|kind| kind.order() == 2);
                let rule = if quadratic { SurfaceRule::FINE } else { SurfaceRule::STANDARD };
                Ok(fem::surface_rows(self.mesh(), &facets, &rule)?)
            }
        }
    }

    /// Values and gradients on facets, for weak supports.
    pub fn flux(&self, volume: &Volume, facets: &[Facet]) -> Result<FluxRows, Failure> {
        match (self, &volume.approximation) {
            (Discretisation::Efg(efg), Some(approximation)) => {
                Ok(efg::flux_rows(approximation, &efg.background, facets, efg.face_points())?.0)
            }
            _ => Ok(fem::flux_rows(self.mesh(), facets, &SurfaceRule::FINE)?),
        }
    }

    /// Values at points of the body. Points outside an element mesh (a coarse mesh is smaller than its curved body)
    /// take the value at the nearest point of its surface; their number is returned.
    pub fn at_points(&self, volume: &Volume, points: &[Point3]) -> Result<(PointRows, usize), Failure> {
        match &volume.approximation {
            Some(approximation) => Ok((approximation.point_rows(points)?.0, 0)),
            None => {
                let (rows, outside) = fem::nearest_point_rows(self.mesh(), points)?;
                Ok((rows, outside.points.len()))
            }
        }
    }

    /// Values and gradients at points, as [`Discretisation::at_points`].
    pub fn gradients_at(&self, volume: &Volume, points: &[Point3]) -> Result<GradRows, Failure> {
        match &volume.approximation {
            Some(approximation) => Ok(approximation.grad_rows(points)?.0),
            None => Ok(fem::nearest_grad_rows(self.mesh(), points)?.0),
        }
    }

    /// A quadrature finer than the solver's own, for error norms.
    pub fn error_rows(&self, volume: &Volume) -> Result<(VolumeRows, Vec<u16>), Failure> {
        match (self, &volume.approximation) {
            (Discretisation::Efg(efg), Some(approximation)) => {
                let (rows, _) = efg::gauss_rows(approximation, &efg.background, ERROR_POINTS)?;
                Ok((rows, of_regions(&efg.background, |mesh| efg::gauss_regions(mesh, ERROR_POINTS))))
            }
            _ => {
                let rule = &VolumeRule::FINE;
                let region = of_regions(self.mesh(), |mesh| fem::regions(mesh, rule));
                Ok((fem::volume_rows(self.mesh(), rule)?, region))
            }
        }
    }
}

/// The region of each point where there are several; where there is one, nothing is looked up for any point.
fn of_regions(mesh: &Mesh, points: impl Fn(&Mesh) -> Vec<u16>) -> Vec<u16> {
    if mesh.region_names().len() > 1 { points(mesh) } else { Vec::new() }
}

/// Points per background tetrahedron of the error quadrature of clouds (degree 5).
const ERROR_POINTS: usize = 14;

impl Efg {
    /// The finite-element nodes, where essential conditions are held by such.
    pub fn coupled(&self) -> Option<&Coupled> {
        match &self.essential {
            Essential::Coupling(coupled) => Some(coupled),
            _ => None,
        }
    }

    fn volume(&self, counters: &mut Counters) -> Result<Volume, Failure> {
        let mut approximation = self.functions.over(&self.cloud, self.followed.as_deref())?;
        if let Some(coupled) = self.coupled() {
            approximation = approximation.coupled(&self.background, &coupled.vertices)?;
        }
        counters.support_radii += self.cloud.points.len() as u64;
        let (rows, mls, region, volume_error) = match self.integration {
            Integration::Gauss { points } => {
                let (rows, mls) = efg::gauss_rows(&approximation, &self.background, points)?;
                let region = of_regions(&self.background, |mesh| efg::gauss_regions(mesh, points));
                (rows, mls, region, None)
            }
            Integration::Grid { spacing, points } => {
                let Some(shape) = &self.shape else {
                    return Err(Failure::unavailable(
                        Key::Method("integration.rule"),
                        "clips a grid by a body in closed form; a mesh and an octant have no inside test",
                        "take rule = \"gauss\" or \"cell-smoothed\"",
                    ));
                };
                if self.background.region_names().len() > 1 {
                    return Err(Failure::unavailable(
                        Key::Method("integration.rule"),
                        "does not know the region of a grid's points, and the body has several",
                        "take rule = \"gauss\" or \"cell-smoothed\"",
                    ));
                }
                let [min, max] = shape.bounds();
                let inside = |x: &Point3| shape.inside(x);
                let (rows, grid, mls) = efg::grid_rows(&approximation, inside, (min, max), spacing, points)?;
                (rows, mls, Vec::new(), Some(grid.volume / shape.volume() - 1.0))
            }
            Integration::CellSmoothed { smoothing, face_points } => {
                let (rows, mls) =
                    efg::smoothed_rows(&approximation, &self.background, smoothing, face_points)?;
                (rows, mls, of_regions(&self.background, |mesh| efg::smoothed_regions(mesh, smoothing)), None)
            }
            Integration::NodeSmoothed { stabilisation, face_points } => {
                let (rows, mls) =
                    efg::node_smoothed_rows(&approximation, &self.background, stabilisation, face_points)?;
                let regions = |mesh: &Mesh| efg::node_smoothed_regions(mesh, stabilisation);
                (rows, mls, of_regions(&self.background, regions), None)
            }
        };
        let groups = match self.dilation {
            Dilation::Standard => None,
            Dilation::Element => Some(self.cell_groups(rows.weights().len())?),
            Dilation::Nodal => Some(DilationGroups::nodal(&rows)?),
            Dilation::Mixed => {
                return Err(Failure::unavailable(
                    Key::Method("dilation"),
                    "is not available for clouds",
                    "\"element-mean\" and \"nodal-mean\" are",
                ));
            }
        };
        let (pressure, approximation, mls) = (None, Some(approximation), Some(mls));
        Ok(Volume { rows, region, groups, pressure, approximation, mls, volume_error })
    }

    /// Whether the points go by background cells: those of a cell stand together, equally many in each.
    fn by_cells(&self) -> bool {
        matches!(self.integration, Integration::Gauss { .. } | Integration::CellSmoothed { .. })
    }

    /// One group per background cell.
    fn cell_groups(&self, points: usize) -> Result<DilationGroups, Failure> {
        if !self.by_cells() {
            return Err(Failure::unavailable(
                Key::Method("dilation"),
                "wants points that go by background cells, which this integration's do not",
                "take dilation = \"nodal-mean\", or rule = \"gauss\" or \"cell-smoothed\"",
            ));
        }
        let cells = self.background.cell_count();
        let each = points / cells;
        let offsets = (0..=cells).map(|c| c * each).collect();
        Ok(DilationGroups::new(points, offsets, (0..points as u32).collect(), vec![1.0; points])?)
    }

    /// Face points of surface integrals: those of the smoothing, so that the integration constraint holds to
    /// rounding; 6 (degree 4) for other rules, whose boundary terms shall not be what limits them.
    pub fn face_points(&self) -> usize {
        match self.integration {
            Integration::CellSmoothed { face_points, .. } | Integration::NodeSmoothed { face_points, .. } => {
                face_points
            }
            _ => 6,
        }
    }

    /// What the smoothed gradients are on facets: Nitsche's traction is made of them. Other rules integrate the gradients of
    /// the shape functions themselves, which the facets' own tables hold.
    pub fn trace(&self, facets: &[Facet]) -> Result<Option<TraceRows>, Failure> {
        match self.integration {
            Integration::CellSmoothed { smoothing, face_points } => {
                Ok(Some(efg::smoothed_trace(&self.background, facets, smoothing, face_points)?))
            }
            Integration::NodeSmoothed { stabilisation, face_points } => {
                Ok(Some(efg::node_smoothed_trace(&self.background, facets, stabilisation, face_points)?))
            }
            _ => Ok(None),
        }
    }

    /// Linear shape functions of the background's own nodes at the same face points: the multiplier basis.
    pub fn multiplier_basis(&self, facets: &[Facet]) -> Result<SurfaceRows, Failure> {
        let rule = SurfaceRule::STANDARD.with(FaceKind::Tri3, self.face_points())?;
        Ok(fem::surface_rows(&self.background, facets, &rule)?)
    }
}
