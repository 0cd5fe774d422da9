//! Cubes of clouds, constrained below and loaded above.
#![allow(dead_code)] // each bench and each test uses its own part

use std::sync::Arc;

use efg::{Basis, CloudSource, CubicSpline, Functions, Integration, Kernel, Smoothing, Support};
use geometry::generate::{Jitter, box_mesh};
use geometry::shapes::Cuboid;
use geometry::{CellKind, Cloud, Facet, Mesh, cloud_from_mesh};
use material::LinearElastic;
use shape::{
    DilationGroups, FixedDof, FluxRows, Matrix3, Point3, RowSource, Rows, SurfaceRows, TraceRows, Vector3,
    VolumeRows,
};
use tissuebench_statics::{LinearBody, LinearProblem, Load, Weak, WeakSupport};

/// Supports of a cube below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Below {
    Nitsche,
    Penalty(f64),
    Coupling,
}

/// A cloud in a cube of side 1 m.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Background cells along a side, six tetrahedra each.
    pub cells: usize,
    /// Number of nodes placed at random; `None` takes the vertices of the background.
    pub random: Option<usize>,
    pub support_scale: f64,
    pub below: Below,
    /// Whether the upper half is a region of its own.
    pub layers: bool,
    /// Gauss points per cell; smoothed cells if `None`.
    pub gauss: Option<usize>,
    /// Whether dilations are shared near nodes.
    pub near: bool,
}

impl Settings {
    pub const fn of(cells: usize) -> Settings {
        Settings {
            cells,
            random: None,
            support_scale: 1.6,
            below: Below::Nitsche,
            layers: false,
            gauss: None,
            near: false,
        }
    }
}

pub struct CloudCube {
    pub mesh: Arc<Mesh>,
    pub nodes: Vec<Point3>,
    pub volume: VolumeRows,
    pub region: Vec<u16>,
    groups: Option<DilationGroups>,
    free: SurfaceRows,
    flux: FluxRows,
    trace: Option<TraceRows>,
    fixed: Vec<FixedDof>,
    spacing: f64,
    below: Below,
    /// Values of the cloud's functions at its nodes.
    pub parameters: Rows,
}

impl CloudCube {
    pub fn new(settings: Settings) -> CloudCube {
        let Settings { cells, support_scale, below, .. } = settings;
        let (low, high) = (Point3::origin(), Point3::new(1.0, 1.0, 1.0));
        let jitter = Some(Jitter { fraction: 0.2, seed: 1 });
        let mut mesh = box_mesh(CellKind::Tet4, low, high, [cells; 3], [1.0; 3], jitter).unwrap();
        if settings.layers {
            let centre = |cell: usize| mesh.cell_points(cell).map(|p| p.z).sum::<f64>() / 4.0;
            let regions = (0..mesh.cell_count()).map(|cell| u16::from(centre(cell) > 0.5)).collect();
            mesh = mesh.with_regions(regions, vec!["lower".into(), "upper".into()]);
        }
        let mesh = Arc::new(mesh);
        let cloud: Cloud = match settings.random {
            Some(count) => geometry::cloud(&Cuboid { min: low, max: high }, count, 1, &[]).unwrap(),
            None => cloud_from_mesh(&mesh),
        };
        let bottom = mesh.group("z-min").unwrap().to_vec();
        let free: Vec<Facet> = mesh.boundary().into_iter().filter(|facet| !bottom.contains(facet)).collect();
        let vertices = mesh.facet_group_nodes(&bottom);
        let coupled = (below == Below::Coupling).then_some(&vertices[..]);
        let functions = Functions::MovingLeastSquares {
            kernel: Kernel::CubicSpline(CubicSpline),
            basis: Basis::Linear,
            support: Support::Dilatation { factor: support_scale },
        };
        let integration = match settings.gauss {
            Some(points) => Integration::Gauss { points },
            None => Integration::CellSmoothed { smoothing: Smoothing::Constant, face_points: 1 },
        };
        let source =
            CloudSource::new(functions, &cloud, None, mesh.clone(), coupled, false, integration).unwrap();
        let nodes = match coupled {
            Some(vertices) => efg::coupled_nodes(&cloud.points, &mesh, vertices).unwrap(),
            None => cloud.points.clone(),
        };
        let first = nodes.len() - coupled.map_or(0, <[u32]>::len);
        let fixed = (first..nodes.len()).flat_map(|node| (0..3).map(move |axis| (node as u32, axis)));
        let fixed = fixed.map(|(node, axis)| FixedDof { node, axis, value: 0.01 }).collect();
        let volume = source.volume().unwrap().rows;
        let flux = source.flux(&bottom).unwrap();
        CloudCube {
            region: if settings.layers { source.regions() } else { Vec::new() },
            groups: settings.near.then(|| DilationGroups::near(&volume).unwrap()),
            free: source.surface(&free).unwrap(),
            trace: if below == Below::Nitsche { source.trace(&bottom).unwrap() } else { None },
            fixed,
            spacing: cloud.spacing.iter().sum::<f64>() / cloud.spacing.len() as f64,
            below,
            parameters: source.at_points(&nodes).unwrap().0.rows().clone(),
            flux,
            volume,
            nodes,
            mesh,
        }
    }

    /// Calls `run` with a problem: a traction above, and supports below that move by 10 mm along each axis.
    pub fn with<T>(&self, materials: &[LinearElastic], run: impl FnOnce(&LinearProblem) -> T) -> T {
        let force = Vector3::new(0.01, 0.003, -0.02) * materials[0].young();
        let traction = |n: &Vector3| if n.z > 0.9 { force } else { Vector3::zeros() };
        self.loaded(materials, traction, |_| Vector3::repeat(0.01), run)
    }

    /// Calls `run` with the problem of an affine field `exact` (m) with the gradient `slope`.
    pub fn stretched<T>(
        &self,
        material: &[LinearElastic],
        slope: Matrix3,
        exact: impl Fn(&Point3) -> Vector3,
        run: impl FnOnce(&LinearProblem) -> T,
    ) -> T {
        let sigma = material[0].stress(&slope);
        self.loaded(material, |n| sigma * n, exact, run)
    }

    fn loaded<T>(
        &self,
        materials: &[LinearElastic],
        traction: impl Fn(&Vector3) -> Vector3,
        below: impl Fn(&Point3) -> Vector3,
        run: impl FnOnce(&LinearProblem) -> T,
    ) -> T {
        let body = LinearBody {
            nodes: &self.nodes,
            volume: &self.volume,
            materials,
            region: &self.region,
            dilation: self.groups.as_ref(),
        };
        let values = self.free.normals().iter().map(traction).collect();
        let loads = [Load::Traction { surface: &self.free, values }];
        let method = match self.below {
            Below::Penalty(factor) => Weak::Penalty { factor },
            _ => Weak::Nitsche { gamma: if self.trace.is_some() { 4.0 } else { 100.0 } },
        };
        let weak = [WeakSupport {
            flux: &self.flux,
            axes: [true; 3],
            values: self.flux.points().iter().map(below).collect(),
            region: &[],
            method,
            h: self.spacing,
            trace: self.trace.as_ref(),
        }];
        let weak = if self.below == Below::Coupling { &weak[..0] } else { &weak[..] };
        run(&LinearProblem { body, loads: &loads, fixed: &self.fixed, constraints: &[], weak })
    }
}
