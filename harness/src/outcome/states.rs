//! The body at the recorded states, for visualisation programs: a `.pvd` series of `.vtu` files.

use geometry::{Mesh, Point3, Vector3};
use mesh_files::{Values, solution_vtu, surface_vtu};
use shape::Matrix3;

/// Body and tools at the recorded states of a run.
#[derive(Clone, Debug)]
pub struct States {
    /// Undeformed mesh of the body; for a cloud, the mesh from which the cloud was drawn.
    pub(crate) mesh: Mesh,
    /// Recorded states in order.
    pub(crate) states: Vec<State>,
    /// Tools, if the procedure has load steps.
    pub(crate) tools: Vec<ToolSkin>,
    /// Force of the supports on each node at the last state, N; empty if unknown, and for a cloud.
    pub(crate) reaction: Vec<Vector3>,
    /// Numbers of the mesh points and of the cells in a file, written beside their values; empty unless
    /// given.
    pub(crate) numbers: [Vec<u64>; 2],
    /// Part of an error that each cell causes per volume, over the mean of the body; empty unless traced.
    pub(crate) error_source: Vec<f64>,
    /// Number of recorded states that were left out.
    pub(crate) left_out: usize,
}

/// Recorded state of the body.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// Time (s) in dynamics, fraction of the load in statics, 1 for a linear solution, or number of a
    /// vibration mode.
    pub(crate) time: f64,
    /// Displacement at the points of the mesh, m.
    pub(crate) displacement: Vec<Vector3>,
    /// Stress and volume ratio of the cells; `None` for vibration modes and viscoelastic tissue.
    pub(crate) tensors: Option<Tensors>,
    /// Motion of each tool from its start.
    pub(crate) tools: Vec<Moved>,
    /// Contact points inside a tool (position, m), each with its signed distance (m, negative inside).
    pub(crate) touching: Vec<(Point3, f64)>,
    /// Smallest signed distance of a mesh point to a tool, m; infinite without tools.
    pub(crate) gap: f64,
}

/// Results in each cell, averaged over the cell's quadrature points.
#[derive(Clone, Debug)]
pub(crate) struct Tensors {
    /// Cauchy stress, Pa.
    pub(crate) stress: Vec<Matrix3>,
    /// Determinant of the deformation gradient.
    pub(crate) det_f: Vec<f64>,
}

/// Surface of a tool at its start.
#[derive(Clone, Debug)]
pub(crate) struct ToolSkin {
    /// Vertices, m.
    pub(crate) points: Vec<Point3>,
    pub(crate) quads: Vec<[u32; 4]>,
    /// Unit direction of travel at the start.
    pub(crate) along: Vector3,
}

/// Rigid motion of a tool from its start: a position `x` moves to `R x + d`.
#[derive(Clone, Debug)]
pub(crate) struct Moved {
    /// Rotation `R` (3, 3); `None` for a tool that does not turn.
    pub(crate) rotation: Option<Matrix3>,
    /// Displacement `d`, m.
    pub(crate) by: Vector3,
}

impl Moved {
    /// Displacement of a position (m), m.
    fn displacement(&self, x: &Point3) -> Vector3 {
        self.rotation.map_or(self.by, |rotation| rotation * x.coords - x.coords + self.by)
    }
}

impl States {
    /// Undeformed mesh of the body; for a cloud, the mesh from which the cloud was drawn.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Displacement of the mesh points at each state (m), with the state's time (s), load fraction or mode
    /// number.
    pub fn displacements(&self) -> impl ExactSizeIterator<Item = (f64, &[Vector3])> {
        self.states.iter().map(|state| (state.time, &state.displacement[..]))
    }

    /// Output files with names relative to a folder: the series `NAME.pvd` first, then its parts in a folder
    /// `NAME`.
    pub fn files<'a>(&'a self, name: &'a str) -> impl Iterator<Item = (String, Vec<u8>)> + 'a {
        let parts = self.states.iter().enumerate().flat_map(move |(k, state)| {
            let body = (part(name, "body", k), self.body(state));
            let tools = (!self.tools.is_empty()).then(|| (part(name, "tools", k), self.tools_at(state)));
            std::iter::once(body).chain(tools)
        });
        std::iter::once((format!("{name}.pvd"), self.series(name).into_bytes())).chain(parts)
    }

    /// Whether a file of this name may belong to an earlier series.
    pub(crate) fn is_file(name: &str) -> bool {
        let part = ["body-", "tools-"].iter().any(|what| name.starts_with(what)) && name.ends_with(".vtu");
        part || name.ends_with(".pvd")
    }

    /// Whether there are no states.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// Number of states.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    fn series(&self, name: &str) -> String {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
        );
        for (k, state) in self.states.iter().enumerate() {
            let bodies = if self.tools.is_empty() { &["body"][..] } else { &["body", "tools"] };
            for (number, what) in bodies.iter().enumerate() {
                let time = state.time;
                let file = part(name, what, k);
                text += &format!(
                    "<DataSet timestep=\"{time:?}\" group=\"\" part=\"{number}\" name=\"{what}\" file=\"{file}\"/>\n"
                );
            }
        }
        text + "</Collection>\n</VTKFile>\n"
    }

    fn body(&self, state: &State) -> Vec<u8> {
        let mut at_points = vec![vectors("displacement", &state.displacement)];
        let mut in_cells = state.tensors.as_ref().map_or(Vec::new(), Tensors::values);
        if !self.error_source.is_empty() {
            let numbers = self.error_source.clone();
            in_cells.push(Values { name: "error_source", components: 1, numbers });
        }
        let [nodes, elements] = &self.numbers;
        let number = |name, of: &[u64]| Values {
            name,
            components: 1,
            numbers: of.iter().map(|n| *n as f64).collect(),
        };
        if !nodes.is_empty() {
            at_points.push(number("node", nodes));
            in_cells.push(number("element", elements));
        }
        solution_vtu(&self.mesh, state.time, &at_points, &in_cells)
    }

    fn tools_at(&self, state: &State) -> Vec<u8> {
        let (mut points, mut quads, mut bodies, mut moved) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (number, (tool, by)) in self.tools.iter().zip(&state.tools).enumerate() {
            let first = points.len() as u32;
            points.extend_from_slice(&tool.points);
            quads.extend(tool.quads.iter().map(|quad| quad.map(|k| first + k)));
            bodies.resize(quads.len(), number as u32);
            moved.extend(tool.points.iter().map(|x| by.displacement(x)));
        }
        surface_vtu(&points, &quads, &bodies, state.time, &[vectors("displacement", &moved)])
    }
}

impl Tensors {
    /// Components xx, yy, zz, xy, yz and zx of each cell's stress, Pa.
    pub(crate) fn components(&self) -> impl Iterator<Item = [f64; 6]> {
        self.stress.iter().map(|s| [s[(0, 0)], s[(1, 1)], s[(2, 2)], s[(0, 1)], s[(1, 2)], s[(0, 2)]])
    }

    fn values(&self) -> Vec<Values> {
        let each = |name, value: &dyn Fn(&Matrix3) -> f64| Values {
            name,
            components: 1,
            numbers: self.stress.iter().map(value).collect(),
        };
        vec![
            Values { name: "stress", components: 6, numbers: self.components().flatten().collect() },
            each("pressure", &|s| -s.trace() / 3.0),
            each("von_mises", &von_mises),
            Values { name: "det_f", components: 1, numbers: self.det_f.clone() },
        ]
    }
}

/// `sqrt(3/2 s : s)` with the deviator `s` of a stress.
pub(crate) fn von_mises(stress: &Matrix3) -> f64 {
    let deviator = stress - Matrix3::identity() * (stress.trace() / 3.0);
    (1.5 * deviator.norm_squared()).sqrt()
}

fn vectors(name: &'static str, values: &[Vector3]) -> Values {
    Values { name, components: 3, numbers: values.iter().flat_map(|v| v.data.0[0]).collect() }
}

fn part(name: &str, what: &str, k: usize) -> String {
    format!("{name}/{what}-{:04}.vtu", k + 1)
}
