//! From the keys of a file to the types the program works with; every finding is noted at its key.

use std::path::{Path, PathBuf};

use super::document::Origin;
use super::error::{ErrorKind, Problem, SceneError, nearest, suggest};
use super::field::{Prescribed, ScalarField, VectorField};
use super::keys::*;
use super::method::*;
use super::metric::Metric;
use super::model::*;
use super::output::{Bound, Check, Output, Parameter, Reference, Target, Transfer};
use super::tool::{Drive, Procedure, ProcedureKind, Tool, ToolShape, ToolShapeName};
use super::units::{Dim, Dimension, Q, Quantity};

/// Collects findings about one file.
pub(crate) struct Report<'o> {
    origin: &'o Origin,
    errors: Vec<SceneError>,
}

impl<'o> Report<'o> {
    pub fn new(origin: &'o Origin) -> Report<'o> {
        Report { origin, errors: Vec::new() }
    }

    pub fn add(&mut self, key: &str, problem: Problem) {
        self.errors.push(self.origin.error(ErrorKind::Invalid, key, problem));
    }

    pub fn finish(self) -> Vec<SceneError> {
        super::document::sorted(self.errors)
    }

    pub fn origin(&self) -> &Origin {
        self.origin
    }

    /// A path of the file, relative ones taken from its folder.
    pub fn path(&self, text: &str) -> PathBuf {
        let folder = Path::new(self.origin.file()).parent().unwrap_or(Path::new(""));
        folder.join(text)
    }

    fn missing(&mut self, key: &str, help: &str) {
        self.add(key, Problem::new("is missing").help(help));
    }

    fn require(&mut self, holds: bool, key: &str, problem: &str, help: &str) {
        if !holds {
            self.add(key, Problem::new(problem).help(help));
        }
    }
}

/// `None` only together with findings.
pub(crate) fn scene(keys: SceneKeys, report: &mut Report) -> Option<Scene> {
    let body = body(keys.body, report);
    let material = material(keys.material, "material", report);
    let regions = keys.region.into_iter().enumerate().map(|(i, r)| {
        let key = format!("region[{i}]");
        let place = place(r.on, r.place, &key, report, true);
        let material = self::material(r.material, &format!("{key}.material"), report);
        MaterialRegion { name: r.name, place, material }
    });
    let regions = regions.collect();
    let supports = keys.support.into_iter().enumerate().map(|(i, s)| support(s, i, report)).collect();
    let loads = keys.load.into_iter().enumerate().filter_map(|(i, l)| load(l, i, report)).collect();
    let tools = keys.tool.into_iter().enumerate().filter_map(|(i, t)| tool(t, i, report)).collect();
    let methods: Vec<Method> =
        keys.method.into_iter().enumerate().filter_map(|(i, m)| method(m, i, report)).collect();
    let output = output(keys.output, report);
    let reference = keys.reference.and_then(|r| reference(r, report));
    let checks = checks(keys.check, "check", report);
    let procedure = procedure(keys.procedure);
    Some(Scene {
        title: keys.title,
        source: keys.source,
        body: body?,
        material,
        regions,
        supports,
        loads,
        tools,
        procedure,
        methods,
        output,
        reference,
        checks,
        origin: report.origin().clone(),
    })
}

fn raw<D: Dim>(q: [Q<D>; 3]) -> [f64; 3] {
    q.map(|q| q.0)
}

fn positive(value: f64, key: &str, report: &mut Report) -> f64 {
    report.require(value > 0.0, key, "is not positive", "give a value above zero");
    value
}

fn body(keys: BodyKeys, report: &mut Report) -> Option<Body> {
    Some(match keys {
        BodyKeys::Box { min, max, size } => {
            let (min, max) = match (min, max, size) {
                (Some(min), Some(max), None) => (raw(min), raw(max)),
                (min, None, Some(size)) => {
                    let (min, size) = (min.map_or([0.0; 3], raw), raw(size));
                    (min, std::array::from_fn(|a| min[a] + size[a]))
                }
                (_, Some(_), Some(_)) => {
                    let help = "give min and max, or size alone (with a corner at the origin, or at min)";
                    report.add("body.size", Problem::new("stands beside max").help(help));
                    return None;
                }
                _ => {
                    report.missing(
                        "body.size",
                        "give size = [\"40 mm\", \"40 mm\", \"20 mm\"], or min and max",
                    );
                    return None;
                }
            };
            let holds = (0..3).all(|a| max[a] > min[a]);
            report.require(holds, "body", "has no volume", "every extent must be above zero");
            Body::Box { min, max }
        }
        BodyKeys::Cylinder { radius, height } => Body::Cylinder {
            radius: positive(radius.0, "body.radius", report),
            height: positive(height.0, "body.height", report),
        },
        BodyKeys::Ball { radius } => Body::Ball { radius: positive(radius.0, "body.radius", report) },
        BodyKeys::SphereShell { inner, outer, octant } => {
            let (inner, outer) =
                (positive(inner.0, "body.inner", report), positive(outer.0, "body.outer", report));
            report.require(outer > inner, "body.outer", "is not above inner", "the wall needs a thickness");
            Body::SphereShell { inner, outer, octant }
        }
        BodyKeys::Kidney {} => Body::Kidney,
        BodyKeys::File { path, unit } => Body::File(mesh_file(&path, unit.0, "body.path", report)),
    })
}

fn mesh_file(path: &str, unit: f64, key: &str, report: &mut Report) -> MeshFile {
    let path = report.path(path);
    if !path.is_file() {
        let help = format!("no file at {}; paths are relative to the scene's folder", path.display());
        report.add(key, Problem::new("can't be found").help(help));
    }
    MeshFile { path, unit }
}

fn elastic(young: f64, poisson: f64, density: Option<f64>, key: &str, report: &mut Report) -> Elastic {
    report.require(young > 0.0, &format!("{key}.young"), "is not positive", "soft tissue has 1 to 100 kPa");
    let help = "give a ratio above -1 and below 0.5; for nearly incompressible tissue 0.49 to 0.4999";
    let holds = poisson > -1.0 && poisson < 0.5;
    report.require(
        holds,
        &format!("{key}.poisson"),
        "is not a Poisson's ratio of a compressible solid",
        help,
    );
    if let Some(density) = density {
        positive(density, &format!("{key}.density"), report);
    }
    Elastic { young, poisson, density }
}

fn material(keys: MaterialKeys, key: &str, report: &mut Report) -> Material {
    type E = MaterialKeys;
    match keys {
        E::Linear { young, poisson, density } => {
            Material::Linear(elastic(young.0, poisson, density.map(|d| d.0), key, report))
        }
        E::SaintVenantKirchhoff { young, poisson, density } => {
            Material::SaintVenantKirchhoff(elastic(young.0, poisson, density.map(|d| d.0), key, report))
        }
        E::NeoHookean { young, poisson, density } => {
            Material::NeoHookean(elastic(young.0, poisson, density.map(|d| d.0), key, report))
        }
        E::Hencky { young, poisson, density } => {
            Material::Hencky(elastic(young.0, poisson, density.map(|d| d.0), key, report))
        }
        E::MooneyRivlin { c10, c01, bulk, density } => Material::MooneyRivlin {
            c10: c10.0,
            c01: c01.0,
            bulk: positive(bulk.0, &format!("{key}.bulk"), report),
            density: density.map(|d| d.0),
        },
        E::Ogden { mu, alpha, bulk, density } => {
            let holds = mu.len() == alpha.len() && !mu.is_empty();
            report.require(holds, &format!("{key}.alpha"), "does not match mu", "give one alpha for each mu");
            Material::Ogden {
                terms: mu.iter().map(|m| m.0).zip(alpha).collect(),
                bulk: positive(bulk.0, &format!("{key}.bulk"), report),
                density: density.map(|d| d.0),
            }
        }
    }
}

fn names(names: Names) -> Vec<String> {
    match names {
        Names::One(name) => vec![name],
        Names::Several(names) => names,
    }
}

fn place(
    on: Option<Names>,
    region: Option<super::region::Region>,
    key: &str,
    report: &mut Report,
    needed: bool,
) -> Place {
    match (on, region) {
        (Some(on), None) => {
            let on = names(on);
            report.require(
                !on.is_empty(),
                &format!("{key}.on"),
                "names nothing",
                "name a part of the surface",
            );
            Place::On(on)
        }
        (None, Some(region)) => Place::Where(region),
        (Some(_), Some(region)) => {
            let help = "say where with 'on' or with 'where', not both";
            report.add(&format!("{key}.where"), Problem::new("stands beside 'on'").help(help));
            Place::Where(region)
        }
        (None, None) => {
            if needed {
                report
                    .missing(&format!("{key}.where"), "say where: on = \"z-min\", or where = \"z == 0 mm\"");
            }
            Place::Everywhere
        }
    }
}

fn support(keys: SupportKeys, index: usize, report: &mut Report) -> Support {
    let key = format!("support[{index}]");
    let place = place(keys.on, keys.place, &key, report, true);
    let zero = || Some(Prescribed::Field(ScalarField::Constant(0.0)));
    let mut motion: [Option<Prescribed>; 3] = [None, None, None];
    if let Some(fix) = &keys.fix {
        let sound = !fix.is_empty() && fix.chars().all(|c| "xyz".contains(c));
        let help = "write the axes held at zero, such as \"xyz\" or \"z\"";
        report.require(sound, &format!("{key}.fix"), "is not a list of axes", help);
        for axis in 0..3 {
            if fix.contains(['x', 'y', 'z'][axis]) {
                motion[axis] = zero();
            }
        }
    }
    match keys.motion {
        Some(MoveKeys::Exact(_)) => motion = std::array::from_fn(|_| Some(Prescribed::Exact)),
        Some(MoveKeys::Axes(axes)) => {
            for (axis, given) in [axes.x, axes.y, axes.z].into_iter().enumerate() {
                let Some(given) = given else { continue };
                if motion[axis].is_some() {
                    let name = ["x", "y", "z"][axis];
                    let problem = Problem::new("moves an axis that 'fix' holds").help("name each axis once");
                    report.add(&format!("{key}.move.{name}"), problem);
                }
                motion[axis] = Some(match given {
                    AxisKeys::Exact(_) => Prescribed::Exact,
                    AxisKeys::Field(field) => Prescribed::Field(scalar(field)),
                });
            }
        }
        None => {}
    }
    if motion.iter().all(Option::is_none) && keys.fix.is_none() {
        report.missing(&format!("{key}.fix"), "write fix = \"xyz\", or move = { z = \"-1 mm\" }");
    }
    Support { place, motion }
}

fn scalar<D: Dim>(keys: FieldKeys<D>) -> ScalarField {
    match keys {
        FieldKeys::Constant(q) => ScalarField::Constant(q.0),
        FieldKeys::Expression(f) => ScalarField::Expression { of: f.of, factor: f.unit.0 },
    }
}

fn vector<D: Dim>(keys: VectorKeys<D>) -> VectorField {
    match keys {
        VectorKeys::Exact(_) => VectorField::Exact,
        VectorKeys::Components(c) => VectorField::Components(c.map(scalar)),
        VectorKeys::Expressions(v) => {
            let factor = v.unit.0;
            VectorField::Components(v.of.map(|of| ScalarField::Expression { of, factor }))
        }
    }
}

fn load(keys: LoadKeys, index: usize, report: &mut Report) -> Option<Load> {
    let key = format!("load[{index}]");
    let kind = match (keys.traction, keys.pressure, keys.body) {
        (Some(t), None, None) => LoadKind::Traction(vector(t)),
        (None, Some(p), None) => LoadKind::Pressure(scalar(p)),
        (None, None, Some(b)) => LoadKind::Body(vector(b)),
        (None, None, None) => {
            report.missing(&key, "give one of traction, pressure and body");
            return None;
        }
        _ => {
            report.add(
                &key,
                Problem::new("has several kinds of load").help("give one of traction, pressure and body"),
            );
            return None;
        }
    };
    let body = matches!(kind, LoadKind::Body(_));
    let place = place(keys.on, keys.place, &key, report, !body);
    let everywhere = place == Place::Everywhere;
    report.require(
        !body || everywhere,
        &key,
        "limits a body force to a place",
        "a body force acts everywhere",
    );
    Some(Load { place, kind })
}

fn tool(keys: ToolKeys, index: usize, report: &mut Report) -> Option<Tool> {
    let key = format!("tool[{index}]");
    let need = |value: Option<f64>, name: &str, report: &mut Report| {
        if value.is_none() {
            report.missing(&format!("{key}.{name}"), "this shape needs it");
        }
        value
    };
    let (radius, length) = (keys.radius.map(|q| q.0), keys.length.map(|q| q.0));
    let shape = match keys.shape {
        ToolShapeName::Plate => ToolShape::Plate,
        ToolShapeName::RoundedBox => match keys.half {
            Some(half) => ToolShape::RoundedBox { half: raw(half), radius: radius.unwrap_or(0.0) },
            None => {
                report.missing(&format!("{key}.half"), "a rounded-box needs its half extents");
                return None;
            }
        },
        ToolShapeName::Sphere => ToolShape::Sphere { radius: need(radius, "radius", report)? },
        ToolShapeName::Cylinder => ToolShape::Cylinder {
            radius: need(radius, "radius", report)?,
            length: need(length, "length", report)?,
        },
        ToolShapeName::Capsule => ToolShape::Capsule {
            radius: need(radius, "radius", report)?,
            length: need(length, "length", report)?,
        },
        ToolShapeName::File => match keys.path {
            Some(path) => {
                let unit = keys.unit.map_or(1e-3, |u| u.0);
                ToolShape::File(mesh_file(&path, unit, &format!("{key}.path"), report))
            }
            None => {
                report.missing(&format!("{key}.path"), "name the mesh file");
                return None;
            }
        },
    };
    let drive = match (keys.drive.closure, keys.drive.force, keys.drive.pressure) {
        (Some(q), None, None) => Drive::Closure(q.0),
        (None, Some(q), None) => Drive::Force(q.0),
        (None, None, Some(q)) => Drive::Pressure(q.0),
        _ => {
            let help = "give one of closure, force and pressure";
            report.add(&format!("{key}.drive"), Problem::new("is not one drive").help(help));
            return None;
        }
    };
    let norm = keys.along.iter().map(|a| a * a).sum::<f64>().sqrt();
    report.require(
        norm > 0.0,
        &format!("{key}.along"),
        "has no direction",
        "give a direction such as [0, 0, -1]",
    );
    let friction = keys.friction.unwrap_or(0.0);
    report.require(
        friction >= 0.0,
        &format!("{key}.friction"),
        "is negative",
        "give a coefficient of 0 or more",
    );
    Some(Tool {
        name: keys.name,
        shape,
        at: raw(keys.at),
        along: keys.along.map(|a| a / norm),
        drive,
        over: keys.drive.over.map(|q| q.0),
        friction,
    })
}

fn procedure(keys: Option<ProcedureKeys>) -> Procedure {
    match keys {
        Some(p) => Procedure {
            kind: p.kind,
            steps: p.steps.unwrap_or(1) as usize,
            duration: p.duration.map(|q| q.0),
        },
        None => Procedure { kind: ProcedureKind::Linear, steps: 1, duration: None },
    }
}

pub(crate) fn size(keys: SizeKeys, key: &str, report: &mut Report) -> Option<Size> {
    let given = [
        keys.nodes.is_some(),
        keys.spacing.is_some(),
        keys.level.is_some(),
        keys.cells.is_some(),
        keys.file.is_some(),
    ];
    if given.iter().filter(|g| **g).count() != 1 {
        let help = "give one of nodes, spacing, level, cells and file, such as { level = 2 }";
        report.add(key, Problem::new("is not one size").help(help));
        return None;
    }
    let one = |n: u32, name: &str, report: &mut Report| {
        report.require(n > 0, &format!("{key}.{name}"), "is zero", "give 1 or more");
        n
    };
    if let Some(n) = keys.nodes {
        return Some(Size::Nodes(one(n, "nodes", report) as usize));
    }
    if let Some(q) = keys.spacing {
        return Some(Size::Spacing(positive(q.0, &format!("{key}.spacing"), report)));
    }
    if let Some(level) = keys.level {
        report.require((1..=8).contains(&level), &format!("{key}.level"), "is no level", "levels are 1 to 8");
        return Some(Size::Level(level.clamp(1, 8)));
    }
    if let Some(cells) = keys.cells {
        let sound = cells.iter().all(|&n| (1..=1000).contains(&n));
        report.require(
            sound,
            &format!("{key}.cells"),
            "is no number of cells",
            "give 1 to 1000 along each axis",
        );
        let grading = keys.grading.unwrap_or([1.0; 3]);
        let sound = grading.iter().all(|g| *g > 0.0 && g.is_finite());
        report.require(sound, &format!("{key}.grading"), "is not positive", "1 is uniform");
        return Some(Size::Cells { cells: cells.map(|n| n as usize), grading });
    }
    let unit = keys.unit.map_or(1e-3, |u| u.0);
    keys.file.map(|file| Size::File(mesh_file(&file, unit, &format!("{key}.file"), report)))
}

fn jitter(keys: Option<JitterKeys>, key: &str, report: &mut Report) -> Option<Jitter> {
    let keys = keys?;
    let sound = (0.0..0.5).contains(&keys.fraction);
    report.require(sound, &format!("{key}.jitter.fraction"), "is no share of a cell", "give 0 to below 0.5");
    Some(Jitter { fraction: keys.fraction, seed: keys.seed })
}

fn method(keys: MethodKeys, index: usize, report: &mut Report) -> Option<Method> {
    let key = format!("method[{index}]");
    match keys {
        MethodKeys::Fem(fem) => {
            let size = size(fem.size, &format!("{key}.size"), report);
            let jitter = jitter(fem.jitter, &key, report);
            let dilation = fem.dilation.unwrap_or(Dilation::Standard);
            Some(Method {
                id: fem.id,
                family: Family::Fem(Fem { element: fem.element, dilation, size: size?, jitter }),
            })
        }
        MethodKeys::Efg(efg) => efg_method(efg, &key, report),
    }
}

fn efg_method(keys: EfgKeys, key: &str, report: &mut Report) -> Option<Method> {
    let at = |name: &str| format!("{key}.{name}");
    let jitter = jitter(keys.jitter, key, report);
    let seed = keys.seed.unwrap_or(1);
    let cloud = match (keys.nodes, keys.size, keys.cloud, keys.graded_towards) {
        (None, Some(s), None | Some(CloudName::Mesh), None) => {
            size(s, &at("size"), report).map(|size| Cloud::Mesh { size, jitter })
        }
        (Some(n), None, None | Some(CloudName::Uniform), None) => {
            Some(Cloud::Uniform { nodes: n as usize, seed })
        }
        (Some(n), None, None | Some(CloudName::Graded), Some(towards)) => {
            Some(Cloud::Graded { nodes: n as usize, seed, towards })
        }
        (None, None, ..) => {
            report.missing(
                &at("nodes"),
                "give nodes = 83 for a cloud of that count, or size for the nodes of a mesh",
            );
            None
        }
        _ => {
            let help = "nodes goes with cloud = \"uniform\", or \"graded\" and graded_towards; size with cloud = \"mesh\"";
            report.add(&at("cloud"), Problem::new("does not go with the keys beside it").help(help));
            None
        }
    };
    let support = match (keys.dilatation, keys.neighbours) {
        (Some(d), None) => {
            report.require(d > 0.0 && d < 10.0, &at("dilatation"), "is no dilatation", "1.2 to 3 is usual");
            Some(SupportRule::Dilatation(d))
        }
        (None, Some(k)) => {
            let factor = keys.factor.unwrap_or(1.2);
            report.require(factor > 0.0, &at("factor"), "is not positive", "1.2 to 1.6 is usual");
            report.require(
                k >= 4,
                &at("neighbours"),
                "are too few for a linear basis",
                "give at least 4, better 12",
            );
            Some(SupportRule::Neighbours { k: k as usize, factor })
        }
        (Some(_), Some(_)) => {
            let help = "give dilatation, or neighbours and factor, not both";
            report.add(&at("neighbours"), Problem::new("stands beside dilatation").help(help));
            None
        }
        (None, None) => {
            report.missing(&at("dilatation"), "give dilatation = 1.6, or neighbours = 15 and factor = 1.2");
            None
        }
    };
    let kernel = match keys.kernel {
        KernelKeys::Name(name) => Kernel { name, alpha: None, power: None, eps: None },
        KernelKeys::Table(t) => Kernel { name: t.name, alpha: t.alpha, power: t.power, eps: t.eps },
    };
    let integration = match keys.integration {
        IntegrationKeys::Gauss { points } => Integration::Gauss { points: points as usize },
        IntegrationKeys::Grid { points, spacing } => {
            let root = (points as f64).cbrt().round() as u32;
            let help = "points per grid cell are 1, 8, 27, 64, ...";
            report.require(root.pow(3) == points, &at("integration.points"), "is not a cube number", help);
            Integration::Grid { points: points as usize, spacing: spacing.map(|q| q.0) }
        }
        IntegrationKeys::CellSmoothed { points } => {
            let points = points.unwrap_or(1);
            let sound = [1, 3, 6].contains(&points);
            report.require(
                sound,
                &at("integration.points"),
                "is no face rule",
                "points per face are 1, 3 or 6",
            );
            Integration::CellSmoothed { face_points: points as usize }
        }
    };
    let (name, factor) = match keys.essential {
        EssentialKeys::Name(name) => (name, None),
        EssentialKeys::Table(table) => (table.method, table.factor),
    };
    if let Some(factor) = factor {
        positive(factor, &at("essential.factor"), report);
    }
    let essential = match name {
        EssentialName::Nitsche => Essential::Nitsche { factor },
        EssentialName::Penalty => Essential::Penalty { factor },
        EssentialName::Multipliers => Essential::Multipliers,
    };
    let background = keys.background.map(|b| size(b, &at("background"), report));
    let background = match background {
        Some(None) => return None,
        Some(Some(size)) => Some(size),
        None => None,
    };
    Some(Method {
        id: keys.id,
        family: Family::Efg(Efg {
            cloud: cloud?,
            kernel,
            support: support?,
            basis: keys.basis,
            integration,
            essential,
            dilation: keys.dilation.unwrap_or(Dilation::Standard),
            background,
        }),
    })
}

fn output(keys: Option<OutputKeys>, report: &mut Report) -> Output {
    let Some(keys) = keys else { return Output { probes: Vec::new(), transfers: Vec::new() } };
    if let Some(probes) = &keys.probes {
        let help = "name a point, or leave the key out";
        report.require(!probes.is_empty(), "output.probes", "is empty", help);
    }
    let list = match keys.transfer {
        None => Vec::new(),
        Some(TransfersKeys::One(one)) => vec![one],
        Some(TransfersKeys::Several(several)) => several,
    };
    let transfers = list.into_iter().map(|t| Transfer {
        to: match t.to {
            TargetKeys::Name(TargetName::ReferenceNodes) => Target::ReferenceNodes,
            TargetKeys::Name(TargetName::Probes) => Target::Probes,
            TargetKeys::File(f) => {
                Target::File(mesh_file(&f.file, f.unit.map_or(1e-3, |u| u.0), "output.transfer", report))
            }
        },
        scheme: t.scheme,
        neighbours: t.neighbours.map(|n| n as usize),
        power: t.power,
        dilatation: t.dilatation,
    });
    Output {
        transfers: transfers.collect(),
        probes: keys.probes.unwrap_or_default().into_iter().map(raw).collect(),
    }
}

fn reference(keys: ReferenceKeys, report: &mut Report) -> Option<Reference> {
    let stray = |report: &mut Report| {
        for name in keys.parameters.keys() {
            let help = suggest(name, &["exact", "method", "record", "size"]);
            report.add(&format!("reference.{name}"), Problem::new("is not known").help(help));
        }
    };
    match (&keys.exact, &keys.method, &keys.record) {
        (Some(_), None, None) => {}
        (None, Some(id), None) => {
            stray(report);
            let (id, given) = (id.clone(), keys.size.is_some());
            let size = keys.size.and_then(|s| size(s, "reference.size", report));
            return (size.is_some() || !given).then_some(Reference::Method { id, size });
        }
        (None, None, Some(record)) => {
            stray(report);
            return Some(Reference::Record(report.path(record)));
        }
        _ => {
            let help = "give one of exact = \"...\", method = \"...\" and record = \"...\"";
            report.add("reference", Problem::new("is not one reference").help(help));
            return None;
        }
    }
    let mut parameters = std::collections::BTreeMap::new();
    for (name, value) in keys.parameters {
        match parameter(value) {
            Ok(value) => {
                parameters.insert(name, value);
            }
            Err(bad) => report.add(&format!("reference.{name}"), bad),
        }
    }
    keys.exact.map(|name| Reference::Exact { name, parameters })
}

fn parameter(keys: ParameterKeys) -> Result<Parameter, Problem> {
    let text = |text: String| -> Result<Parameter, Problem> {
        if text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
            Quantity::read(&text).map(Parameter::Quantity)
        } else {
            Ok(Parameter::Text(text))
        }
    };
    Ok(match keys {
        ParameterKeys::Truth(value) => Parameter::Truth(value),
        ParameterKeys::Number(value) => Parameter::Number(value),
        ParameterKeys::Text(value) => text(value)?,
        ParameterKeys::List(items) => Parameter::List(
            items
                .into_iter()
                .map(|item| match item {
                    ParameterItem::Number(value) => Ok(Parameter::Number(value)),
                    ParameterItem::Text(value) => text(value),
                    ParameterItem::List(leaves) => leaves
                        .into_iter()
                        .map(|leaf| match leaf {
                            ParameterLeaf::Number(value) => Ok(Parameter::Number(value)),
                            ParameterLeaf::Text(value) => text(value),
                        })
                        .collect::<Result<_, _>>()
                        .map(Parameter::List),
                })
                .collect::<Result<_, _>>()?,
        ),
    })
}

/// Checks of a scene or of a run of a study; `key` is the path of their list.
pub(crate) fn checks(keys: Vec<CheckKeys>, key: &str, report: &mut Report) -> Vec<Check> {
    keys.into_iter().enumerate().filter_map(|(i, c)| check(c, &format!("{key}[{i}]"), report)).collect()
}

fn check(keys: CheckKeys, key: &str, report: &mut Report) -> Option<Check> {
    let metric = match Metric::find(&keys.metric) {
        Ok(metric) => metric,
        Err(bad) => {
            report.add(&format!("{key}.metric"), bad);
            return None;
        }
    };
    let bound = |value: BoundKeys, name: &str, report: &mut Report| match limit(value, metric.dimension) {
        Ok(value) => Some(value),
        Err(bad) => {
            report.add(&format!("{key}.{name}"), bad);
            None
        }
    };
    let bound = match (keys.at_least, keys.at_most, keys.known_band) {
        (None, None, None) => {
            report.missing(key, "give at_most, at_least or known_band");
            return None;
        }
        (None, None, Some([low, high])) => {
            let (low, high) = (bound(low, "known_band", report)?, bound(high, "known_band", report)?);
            report.require(low < high, &format!("{key}.known_band"), "is no band", "give the low end first");
            match keys.reason {
                Some(reason) => Bound::KnownBand { low, high, reason },
                None => {
                    report.missing(&format!("{key}.reason"), "say why the method can't do better");
                    return None;
                }
            }
        }
        (_, _, Some(_)) => {
            let help = "give a band or bounds, not both";
            report.add(&format!("{key}.known_band"), Problem::new("stands beside a bound").help(help));
            return None;
        }
        (low, high, None) => Bound::Within {
            at_least: match low {
                Some(low) => Some(bound(low, "at_least", report)?),
                None => None,
            },
            at_most: match high {
                Some(high) => Some(bound(high, "at_most", report)?),
                None => None,
            },
        },
    };
    Some(Check { metric, methods: keys.method.map(names).unwrap_or_default(), bound })
}

fn limit(keys: BoundKeys, dimension: Dimension) -> Result<f64, Problem> {
    match (keys, dimension) {
        (BoundKeys::Number(value), Dimension::None) => Ok(value),
        (BoundKeys::Number(value), _) => {
            Err(Problem::new("has no unit").help(dimension.fix(&value.to_string())))
        }
        (BoundKeys::Text(text), _) => dimension.read(&text),
    }
}

/// The nearest of the ids there are, as help.
pub(crate) fn which<'a>(id: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let list = known.clone().collect::<Vec<_>>().join(", ");
    match nearest(id, known) {
        Some(near) => format!("did you mean '{near}'? (there are {list})"),
        None => format!("there are {list}"),
    }
}
