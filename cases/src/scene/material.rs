//! Materials of a scene: laws with their constants, density and relaxation, and the parts of the body with
//! their own material.

use std::borrow::Cow;

use catalogue::{Problem, Value, Values};
use material::{Law, LawEntry, Material as _};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::body::Body;
use super::expression::Expression;
use super::field::ScalarField;
use super::procedure::{Procedure, ProcedureKind};
use super::region::Region;
use super::report::Report;
use super::selection::{Names, Place};
use super::units::{Angle, Density, Pressure, Q, Time};
use super::vocabulary::{Given, Laws, Word, build, settings, tagged};
use crate::exact::{Elastic, ExactError, Hyperelastic, Medium};

/// A material law and its constants
#[derive(Deserialize)]
pub(crate) struct MaterialKeys {
    law: Word<Laws>,
    #[serde(flatten)]
    beside: BesideLaw,
    #[serde(flatten)]
    settings: Given<Laws>,
}

/// Keys that every material has, whatever its law
#[derive(Deserialize, JsonSchema)]
struct BesideLaw {
    density: Option<Q<Density>>,
    #[serde(default)]
    prony: Vec<PronyKeys>,
    /// Direction of the fibres in the undeformed body, of any length: [1, 0, 0], or expressions in x, y and z
    /// (metres) such as ["-y", "x", "0"]; for laws that depend on directions
    fibers: Option<DirectionKeys>,
    /// Active stress of contracting muscle along the fibres at the end of the loading, with which it grows: the second
    /// Piola-Kirchhoff stress T f x f beside the passive law; none unless given
    active: Option<Q<Pressure>>,
    /// Direction within a sheet across the fibres; its part along the fibre is taken off. Any direction across the
    /// fibre unless given
    sheets: Option<DirectionKeys>,
}

/// Three numbers, or three expressions in x, y and z (metres)
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum DirectionKeys {
    Constant([f64; 3]),
    Expressions([Expression; 3]),
    Helix(HelixKeys),
}

/// Fibres of a ventricle: the angle from the circumference towards the base, at the inner and at the outer wall
/// and linear between them
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct HelixKeys {
    helix: [Q<Angle>; 2],
}

impl From<DirectionKeys> for Direction {
    fn from(keys: DirectionKeys) -> Direction {
        match keys {
            DirectionKeys::Constant(components) => Direction::Field(components.map(ScalarField::Constant)),
            DirectionKeys::Expressions(of) => {
                Direction::Field(of.map(|of| ScalarField::Expression { of, factor: 1.0 }))
            }
            DirectionKeys::Helix(keys) => Direction::Helix(keys.helix.map(|angle| angle.0)),
        }
    }
}

impl JsonSchema for MaterialKeys {
    fn schema_name() -> Cow<'static, str> {
        "material".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        tagged::<Laws, BesideLaw>("law", "A material law and its constants", generator)
    }
}

/// A share of the shear response that relaxes, with its relaxation time
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct PronyKeys {
    g: f64,
    tau: Q<Time>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RegionKeys {
    name: String,
    /// A volume named in the mesh file
    on: Option<Names>,
    #[serde(rename = "where")]
    place: Option<Region>,
    material: MaterialKeys,
}

/// A law with the constants given by the scene, and its density and relaxation.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    entry: &'static LawEntry,
    values: Values,
    law: Law,
    /// Density in kilograms per cubic metre, if given.
    pub density: Option<f64>,
    /// Prony series of the relaxation; empty for a material that does not relax.
    pub prony: Vec<Relaxation>,
    /// Directions of fibres and sheets; `None` for a law that does not depend on them.
    pub directions: Option<Directions>,
    /// Active stress along the fibres at the end of the loading, in pascals; 0 without.
    pub active: f64,
}

/// Directions of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    /// Along the fibres.
    pub fibers: Direction,
    /// Within a sheet across the fibres, if given.
    pub sheets: Option<Direction>,
}

/// A direction as a function of the undeformed position.
#[derive(Clone, Debug, PartialEq)]
pub enum Direction {
    /// A vector of any length.
    Field([ScalarField; 3]),
    /// In the wall of a ventricle, at an angle (radians) from the circumference towards the base: at the inner and
    /// at the outer wall, and linear in the depth.
    Helix([f64; 2]),
}

impl Direction {
    /// Whether the direction is zero everywhere.
    fn is_zero(&self) -> bool {
        let zero = |field: &ScalarField| matches!(field, ScalarField::Constant(0.0));
        matches!(self, Direction::Field(components) if components.iter().all(zero))
    }
}

/// A term of a Prony series: a share of the shear response that relaxes exponentially.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    /// Share `g` of the shear response, between 0 and 1.
    pub g: f64,
    /// Relaxation time in seconds, positive.
    pub tau: f64,
}

/// A part of the body with its own material.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialRegion {
    /// Name in tables.
    pub name: String,
    /// Selection of its cells; names refer to volumes in the mesh file.
    pub place: Place,
    /// Material of the region.
    pub material: Material,
}

impl MaterialKeys {
    pub fn read(self, report: &Report) -> Option<Material> {
        let density = self.beside.density.map(|d| report.positive("density", d.0));
        let prony = prony(self.beside.prony, report);
        let entry = self.law.0;
        let values = settings(&self.law, self.settings, report)?;
        let law = build(entry, &values, "law", report)?;
        let given = (self.beside.fibers.map(Into::into), self.beside.sheets.map(Into::into));
        let directions = directions(&law, given, report);
        let active = self.beside.active.map_or(0.0, |active| active.0);
        let help = "take a law with fibres, such as law = \"guccione\"";
        report.require(active == 0.0 || directions.is_some(), "active", "has no fibre to act along", help);
        Some(Material { entry, values, law, density, prony, directions, active })
    }
}

/// Checks that directions are given for a law that depends on them, and for no other.
fn directions(
    law: &Law,
    (fibers, sheets): (Option<Direction>, Option<Direction>),
    report: &Report,
) -> Option<Directions> {
    if !law.has_axes() {
        for (key, given) in [("fibers", &fibers), ("sheets", &sheets)] {
            let problem = format!("has no effect: the law {} is the same in all directions", law.name());
            report.require(given.is_none(), key, &problem, "leave it out, or take a law with fibres");
        }
        return None;
    }
    let Some(fibers) = fibers else {
        report.missing("fibers", "give the direction of the fibres, such as fibers = [1, 0, 0]");
        return None;
    };
    for (key, direction) in [("fibers", Some(&fibers)), ("sheets", sheets.as_ref())] {
        let sound = direction.is_none_or(|direction| !direction.is_zero());
        report.require(sound, key, "has no direction", "give a vector such as [1, 0, 0]");
    }
    Some(Directions { fibers, sheets })
}

fn prony(terms: Vec<PronyKeys>, report: &Report) -> Vec<Relaxation> {
    let terms = report.each("prony", terms, |term, report| {
        Some(Relaxation { g: report.positive("g", term.g), tau: report.positive("tau", term.tau.0) })
    });
    let sum: f64 = terms.iter().map(|term| term.g).sum();
    let help = "a part must not relax: the sum of the shares has to be below 1";
    report.require(sum < 1.0, "prony", "relaxes everything", help);
    terms
}

impl RegionKeys {
    pub fn read(self, report: &Report) -> Option<MaterialRegion> {
        let place = Place::required(self.on, self.place, report);
        let material = self.material.read(&report.at("material"));
        Some(MaterialRegion { name: self.name, place, material: material? })
    }
}

/// Reports names of regions that are not unique.
pub(crate) fn unique(regions: &[MaterialRegion], report: &Report) {
    for (i, region) in regions.iter().enumerate() {
        if regions[..i].iter().any(|other| other.name == region.name) {
            let problem = Problem::new("is the name of another region").help("names are unique");
            report.add(&format!("region[{i}].name"), problem);
        }
    }
}

impl Material {
    /// The law.
    pub fn law(&self) -> &Law {
        &self.law
    }

    /// The name of the law in files and tables.
    pub fn name(&self) -> &'static str {
        self.entry.name
    }

    /// A constant that the scene gives as one number, such as `young` (SI).
    pub fn constant(&self, name: &str) -> Option<f64> {
        self.values.get(name)
    }

    /// The law with another Poisson's ratio; unchanged if the law has no such constant.
    pub fn at_poisson(&self, poisson: f64) -> Result<Law, Problem> {
        let mut values = self.values.clone();
        if values.has("poisson") {
            values.give("poisson", Value::Number(poisson))?;
        }
        (self.entry.build)(&values)
    }
    /// Reports contradictions with the body and the procedure.
    pub(crate) fn demands(&self, body: &Body, procedure: &Procedure, report: &Report) {
        let kind = procedure.kind();
        if self.active != 0.0 && kind == ProcedureKind::Explicit {
            let help = "take [procedure] kind = \"static\" or \"implicit-dynamic\"";
            report.add("active", Problem::new("is not available in explicit dynamics yet").help(help));
        }
        if let Some(Directions { fibers, sheets }) = &self.directions {
            for (key, direction) in [("fibers", Some(fibers)), ("sheets", sheets.as_ref())] {
                let sound =
                    !matches!(direction, Some(Direction::Helix(_))) || matches!(body, Body::Ventricle(_));
                let help = "take body = { shape = \"ventricle\", ... }, or give numbers or expressions";
                report.require(sound, &format!("{key}.helix"), "needs a ventricle as the body", help);
            }
        }
        let name = self.name();
        if matches!(kind, ProcedureKind::Linear | ProcedureKind::Modes) && !self.law.is_small_strain() {
            let problem = Problem::new("is a law of large strain, but the procedure is linear").found(name);
            let help = "add [procedure] kind = \"static\" and steps = 10, or take law = \"linear\"";
            report.add("law", problem.help(help));
        }
        if !self.prony.is_empty() && procedure.ramp().is_none() {
            let problem = format!("relaxes over time, but a {} procedure has no time", kind.name());
            let help = "leave it out: young and poisson are then the moduli for the duration of the load";
            report.add("prony", Problem::new(problem).help(help));
        }
        if procedure.has_inertia() && self.density.is_none() {
            let help = match kind {
                ProcedureKind::Modes => "vibrations need a mass: density = \"1000 kg/m^3\"".into(),
                _ => format!("the {name} law needs its mass in dynamics: density = \"1000 kg/m^3\""),
            };
            report.missing("density", &help);
        }
    }
}

/// The medium of the exact solutions for a law, with its moduli at small strain. The energies of
/// [`Hyperelastic`] are written separately from the solvers' laws and share only the constants. Other laws
/// have solutions at small strain only.
pub fn medium(law: &Law, young: f64, poisson: f64) -> Result<Medium, ExactError> {
    let elastic = Elastic::new(young, poisson)?;
    let law = match law {
        Law::SaintVenantKirchhoff(_) => Some(Hyperelastic::SaintVenantKirchhoff(elastic)),
        Law::NeoHookean(_) => Some(Hyperelastic::NeoHookean(elastic)),
        Law::Hencky(_) => Some(Hyperelastic::Hencky(elastic)),
        Law::NeoHookeanIsochoric(law) => {
            Some(Hyperelastic::MooneyRivlin { c10: law.c10(), c01: 0.0, bulk: law.bulk() })
        }
        Law::MooneyRivlin(law) => {
            Some(Hyperelastic::MooneyRivlin { c10: law.c10(), c01: law.c01(), bulk: law.bulk() })
        }
        Law::Ogden(law) => Some(Hyperelastic::Ogden { terms: law.terms().to_vec(), bulk: law.bulk() }),
        Law::FungDemiray(law) => {
            Some(Hyperelastic::FungDemiray { mu: law.mu(), b: law.b(), bulk: law.bulk() })
        }
        Law::Gent(law) => Some(Hyperelastic::Gent { mu: law.mu(), jm: law.jm(), bulk: law.bulk() }),
        Law::Yeoh(law) => {
            let terms = (1..).zip(law.constants()).map(|(i, c)| (i, 0, *c)).collect();
            Some(Hyperelastic::Polynomial { terms, bulk: law.bulk() })
        }
        Law::Polynomial(law) => {
            Some(Hyperelastic::Polynomial { terms: law.terms().to_vec(), bulk: law.bulk() })
        }
        Law::BlatzKo(_) => Some(Hyperelastic::BlatzKo(elastic)),
        Law::Hyperfoam(law) => Some(Hyperelastic::Hyperfoam { terms: law.terms().to_vec() }),
        Law::Corotational(_) => Some(Hyperelastic::Corotational(elastic)),
        _ => None,
    };
    Ok(Medium { elastic, law })
}
