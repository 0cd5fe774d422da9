//! What a method of a scene takes, before any mesh is made: nodes by the volume of the body, steps by the procedure, memory and
//! time by what both took elsewhere. Good to a factor of about three: enough to deal out the runs of a study, and to refuse one
//! that a slip of the pen has made a thousand times too large.

use cases::scene::{
    Body, Cloud, Element, ErrorKind, External, Family, MeshFile, Method, Procedure, Reference, Scene,
    SceneError, Size,
};
use geometry::shapes::Shape;
use material::Material as _;

use super::body::{self, base, shape};
use super::expected::narrowest;
use super::file_body;

/// Bytes of a mesh file for a node with its cells.
const FILE_BYTES: f64 = 250.0;
/// Iterations of Newton's method in a step.
const ITERATIONS: f64 = 4.0;
/// A cloud's rows are so many times as long as an element's.
const CLOUD: f64 = 8.0;
/// Seconds to assemble and factor a matrix of N unknowns over N^1.5; for each node and explicit step.
const FACTOR: f64 = 1e-7;
const EXPLICIT: f64 = 1e-7;
/// A run of more seconds is refused; one of more explicit steps is by itself.
const MOST_SECONDS: f64 = 12.0 * 3600.0;
const MOST_STEPS: f64 = 1e7;
/// Seconds of the smallest run.
const LEAST: f64 = 1e-3;

/// What a run is about to take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Nodes.
    pub nodes: f64,
    /// Load steps or time steps.
    pub steps: f64,
    /// Bytes of memory.
    pub bytes: f64,
    /// Seconds of one solution.
    pub seconds: f64,
}

impl Estimate {
    /// What it is, in words, if it is more than anyone means to run: twice the memory of the machine, or half a day.
    fn excess(&self) -> Option<String> {
        let too_large = self.bytes > 2.0 * memory() || self.seconds > MOST_SECONDS;
        too_large.then(|| {
            let Estimate { nodes, steps, bytes, seconds } = self;
            format!(
                "takes about {:.1e} unknowns, {steps:.1e} steps, {:.1e} GB of memory and {:.1e} hours",
                3.0 * nodes,
                bytes / 1e9,
                seconds / 3600.0
            )
        })
    }
}

/// Refuses a method of a scene that takes more than anyone means to spend, or the reference that it needs. What no `--force` lifts is
/// left to the checks that say more about it: a mesh of too many nodes, explicit dynamics in too many steps.
/// Estimated seconds are multiplied by the factor that runs of the scene took before.
pub fn too_large(scene: &Scene, method: &Method, factor: f64) -> Option<SceneError> {
    let of_reference = || {
        let (method, size) = reference(scene)?;
        refuse(scene, &method, size.map(|_| "reference.size".into()), factor)
    };
    refuse(scene, method, None, factor).or_else(of_reference)
}

/// The same of a method alone, whose size is at this key unless it is the method's own.
fn refuse(scene: &Scene, method: &Method, size: Option<String>, factor: f64) -> Option<SceneError> {
    let found = estimate(scene, &method.family);
    let found = Estimate { seconds: factor * found.seconds, ..found };
    let explicit = matches!(scene.procedure, Procedure::Explicit(_));
    let counted = matches!(method.size(), Some(Size::Cells { .. }));
    if explicit && found.steps > MOST_STEPS || !counted && found.nodes > body::MOST_NODES as f64 {
        return None;
    }
    let problem = found.excess()?;
    let at = scene.methods.iter().position(|other| other.id == method.id).unwrap_or_default();
    let key = match &scene.procedure {
        Procedure::Static(_) if found.steps > 1e3 => "procedure.steps".into(),
        Procedure::Explicit(_) | Procedure::ImplicitDynamic(_) if found.steps > 1e3 => {
            "procedure.duration".into()
        }
        _ => size.unwrap_or_else(|| format!("method[{at}].size")),
    };
    let help = "make it coarser or shorter, or give --force to run it";
    Some(scene.error(ErrorKind::Invalid, &key, &problem, Some(help)))
}

/// Memory of this machine in bytes; where the system does not say, that of a large one.
fn memory() -> f64 {
    let known = || {
        let text = std::fs::read_to_string("/proc/meminfo").ok()?;
        let total = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
        Some(1024.0 * total.split_whitespace().next()?.parse::<f64>().ok()?)
    };
    known().unwrap_or(256e9)
}

/// The method that all others of a scene are compared with, where that is solved, and the size that is given for it.
fn reference(scene: &Scene) -> Option<(Method, Option<&Size>)> {
    let Some(Reference::Method { id, size }) = &scene.reference else { return None };
    let mut method = scene.method(id)?.clone();
    if let Some(size) = size {
        method.resize(size);
    }
    Some((method, size.as_ref()))
}

/// Of the reference that all methods of a scene are compared with, where that is solved.
pub fn of_reference(scene: &Scene) -> Option<Estimate> {
    reference(scene).map(|(method, _)| estimate(scene, &method.family))
}

/// Of one of a scene's methods.
pub fn estimate(scene: &Scene, family: &Family) -> Estimate {
    let (nodes, across, rows) = size(scene, family);
    let steps = steps(scene, across);
    let unknowns = 3.0 * nodes;
    let solve = FACTOR * unknowns.powf(1.5);
    let (bytes, seconds) = match &scene.procedure {
        Procedure::Prepare => (1e3 * nodes, 1e-5 * nodes),
        Procedure::Explicit(_) => (1e3 * nodes, EXPLICIT * nodes * steps),
        // Above a few ten thousand unknowns by multigrid, whose memory grows as they do.
        Procedure::Linear { .. } => (factor(unknowns).min(4e3 * unknowns), solve),
        Procedure::Modes { .. } => (factor(unknowns), 10.0 * solve),
        Procedure::Static(_) | Procedure::ImplicitDynamic(_) => {
            (factor(unknowns), ITERATIONS * steps * solve)
        }
    };
    Estimate { nodes, steps, bytes: rows * bytes, seconds: LEAST + rows * seconds }
}

/// Bytes of a matrix with its factor.
fn factor(unknowns: f64) -> f64 {
    1e3 * unknowns + 80.0 * unknowns.powf(4.0 / 3.0)
}

/// Nodes, cells across the narrowest extent, and how long rows are against those of linear elements.
fn size(scene: &Scene, family: &Family) -> (f64, f64, f64) {
    let body = &scene.body;
    let of_cloud = |count: usize| (count as f64, (count as f64).cbrt(), CLOUD);
    match family {
        Family::Fem(fem) | Family::External(External { elements: fem, .. }) => {
            let (cells, across) = cells(body, &fem.size);
            match fem.element {
                Element::Tet4 | Element::Hex8 => (nodes(cells, 1.0), across, 1.0),
                Element::Hex20 => (4.0 * nodes(cells, 1.0), across, 2.0),
                Element::Tet10 => (nodes(cells, 2.0), 2.0 * across, 1.0),
            }
        }
        Family::OverMesh(over) => {
            let (cells, across) = cells(body, &over.size);
            (nodes(cells, 1.0), across, CLOUD)
        }
        Family::Efg(efg) => match &efg.cloud {
            Cloud::Mesh { size, .. } => {
                let (cells, across) = cells(body, size);
                (nodes(cells, 1.0), across, CLOUD)
            }
            Cloud::Uniform { nodes, .. } | Cloud::Graded { nodes, .. } => of_cloud(*nodes),
            // Each of its clouds is solved.
            Cloud::Refined { nodes, refine, .. } => {
                let (nodes, across, rows) = of_cloud(*nodes);
                (nodes, across, rows * (1 + refine.steps) as f64)
            }
            Cloud::File { file, nodes } => match nodes {
                Some(nodes) => of_cloud(*nodes),
                None => of_cloud(of_file(file) as usize),
            },
        },
    }
}

/// Cells of a body, about cubes, and how many are across its narrowest extent.
fn cells(body: &Body, size: &Size) -> (f64, f64) {
    let across = match size {
        Size::Level(level) => base(body) as f64 * f64::from(*level - 1).exp2(),
        Size::Spacing(spacing) => (narrowest(body) / spacing).max(1.0),
        Size::Nodes(nodes) => return (*nodes as f64, (*nodes as f64).cbrt()),
        Size::Cells { cells, .. } => {
            let least = cells.iter().copied().min().unwrap_or(1);
            return (cells.iter().map(|&n| n as f64).product(), least as f64);
        }
        Size::File(file) => return (of_file(file), of_file(file).cbrt()),
    };
    (volume(body) / (narrowest(body) / across).powi(3), across)
}

/// Corners of so many cells, each edge cut in so many parts.
fn nodes(cells: f64, parts: f64) -> f64 {
    (parts * cells.cbrt() + 1.0).powi(3)
}

fn of_file(file: &MeshFile) -> f64 {
    std::fs::metadata(&file.path).map_or(0.0, |of| of.len() as f64 / FILE_BYTES)
}

fn volume(body: &Body) -> f64 {
    let shell = |inner: f64, outer: f64| std::f64::consts::PI * (outer.powi(3) - inner.powi(3)) / 6.0;
    match (shape(body), body) {
        (Some(shape), _) => Shape::volume(&*shape),
        (None, Body::SphereShell { inner, outer, .. }) => shell(*inner, *outer),
        (None, Body::File(file)) => file_body::load(file).map_or(0.0, |body| body.surface.volume()),
        (None, _) => 0.0,
    }
}

/// Load steps; time steps of explicit dynamics by the time that a wave takes through a cell.
fn steps(scene: &Scene, across: f64) -> f64 {
    match &scene.procedure {
        Procedure::Prepare | Procedure::Linear { .. } | Procedure::Modes { .. } => 1.0,
        Procedure::Static(path) => path.steps as f64,
        Procedure::ImplicitDynamic(implicit) => implicit.ramp.steps as f64,
        Procedure::Explicit(explicit) => {
            let (law, density) = (scene.material.law(), scene.material.density.unwrap_or(1e3));
            let speed = ((law.lambda() + 2.0 * law.mu()) / density).sqrt();
            // Flat cells of an organ stand less than a third of the mean one's.
            let stable = 0.3 * narrowest(&scene.body) / across / speed;
            let stable = if stable > 0.0 { explicit.safety * stable } else { f64::MAX };
            (explicit.ramp.duration / explicit.step.unwrap_or(stable)).max(explicit.ramp.steps as f64)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLOCK: &str = r#"title = "A block"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "LAW", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }
support = [{ where = "z == 0 mm", fix = "xyz" }]
load = [{ on = "z-max", pressure = "1 kPa" }]
procedure = PROCEDURE
method = [{ id = "m", family = "fem", element = "ELEMENT", size = SIZE }]
"#;

    fn of(procedure: &str, element: &str, size: &str) -> Estimate {
        let law = if procedure.contains("linear") { "linear" } else { "neo-hookean" };
        let text = BLOCK
            .replace("LAW", law)
            .replace("PROCEDURE", procedure)
            .replace("ELEMENT", element)
            .replace("SIZE", size);
        let scene = cases::scene::parse(&text, "block.toml").unwrap();
        estimate(&scene, &scene.methods[0].family)
    }

    #[test]
    fn nodes_are_those_of_the_mesh_within_a_third() {
        // 16 x 16 x 8 cells; corners, and of a quadratic element the middles of edges.
        let corners = 17.0 * 17.0 * 9.0;
        let (tet10, hex20) = (33.0 * 33.0 * 17.0, corners + 16.0 * 17.0 * 9.0 * 2.0 + 17.0 * 17.0 * 8.0);
        for (element, exact) in [("tet4", corners), ("hex8", corners), ("tet10", tet10), ("hex20", hex20)] {
            for size in ["{ level = 3 }", "{ spacing = \"2.5 mm\" }", "{ cells = [16, 16, 8] }"] {
                let found = of("{ kind = \"static\" }", element, size).nodes;
                assert!((found / exact - 1.0).abs() < 0.34, "{element} {size}: {found} of {exact}");
            }
        }
    }

    #[test]
    fn only_what_nobody_means_is_refused() {
        let level = "{ level = 3 }";
        for (procedure, size) in [
            ("{ kind = \"static\", steps = 10 }", "{ cells = [40, 40, 40] }"),
            ("{ kind = \"linear\" }", "{ cells = [60, 60, 60] }"),
            ("{ kind = \"explicit\", duration = \"1 s\" }", level),
        ] {
            assert_eq!(of(procedure, "hex8", size).excess(), None, "{procedure}");
        }
        for (procedure, size) in [
            ("{ kind = \"static\", steps = 100000 }", "{ level = 4 }"),
            ("{ kind = \"linear\" }", "{ cells = [270, 270, 270] }"),
            ("{ kind = \"explicit\", duration = \"1e9 s\" }", level),
            ("{ kind = \"static\", steps = 10 }", "{ level = 8 }"),
        ] {
            let words = of(procedure, "hex8", size).excess().unwrap_or_default();
            assert!(words.contains("unknowns") && words.contains("hours"), "{procedure} {size}: {words}");
        }
    }
}
