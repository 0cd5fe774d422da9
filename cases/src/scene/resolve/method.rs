//! Methods and their sizes.

use crate::scene::external::external;
use crate::scene::family::over_mesh;
use crate::scene::keys::*;
use crate::scene::method::*;
use crate::scene::region::Region;
use crate::scene::report::Report;
use crate::scene::vocabulary::{build, settings};
use catalogue::{Problem, Values};

use super::{MILLIMETRE, mesh_file, positive};

pub(super) fn method(keys: MethodKeys, index: usize, report: &mut Report) -> Option<Method> {
    let key = format!("method[{index}]");
    match keys {
        MethodKeys::Fem(fem) => {
            let size = size(fem.size, &format!("{key}.size"), report);
            let reduced = fem.reduced;
            let key_of = format!("{key}.reduced");
            let help = "leave it out, or take element = \"hex20\"";
            report.require(!reduced || fem.element == Element::Hex20, &key_of, "is for hex20 only", help);
            let jitter = jitter(fem.jitter, &key, report);
            let dilation = fem.dilation.unwrap_or(Dilation::Standard);
            Some(Method {
                series: fem.series.unwrap_or_else(|| fem.id.clone()),
                id: fem.id,
                family: Family::Fem(Fem { element: fem.element, dilation, reduced, size: size?, jitter }),
                mass: fem.mass,
            })
        }
        MethodKeys::Efg(efg) => efg_method(*efg, &key, report),
        MethodKeys::External(keys) => external(*keys, &key, report),
        MethodKeys::OverMesh(keys) => over_mesh(keys, &key, report),
    }
}

fn efg_method(keys: EfgKeys, key: &str, report: &mut Report) -> Option<Method> {
    let at = |name: &str| format!("{key}.{name}");
    let background = keys.background.map(|b| size(b, &at("background"), report));
    let jitter = jitter(keys.jitter, key, report);
    let (name, table) = match keys.cloud {
        Some(CloudKeys::Name(name)) => (Some(name), None),
        Some(CloudKeys::Table(table)) => (None, Some(table)),
        None => (None, None),
    };
    let source = table.and_then(|table| source(table, key, report));
    let file = match &source {
        Some(Source::File(file)) => Some(file),
        _ => None,
    };
    let with_cells = keys.size.is_some() || file.is_some_and(|f| geometry::files::is_mesh(&f.path));
    let layout = Layout {
        nodes: keys.nodes.map(|n| count(n, &at("nodes"), report)),
        size: keys.size.map(|s| size(s, &at("size"), report)),
        name,
        source,
        towards: keys.graded_towards,
        seed: keys.seed,
        jitter,
    };
    let cloud = cloud(layout, key, report);
    let help = "take the nodes of a mesh: size = { level = 2 }";
    report.require(
        keys.neighbourhood != Some(SupportShape::Ellipsoid) || with_cells,
        &at("neighbourhood"),
        "follows the cells around each node, and the nodes of this cloud have none",
        help,
    );
    let reach = Reach {
        support_scale: keys.support_scale,
        neighbours: keys.neighbours,
        factor: keys.factor,
        shape: keys.neighbourhood,
    };
    let functions = functions(keys.basis, keys.kernel, reach, keys.gamma, key, report);
    let integration = integration(keys.integration, &at("integration"), report);
    let essential = essential(keys.essential, &at("essential"), report);
    let (cloud, functions, background) =
        (cloud?, functions?, background.map_or(Some(None), |b| b.map(Some))?);
    if essential == Essential::Coupling {
        coupling(&cloud, &functions, key, report);
    }
    let dilation = keys.dilation.unwrap_or(Dilation::Standard);
    let regions = keys.regions.unwrap_or(Regions::Blended);
    report.require(
        regions == Regions::Blended || essential == Essential::Coupling,
        &at("regions"),
        "wants finite elements along the borders, as essential = \"coupling\" has them along supports",
        "take essential = \"coupling\", or regions = \"blended\"",
    );
    let efg = Efg { cloud, functions, integration, essential, dilation, regions, background };
    let series = keys.series.unwrap_or_else(|| keys.id.clone());
    Some(Method { id: keys.id, series, family: Family::Efg(efg), mass: keys.mass })
}

/// Checks the demands of coupling to finite elements on the cloud and its functions.
fn coupling(cloud: &Cloud, functions: &Functions, key: &str, report: &mut Report) {
    let linear = matches!(functions, Functions::MovingLeastSquares { basis: Basis::Linear, .. });
    report.require(
        linear,
        &format!("{key}.basis"),
        "does not go with essential = \"coupling\"",
        "take basis = \"linear\": what linear elements leave of another does not vanish where they hold",
    );
    report.require(
        !matches!(cloud, Cloud::Refined { .. }),
        &format!("{key}.cloud.refine"),
        "does not go with essential = \"coupling\"",
        "take essential = \"elimination\": nodes of finite elements can't be placed anew",
    );
}

/// Keys of a file about a cloud; `size` is `Some(None)` if it could not be read.
struct Layout {
    nodes: Option<usize>,
    size: Option<Option<Size>>,
    name: Option<CloudName>,
    source: Option<Source>,
    towards: Option<Region>,
    seed: Option<u64>,
    jitter: Option<Jitter>,
}

/// Meaning of a cloud's table.
enum Source {
    File(MeshFile),
    Refine(Refine),
}

fn source(table: CloudTable, key: &str, report: &mut Report) -> Option<Source> {
    let at = |name: &str| format!("{key}.cloud.{name}");
    match (table.file, table.unit, table.refine) {
        (Some(file), Some(unit), None) => Some(Source::File(mesh_file(&file, unit.0, &at("file"), report))),
        (Some(_), None, None) => {
            report.missing(&at("unit"), "say what the numbers of the file are in: unit = \"mm\"");
            None
        }
        (None, None, Some(RefineKeys { by: Indicator::GradientError, steps, ratio })) => {
            let (steps, ratio) = (steps.unwrap_or(2), ratio.unwrap_or(3.0));
            let sound = (1..=10).contains(&steps);
            report.require(sound, &at("refine.steps"), "is no number of steps", "give 1 to 10; 2 is usual");
            let sound = (1.0..=10.0).contains(&ratio);
            report.require(sound, &at("refine.ratio"), "is no ratio", "give 1 to 10; 3 is usual");
            Some(Source::Refine(Refine { steps: steps as usize, ratio }))
        }
        _ => {
            let help =
                "give { file = \"nodes.csv\", unit = \"mm\" }, or { refine = { by = \"gradient-error\" } }";
            report.add(&format!("{key}.cloud"), Problem::new("is not one cloud").help(help));
            None
        }
    }
}

fn cloud(layout: Layout, key: &str, report: &mut Report) -> Option<Cloud> {
    let at = |name: &str| format!("{key}.{name}");
    let of_mesh = layout.size.is_some();
    let problem = "does not belong to this cloud";
    report.require(
        of_mesh || layout.jitter.is_none(),
        &at("jitter"),
        problem,
        "it moves the nodes of a mesh: give size",
    );
    let given = of_mesh || matches!(layout.source, Some(Source::File(_)));
    report.require(!given || layout.seed.is_none(), &at("seed"), problem, "nodes that are given need none");
    let seed = layout.seed.unwrap_or(1);
    if let Some(source) = layout.source {
        let help = "cloud = { ... } is the whole cloud; nodes = 83 beside it is how many it has";
        for (name, stray) in [("size", of_mesh), ("graded_towards", layout.towards.is_some())] {
            report.require(!stray, &at(name), "does not go with this cloud", help);
        }
        return match (source, layout.nodes) {
            (Source::File(file), nodes) => Some(Cloud::File { file, nodes }),
            (Source::Refine(refine), Some(nodes)) => Some(Cloud::Refined { nodes, seed, refine }),
            (Source::Refine(_), None) => {
                report.missing(&at("nodes"), "give nodes = 332, how many there are after every step");
                None
            }
        };
    }
    match (layout.nodes, layout.size, layout.name, layout.towards) {
        (None, Some(size), None | Some(CloudName::Mesh), None) => {
            Some(Cloud::Mesh { size: size?, jitter: layout.jitter })
        }
        (Some(nodes), None, None | Some(CloudName::Uniform), None) => Some(Cloud::Uniform { nodes, seed }),
        (Some(nodes), None, Some(CloudName::Graded), Some(towards)) => {
            Some(Cloud::Graded { nodes, seed, towards })
        }
        (Some(_), None, Some(CloudName::Graded), None) => {
            report.missing(&at("graded_towards"), "say where it is denser: graded_towards = \"z >= 10 mm\"");
            None
        }
        (None, None, ..) => {
            let help = "give nodes = 83 for a cloud of that count, or size for the nodes of a mesh";
            report.missing(&at("nodes"), help);
            None
        }
        _ => {
            let help = "nodes goes with cloud = \"uniform\", or \"graded\" and graded_towards; size with cloud = \"mesh\"";
            report.add(&at("cloud"), Problem::new("does not go with the keys beside it").help(help));
            None
        }
    }
}

/// Keys of a file about the supports of nodes.
struct Reach {
    support_scale: Option<f64>,
    neighbours: Option<u32>,
    factor: Option<f64>,
    shape: Option<SupportShape>,
}

fn functions(
    basis: BasisKeys,
    kernel: Option<KernelKeys>,
    reach: Reach,
    gamma: Option<f64>,
    key: &str,
    report: &mut Report,
) -> Option<Functions> {
    let at = |name: &str| format!("{key}.{name}");
    let basis = match basis {
        BasisKeys::Polynomial(basis) => basis,
        BasisKeys::Entropy(Entropy::Maximum) => {
            let given = [
                ("kernel", kernel.is_some()),
                ("support_scale", reach.support_scale.is_some()),
                ("neighbours", reach.neighbours.is_some()),
                ("factor", reach.factor.is_some()),
                ("neighbourhood", reach.shape.is_some()),
            ];
            for (name, given) in given {
                let problem = "does not go with basis = \"maximum-entropy\"";
                report.require(!given, &at(name), problem, "leave it out: gamma says how far nodes reach");
            }
            let gamma = gamma.unwrap_or(Functions::GAMMA);
            let help = "0.8 to 4 is usual: below, rows are long; above, close to linear interpolation";
            report.require((0.6..=6.0).contains(&gamma), &at("gamma"), "is no locality", help);
            return Some(Functions::MaximumEntropy { gamma });
        }
    };
    report.require(
        gamma.is_none(),
        &at("gamma"),
        "goes with basis = \"maximum-entropy\" only",
        "leave it out",
    );
    let shape = reach.shape.unwrap_or(SupportShape::Ball);
    let support = support(reach, basis, key, report);
    let Some(kernel) = kernel else {
        report.missing(&at("kernel"), "give kernel = \"cubic-spline\", or basis = \"maximum-entropy\"");
        return None;
    };
    let kernel = self::kernel(kernel, &at("kernel"), report);
    Some(Functions::MovingLeastSquares { kernel: kernel?, support: support?, shape, basis })
}

fn support(
    Reach { support_scale, neighbours, factor, .. }: Reach,
    basis: Basis,
    key: &str,
    report: &mut Report,
) -> Option<SupportRule> {
    let at = |name: &str| format!("{key}.{name}");
    let stray = factor.is_some() && neighbours.is_none();
    report.require(!stray, &at("factor"), "goes with neighbours only", "leave it out");
    match (support_scale, neighbours) {
        (Some(d), None) => {
            report.require(
                (1.0..=10.0).contains(&d),
                &at("support_scale"),
                "is no support scale",
                "1.2 to 3 is usual",
            );
            Some(SupportRule::Scale(d))
        }
        (None, Some(k)) => {
            let factor = factor.unwrap_or(1.2);
            report.require(
                (1.0..=10.0).contains(&factor),
                &at("factor"),
                "is no factor",
                "1.1 to 1.6 is usual",
            );
            let least = match basis {
                Basis::Linear => 4,
                Basis::Quadratic => 10,
            };
            let help =
                format!("a {} basis needs {least} at the least, better three times that", basis.name());
            report.require(k >= least, &at("neighbours"), "are too few", &help);
            Some(SupportRule::Neighbours { k: k as usize, factor })
        }
        (Some(_), Some(_)) => {
            let help = "give support_scale, or neighbours and factor, not both";
            report.add(&at("neighbours"), Problem::new("stands beside support_scale").help(help));
            None
        }
        (None, None) => {
            report.missing(
                &at("support_scale"),
                "give support_scale = 1.6, or neighbours = 15 and factor = 1.2",
            );
            None
        }
    }
}

fn kernel(keys: KernelKeys, key: &str, report: &mut Report) -> Option<efg::Kernel> {
    let (word, values) = match keys {
        KernelKeys::Name(word) => {
            let values = Values::new(word.0.parameters);
            (word, values)
        }
        KernelKeys::Table(keys) => {
            let values = settings(&keys.name, keys.settings, key, report)?;
            (keys.name, values)
        }
    };
    build(word.0, &values, (key, key), report)
}

pub(crate) fn integration(keys: IntegrationKeys, key: &str, report: &mut Report) -> Integration {
    let at = format!("{key}.points");
    match keys {
        IntegrationKeys::Gauss { points } => {
            report.require(
                points > 0,
                &at,
                "is zero",
                "in a tetrahedron 1, 4, 8, 14, 15, 24, 35 and 46 are known",
            );
            Integration::Gauss { points: points as usize }
        }
        IntegrationKeys::Grid { points, spacing } => {
            let sound = (1u32..=10).any(|n| n.pow(3) == points);
            report.require(
                sound,
                &at,
                "is no cube number",
                "points per grid cell are 1, 8, 27, 64, ... 1000",
            );
            let spacing = spacing.map(|q| positive(q.0, &format!("{key}.spacing"), report));
            Integration::Grid { points: points as usize, spacing }
        }
        IntegrationKeys::CellSmoothed { points, order } => {
            let order = order.unwrap_or(1);
            let known = [1, 2].contains(&order);
            report.require(
                known,
                &format!("{key}.order"),
                "is not known",
                "1 is exact for linear displacements, 2 for quadratic ones",
            );
            let points = points.unwrap_or(if order == 2 { 6 } else { 1 });
            report.require(
                order != 2 || ![1, 3].contains(&points),
                &at,
                "is too coarse for order 2",
                "6 points per face are exact to the degree it needs",
            );
            Integration::CellSmoothed { order, face_points: face_points(points, &at, report) }
        }
        IntegrationKeys::NodeSmoothed { stabilisation, points } => {
            report.require(
                (0.0..1.0).contains(&stabilisation),
                &format!("{key}.stabilisation"),
                "is no share of the weight",
                "0 is none, 0.05 is usual; all of it is rule = \"cell-smoothed\"",
            );
            let face_points = face_points(points.unwrap_or(1), &at, report);
            Integration::NodeSmoothed { stabilisation, face_points }
        }
    }
}

fn face_points(points: u32, key: &str, report: &mut Report) -> usize {
    report.require([1, 3, 6].contains(&points), key, "is no face rule", "points per face are 1, 3 or 6");
    points as usize
}

pub(crate) fn essential(keys: EssentialKeys, key: &str, report: &mut Report) -> Essential {
    let (name, factor, rows) = match keys {
        EssentialKeys::Name(name) => (name, None, None),
        EssentialKeys::Table(table) => (table.method, table.factor, table.rows),
    };
    let at = |name: &str| format!("{key}.{name}");
    if let Some(factor) = factor {
        positive(factor, &at("factor"), report);
    }
    let weak = matches!(name, EssentialKind::Nitsche | EssentialKind::Penalty);
    let help = "leave it out";
    report.require(factor.is_none() || weak, &at("factor"), "goes with nitsche and penalty only", help);
    let eliminated = name == EssentialKind::Elimination;
    report.require(rows.is_none() || eliminated, &at("rows"), "goes with elimination only", help);
    match name {
        EssentialKind::Nitsche => Essential::Nitsche { factor },
        EssentialKind::Penalty => Essential::Penalty { factor },
        EssentialKind::Multipliers => Essential::Multipliers,
        EssentialKind::Coupling => Essential::Coupling,
        EssentialKind::Elimination => Essential::Elimination { rows: rows.unwrap_or(ConstraintRows::Means) },
    }
}

pub(crate) fn size(keys: SizeKeys, key: &str, report: &mut Report) -> Option<Size> {
    let at = |name: &str| format!("{key}.{name}");
    let (grading, unit, file) = (keys.grading, keys.unit, keys.file.is_some());
    report.require(
        grading.is_none() || keys.cells.is_some(),
        &at("grading"),
        "goes with cells only",
        "leave it out",
    );
    report.require(unit.is_none() || file, &at("unit"), "goes with file only", "leave it out");
    match (keys.nodes, keys.spacing, keys.level, keys.cells, keys.file) {
        (Some(n), None, None, None, None) => Some(Size::Nodes(count(n, &at("nodes"), report))),
        (None, Some(q), None, None, None) => Some(Size::Spacing(positive(q.0, &at("spacing"), report))),
        (None, None, Some(level), None, None) => {
            report.require((1..=8).contains(&level), &at("level"), "is no level", "levels are 1 to 8");
            Some(Size::Level(level))
        }
        (None, None, None, Some(cells), None) => {
            let cells = cells.map(|n| n as usize);
            let all = cells.iter().fold(1usize, |all, n| all.saturating_mul(*n));
            let help = format!("give 1 or more along each axis, {MOST} in all at most");
            report.require((1..=MOST).contains(&all), &at("cells"), "is no number of cells", &help);
            let grading = grading.unwrap_or([1.0; 3]);
            let sound = grading.iter().all(|g| *g > 0.0);
            report.require(sound, &at("grading"), "is not positive", "1 is uniform");
            Some(Size::Cells { cells, grading })
        }
        (None, None, None, None, Some(file)) => {
            Some(Size::File(mesh_file(&file, unit.map_or(MILLIMETRE, |u| u.0), &at("file"), report)))
        }
        _ => {
            let help = "give one of nodes, spacing, level, cells and file, such as { level = 2 }";
            report.add(key, Problem::new("is not one size").help(help));
            None
        }
    }
}

/// Largest number of nodes or cells: beyond it the memory of a large machine could not hold the matrix.
const MOST: usize = 20_000_000;

/// Checks a number of nodes.
fn count(n: u32, key: &str, report: &mut Report) -> usize {
    let help = format!("give 4 to {MOST}");
    report.require((4..=MOST).contains(&(n as usize)), key, "is no number of nodes", &help);
    n as usize
}

pub(crate) fn jitter(keys: Option<JitterKeys>, key: &str, report: &mut Report) -> Option<Jitter> {
    let keys = keys?;
    let sound = (0.0..0.5).contains(&keys.fraction);
    report.require(sound, &format!("{key}.jitter.fraction"), "is no share of a cell", "give 0 to below 0.5");
    Some(Jitter { fraction: keys.fraction, seed: keys.seed })
}
