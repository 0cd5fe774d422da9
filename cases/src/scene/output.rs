//! Output of a scene: probes, means, transfers, and frames of a repeated loading.

use catalogue::{Problem, Values, suggest};
use schemars::JsonSchema;
use serde::Deserialize;

use super::goal::Goal;
use super::mesh_file::MeshFile;
use super::procedure::ProcedureKind;
use super::reference::Reference;
use super::region::Region;
use super::report::Report;
use super::selection::{Names, Place};
use super::table::{Key, table};
use super::units::{Length, Q, Time, Unit};
use super::vocabulary::{Given, Schemes, Word, build, settings};
use super::words::words;

#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OutputKeys {
    /// Points at which results are reported
    probes: Option<Vec<[Q<Length>; 3]>>,
    /// Faces whose area mean of the displacement is reported: [{ on = "z-max" }, { where = "z == 20 mm and x
    /// >= 3 mm" }]
    means: Option<Vec<MeanKeys>>,
    /// Points at which the stretch along a direction is reported: [{ at = ["5 mm", "0 mm", "0 mm"], along = [1,
    /// 0, 0] }]
    stretches: Option<Vec<StretchKeys>>,
    /// Surfaces whose enclosed volume is reported: [{ on = "inner" }]
    volumes: Option<Vec<VolumeKeys>>,
    /// Regions whose strain energy is reported: names of [[region]], and "body" for the rest
    energies: Option<Vec<String>>,
    /// Point about which the moments of tools and supports are reported
    moments_about: Option<[Q<Length>; 3]>,
    transfer: Option<TransfersKeys>,
    /// Secondary reference: a method of this scene that every run is also compared with at the targets. For a
    /// published method whose own error is part of a published difference
    beside: Option<String>,
    /// Whether studies draw the deformed body with each method
    #[serde(default)]
    pictures: bool,
    /// Whether the errors of each run are estimated, by a prediction with more shape functions on the same body
    #[serde(default)]
    estimate: bool,
    /// Number whose error is traced to the cells of each method that cause it, such as "tool-force",
    /// "probe-2" or "reaction-z"
    error_of: Option<String>,
    /// Whether strict bounds of the strain energy are computed with each run, in linear elasticity
    #[serde(default)]
    bounds: bool,
    /// Repetition of the loading after the first solution, as in a simulator, with each frame timed
    repeated: Option<RepeatedKeys>,
}

/// A part of the surface
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct MeanKeys {
    /// Names given by the shape or the mesh file
    on: Option<Names>,
    /// Comparisons joined by 'and'
    #[serde(rename = "where")]
    place: Option<Region>,
}

/// A point and a direction of the undeformed body
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StretchKeys {
    at: [Q<Length>; 3],
    /// Direction of any length
    along: [f64; 3],
}

/// A closed surface, or an open surface with the apex of the cone that closes it
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct VolumeKeys {
    /// Names given by the shape or the mesh file
    on: Option<Names>,
    /// Comparisons joined by 'and'
    #[serde(rename = "where")]
    place: Option<Region>,
    /// Fixed point in space from which straight lines to the rim of an open surface close the volume. If the
    /// rim moves in planes through this point, the planes close it
    apex: Option<[Q<Length>; 3]>,
}

table! {
    /// A simulator's loop: prepared once, the loading goes up and down frame by frame
    #[serde(deny_unknown_fields)]
    pub struct Repeated from RepeatedKeys {
        /// Total number of frames; percentiles above 99 need 1000
        frames: usize as u32,
        /// Frames of one cycle up and down; 120 unless given, 4 s at 30 Hz
        cycle: usize as u32 = 120,
        /// Time after which no further frame starts; 10 s unless given
        within: f64 as Q<Time> = 10.0,
        /// Relative residual of a frame solved by Newton's method; the procedure's tolerance unless given
        tolerance: Option<f64>,
    }
}

/// One transfer or several
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum TransfersKeys {
    One(TransferKeys),
    Several(Vec<TransferKeys>),
}

/// A transfer of nodal displacements to other points
#[derive(Deserialize, JsonSchema)]
struct TransferKeys {
    to: TargetKeys,
    scheme: SchemeKeys,
    #[serde(flatten)]
    settings: Given<Schemes>,
}

/// A transfer scheme, or "own": the method's own shape functions
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum SchemeKeys {
    Scheme(Word<Schemes>),
    Own(OwnWord),
}

words! {
    /// A transfer without a scheme.
    enum OwnWord {
        /// The method's own shape functions.
        Own = "own",
    }
}

/// "reference-nodes", "probes", or the nodes of a mesh file
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum TargetKeys {
    Name(TargetName),
    File(FileKeys),
}

words! {
    /// Target points of a transfer.
    enum TargetName {
        /// The nodes of the reference method.
        ReferenceNodes = "reference-nodes",
        /// The probes of the output.
        Probes = "probes",
    }
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct FileKeys {
    file: String,
    unit: Option<Unit<Length>>,
}

/// Output of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Output {
    /// Points at which results are reported, in metres.
    pub probes: Vec<[f64; 3]>,
    /// Parts of the surface whose mean displacement is reported.
    pub means: Vec<Place>,
    /// Points and directions whose stretch is reported.
    pub stretches: Vec<Stretch>,
    /// Surfaces whose enclosed volume is reported.
    pub volumes: Vec<Enclosed>,
    /// Regions whose strain energy is reported; "body" is the part without a region of its own.
    pub energies: Vec<String>,
    /// Point about which moments are reported, m.
    pub moments_about: Option<[f64; 3]>,
    /// Transfers of the nodal displacements to other points.
    pub transfers: Vec<Transfer>,
    /// Id of the secondary reference: a method that every run is also compared with at the targets.
    pub beside: Option<String>,
    /// Whether studies draw the deformed body.
    pub pictures: bool,
    /// Whether the errors of each run are estimated.
    pub estimate: bool,
    /// Number whose error is traced to the cells that cause it.
    pub error_of: Option<Goal>,
    /// Whether strict bounds of the strain energy are computed with each run.
    pub bounds: bool,
    /// Repetition of the loading in frames.
    pub repeated: Option<Repeated>,
}

/// A point and a direction whose stretch is reported.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Point of the undeformed body, m.
    pub at: [f64; 3],
    /// Unit direction in the undeformed body.
    pub along: [f64; 3],
}

/// A surface whose enclosed volume is reported.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosed {
    /// The surface.
    pub surface: Place,
    /// Apex of the cone that closes an open surface, m.
    pub apex: Option<[f64; 3]>,
}

/// A transfer of nodal displacements to other points.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// Target points.
    pub to: Target,
    /// The scheme and the values of its parameters; `None` for the solver's own rows.
    pub scheme: Option<(interp::Scheme, Values)>,
}

/// Target points of a transfer.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The nodes of the reference method.
    ReferenceNodes,
    /// The probes.
    Probes,
    /// The nodes of a mesh file.
    File(MeshFile),
}

impl OutputKeys {
    pub fn read(self, report: &Report) -> Output {
        if let Some(probes) = &self.probes {
            let help = "name a point, or leave the key out";
            report.require(!probes.is_empty(), "probes", "is empty", help);
        }
        if let Some(means) = &self.means {
            let help = "name a face, such as { on = \"z-max\" }, or leave the key out";
            report.require(!means.is_empty(), "means", "is empty", help);
        }
        if let Some(stretches) = &self.stretches {
            let help = "give a point and a direction, or leave the key out";
            report.require(!stretches.is_empty(), "stretches", "is empty", help);
        }
        if let Some(volumes) = &self.volumes {
            let help = "name a surface, such as { on = \"inner\" }, or leave the key out";
            report.require(!volumes.is_empty(), "volumes", "is empty", help);
        }
        if let Some(energies) = &self.energies {
            let help = "name a region, such as \"body\", or leave the key out";
            report.require(!energies.is_empty(), "energies", "is empty", help);
        }
        let mean = |of: MeanKeys, report: &Report| Some(Place::required(of.on, of.place, report));
        Output {
            probes: self.probes.unwrap_or_default().into_iter().map(|x| x.map(|q| q.0)).collect(),
            means: report.each("means", self.means.unwrap_or_default(), mean),
            stretches: report.each("stretches", self.stretches.unwrap_or_default(), StretchKeys::read),
            volumes: report.each("volumes", self.volumes.unwrap_or_default(), VolumeKeys::read),
            energies: self.energies.unwrap_or_default(),
            moments_about: self.moments_about.map(|x| x.map(|q| q.0)),
            transfers: match self.transfer {
                None => Vec::new(),
                Some(TransfersKeys::One(one)) => one.read(&report.at("transfer")).into_iter().collect(),
                Some(TransfersKeys::Several(several)) => report.each("transfer", several, TransferKeys::read),
            },
            beside: self.beside,
            pictures: self.pictures,
            estimate: self.estimate,
            error_of: self.error_of.and_then(|name| Goal::read(&name, "error_of", report)),
            bounds: self.bounds,
            repeated: self.repeated.map(|keys| keys.read(&report.at("repeated"))),
        }
    }
}

/// Largest number of frames: nine hours at 30 Hz, with the time of each frame stored.
const MOST_FRAMES: usize = 1_000_000;

impl RepeatedKeys {
    fn read(self, report: &Report) -> Repeated {
        let repeated = self.value();
        let sound = (1..=MOST_FRAMES).contains(&repeated.frames);
        let help = "give 1 to 1000000; a percentile of 99.9 needs 1000";
        report.require(sound, "frames", "is no number of frames", help);
        let sound = repeated.cycle >= 2 && repeated.cycle % 2 == 0;
        let help = "give an even number of frames, half of them for the way up";
        report.require(sound, "cycle", "is no way up and down", help);
        report.positive("within", repeated.within);
        repeated.tolerance.map(|tolerance| report.positive("tolerance", tolerance));
        repeated
    }
}

impl StretchKeys {
    fn read(self, report: &Report) -> Option<Stretch> {
        let length = self.along.iter().map(|c| c * c).sum::<f64>().sqrt();
        let sound = length > 0.0 && length.is_finite();
        report.require(sound, "along", "has no direction", "give a vector such as [1, 0, 0]");
        Some(Stretch { at: self.at.map(|q| q.0), along: self.along.map(|c| c / length) })
    }
}

impl VolumeKeys {
    fn read(self, report: &Report) -> Option<Enclosed> {
        let surface = Place::required(self.on, self.place, report);
        Some(Enclosed { surface, apex: self.apex.map(|x| x.map(|q| q.0)) })
    }
}

impl TransferKeys {
    fn read(self, report: &Report) -> Option<Transfer> {
        let to = match self.to {
            TargetKeys::Name(TargetName::ReferenceNodes) => Target::ReferenceNodes,
            TargetKeys::Name(TargetName::Probes) => Target::Probes,
            TargetKeys::File(f) => Target::File(MeshFile::read(&f.file, f.unit, "to.file", report)),
        };
        let scheme = match self.scheme {
            SchemeKeys::Own(OwnWord::Own) => None,
            SchemeKeys::Scheme(word) => {
                let values = settings(&word, self.settings, report)?;
                Some((build(word.0, &values, "scheme", report)?, values))
            }
        };
        Some(Transfer { to, scheme })
    }
}

impl Output {
    /// Reports names in `energies` that are not those of the `known` regions.
    pub(crate) fn check_regions<'a>(&self, known: impl Iterator<Item = &'a str>, report: &Report) {
        let known: Vec<&str> = known.collect();
        for (index, name) in
            self.energies.iter().enumerate().filter(|(_, name)| !known.contains(&name.as_str()))
        {
            let problem =
                Problem::new("is not a region of the scene").found(name).help(suggest(name, &known));
            report.add(&format!("energies[{index}]"), problem);
        }
    }

    /// Reports contradictions with the procedure and the reference.
    pub(crate) fn demands(&self, kind: ProcedureKind, reference: Option<&Reference>, report: &Report) {
        if let Some((problem, help)) = kind.lacks_displacements() {
            for (key, given) in [
                ("probes", !self.probes.is_empty()),
                ("means", !self.means.is_empty()),
                ("stretches", !self.stretches.is_empty()),
                ("volumes", !self.volumes.is_empty()),
                ("energies", !self.energies.is_empty()),
                ("moments_about", self.moments_about.is_some()),
                ("transfer", !self.transfers.is_empty()),
                ("beside", self.beside.is_some()),
                ("pictures", self.pictures),
                ("estimate", self.estimate && kind != ProcedureKind::Modes),
                ("error_of", self.error_of.is_some()),
                ("repeated", self.repeated.is_some() && kind == ProcedureKind::Prepare),
            ] {
                report.require(!given, key, problem, help);
            }
        }
        let at_rest = matches!(kind, ProcedureKind::Prepare | ProcedureKind::Linear | ProcedureKind::Static);
        let help = "take [procedure] kind = \"linear\" or \"static\", or leave it out";
        let sound = at_rest || self.repeated.is_none();
        report.require(sound, "repeated", "is of solutions at rest, not of motion", help);
        let estimated = at_rest || kind == ProcedureKind::Modes;
        let problem = "is of solutions at rest and of vibrations, not of motion";
        report.require(estimated || !self.estimate, "estimate", problem, help);
        let problem = "is traced in solutions at rest, not in motion";
        report.require(at_rest || self.error_of.is_none(), "error_of", problem, help);
        let compared = !self.transfers.is_empty() || matches!(reference, Some(Reference::Method { .. }));
        let help = "add output.transfer = { to = { file = \"...\" }, ... }";
        let sound = compared || self.beside.is_none();
        report.require(sound, "beside", "has no points to be compared at", help);
        for (i, transfer) in self.transfers.iter().enumerate() {
            let (problem, help) = match transfer.to {
                Target::ReferenceNodes if !reference.is_some_and(Reference::is_solved) => (
                    "has no nodes to go to",
                    "add [reference] method = \"...\" or record = \"...\", or transfer to { file = \"...\" }",
                ),
                Target::Probes if self.probes.is_empty() => ("has no probes to go to", "add output.probes"),
                _ => continue,
            };
            let listed = format!("transfer[{i}]");
            let key = if report.is_given(&listed) { listed } else { "transfer".into() };
            report.add(&format!("{key}.to"), Problem::new(problem).help(help));
        }
    }
}
