//! Clouds: nodes, background cells, supports, integration and essential conditions of an element-free method.

use std::sync::Arc;

use cases::scene::{self, ErrorKind};
use efg::{CloudSource, Functions, Integration};
use geometry::shapes::Shape;
use geometry::{CellKind, Cloud, CloudError, Mesh, cloud, cloud_from_mesh, locate};
use shape::{length, position};

use super::{Scenario, body, body_mesh, cloud_file, file_body, grading};
use crate::discretise::{Coupled, Discretisation, Essential, InnerPoints, Refine, node_set, place};
use crate::error::{Failure, Key};

/// Default stabilisation of Nitsche's method with smoothed gradients, times (lambda + 2 mu) / h with h from
/// the trace inequality. The matrix is definite above 1; with 4, half of the energy is left.
const NITSCHE_SMOOTHED: f64 = 4.0;
/// Default stabilisation with other gradients, with h the node spacing. A value of 10 is too small at support
/// scale 1.2 with one point per face and at 2.0 with three. From 20 on the matrix stayed definite.
const NITSCHE: f64 = 100.0;
/// Default penalty, times E / h. A factor ten times as large locks the functions at the edge of a support
/// that ends within a face.
const PENALTY: f64 = 1e3;

/// A body with an inside test, required by grids and by clouds of an exact node count.
type Body = Arc<dyn Shape + Send + Sync>;

/// Placed nodes, the cells for their integration, and the mesh that the nodes come from, if any.
struct Placed {
    cloud: Cloud,
    background: Mesh,
    cells: Option<Mesh>,
}

/// Enforcement of the supports of a method on a cloud.
#[derive(Clone)]
enum Supports {
    /// A method that does not depend on the cloud.
    Enforced(Essential),
    /// Coupling to finite elements at these vertices of the background mesh.
    Coupled(Vec<u32>),
}

impl Supports {
    fn coupled(&self) -> Option<&[u32]> {
        match self {
            Supports::Coupled(vertices) => Some(vertices),
            Supports::Enforced(_) => None,
        }
    }
}

/// An element-free method without its nodes.
#[derive(Clone)]
struct CloudMethod {
    background: Arc<Mesh>,
    /// The mesh that the nodes come from, if supports are ellipsoids that follow its cells.
    followed: Option<Arc<Mesh>>,
    functions: Functions,
    integration: Integration,
    supports: Supports,
    /// Whether nodes act only in their own region.
    separate: bool,
    dilation: scene::Dilation,
    /// Parameters, random seed and body of an adaptively refined cloud.
    refine: Option<(scene::Refine, u64, Body)>,
}

impl Scenario<'_> {
    pub(super) fn cloud(&self, efg: &scene::Efg) -> Result<Discretisation, Failure> {
        let shape = self.shape_for(efg)?;
        let Placed { cloud, background, cells } = self.placed(efg, shape.as_ref())?;
        if efg.background.is_some() || !matches!(efg.cloud, scene::Cloud::Mesh { .. }) {
            in_background(&cloud, &background)?;
        }
        let refine = match (&efg.cloud, &shape) {
            (scene::Cloud::Refined { seed, refine, .. }, Some(shape)) => {
                Some((*refine, *seed, shape.clone()))
            }
            _ => None,
        };
        let adapted = matches!(
            efg.functions,
            scene::Functions::MovingLeastSquares { shape: scene::SupportShape::Ellipsoid, .. }
        );
        let spacing = cloud.spacing.iter().sum::<f64>() / cloud.spacing.len() as f64;
        let separate = efg.regions == scene::Regions::Separate;
        let constrained = self.constrained_vertices(&background);
        let background = Arc::new(self.with_regions(background)?);
        let supports = match essential(efg) {
            Some(essential) => Supports::Enforced(essential),
            None => {
                let mut vertices = constrained?;
                if separate {
                    vertices.extend(efg::border_vertices(&background));
                    vertices.sort_unstable();
                    vertices.dedup();
                }
                Supports::Coupled(vertices)
            }
        };
        let method = CloudMethod {
            integration: integration(efg.integration, spacing, shape, &background)?,
            background,
            followed: cells.filter(|_| adapted).map(Arc::new),
            functions: functions(efg.functions),
            supports,
            separate,
            dilation: efg.dilation,
            refine,
        };
        method.on(cloud)
    }

    /// Returns the body's shape. For a mesh file the shape is built only if the file's cells do not suffice,
    /// because its whole boundary is searched for intersections.
    fn shape_for(&self, efg: &scene::Efg) -> Result<Option<Body>, Failure> {
        let scene::Body::File(file) = &self.scene.body else { return Ok(body::shape(&self.scene.body)) };
        let of_mesh = matches!(efg.cloud, scene::Cloud::Mesh { .. } | scene::Cloud::File { .. });
        let by_cells = of_mesh && !matches!(efg.integration, scene::Integration::Grid { .. });
        if by_cells && !mesh_files::is_surface(&file.path) {
            return Ok(None);
        }
        let shape: Body = file_body::load(file)?.surface.clone();
        Ok(Some(shape))
    }

    /// Places the nodes and makes their background mesh.
    fn placed(&self, efg: &scene::Efg, shape: Option<&Body>) -> Result<Placed, Failure> {
        let bad = |e: CloudError| match e {
            CloudError::TooFew { .. } | CloudError::TooMany { .. } => {
                Failure::input(Key::Size(""), format!("makes no cloud: {e}"), "")
            }
            _ => Failure::at(ErrorKind::NotRun, Key::Size(""), format!("makes no cloud: {e}"), ""),
        };
        let need_shape = || {
            shape.map(|shape| &**shape).ok_or_else(|| {
                Failure::input(
                    Key::Method("nodes"),
                    "places an exact number of nodes, which is not available for an octant",
                    "take the nodes of a mesh instead: size = { level = 2 } or { file = \"...\" }",
                )
            })
        };
        let cells_of = |size: &scene::Size| body_mesh::mesh(&self.scene.body, CellKind::Tet4, size, None);
        let background = |count: usize| match &efg.background {
            Some(size) => cells_of(size).map_err(Failure::of_background),
            None => cells_of(&scene::Size::Nodes(count)),
        };
        Ok(match &efg.cloud {
            scene::Cloud::Mesh { size, jitter } => {
                let mesh = body_mesh::mesh(&self.scene.body, CellKind::Tet4, size, *jitter)?;
                let background = match &efg.background {
                    Some(size) => cells_of(size).map_err(Failure::of_background)?,
                    None => mesh.clone(),
                };
                Placed { cloud: cloud_from_mesh(&mesh), background, cells: Some(mesh) }
            }
            scene::Cloud::File { file, nodes } => {
                let read = cloud_file::read(file, *nodes)?;
                let background = background(read.cloud.points.len())?;
                read.within(shape.map(|shape| &**shape), &background)?;
                Placed { cloud: read.cloud, background, cells: read.mesh }
            }
            scene::Cloud::Uniform { nodes, seed } | scene::Cloud::Refined { nodes, seed, .. } => {
                let cloud = cloud(need_shape()?, *nodes, *seed, &[]).map_err(bad)?;
                Placed { cloud, background: background(*nodes)?, cells: None }
            }
            scene::Cloud::Graded { nodes, seed, towards } => {
                let shape = need_shape()?;
                let refinement = grading::refinement(shape, towards)?;
                let cloud = cloud(shape, *nodes, *seed, &[refinement]).map_err(bad)?;
                Placed { cloud, background: background(*nodes)?, cells: None }
            }
        })
    }

    /// Returns all background vertices on the scene's supports, ascending.
    fn constrained_vertices(&self, background: &Mesh) -> Result<Vec<u32>, Failure> {
        let mut vertices = Vec::new();
        for (index, support) in self.scene.supports.iter().enumerate() {
            let key = format!("support[{index}]");
            place::whole(&key, &support.place, background)?;
            vertices.extend(node_set::nodes(&key, &support.place, background)?);
        }
        vertices.sort_unstable();
        vertices.dedup();
        Ok(vertices)
    }
}

impl CloudMethod {
    /// Discretises the method on a cloud.
    fn on(&self, cloud: Cloud) -> Result<Discretisation, Failure> {
        let (nodes, essential) = match &self.supports {
            Supports::Coupled(vertices) => {
                let nodes = efg::coupled_nodes(&cloud.points, &self.background, vertices)?;
                let free = nodes.len() - vertices.len();
                (nodes, Essential::Coupling(Coupled { vertices: vertices.clone(), free }))
            }
            Supports::Enforced(essential) => (cloud.points.clone(), essential.clone()),
        };
        let refine = self.refine.as_ref().map(|(refine, seed, shape)| {
            let method = self.clone();
            Refine {
                steps: refine.steps,
                ratio: refine.ratio,
                seed: *seed,
                shape: shape.clone(),
                cloud: cloud.clone(),
                on: Arc::new(move |cloud| method.on(cloud)),
            }
        });
        let supports = Some(self.supports(&cloud));
        let shape_functions = self.shape_functions();
        let method = self.clone();
        Ok(Discretisation {
            nodes: Arc::new(nodes),
            mesh: self.background.clone(),
            interpolates: false,
            blends: !self.separate,
            wide: self.has_wide_supports(),
            order: match self.functions {
                Functions::MovingLeastSquares { basis: efg::Basis::Quadratic, .. } => 2,
                _ => 1,
            },
            reduced: false,
            essential,
            dilation: self.dilation,
            inner: inner(&self.integration),
            refine,
            adapt: None,
            supports,
            shape_functions,
            outside: None,
            source: Arc::new(move || {
                let CloudMethod { background, followed, functions, integration, supports, separate, .. } =
                    &method;
                let followed = followed.as_deref();
                let (background, integration) = (background.clone(), integration.clone());
                Ok(Box::new(CloudSource::new(
                    *functions,
                    &cloud,
                    followed,
                    background,
                    supports.coupled(),
                    *separate,
                    integration,
                )?))
            }),
        })
    }

    /// Whether iterations with multigrid are slow. A cloud of 10,648 nodes takes 58 iterations at a support
    /// scale of 1.6 and 121 at 1.8, and a cloud of 4,096 nodes takes 285 at 2.0. A quadratic cloud takes 68
    /// (10,648 nodes) at 2.0 and 354 (4,096 nodes) at 2.5.
    fn has_wide_supports(&self) -> bool {
        /// Largest support scale for iterations, and the nodes in such a support.
        const LINEAR: (f64, f64) = (1.8, 50.0);
        const QUADRATIC: (f64, f64) = (2.0, 70.0);
        let Functions::MovingLeastSquares { support, basis, .. } = self.functions else { return true };
        let (scale, nodes) = match basis {
            efg::Basis::Linear => LINEAR,
            efg::Basis::Quadratic => QUADRATIC,
        };
        match support {
            efg::Support::Dilatation { factor } => factor > scale,
            efg::Support::Neighbours { count, factor } => count as f64 * factor.powi(3) > nodes,
        }
    }

    /// Describes the support search for the plan.
    fn supports(&self, cloud: &Cloud) -> String {
        let supports = match self.followed {
            Some(_) => "ellipsoids that follow the cells, and neighbours",
            None => "radius and neighbours",
        };
        format!("{supports} of {} nodes", cloud.points.len())
    }

    /// Describes the shape functions and their evaluation points for the plan.
    fn shape_functions(&self) -> String {
        let functions = match self.functions {
            Functions::MovingLeastSquares { .. } => "moving least squares",
            Functions::MaximumEntropy { .. } => "maximum entropy",
        };
        let points = match &self.integration {
            Integration::Gauss { points: 1 } => "1 point per background cell".into(),
            Integration::Gauss { points } => format!("{points} points per background cell"),
            Integration::Grid { points: 1, .. } => "1 point per grid cell".into(),
            Integration::Grid { points, .. } => format!("{points}^3 points per grid cell"),
            Integration::CellSmoothed { smoothing, face_points } => {
                let gradients = match smoothing {
                    efg::Smoothing::Constant => "constant",
                    efg::Smoothing::Linear => "linear",
                };
                format!("{}, smoothed to {gradients} gradients per cell", per_face(*face_points))
            }
            Integration::NodeSmoothed { stabilisation, face_points } => {
                let cells = match stabilisation {
                    0.0 => String::new(),
                    share => format!(", cells with {share} of the weight"),
                };
                format!("{}, smoothed to one gradient per vertex{cells}", per_face(*face_points))
            }
        };
        let coupled = match self.supports.coupled() {
            Some(vertices) => format!(", coupled to {} nodes of finite elements", vertices.len()),
            None => String::new(),
        };
        format!("{functions} at {points}{coupled}")
    }
}

/// Refuses nodes that lie outside the background cells by more than their spacing: no cell would contain
/// them. Coarse cells leave out thin parts of a body.
fn in_background(cloud: &Cloud, background: &Mesh) -> Result<(), Failure> {
    let key = || Key::Method("background");
    let found = locate(background, &cloud.points)
        .map_err(|bad| Failure::input(key(), format!("can't be compared with the nodes: {bad}"), ""))?;
    let lost = |&node: &usize| found[node].outside > cloud.spacing[node];
    let lost: Vec<usize> = (0..found.len()).filter(lost).collect();
    let Some(&farthest) = lost.iter().max_by(|&&a, &&b| found[a].outside.total_cmp(&found[b].outside)) else {
        return Ok(());
    };
    let problem = format!(
        "has no cells around {} of {} nodes; the farthest node, at {}, is {} away from \
         all cells: the cells leave out thin parts of the body",
        lost.len(),
        found.len(),
        position(&cloud.points[farthest], place::size(background)),
        length(found[farthest].outside)
    );
    Err(Failure::at(
        ErrorKind::NotRun,
        key(),
        problem,
        "take finer cells: background = { nodes = .. } or { spacing = .. }",
    ))
}

/// Returns the integration points of a rule, as far as they are known.
fn inner(integration: &Integration) -> InnerPoints {
    let per_cell = match integration {
        Integration::NodeSmoothed { stabilisation, .. } => usize::from(*stabilisation != 0.0),
        // Clipping the grid would test every point; a centroid per cell stands for its points.
        Integration::Grid { .. } => 1,
        by_cells => by_cells.points_per_cell().unwrap_or(0),
    };
    let vertices = matches!(integration, Integration::NodeSmoothed { .. });
    InnerPoints { per_cell, vertices, grid: matches!(integration, Integration::Grid { .. }) }
}

/// Returns the integration rule of the scene. A grid's cells are as large as the mean node spacing (m) unless
/// the scene gives another size.
fn integration(
    rule: scene::Integration,
    spacing: f64,
    shape: Option<Body>,
    background: &Mesh,
) -> Result<Integration, Failure> {
    Ok(match rule {
        scene::Integration::Gauss { points } => Integration::Gauss { points },
        scene::Integration::Grid { points, spacing: given } => {
            let key = || Key::Method("integration.rule");
            let help = "take rule = \"gauss\" or \"cell-smoothed\"";
            let clips = "needs a test for points inside the body, which an octant does not have";
            let shape = shape.ok_or_else(|| Failure::input(key(), clips, help))?;
            if background.region_names().len() > 1 {
                let problem = "can't assign the points of a grid to the regions of the body";
                return Err(Failure::unavailable(key(), problem, help));
            }
            let points = (points as f64).cbrt().round() as usize;
            Integration::Grid { spacing: given.unwrap_or(spacing), points, shape }
        }
        scene::Integration::CellSmoothed { order, face_points } => Integration::CellSmoothed {
            smoothing: if order == 2 { efg::Smoothing::Linear } else { efg::Smoothing::Constant },
            face_points,
        },
        scene::Integration::NodeSmoothed { stabilisation, face_points } => {
            Integration::NodeSmoothed { stabilisation, face_points }
        }
    })
}

/// Returns the scene's essential conditions; `None` for a coupled cloud, whose elements depend on the
/// background mesh.
fn essential(efg: &scene::Efg) -> Option<Essential> {
    Some(match efg.essential {
        scene::Essential::Nitsche { factor } => {
            let smoothed = matches!(
                efg.integration,
                scene::Integration::CellSmoothed { .. } | scene::Integration::NodeSmoothed { .. }
            );
            Essential::Nitsche(factor.unwrap_or(if smoothed { NITSCHE_SMOOTHED } else { NITSCHE }))
        }
        scene::Essential::Penalty { factor } => Essential::Penalty(factor.unwrap_or(PENALTY)),
        scene::Essential::Multipliers => Essential::Multipliers,
        scene::Essential::Elimination { rows } => Essential::Elimination(rows),
        scene::Essential::Coupling => return None,
    })
}

/// Returns the shape functions of the scene.
fn functions(functions: scene::Functions) -> Functions {
    match functions {
        scene::Functions::MovingLeastSquares { kernel, support, basis, .. } => {
            Functions::MovingLeastSquares {
                kernel,
                basis: match basis {
                    scene::Basis::Linear => efg::Basis::Linear,
                    scene::Basis::Quadratic => efg::Basis::Quadratic,
                },
                support: match support {
                    scene::SupportRule::Scale(factor) => efg::Support::Dilatation { factor },
                    scene::SupportRule::Neighbours { k, factor } => {
                        efg::Support::Neighbours { count: k, factor }
                    }
                },
            }
        }
        scene::Functions::MaximumEntropy { gamma } => Functions::MaximumEntropy { gamma },
    }
}

/// Describes the number of points on a face.
fn per_face(points: usize) -> String {
    if points == 1 { "1 point per face".into() } else { format!("{points} points per face") }
}
