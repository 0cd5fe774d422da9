//! Methods and their sizes.

use crate::scene::error::Problem;
use crate::scene::keys::*;
use crate::scene::method::*;
use crate::scene::report::Report;

use super::{mesh_file, positive};

pub(super) fn method(keys: MethodKeys, index: usize, report: &mut Report) -> Option<Method> {
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

pub(super) fn size(keys: SizeKeys, key: &str, report: &mut Report) -> Option<Size> {
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
