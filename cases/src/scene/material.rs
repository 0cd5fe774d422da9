//! Materials of a scene: laws with their constants, density and relaxation, and the parts of the body with
//! their own material.

use std::borrow::Cow;
use std::sync::Arc;

use catalogue::{Problem, Value, Values};
use material::{Law, LawEntry, Material as _, VolumetricForm};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use shape::Curve;

use super::body::Body;
use super::curve::{NamedCurve, named};
use super::direction::{Direction, DirectionKeys};
use super::procedure::{Procedure, ProcedureKind};
use super::region::Region;
use super::report::Report;
use super::selection::{Names, Place};
use super::units::{Density, Pressure, Q, Time};
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
    /// Direction of the fibres in the undeformed body, of any length: [1, 0, 0], expressions in x, y and z
    /// (metres) such as ["-y", "x", "0"], or a rule; for laws that depend on directions, and for active
    fibers: Option<DirectionKeys>,
    /// Active stress of contracting muscle along the fibres, which grows with the loading or along active_curve: the second
    /// Piola-Kirchhoff stress T f x f beside the passive law; none unless given
    active: Option<Q<Pressure>>,
    /// Name of the curve that the active stress follows; the common growth unless given
    active_curve: Option<String>,
    /// Direction within a sheet across the fibres; its part along the fibre is taken off. Any direction across the
    /// fibre unless given, for a law that is the same all around the fibre
    sheets: Option<DirectionKeys>,
    /// Form of the volumetric energy, with the bulk modulus of the law; that of the law's formula unless
    /// given. Only for laws whose formula has a term of J alone
    volumetric: Option<VolumetricKeys>,
}

/// Volumetric energy with the bulk modulus kappa
#[derive(Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum VolumetricKeys {
    /// kappa/2 (J - 1)^2, as in Abaqus and CalculiX
    Quadratic,
    /// kappa/2 (ln J)^2, as in the uncoupled laws of FEBio
    Logarithmic,
    /// kappa/4 (J^2 - 1 - 2 ln J)
    SimoTaylor,
}

impl From<VolumetricKeys> for VolumetricForm {
    fn from(keys: VolumetricKeys) -> VolumetricForm {
        match keys {
            VolumetricKeys::Quadratic => VolumetricForm::Quadratic,
            VolumetricKeys::Logarithmic => VolumetricForm::Logarithmic,
            VolumetricKeys::SimoTaylor => VolumetricForm::SimoTaylor,
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
    /// Form of the volumetric energy, if it is not that of the law's formula.
    volumetric: Option<VolumetricForm>,
    law: Law,
    /// Density in kilograms per cubic metre, if given.
    pub density: Option<f64>,
    /// Prony series of the relaxation; empty for a material that does not relax.
    pub prony: Vec<Relaxation>,
    /// Directions of fibres and sheets; `None` for a law that does not depend on them.
    pub directions: Option<Directions>,
    /// Active stress along the fibres at the end of the loading, in pascals; 0 without.
    pub active: f64,
    /// Factor of the active stress over time; `None` for the common growth.
    pub active_curve: Option<Arc<Curve>>,
}

/// Directions of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    /// Along the fibres.
    pub fibers: Direction,
    /// Within a sheet across the fibres, if given.
    pub sheets: Option<Direction>,
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
    pub fn read(self, curves: &[NamedCurve], report: &Report) -> Option<Material> {
        let density = self.beside.density.map(|d| report.positive("density", d.0));
        let prony = prony(self.beside.prony, report);
        let entry = self.law.0;
        let values = settings(&self.law, self.settings, report)?;
        let law = build(entry, &values, "law", report)?;
        let volumetric = self.beside.volumetric.map(VolumetricForm::from);
        let law = with_volumetric(law, volumetric).map_err(|bad| report.add("volumetric", bad)).ok()?;
        let given = [("fibers", self.beside.fibers), ("sheets", self.beside.sheets)];
        let active = self.beside.active.map_or(0.0, |active| active.0);
        let directions = directions(&law, active != 0.0, given, report);
        let help = "take a law of large strain, such as law = \"neo-hookean\"";
        let sound = active == 0.0 || !law.is_small_strain();
        report.require(sound, "active", "turns with the fibre, and the law does not", help);
        let active_curve = named(self.beside.active_curve.as_ref(), curves, "active_curve", report);
        let help = "give active = \"60 kPa\", the stress at the factor 1";
        report.require(active != 0.0 || active_curve.is_none(), "active_curve", "has no active stress", help);
        Some(Material { entry, values, volumetric, law, density, prony, directions, active, active_curve })
    }
}

/// Returns the law with another form of its volumetric energy.
fn with_volumetric(law: Law, form: Option<VolumetricForm>) -> Result<Law, Problem> {
    let Some(form) = form else { return Ok(law) };
    let name = law.name();
    law.with_volumetric(form).ok_or_else(|| {
        let help = "leave it out, or take a law with such a term, such as law = \"mooney-rivlin\"";
        Problem::new(format!("has no effect: the energy of the law {name} has no term of J alone")).help(help)
    })
}

/// Checks that directions are given for a law that depends on them and for an active stress, and for no
/// other.
fn directions(
    law: &Law,
    contracts: bool,
    given: [(&str, Option<DirectionKeys>); 2],
    report: &Report,
) -> Option<Directions> {
    let used = [contracts || law.has_axes(), law.has_axes()];
    for ((key, given), used) in given.iter().zip(used) {
        let problem = format!("has no effect: the law {} is the same in all directions", law.name());
        report.require(used || given.is_none(), key, &problem, "leave it out, or take a law with fibres");
    }
    if !used[0] {
        return None;
    }
    let [fibers, sheets] = given.map(|(key, keys)| keys.map(|keys| keys.read(key, report)));
    if fibers.is_none() {
        report.missing("fibers", "give the direction of the fibres, such as fibers = [1, 0, 0]");
    }
    if law.has_sheets() && sheets.is_none() {
        report.missing(
            "sheets",
            "this law depends on them: give a direction across the fibres, such as sheets = [0, 1, 0]",
        );
    }
    Some(Directions { fibers: fibers.flatten()?, sheets: sheets.flatten() })
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
    pub fn read(self, curves: &[NamedCurve], report: &Report) -> Option<MaterialRegion> {
        let place = Place::required(self.on, self.place, report);
        let material = self.material.read(curves, &report.at("material"));
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

    /// Whether the volumetric energy has another form than in the law's formula.
    pub fn has_other_volumetric(&self) -> bool {
        matches!(self.law, Law::WithVolumetric(_))
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
        with_volumetric((self.entry.build)(&values)?, self.volumetric)
    }

    /// Reports contradictions with the body and the procedure.
    pub(crate) fn demands(&self, body: &Body, procedure: &Procedure, report: &Report) {
        let kind = procedure.kind();
        if kind == ProcedureKind::ImplicitDynamic
            && procedure.ramp().is_some_and(|ramp| ramp.stiffness_damping > 0.0)
        {
            let problem =
                "changes the internal forces by itself, and stiffness_damping resists all their changes";
            let help = "leave procedure.stiffness_damping out, or take damping";
            report.require(self.prony.is_empty(), "prony", problem, help);
            report.require(self.active == 0.0, "active", problem, help);
        }
        if let Some(Directions { fibers, sheets }) = &self.directions {
            fibers.demands("fibers", body, report);
            sheets.iter().for_each(|sheets| sheets.demands("sheets", body, report));
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
    Ok(Medium { elastic, law: hyperelastic(law, elastic) })
}

/// The energy of a law for exact solutions; `elastic` has the moduli of the whole law.
fn hyperelastic(law: &Law, elastic: Elastic) -> Option<Hyperelastic> {
    match law {
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
        Law::Hyperfoam(law) => {
            Some(Hyperelastic::Hyperfoam { terms: law.terms().to_vec(), kappa: law.kappa() })
        }
        Law::Corotational(_) => Some(Hyperelastic::Corotational(elastic)),
        Law::StableNeoHookean(_) => Some(Hyperelastic::StableNeoHookean(elastic)),
        // Hencky's law takes its moduli from those of the whole law, so the volumetric part can't be taken
        // off.
        Law::WithVolumetric(law) if !matches!(law.rest(), Law::Hencky(_)) => {
            let rest = Box::new(hyperelastic(law.rest(), elastic)?);
            let bulk = law.volume().bulk;
            Some(match law.volume().form {
                VolumetricForm::Logarithmic => Hyperelastic::LogarithmicVolume { rest, bulk },
                VolumetricForm::SimoTaylor => Hyperelastic::SimoTaylorVolume { rest, bulk },
                VolumetricForm::Quadratic => return None,
            })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_poissons_ratio_keeps_the_volumetric_energy() {
        let entry = catalogue::find(material::LAWS, "neo-hookean-isochoric").unwrap();
        let mut values = Values::new(entry.parameters);
        values.give("young", Value::Number(15e3)).unwrap();
        values.give("poisson", Value::Number(0.3)).unwrap();
        let volumetric = Some(VolumetricForm::SimoTaylor);
        let law = with_volumetric((entry.build)(&values).unwrap(), volumetric).unwrap();
        let material = Material {
            entry,
            values,
            volumetric,
            law,
            density: None,
            prony: Vec::new(),
            directions: None,
            active: 0.0,
            active_curve: None,
        };
        // kappa = E / (3 (1 - 2 nu)).
        for (law, bulk) in [(material.law().clone(), 12.5e3), (material.at_poisson(0.45).unwrap(), 50e3)] {
            let Law::WithVolumetric(law) = law else { panic!("{law:?}") };
            assert_eq!(law.volume().form, VolumetricForm::SimoTaylor);
            assert!((law.volume().bulk - bulk).abs() < 1e-9 * bulk, "{:?}", law.volume());
        }
    }
}
