//! Element-free Galerkin methods.

use schemars::JsonSchema;
use serde::Deserialize;

use super::cloud::{Cloud, CloudKeys};
use super::common::{Dilation, Mass, Size, SizeKeys};
use super::essential::{Essential, EssentialKeys};
use super::functions::{FunctionKeys, Functions};
use super::integration::{Integration, IntegrationKeys};
use super::pod::PodKeys;
use crate::scene::procedure::ProcedureKind;
use crate::scene::report::Report;
use crate::scene::words::words;

#[derive(Deserialize, JsonSchema)]
pub(crate) struct EfgKeys {
    #[serde(flatten)]
    cloud: CloudKeys,
    #[serde(flatten)]
    functions: FunctionKeys,
    integration: IntegrationKeys,
    essential: EssentialKeys,
    dilation: Option<Dilation>,
    /// Treatment of the borders of material regions by the shape functions; separate with essential =
    /// "coupling" only
    regions: Option<Regions>,
    /// Size of the mesh of integration cells
    background: Option<SizeKeys>,
    /// Mass matrix for vibrations; kind = "modes" only
    pub mass: Option<Mass>,
    pub pod: Option<PodKeys>,
}

/// Settings of an element-free Galerkin method.
#[derive(Clone, Debug, PartialEq)]
pub struct Efg {
    /// Nodes of the method.
    pub cloud: Cloud,
    /// Shape functions.
    pub functions: Functions,
    /// Integration rule.
    pub integration: Integration,
    /// Method of imposing prescribed displacements.
    pub essential: Essential,
    /// Treatment of the volume change.
    pub dilation: Dilation,
    /// Treatment of the borders of material regions by the shape functions.
    pub regions: Regions,
    /// Mesh of integration cells, if it differs from the mesh that supplies the nodes.
    pub background: Option<Size>,
}

words! {
    /// Treatment of the borders of material regions by a cloud's shape functions.
    pub enum Regions {
        /// Shape functions reach across and smooth the jump of the strain; the default.
        Blended = "blended",
        /// Shape functions end at the border. Linear finite elements along it, coupled to the cloud, keep the
        /// displacement continuous.
        Separate = "separate",
    }
}

impl EfgKeys {
    pub fn read(self, report: &Report) -> Option<Efg> {
        let background = self.background.map(|size| size.read(&report.at("background")));
        let has_cells = self.cloud.has_cells();
        let cloud = self.cloud.read(report);
        let functions = self.functions.read(has_cells, report);
        let integration = self.integration.read(&report.at("integration"));
        let essential = self.essential.read(&report.at("essential"));
        let background = background.map_or(Some(None), |size| size.map(Some));
        let (cloud, functions, background) = (cloud?, functions?, background?);
        let couples = essential == Essential::Coupling;
        if couples {
            let problem = "can't be combined with essential = \"coupling\"";
            let help =
                "take basis = \"linear\": the other terms of the basis do not vanish on the coupled elements";
            report.require(functions.have_linear_basis(), "basis", problem, help);
            let help = "take essential = \"elimination\": the nodes of finite elements can't be refined";
            report.require(!cloud.is_refined(), "cloud.refine", problem, help);
        }
        let dilation = self.dilation.unwrap_or(Dilation::Standard);
        let regions = self.regions.unwrap_or(Regions::Blended);
        report.require(
            regions == Regions::Blended || couples,
            "regions",
            "needs finite elements along the borders, which only essential = \"coupling\" provides",
            "take essential = \"coupling\", or regions = \"blended\"",
        );
        Some(Efg { cloud, functions, integration, essential, dilation, regions, background })
    }
}

impl Efg {
    /// Reports contradictions with the procedure and the regions of the scene.
    pub(super) fn demands(&self, kind: ProcedureKind, has_regions: bool, report: &Report) {
        // Explicit dynamics refuses other conditions than coupling as not available yet.
        let problem = self.essential.unsupported(kind).filter(|_| kind != ProcedureKind::Explicit);
        if let Some(problem) = problem {
            let table = "essential.method";
            report.add(if report.is_given(table) { table } else { "essential" }, problem);
        }
        // A scene with one material has no borders.
        report.require(
            has_regions || self.regions != Regions::Separate,
            "regions",
            "concerns the borders between material regions, but the scene has no [[region]]",
            "leave it out",
        );
        report.require(
            kind == ProcedureKind::Linear || !self.cloud.is_refined(),
            "cloud.refine",
            "needs a solution at every step, which is affordable only in a linear procedure",
            "take [procedure] kind = \"linear\", or leave refine out",
        );
    }

    /// Whether coupled finite elements can impose the prescribed displacements.
    pub(crate) fn can_couple(&self) -> bool {
        self.functions.have_linear_basis() && !self.cloud.is_refined()
    }
}
