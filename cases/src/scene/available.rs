//! Valid requests of a scene that no solver supports yet.

use catalogue::Problem;
use geometry::CellKind;

use super::condition::LoadKind;
use super::drive::Drive;
use super::error::{ErrorKind, SceneError};
use super::method::{Dilation, Essential, Family};
use super::procedure::{Precision, Procedure, ProcedureKind};
use super::scene::Scene;
use super::tool::Tool;

impl Scene {
    /// Every part of the scene that no solver here supports yet; empty if all parts can run.
    pub fn unavailable(&self) -> Vec<SceneError> {
        let mut errors = Vec::new();
        let mut add = |key: &str, what: String, help: &str| {
            let problem = Problem::new(format!("{what} is not available yet")).help(help);
            errors.push(self.origin.error(ErrorKind::NotAvailable, key, problem));
        };
        let kind = self.procedure.kind();
        let explicit = kind == ProcedureKind::Explicit;
        let implicit = kind == ProcedureKind::ImplicitDynamic;
        let gains = match &self.procedure {
            Procedure::ImplicitDynamic(implicit) if implicit.alpha.is_some() => Some(("alpha", "alpha")),
            Procedure::ImplicitDynamic(implicit) if implicit.spectral_radius > 0.0 => {
                Some(("spectral_radius", "a spectral radius above 0"))
            }
            _ => None,
        };
        if let Some((key, what)) = gains.filter(|_| !self.tools.is_empty()) {
            let help = "leave it out: above 0 stiff contact gains energy";
            add(&format!("procedure.{key}"), format!("{what} with tools"), help);
        }
        let clouds = self.methods.iter().any(|method| matches!(method.family, Family::Efg(_)));
        if clouds
            && matches!(&self.procedure, Procedure::Explicit(asked) if asked.precision == Precision::Single)
        {
            let help = "take \"double\", or finite elements only: tet4, hex8, tet10 or hex20";
            add("procedure.precision", "precision = \"single\" with clouds".into(), help);
        }
        if implicit {
            self.unavailable_ramps(&mut add);
        }
        for (i, method) in self.methods.iter().enumerate() {
            let at = |key: &str| format!("method[{i}].{key}");
            let mixed = match &method.family {
                Family::Fem(fem) => fem.dilation == Dilation::Mixed,
                Family::Efg(efg) => efg.dilation == Dilation::Mixed,
                Family::External(_) => false,
            };
            match kind {
                ProcedureKind::Modes if mixed => {
                    let help = "\"standard\", \"element-mean\", \"nodal-mean\" and \"nodal-near\" are";
                    add(&at("dilation"), "dilation = \"mixed\" in vibrations".into(), help);
                }
                ProcedureKind::Linear if mixed => {
                    let help =
                        "procedure = { kind = \"static\" } has it, with the linear law in one step too";
                    add(&at("dilation"), "dilation = \"mixed\" in a linear procedure".into(), help);
                }
                ProcedureKind::Explicit if mixed => {
                    let help = "\"element-mean\", \"nodal-mean\" and \"nodal-near\" are: their dilation needs no system of equations";
                    add(&at("dilation"), "dilation = \"mixed\" in explicit dynamics".into(), help);
                }
                _ => {}
            }
            match &method.family {
                Family::Efg(efg)
                    if explicit && efg.essential != Essential::Coupling && !self.supports.is_empty() =>
                {
                    let help = "take essential = \"coupling\": its nodes on supports have displacements, which explicit steps prescribe";
                    add(
                        &at("essential"),
                        "a cloud without coupled elements at its supports in explicit dynamics".into(),
                        help,
                    );
                }
                Family::Fem(_) | Family::Efg(_) | Family::External(_) => {}
            }
        }
        if explicit {
            for (key, _) in self.materials().filter(|(_, material)| !material.prony.is_empty()) {
                add(&format!("{key}.prony"), "relaxation in explicit dynamics".into(), "leave it out");
            }
        }
        if self.procedure.has_frames() {
            self.unavailable_in_frames(&mut add);
        }
        errors
    }

    /// Adds the ramps of tools that differ from the first tool's, in implicit dynamics.
    fn unavailable_ramps(&self, add: &mut impl FnMut(&str, String, &str)) {
        let ramp = |tool: &Tool| tool.over.or(self.procedure.duration());
        let mut ramped = self.tools.iter().enumerate().filter(|(_, tool)| tool.curve.is_none());
        if let Some((_, first)) = ramped.next() {
            for (i, _) in ramped.filter(|(_, tool)| ramp(tool) != ramp(first)) {
                let help = "give all tools the same, or take kind = \"explicit\"";
                let what = "a ramp other than the first tool's in implicit dynamics".into();
                add(&format!("tool[{i}].drive.over"), what, help);
            }
        }
    }

    /// Adds the parts of the scene that frames with a fixed budget of work do not support.
    fn unavailable_in_frames(&self, add: &mut impl FnMut(&str, String, &str)) {
        let of = |what: &str| format!("{what} in kind = \"{}\"", self.procedure.kind().name());
        let sweeps = self.procedure.kind() != ProcedureKind::ImplicitCg;
        for (i, method) in self.methods.iter().enumerate() {
            let (sound, plain) = match &method.family {
                Family::Fem(fem) => {
                    let plain = fem.dilation == Dilation::Standard && fem.hourglass.is_none();
                    (plain && (!sweeps || fem.element.kind() == Some(CellKind::Tet4)), plain)
                }
                Family::Efg(_) | Family::External(_) => (false, false),
            };
            if !sound && plain {
                let help = "take element = \"tet4\": the energy of its one point depends on one node in turn";
                add(&format!("method[{i}].element"), of("another element than tet4"), help);
            } else if !sound {
                let help = "take family = \"fem\", dilation = \"standard\", and no hourglass control";
                add(&format!("method[{i}]"), of("another method than plain elements"), help);
            }
        }
        for (key, material) in self.materials() {
            if sweeps && material.name() != "stable-neo-hookean" {
                let what = of(&format!("the law {}", material.name()));
                add(&format!("{key}.law"), what, "take law = \"stable-neo-hookean\"");
            }
            if !material.prony.is_empty() {
                add(&format!("{key}.prony"), of("relaxation"), "leave it out");
            }
            if material.active != 0.0 {
                add(&format!("{key}.active"), of("active stress"), "leave it out");
            }
        }
        for (i, load) in self.loads.iter().enumerate().filter(|(_, load)| !load.dead) {
            let key = if matches!(load.kind, LoadKind::Pressure(_)) { "pressure" } else { "traction" };
            let what = of("a load on the deformed surface");
            add(&format!("load[{i}].{key}"), what, "add dead = true for a load on the undeformed surface");
        }
        for i in 0..self.foundations.len() {
            add(&format!("foundation[{i}]"), of("springs and dampers on a surface"), "leave them out");
        }
        for key in self.staged() {
            add(&key, of("a support of a part of the loading"), "leave during out");
        }
        for (i, tool) in self.tools.iter().enumerate() {
            if !matches!(tool.drive, Drive::Closure(_)) {
                let help = "give drive = { closure = ... }";
                add(&format!("tool[{i}].drive"), of("a tool driven by a force"), help);
            }
            if tool.friction.is_some() {
                add(&format!("tool[{i}].friction"), of("friction"), "leave it out");
            }
        }
    }
}
