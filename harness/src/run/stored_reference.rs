//! A reference in a file: the common result of several fine solutions of one scene, and the differences
//! between them. `tissuebench reference` makes it once, because it takes too long for every run. A scene
//! compares with it by `[reference] record`.

use std::collections::BTreeMap;
use std::path::Path;

use cases::scene::{ErrorKind, Scene};
use catalogue::metric::{self, Address};
use catalogue::warning;
use geometry::{Point3, Vector3};
use records::{Family, Record};
use serde::{Deserialize, Serialize};

use super::symmetry::Mirror;
use crate::error::Failure;
use crate::measure::{OwnError, Reference, norms};
use crate::outcome::{LoadStep, ToolStep, Warning, provenance, push, run_id};
use crate::scenario::PlacedTool;

/// Stored reference, a JSON file. Lengths in m, forces in N.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stored {
    /// Case name of the scene from which the reference was made.
    pub case: String,
    /// BLAKE3 hash of that scene without its title, source, purpose, published data, checks and methods. It
    /// identifies the problem that was solved.
    pub problem: String,
    /// Version and commit of the program that made the file.
    pub program: String,
    /// Compiler and instruction sets, which change the last bits of the results.
    pub made_on: String,
    /// Solution whose values are stored. The others only widen the bands.
    pub source: Source,
    /// Other solutions, which widen the bands.
    pub beside: Vec<Source>,
    /// Positions of the probes, m.
    pub probes: Vec<[f64; 3]>,
    /// Results at the end of each load step.
    pub steps: Vec<StoredStep>,
    /// Points at which the final displacement is given, m.
    pub points: Vec<[f64; 3]>,
    /// Final displacement at the points, m.
    pub displacement: Vec<[f64; 3]>,
    /// Largest root-mean-square difference of another solution's displacement, m.
    pub displacement_band: f64,
}

/// Method and size of a stored solution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Id of the method in the scene.
    pub method: String,
    /// Number of nodes.
    pub nodes: usize,
    /// Table of the method in the scene, as TOML.
    pub table: String,
}

/// Hash of a scene's problem, and the tables of the scene's methods.
pub(crate) struct Problem {
    pub(crate) problem: String,
    /// Tables by method id.
    pub(crate) methods: BTreeMap<String, String>,
}

impl Problem {
    /// Parses `text`, the source of a scene that was read successfully.
    pub(crate) fn of(text: &str) -> Problem {
        let mut table: toml::Table = text.parse().expect("a scene is TOML");
        let mut methods = BTreeMap::new();
        if let Some(toml::Value::Array(tables)) = table.remove("method") {
            for table in tables {
                let id = table.get("id").and_then(toml::Value::as_str).unwrap_or_default().to_string();
                methods.insert(id, toml::to_string(&table).expect("a table of TOML"));
            }
        }
        // Descriptions and checks are not part of the problem.
        for words in ["title", "source", "purpose", "published", "check", "loop"] {
            table.remove(words);
        }
        Problem { problem: provenance::hash(&toml::to_string(&table).expect("a table of TOML")), methods }
    }
}

/// Results at the end of a load step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredStep {
    /// Fraction of the loading, 0 to 1.
    pub load: f64,
    /// Results of each tool.
    pub tools: Vec<StoredTool>,
    /// Displacement at the probes, m.
    pub probes: Vec<[f64; 3]>,
    /// Largest difference of another solution's displacement at a probe, m.
    pub probe_band: f64,
}

/// A tool at the end of a load step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredTool {
    /// Travel from the start, m.
    pub closure: f64,
    /// Force along the direction of travel, N.
    pub force: f64,
    /// Smallest force of all solutions, N.
    pub low: f64,
    /// Largest force of all solutions, N.
    pub high: f64,
}

/// Tolerance of probe positions, relative to the largest coordinate.
const SAME: f64 = 1e-7;

impl Stored {
    /// Ids of the methods whose solutions the reference contains.
    pub fn methods(&self) -> impl Iterator<Item = &str> {
        self.beside.iter().chain([&self.source]).map(|s| s.method.as_str())
    }

    /// Checks that the reference belongs to the problem of the scene `text` and to `points` (m).
    ///
    /// # Errors
    /// Returns a message if the problem, the points, or the scene's tables of the stored methods differ.
    pub fn belongs(&self, text: &str, points: &[Point3]) -> Result<(), String> {
        let Source { method, nodes, .. } = &self.source;
        let problem = Problem::of(text);
        if self.problem != problem.problem {
            return Err(format!(
                "{method} on {nodes} nodes belongs to another scene, or to another text of the scene"
            ));
        }
        for Source { method, nodes, table } in self.beside.iter().chain([&self.source]) {
            if problem.methods.get(method) != Some(table) {
                return Err(format!(
                    "{method} on {nodes} nodes was not computed by the scene's '{method}', but by\n{table}"
                ));
            }
        }
        let same = self.points.iter().copied().eq(points.iter().map(|x| <[f64; 3]>::from(x.coords)));
        if same { Ok(()) } else { Err(format!("{method} on {nodes} nodes has other points")) }
    }

    /// Widens the bands to include those of another solution of the same scene at the same points.
    pub fn widen(&mut self, other: &Stored) {
        for (step, beside) in self.steps.iter_mut().zip(&other.steps) {
            for (tool, beside) in step.tools.iter_mut().zip(&beside.tools) {
                tool.low = tool.low.min(beside.low);
                tool.high = tool.high.max(beside.high);
            }
            for (u, v) in step.probes.iter().zip(&beside.probes) {
                let apart = (Vector3::from(*u) - Vector3::from(*v)).norm();
                step.probe_band = step.probe_band.max(apart + beside.probe_band);
            }
        }
        let [here, there] = [&self.displacement, &other.displacement]
            .map(|all| all.iter().map(|&u| u.into()).collect::<Vec<_>>());
        let apart = norms::difference(&there, &here).rms_magnitude;
        self.displacement_band = self.displacement_band.max(apart + other.displacement_band);
        self.beside.extend(other.beside.iter().chain([&other.source]).cloned());
        // The result must not depend on the order in which solutions are joined.
        self.beside.sort_by(|a, b| a.method.cmp(&b.method));
    }

    /// Reads a file.
    ///
    /// # Errors
    /// Returns a message with the path and the reason if the file cannot be read or parsed.
    pub fn read(path: &Path) -> Result<Stored, String> {
        Stored::parsed(path).map_err(|problem| format!("{}: {problem}", path.display()))
    }

    fn parsed(path: &Path) -> Result<Stored, String> {
        let text = disk::read_text(path, disk::Kind::REFERENCE).map_err(|bad| match bad.kind() {
            std::io::ErrorKind::NotFound => format!("can't be read: there is no file {}", path.display()),
            _ => format!("can't be read: {bad}"),
        })?;
        Stored::parse(&text)
    }

    /// Parses the text of a file.
    ///
    /// # Errors
    /// Returns a message if the text is no reference, or if the numbers of points and displacements differ.
    pub fn parse(text: &str) -> Result<Stored, String> {
        let stored: Stored =
            serde_json::from_str(text).map_err(|bad| format!("is not a reference: {bad}"))?;
        let (points, values) = (stored.points.len(), stored.displacement.len());
        if points == values {
            Ok(stored)
        } else {
            Err(format!("has {points} points but {values} displacements"))
        }
    }

    /// Reads the stored reference of a scene.
    ///
    /// # Errors
    /// Returns an error at `reference.record` if the file cannot be read or was made for other probes.
    pub fn load(scene: &Scene, path: &Path) -> Result<Stored, Failure> {
        let wrong = |problem: String, help: &str| {
            Failure::of_scene(scene, ErrorKind::Invalid, "reference.record", &problem, help)
        };
        let remake = "create the file with tissuebench reference SCENE";
        // The message contains the file's name as the value of the key.
        let stored = Stored::parsed(path).map_err(|problem| wrong(problem, remake))?;
        let probes = &scene.output.probes;
        let size = probes.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
        let far = |(a, b): (&[f64; 3], &[f64; 3])| (Point3::from(*a) - Point3::from(*b)).norm() > SAME * size;
        if stored.probes.len() != probes.len() || stored.probes.iter().zip(probes).any(far) {
            return Err(wrong(
                "was made for other probes".into(),
                "give output.probes as in the scene of the reference",
            ));
        }
        Ok(stored)
    }

    /// Points at which the displacement is given, mirrored to the modelled part, m.
    pub(crate) fn targets(&self, mirror: &Mirror) -> Vec<Point3> {
        self.points.iter().map(|&x| mirror.place(&x.into())).collect()
    }

    /// Warns of each tool that a plane of symmetry cuts, because the file has its force on the whole body.
    fn cut_tools(&self, mirror: &Mirror, tools: &[PlacedTool]) -> Vec<Warning> {
        let body: Vec<Point3> = self.points.iter().map(|&x| x.into()).collect();
        let cut = |(index, placed): (usize, &PlacedTool)| {
            let fraction = mirror.fraction(&placed.tool, &body);
            (fraction < 1.0).then(|| {
                let message = format!(
                    "the tool '{}' is cut by planes of symmetry: its force in this scene is {fraction} of that on \
                     the whole body, which the reference has, and the two are compared as they are",
                    placed.name
                );
                Warning::new(&warning::TOOL_CUT, fraction, format!("tool[{index}]"), message)
            })
        };
        tools.iter().enumerate().filter_map(cut).collect()
    }

    /// Converts the file to the reference of a run with these tools.
    pub(crate) fn reference(&self, mirror: &Mirror, tools: &[PlacedTool]) -> Reference {
        let vectors = |all: &[[f64; 3]]| -> Vec<Vector3> { all.iter().map(|&v| v.into()).collect() };
        let at_points = self.points.iter().zip(&self.displacement);
        let steps = self.steps.iter().map(|step| LoadStep {
            load: step.load,
            tools: (step.tools.iter())
                .map(|t| ToolStep { closure: t.closure, pushed: t.force, ..ToolStep::UNTOUCHED })
                .collect(),
            supports: Vec::new(),
            means: Vec::new(),
            strain_energy: None,
            smallest_j: 1.0,
            iterations: 0,
            probes: vectors(&step.probes),
            points: Vec::new(),
            against: Vec::new(),
            more: Vec::new(),
        });
        Reference {
            method: self.source.method.clone(),
            nodes: self.source.nodes,
            targets: at_points.map(|(&x, &u)| mirror.displacement(&x.into(), u.into())).collect(),
            steps: steps.collect(),
            finished: true,
            warnings: self.cut_tools(mirror, tools),
            own: self.own_error(),
            at: None,
        }
    }

    /// Relative differences of the other solutions at the end.
    fn own_error(&self) -> OwnError {
        let mut own = OwnError::default();
        if self.beside.is_empty() {
            own.unknown = format!("only the solution by {} is stored", self.source.method);
            return own;
        }
        own.by = self.beside.iter().map(|s| format!("{} with {} nodes", s.method, s.nodes)).collect();
        let u: Vec<Vector3> = self.displacement.iter().map(|&u| u.into()).collect();
        let size = norms::difference(&u, &vec![Vector3::zeros(); u.len()]).rms_magnitude;
        if size > 0.0 {
            push(&mut own.band, &metric::RELATIVE_RMS, self.displacement_band / size);
        }
        for (index, tool) in self.steps.iter().last().iter().flat_map(|step| &step.tools).enumerate() {
            if tool.force != 0.0 {
                let farthest = (tool.high - tool.force).max(tool.force - tool.low);
                push(&mut own.band, metric::TOOL_FORCE_ERROR.at(index), farthest / tool.force.abs());
            }
        }
        own
    }

    /// Forces and their bands as rows of the long table. `case` provides the case's name, purpose and
    /// Poisson's ratio.
    pub fn records(&self, case: &Record) -> Vec<Record> {
        let own = Record {
            method: "reference".into(),
            series: "reference".into(),
            family: Family::Reference,
            variant: self.source.method.clone(),
            nodes: self.source.nodes as u64,
            ..case.clone()
        };
        let own = Record { run: run_id(&own), ..own };
        let mut rows = Vec::new();
        for (number, step) in self.steps.iter().enumerate() {
            let here = Record { step: Some(number as u64 + 1), ..own.clone() };
            let mut push = |of: Address, statistic: &str, value: f64| {
                rows.push(Record { statistic: statistic.into(), value, ..here.clone() }.with(of));
            };
            for (index, tool) in step.tools.iter().enumerate() {
                push(metric::CLOSURE.at(index), "value", tool.closure);
                for (statistic, value) in [("value", tool.force), ("low", tool.low), ("high", tool.high)] {
                    push(metric::TOOL_FORCE.at(index), statistic, value);
                }
            }
            push(metric::PROBE_BAND.whole(), "value", step.probe_band);
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Solution with one point, one probe and one tool. All lengths are `u`, the force is 10 `u`.
    fn solution(method: &str, u: f64) -> Stored {
        let tool = StoredTool { closure: u, force: 10.0 * u, low: 10.0 * u, high: 10.0 * u };
        let probes = vec![[u, 0.0, 0.0]];
        Stored {
            case: "block".into(),
            problem: String::new(),
            program: String::new(),
            made_on: String::new(),
            source: Source { method: method.into(), nodes: 8, table: String::new() },
            beside: Vec::new(),
            probes: vec![[0.0; 3]],
            steps: vec![StoredStep { load: 1.0, tools: vec![tool], probes: probes.clone(), probe_band: 0.0 }],
            points: vec![[0.0; 3]],
            displacement: probes,
            displacement_band: 0.0,
        }
    }

    /// A band includes the farthest solution and the bands that this solution already had.
    #[test]
    fn bands_reach_over_every_solution() {
        let mut fine = solution("fine", 2.0);
        fine.widen(&solution("stiff", 1.5));
        let band = |stored: &Stored| {
            let tool = stored.steps[0].tools[0];
            (tool.low, tool.force, tool.high, stored.steps[0].probe_band, stored.displacement_band)
        };
        assert_eq!(band(&fine), (15.0, 20.0, 20.0, 0.5, 0.5));
        let mut soft = solution("soft", 3.0);
        soft.widen(&solution("softest", 3.25));
        fine.widen(&soft);
        // 1 to the soft solution, and 0.25 from there.
        assert_eq!(band(&fine), (15.0, 20.0, 32.5, 1.25, 1.25));
        assert_eq!(fine.methods().collect::<Vec<_>>(), ["soft", "softest", "stiff", "fine"]);
    }
}
