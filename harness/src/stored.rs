//! A reference in a file: what several fine solutions of one scene agree on, and how far they differ. It is made once by
//! `tissuebench reference`, takes too long to be made at every run, and is compared with by `[reference] record`.

use std::path::Path;

use cases::scene::{Body, ErrorKind, Scene};
use geometry::{Point3, Vector3};
use reports::Record;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::group::{Group, case_name};
use crate::outcome::{LoadStep, ToolStep, of_tool};
use crate::provenance;
use crate::run::Reference;

/// The file, as JSON. Lengths in m, forces in N.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stored {
    /// The scene it was made from.
    pub case: String,
    /// BLAKE3 of that scene's text.
    pub scene: String,
    /// Version and commit of the program that made it.
    pub program: String,
    /// Compiler and instruction sets: they change the last bits.
    pub made_on: String,
    /// The solution whose values stand here; the others only widen the bands.
    pub source: Source,
    /// The other solutions.
    pub beside: Vec<Source>,
    /// Positions of the probes.
    pub probes: Vec<[f64; 3]>,
    /// The ends of the load steps.
    pub steps: Vec<StoredStep>,
    /// Where the displacement at the end is told.
    pub points: Vec<[f64; 3]>,
    /// The displacement there.
    pub displacement: Vec<[f64; 3]>,
    /// Largest root mean square by which another solution's displacement differs from it.
    pub displacement_band: f64,
}

/// A solution by its method and size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Id in the scene.
    pub method: String,
    /// Nodes.
    pub nodes: usize,
}

/// The end of a load step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredStep {
    /// Part of the loading, 0 to 1.
    pub load: f64,
    /// One per tool.
    pub tools: Vec<StoredTool>,
    /// Displacement at the probes.
    pub probes: Vec<[f64; 3]>,
    /// Largest distance of another solution's displacement at a probe.
    pub probe_band: f64,
}

/// A tool at the end of a load step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredTool {
    /// Way from its start.
    pub closure: f64,
    /// Force along its way.
    pub force: f64,
    /// Smallest of all solutions.
    pub low: f64,
    /// Largest of all solutions.
    pub high: f64,
}

impl Stored {
    /// Runs every method of the scene. The last one's values are told, all of them span the bands. `points` below z = 0
    /// are told by their mirror images if the scene has only the half above.
    pub fn make(scene: &Scene, text: &str, points: &[Point3]) -> Result<Stored, Failure> {
        let half = matches!(scene.body, Body::Kidney { half: true });
        let below = |x: &Point3| half && x.z < 0.0;
        let mirrored = |v: Vector3| Vector3::new(v.x, v.y, -v.z);
        let images: Vec<Point3> =
            points.iter().map(|x| if below(x) { Point3::from(mirrored(x.coords)) } else { *x }).collect();
        let mut all = Vec::new();
        for method in &scene.methods {
            let reference = Group::solve_for(scene, &method.id, images.clone())?;
            eprintln!("{}: {} nodes", reference.method, reference.nodes);
            all.push(reference);
        }
        let Some((told, others)) = all.split_last() else {
            return Err(Failure::Run(format!("{} has no method to make a reference with", scene.file())));
        };
        let steps = told.steps.iter().enumerate().map(|(n, step)| {
            let same: Vec<&LoadStep> = others.iter().filter_map(|o| o.steps.get(n)).collect();
            let tools = step.tools.iter().enumerate().map(|(k, tool)| {
                let forces = || same.iter().map(|s| s.tools[k].pushed).chain([tool.pushed]);
                StoredTool {
                    closure: tool.closure,
                    force: tool.pushed,
                    low: forces().fold(f64::INFINITY, f64::min),
                    high: forces().fold(f64::NEG_INFINITY, f64::max),
                }
            });
            let distances =
                same.iter().flat_map(|s| s.probes.iter().zip(&step.probes).map(|(u, v)| (u - v).norm()));
            StoredStep {
                load: step.load,
                tools: tools.collect(),
                probes: step.probes.iter().map(|&u| u.into()).collect(),
                probe_band: distances.fold(0.0, f64::max),
            }
        });
        let apart = |other: &Reference| crate::norms::difference(&other.targets, &told.targets).rms_magnitude;
        let displacement = points.iter().zip(&told.targets);
        let source = |r: &Reference| Source { method: r.method.clone(), nodes: r.nodes };
        let provenance = provenance::provenance(&[(case_name(scene), text.into())], 0);
        Ok(Stored {
            case: case_name(scene),
            scene: provenance.scenes[0].blake3.clone(),
            program: format!("tissuebench {} ({})", provenance.version, provenance.commit),
            made_on: format!("{}; {}", provenance.rustc, provenance.features),
            source: source(told),
            beside: others.iter().map(source).collect(),
            probes: scene.output.probes.clone(),
            steps: steps.collect(),
            points: points.iter().map(|x| x.coords.into()).collect(),
            displacement: displacement
                .map(|(x, &u)| if below(x) { mirrored(u).into() } else { u.into() })
                .collect(),
            displacement_band: others.iter().map(apart).fold(0.0, f64::max),
        })
    }

    /// Reads the record that a scene compares with and holds it against the scene's probes.
    pub fn load(scene: &Scene, path: &Path) -> Result<Stored, Failure> {
        let wrong = |problem: String, help: &str| {
            Failure::of_scene(scene, ErrorKind::Invalid, "reference.record", &problem, help)
        };
        let remake = "make it with tissuebench reference SCENE";
        let text = std::fs::read_to_string(path)
            .map_err(|bad| wrong(format!("{}: can't be read: {bad}", path.display()), remake))?;
        let stored: Stored = serde_json::from_str(&text)
            .map_err(|bad| wrong(format!("{}: is no reference: {bad}", path.display()), remake))?;
        if stored.points.len() != stored.displacement.len() {
            let (points, told) = (stored.points.len(), stored.displacement.len());
            return Err(wrong(
                format!("{}: {points} points but {told} displacements", path.display()),
                remake,
            ));
        }
        let probes = &scene.output.probes;
        let far = |(a, b): (&[f64; 3], &[f64; 3])| (Point3::from(*a) - Point3::from(*b)).norm() > 1e-9;
        if stored.probes.len() != probes.len() || stored.probes.iter().zip(probes).any(far) {
            let problem = format!("{}: was made for other probes", path.display());
            return Err(wrong(problem, "give output.probes as in the scene it was made from"));
        }
        Ok(stored)
    }

    /// The points whose displacement is told, m.
    pub fn targets(&self) -> Vec<Point3> {
        self.points.iter().map(|&x| Point3::from(x)).collect()
    }

    /// As a run's reference.
    pub fn reference(&self) -> Reference {
        let vectors = |all: &[[f64; 3]]| -> Vec<Vector3> { all.iter().map(|&v| v.into()).collect() };
        let steps = self.steps.iter().map(|step| LoadStep {
            load: step.load,
            tools: (step.tools.iter())
                .map(|t| ToolStep { closure: t.closure, pushed: t.force, ..ToolStep::UNTOUCHED })
                .collect(),
            strain_energy: 0.0,
            smallest_j: 1.0,
            iterations: 0,
            probes: vectors(&step.probes),
            against: Vec::new(),
            more: Vec::new(),
        });
        Reference {
            method: self.source.method.clone(),
            nodes: self.source.nodes,
            targets: vectors(&self.displacement),
            steps: steps.collect(),
            finished: true,
            at: None,
        }
    }

    /// Its forces and their bands as rows of the long table.
    pub fn records(&self, case: &str, poisson: f64) -> Vec<Record> {
        let row = |quantity: String, unit: &str, phase: &str, statistic: &str, value: f64| Record {
            case: case.into(),
            method: "reference".into(),
            family: "reference".into(),
            variant: self.source.method.clone(),
            parameters: String::new(),
            poisson,
            level: 0,
            nodes: self.source.nodes as u64,
            elements: 0,
            points: 0,
            dofs: 0,
            spacing: 0.0,
            seed: 0,
            quantity,
            unit: unit.into(),
            phase: phase.into(),
            statistic: statistic.into(),
            value,
        };
        let mut rows = Vec::new();
        for (number, step) in self.steps.iter().enumerate() {
            let phase = format!("step-{}", number + 1);
            for (index, tool) in step.tools.iter().enumerate() {
                rows.push(row(of_tool("closure", index), "m", &phase, "value", tool.closure));
                for (statistic, value) in [("value", tool.force), ("low", tool.low), ("high", tool.high)] {
                    rows.push(row(of_tool("tool-force", index), "N", &phase, statistic, value));
                }
            }
            rows.push(row("probe-band".into(), "m", &phase, "value", step.probe_band));
        }
        rows
    }
}
