//! What a sound scene may ask for and can't have yet.

use super::error::{ErrorKind, Problem, SceneError};
use super::method::{Dilation, Family};
use super::model::{Material, Scene};
use super::output::Reference;
use super::tool::ProcedureKind;

impl Scene {
    /// Every part of the scene that no solver here runs yet; empty if all of it runs.
    pub fn unavailable(&self) -> Vec<SceneError> {
        let mut errors = Vec::new();
        let mut add = |key: &str, what: String, help: &str| {
            let problem = Problem::new(format!("{what} is not available yet")).help(help);
            errors.push(self.origin.error(ErrorKind::NotAvailable, key, problem));
        };
        if !matches!(self.material, Material::Linear(_)) {
            add("material.law", format!("the {} law", self.material.name()), "law = \"linear\" is");
        }
        for (i, region) in self.regions.iter().enumerate() {
            if !matches!(region.material, Material::Linear(_)) {
                let key = format!("region[{i}].material.law");
                add(&key, format!("the {} law", region.material.name()), "law = \"linear\" is");
            }
        }
        for (i, tool) in self.tools.iter().enumerate() {
            add(
                &format!("tool[{i}]"),
                format!("contact with '{}'", tool.name),
                "give the load itself: [[load]]",
            );
        }
        match self.procedure.kind {
            ProcedureKind::Linear | ProcedureKind::Static => {}
            kind => add("procedure.kind", format!("the {} procedure", kind.name()), "kind = \"linear\" is"),
        }
        for (i, method) in self.methods.iter().enumerate() {
            let (Family::Fem(super::method::Fem { dilation, .. })
            | Family::Efg(super::method::Efg { dilation, .. })) = &method.family;
            if *dilation == Dilation::Mixed {
                let help = "\"element-mean\" and \"nodal-mean\" are";
                add(&format!("method[{i}].dilation"), "dilation = \"mixed\"".into(), help);
            }
        }
        if let Some(Reference::Record(_)) = &self.reference {
            add("reference.record", "a stored record as reference".into(), "exact solutions and methods are");
        }
        errors
    }
}
