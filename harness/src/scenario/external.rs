//! Methods of external solvers: their mesh, and the features of the scene that the adapter must support.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use cases::scene::{self, Family, LoadKind, ProcedureKind, Setting};

use super::Scenario;
use crate::adapter::{self, About, Outside};
use crate::discretise::Discretisation;
use crate::error::{Failure, Foreign, ForeignStatus, Key};
use crate::process::Limits;

/// Part of a scene that problem files cannot describe yet.
struct Unsaid {
    key: String,
    what: &'static str,
    /// A replacement that the files can describe.
    help: &'static str,
}

impl Scenario<'_> {
    /// Discretises the body with the solver's elements and attaches the external solver.
    pub(super) fn external(&self, external: &scene::External) -> Result<Discretisation, Failure> {
        let bad = |failure: Failure| match failure {
            Failure::Input(problem) => Failure::input(Key::Method("adapter"), problem, ""),
            other => other,
        };
        let adapter = adapter::find(&external.adapter, Some(Path::new(self.scene.file()))).map_err(bad)?;
        let element = external.elements.element.name();
        if let Some(reason) = adapter.manifest.refusal(element, &self.asked()) {
            let reason = format!("{} {reason}", external.adapter);
            return Err(Foreign::new(ForeignStatus::NotOffered, reason).into());
        }
        let limits = Limits {
            time: Duration::try_from_secs_f64(external.time_limit).unwrap_or(Duration::MAX),
            memory: external.memory_limit,
        };
        let about = self.about(element, external.settings.clone(), limits);
        let outside = Outside { adapter, about };
        Ok(Discretisation { outside: Some(Arc::new(outside)), ..self.elements(&external.elements)? })
    }

    fn about(&self, element: &'static str, settings: BTreeMap<String, Setting>, limits: Limits) -> About {
        About { case: self.case.clone(), method: self.method.id.clone(), element, settings, limits }
    }

    /// Names the problem of a finite-element method, whichever solver is used.
    pub(crate) fn about_elements(&self) -> Result<About, Failure> {
        let fem = match &self.method.family {
            Family::Fem(fem) => fem,
            Family::External(_) => {
                let outside = self.discretise()?.outside;
                return Ok(outside.map(|outside| outside.about.clone()).expect("it has one"));
            }
            Family::Efg(_) => {
                let problem = "is not a finite-element method: problem files describe meshes";
                return Err(self.locate(Failure::input(
                    Key::Method("family"),
                    problem,
                    "give another method",
                )));
            }
        };
        let limits = Limits { time: Duration::from_secs(600), memory: 4 << 30 };
        Ok(self.about(fem.element.name(), BTreeMap::new(), limits))
    }

    /// Refuses a scene that problem files cannot describe yet.
    pub(crate) fn check_files(&self) -> Result<(), Failure> {
        if let Some(Unsaid { key, what, help }) = self.unsaid().into_iter().next() {
            let problem = format!("is {what}, which problem files do not support yet");
            return Err(Failure::input(Key::Scene(key), problem, help));
        }
        match self.scene.procedure.kind() {
            ProcedureKind::Linear | ProcedureKind::Static => Ok(()),
            _ => Err(Failure::input(
                Key::Scene("procedure.kind".into()),
                "is not supported in problem files yet",
                "linear and static procedures are supported",
            )),
        }
    }

    /// Key of the first load on the deformed surface.
    pub(crate) fn following(&self) -> Option<String> {
        let (laws, _) = self.laws().ok()?;
        let index = self.scene.loads.iter().position(|load| self.follows(load, &laws))?;
        Some(match self.scene.loads[index].kind {
            LoadKind::Pressure(_) => format!("load[{index}].pressure"),
            _ => format!("load[{index}].traction"),
        })
    }

    /// Lists the loads, materials and tools of the scene that problem files cannot describe yet.
    fn unsaid(&self) -> Vec<Unsaid> {
        let mut unsaid = Vec::new();
        let mut add = |key, what, help| unsaid.push(Unsaid { key, what, help });
        if let Some(key) = self.following() {
            let what = "a load on the deformed surface";
            add(key, what, "add dead = true for a load on the undeformed surface");
        }
        for index in 0..self.scene.foundations.len() {
            add(format!("foundation[{index}]"), "springs and dampers on a surface", "leave them out");
        }
        for (key, material) in self.scene.materials() {
            if material.has_other_volumetric() {
                let what = "another volumetric energy than that of the law";
                add(format!("{key}.volumetric"), what, "leave it out");
            }
            if material.directions.is_some() {
                let what = "a material with directions";
                add(format!("{key}.fibers"), what, "take a law without fibres");
            }
        }
        if let Some((key, _)) = self.scene.curved().next() {
            add(key, "a curve over time", "leave it out: everything grows in proportion to the load");
        }
        for key in self.scene.staged() {
            add(
                key,
                "a support that begins late or ends early",
                "leave it out: the support holds throughout",
            );
        }
        for (index, tool) in self.scene.tools.iter().enumerate() {
            if !tool.path.is_empty() {
                let key = format!("tool[{index}].drive");
                add(key, "a path or a turn of a tool", "give along and drive = { closure = ... }");
            }
            if tool.file.is_some() {
                let key = format!("tool[{index}].shape");
                add(key, "a surface as a tool", "take a shape of the catalogue");
            }
        }
        unsaid
    }

    /// Lists the features a solver needs for the scene: the word that an adapter lists in `can`, and a phrase
    /// for messages. Procedures that problem files do not support yet get an empty word, which no adapter
    /// lists.
    fn asked(&self) -> Vec<(&'static str, String)> {
        let kind = self.scene.procedure.kind();
        let mut asked = vec![match kind {
            ProcedureKind::Linear => ("linear", "a linear procedure".into()),
            ProcedureKind::Static => ("static", "load steps (kind = \"static\")".into()),
            other => ("", format!("kind = \"{}\", which problem files do not support yet", other.name())),
        }];
        asked.extend(self.scene.materials().map(|(_, m)| (m.name(), format!("the law \"{}\"", m.name()))));
        if !self.scene.tools.is_empty() {
            asked.push(("tools", "rigid tools ([[tool]])".into()));
        }
        asked.extend(self.unsaid().into_iter().map(|Unsaid { key, what, help }| {
            ("", format!("{what}, which problem files do not support yet ({key}: {help})"))
        }));
        asked
    }
}
