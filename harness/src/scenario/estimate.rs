//! Estimates nodes, steps, memory and time of a method before any mesh is made. Nodes follow from the body's
//! volume, steps from the procedure, and memory and time from measured runs.
//!
//! Estimates are accurate to within a factor of about three. They serve to distribute the runs of a study and
//! to refuse a run that a typing error has made a thousand times too large.

use cases::scene::{
    Body, Cloud, ErrorKind, External, Family, MeshFile, Method, Procedure, Reference, Scene, SceneError, Size,
};
use geometry::CellKind;
use material::Material as _;

use super::body::{self, base};
use super::expected::{self, narrowest};
use crate::process::memory;

/// Bytes of a mesh file per node, including cells.
const FILE_BYTES: f64 = 250.0;
/// Newton iterations per step.
const ITERATIONS: f64 = 4.0;
/// Ratio of a cloud's row length to that of an element.
const CLOUD: f64 = 8.0;
/// Time, s, to assemble and factor a matrix of N unknowns, over N^1.5; and time, s, per node and explicit
/// step.
const FACTOR: f64 = 1e-7;
const EXPLICIT: f64 = 1e-7;
/// Time, s, per node and sweep of vertex block descent.
const SWEEP: f64 = 2e-6;
/// Longest run that is accepted, s, and most explicit steps; another check refuses more steps.
const MOST_SECONDS: f64 = 12.0 * 3600.0;
const MOST_STEPS: f64 = 1e7;
/// Time of the smallest run, s.
const LEAST: f64 = 1e-3;

/// Estimated cost of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Number of nodes.
    pub nodes: f64,
    /// Number of load steps or time steps.
    pub steps: f64,
    /// Memory, bytes.
    pub bytes: f64,
    /// Time of one solution, s.
    pub seconds: f64,
}

impl Estimate {
    /// Describes the cost if it exceeds any plausible intention: twice the machine's memory, or half a day.
    fn excess(&self) -> Option<String> {
        let too_large = self.bytes > 2.0 * memory() || self.seconds > MOST_SECONDS;
        too_large.then(|| {
            let Estimate { nodes, steps, bytes, seconds } = self;
            format!(
                "needs about {:.1e} unknowns, {steps:.1e} steps, {:.1e} GB of memory and {:.1e} hours",
                3.0 * nodes,
                bytes / 1e9,
                seconds / 3600.0
            )
        })
    }
}

/// Refuses a method of a scene, or its reference, if the estimated cost exceeds any plausible intention. A
/// mesh of too many nodes and explicit dynamics with too many steps are left to checks with better messages,
/// which `--force` does not lift. The estimated time is multiplied by `factor`, from earlier runs of the
/// scene.
pub fn too_large(scene: &Scene, method: &Method, factor: f64) -> Option<SceneError> {
    let of_reference = || {
        let (method, size) = reference(scene)?;
        refuse(scene, &method, size.map(|_| "reference.size".into()), factor)
    };
    refuse(scene, method, None, factor).or_else(of_reference)
}

/// Checks one method. `size` is the key of its size if that is not the method's own key.
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
        Procedure::Explicit(_)
        | Procedure::ImplicitDynamic(_)
        | Procedure::Vbd(_)
        | Procedure::Xpbd(_)
        | Procedure::ImplicitCg(_)
            if found.steps > 1e3 =>
        {
            "procedure.duration".into()
        }
        _ => size.unwrap_or_else(|| format!("method[{at}].size")),
    };
    let help = "take a coarser mesh or a shorter run, or give --force";
    Some(scene.error(ErrorKind::Invalid, &key, &problem, Some(help)))
}

/// Returns the scene's reference method, if the reference is computed, and the size given for it.
fn reference(scene: &Scene) -> Option<(Method, Option<&Size>)> {
    let Some(Reference::Method { id, size, .. }) = &scene.reference else { return None };
    let mut method = scene.method(id)?.clone();
    if let Some(size) = size {
        method.resize(size);
    }
    Some((method, size.as_ref()))
}

/// Estimates the cost of the scene's reference method, if the reference is computed.
pub fn of_reference(scene: &Scene) -> Option<Estimate> {
    reference(scene).map(|(method, _)| estimate(scene, &method.family))
}

/// Estimates the cost of one of the scene's methods.
pub fn estimate(scene: &Scene, family: &Family) -> Estimate {
    let (nodes, across, rows) = size(scene, family);
    let steps = steps(scene, across);
    let unknowns = 3.0 * nodes;
    let solve = FACTOR * unknowns.powf(1.5);
    let (bytes, seconds) = match &scene.procedure {
        Procedure::Prepare => (1e3 * nodes, 1e-5 * nodes),
        Procedure::Explicit(_) => (1e3 * nodes, EXPLICIT * nodes * steps),
        Procedure::Vbd(swept) | Procedure::Xpbd(swept) => {
            (3e3 * nodes, SWEEP * nodes * steps * swept.sweeps as f64)
        }
        // Multigrid is used above a few tens of thousands of unknowns; its memory is proportional to their
        // number.
        Procedure::ImplicitCg(asked) => {
            let iterations = steps * asked.iterations as f64;
            (6e3 * nodes, SWEEP * nodes * iterations)
        }
        Procedure::Linear { .. } => (factor(unknowns).min(4e3 * unknowns), solve),
        Procedure::Modes { .. } => (factor(unknowns), 10.0 * solve),
        Procedure::Static(_) | Procedure::ImplicitDynamic(_) => {
            (factor(unknowns), ITERATIONS * steps * solve)
        }
    };
    Estimate { nodes, steps, bytes: rows * bytes, seconds: LEAST + rows * seconds }
}

/// Returns the memory of a matrix and its factor, bytes.
fn factor(unknowns: f64) -> f64 {
    1e3 * unknowns + 80.0 * unknowns.powf(4.0 / 3.0)
}

/// Returns the number of nodes, the cells across the narrowest extent, and the row length relative to linear
/// elements.
fn size(scene: &Scene, family: &Family) -> (f64, f64, f64) {
    let body = &scene.body;
    let of_cloud = |count: usize| (count as f64, (count as f64).cbrt(), CLOUD);
    match family {
        Family::Fem(fem) | Family::External(External { elements: fem, .. }) => {
            // Cells of several kinds are of a file, whose size does not depend on a kind.
            let kind = fem.element.kind().unwrap_or(CellKind::Hex8);
            let across = across(body, &fem.size);
            // The midpoints of the edges of tetrahedra are those of a lattice of half the spacing.
            let fills = kind.entry().cell.diagonals == [1; 4];
            let (across, rows) = match fem.element.order() {
                1 => (across, 1.0),
                _ if fills => (2.0 * across, 1.0),
                _ => (across, 2.0),
            };
            (nodes(body, kind, &fem.size), across, rows)
        }
        Family::Efg(efg) => match &efg.cloud {
            Cloud::Mesh { size, .. } => (nodes(body, CellKind::Tet4, size), across(body, size), CLOUD),
            Cloud::Uniform { nodes, .. } | Cloud::Graded { nodes, .. } => of_cloud(*nodes),
            // Each refined cloud is solved.
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

/// Returns the number of nodes of a mesh.
fn nodes(body: &Body, kind: CellKind, size: &Size) -> f64 {
    match size {
        Size::File(file) => of_file(file),
        size => expected::nodes(body, kind, size),
    }
}

/// Returns the number of cells across the body's narrowest extent.
fn across(body: &Body, size: &Size) -> f64 {
    match size {
        Size::Level(level) => base(body) as f64 * f64::from(*level - 1).exp2(),
        Size::Spacing(spacing) => (narrowest(body) / spacing).max(1.0),
        Size::Nodes(nodes) => (*nodes as f64).cbrt(),
        Size::Cells { cells, .. } => cells.iter().copied().min().unwrap_or(1) as f64,
        Size::File(file) => of_file(file).cbrt(),
    }
}

fn of_file(file: &MeshFile) -> f64 {
    std::fs::metadata(&file.path).map_or(0.0, |of| of.len() as f64 / FILE_BYTES)
}

/// Returns the number of load steps or time steps. Explicit steps follow from the travel time of a wave
/// through a cell.
fn steps(scene: &Scene, across: f64) -> f64 {
    match &scene.procedure {
        Procedure::Prepare | Procedure::Linear { .. } | Procedure::Modes { .. } => 1.0,
        Procedure::Static(path) => path.steps as f64,
        Procedure::ImplicitDynamic(implicit) => implicit.ramp.steps as f64,
        Procedure::ImplicitCg(asked) => (asked.frames().time_steps().1 * asked.ramp.steps) as f64,
        Procedure::Vbd(swept) | Procedure::Xpbd(swept) => (swept.time_steps().1 * swept.ramp.steps) as f64,
        Procedure::Explicit(explicit) => {
            let law = scene.material.law();
            let density = scene.material.density.unwrap_or(1e3);
            let speed = ((law.lambda() + 2.0 * law.mu()) / density).sqrt();
            // The height of an organ's flat cells is less than a third of the mean cell size.
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
        // 16 x 16 x 8 cells: corners, and midpoints of edges for quadratic elements.
        let corners = 17.0 * 17.0 * 9.0;
        let tet10 = 33.0 * 33.0 * 17.0;
        let hex20 = corners + 16.0 * 17.0 * 9.0 * 2.0 + 17.0 * 17.0 * 8.0;
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
