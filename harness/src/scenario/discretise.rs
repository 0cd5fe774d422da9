//! Nodes, cells and rules of a scenario's method.

use cases::scene::{self, ErrorKind, Family};
use geometry::{CellKind, Cloud, CloudError, Mesh, Point3, Vector3, cloud, cloud_from_mesh};

use super::{Scenario, body, cloud_file, grading};
use crate::Failure;
use crate::discretise::place::{self, tolerance};
use crate::discretise::{
    Coupled, Dilation, Discretisation, Efg, Essential, Fem, Functions, Integration, Refine,
};
use crate::error::Key;

/// Stabilisation of Nitsche's method with smoothed gradients where the scene gives none: times (lambda + 2 mu) / h with h
/// from the trace inequality. Above 1 the matrix is definite; 4 leaves half of the energy.
const NITSCHE_SMOOTHED: f64 = 4.0;
/// The same with other gradients and h the node spacing. 10 is too little at
/// support scale 1.2 with one point per face and at 2.0 with three; from 20 on the matrix stayed definite.
const NITSCHE: f64 = 100.0;
/// Penalty where the scene gives none: times E / h.
const PENALTY: f64 = 1e4;

impl Scenario<'_> {
    /// Nodes, cells and rules.
    pub fn discretise(&self) -> Result<Discretisation, Failure> {
        self.nodes_and_cells().map_err(|failure| self.locate(failure))
    }

    fn nodes_and_cells(&self) -> Result<Discretisation, Failure> {
        match &self.method.family {
            Family::Fem(fem) => {
                let mesh = body::mesh(&self.scene.body, kind(fem.element), &fem.size, fem.jitter)?;
                let standard = fem::VolumeRule::STANDARD;
                let rule = if fem.reduced { standard.with(CellKind::Hex20, 2)? } else { standard };
                Ok(Discretisation::Fem(Fem {
                    mesh: self.with_regions(mesh)?,
                    dilation: dilation(fem.dilation),
                    rule,
                }))
            }
            Family::Efg(efg) => self.cloud(efg).map(Discretisation::Efg),
        }
    }

    fn cloud(&self, efg: &scene::Efg) -> Result<Efg, Failure> {
        let shape = body::shape(&self.scene.body);
        let bad = |e: CloudError| match e {
            CloudError::TooFew { .. } | CloudError::TooMany { .. } => {
                Failure::input(Key::Size(""), format!("makes no cloud: {e}"), "")
            }
            _ => Failure::at(ErrorKind::NotRun, Key::Size(""), format!("makes no cloud: {e}"), ""),
        };
        let need_shape = || {
            shape.as_deref().ok_or_else(|| {
                Failure::unavailable(
                    Key::Method("nodes"),
                    "makes a cloud of an exact count, which needs a body in closed form (box, cylinder, ball, \
                     whole sphere-shell, kidney)",
                    "take the nodes of a mesh instead: size = { level = 2 } or { file = \"...\" }",
                )
            })
        };
        let cells_of = |size: &scene::Size| body::mesh(&self.scene.body, CellKind::Tet4, size, None);
        let background = |count: usize| match &efg.background {
            Some(size) => cells_of(size).map_err(Failure::of_background),
            None => cells_of(&scene::Size::Nodes(count)),
        };
        let (cloud, background, cells) = match &efg.cloud {
            scene::Cloud::Mesh { size, jitter } => {
                let mesh = body::mesh(&self.scene.body, CellKind::Tet4, size, *jitter)?;
                let background = match &efg.background {
                    Some(size) => cells_of(size).map_err(Failure::of_background)?,
                    None => mesh.clone(),
                };
                (cloud_from_mesh(&mesh), background, Some(mesh))
            }
            scene::Cloud::File { file, nodes } => {
                let read = cloud_file::read(file, *nodes)?;
                let background = background(read.cloud.points.len())?;
                read.within(shape.as_deref(), &background)?;
                (read.cloud, background, read.mesh)
            }
            scene::Cloud::Uniform { nodes, seed } | scene::Cloud::Refined { nodes, seed, .. } => {
                let cloud = cloud(need_shape()?, *nodes, *seed, &[]).map_err(bad)?;
                (cloud, background(*nodes)?, None)
            }
            scene::Cloud::Graded { nodes, seed, towards } => {
                let shape = need_shape()?;
                let refinement = grading::refinement(shape, towards)?;
                let cloud = cloud(shape, *nodes, *seed, &[refinement]).map_err(bad)?;
                (cloud, background(*nodes)?, None)
            }
        };
        let refine = match (&efg.cloud, &shape) {
            (scene::Cloud::Refined { seed, refine, .. }, Some(shape)) => {
                let (scene::Refine { steps, ratio }, shape) = (*refine, shape.clone());
                Some(Refine { steps, ratio, seed: *seed, shape })
            }
            _ => None,
        };
        let adapted = matches!(
            efg.functions,
            scene::Functions::MovingLeastSquares { shape: scene::SupportShape::Ellipsoid, .. }
        );
        let followed = cells.filter(|_| adapted).map(Box::new);
        let spacing = cloud.spacing.iter().sum::<f64>() / cloud.spacing.len() as f64;
        let integration = match efg.integration {
            scene::Integration::Gauss { points } => Integration::Gauss { points },
            scene::Integration::Grid { points, spacing: given } => Integration::Grid {
                spacing: given.unwrap_or(spacing),
                points: (points as f64).cbrt().round() as usize,
            },
            scene::Integration::CellSmoothed { order, face_points } => Integration::CellSmoothed {
                smoothing: if order == 2 { efg::Smoothing::Linear } else { efg::Smoothing::Constant },
                face_points,
            },
            scene::Integration::NodeSmoothed { stabilisation, face_points } => {
                Integration::NodeSmoothed { stabilisation, face_points }
            }
        };
        let essential = match efg.essential {
            scene::Essential::Nitsche { factor } => {
                let smoothed = matches!(
                    integration,
                    Integration::CellSmoothed { .. } | Integration::NodeSmoothed { .. }
                );
                Essential::Nitsche(factor.unwrap_or(if smoothed { NITSCHE_SMOOTHED } else { NITSCHE }))
            }
            scene::Essential::Penalty { factor } => Essential::Penalty(factor.unwrap_or(PENALTY)),
            scene::Essential::Multipliers => Essential::Multipliers,
            scene::Essential::Elimination { rows } => Essential::Elimination(rows),
            scene::Essential::Coupling => Essential::Coupling(self.coupled(&cloud, &background)?),
        };
        Ok(Efg {
            background: self.with_regions(background)?,
            cloud,
            shape,
            followed,
            refine,
            functions: functions(efg.functions),
            integration,
            essential,
            dilation: dilation(efg.dilation),
        })
    }

    /// Finite-element nodes at all vertices of what is held.
    fn coupled(&self, cloud: &Cloud, background: &Mesh) -> Result<Coupled, Failure> {
        let mut vertices = Vec::new();
        for (index, support) in self.scene.supports.iter().enumerate() {
            let key = format!("support[{index}]");
            place::whole(&key, &support.place, background)?;
            vertices.extend(place::nodes(&key, &support.place, background)?);
        }
        vertices.sort_unstable();
        vertices.dedup();
        let nodes = efg::coupled_nodes(&cloud.points, background, &vertices)?;
        Ok(Coupled { vertices, nodes })
    }

    /// Numbers the cells by the scene's material regions: 0 the scene's material, k + 1 its k-th region.
    fn with_regions(&self, mesh: Mesh) -> Result<Mesh, Failure> {
        if self.scene.regions.is_empty() {
            let cells = mesh.cell_count();
            return Ok(mesh.with_regions(vec![0; cells], vec!["body".into()]));
        }
        let tolerance = tolerance(&mesh);
        let mut regions = vec![0u16; mesh.cell_count()];
        for (index, region) in self.scene.regions.iter().enumerate() {
            let mut hit = false;
            for (cell, slot) in regions.iter_mut().enumerate() {
                let inside = match &region.place {
                    scene::Place::On(names) => {
                        names.contains(&mesh.region_names()[mesh.region(cell) as usize])
                    }
                    at => {
                        let n = mesh.cell(cell).len() as f64;
                        let sum = mesh.cell_points(cell).fold(Vector3::zeros(), |s, p| s + p.coords);
                        place::holds(at, &Point3::from(sum / n), tolerance)
                    }
                };
                if inside {
                    *slot = index as u16 + 1;
                    hit = true;
                }
            }
            if !hit {
                let (key, help) = match &region.place {
                    scene::Place::On(_) => ("on", format!("the mesh has {}", mesh.region_names().join(", "))),
                    _ => ("where", format!("{}; check its signs and its unit", place::extent(&mesh))),
                };
                let key = Key::Scene(format!("region[{index}].{key}"));
                return Err(Failure::input(key, "holds no cell of the mesh", &help));
            }
        }
        let names = std::iter::once("body".into()).chain(self.scene.regions.iter().map(|r| r.name.clone()));
        Ok(mesh.with_regions(regions, names.collect()))
    }
}

fn kind(element: scene::Element) -> CellKind {
    match element {
        scene::Element::Tet4 => CellKind::Tet4,
        scene::Element::Tet10 => CellKind::Tet10,
        scene::Element::Hex8 => CellKind::Hex8,
        scene::Element::Hex20 => CellKind::Hex20,
    }
}

fn dilation(dilation: scene::Dilation) -> Dilation {
    match dilation {
        scene::Dilation::Standard => Dilation::Standard,
        scene::Dilation::ElementMean => Dilation::Element,
        scene::Dilation::NodalMean => Dilation::Nodal,
        scene::Dilation::Mixed => Dilation::Mixed,
    }
}

/// The shape functions that a scene names.
fn functions(functions: scene::Functions) -> Functions {
    match functions {
        scene::Functions::MovingLeastSquares { kernel, support, basis, .. } => {
            Functions::MovingLeastSquares {
                kernel,
                basis: match basis {
                    scene::Basis::Linear => efg::Basis::Linear,
                    scene::Basis::Quadratic => efg::Basis::Quadratic,
                },
                support: match support {
                    scene::SupportRule::Scale(factor) => efg::Support::Dilatation { factor },
                    scene::SupportRule::Neighbours { k, factor } => {
                        efg::Support::Neighbours { count: k, factor }
                    }
                },
            }
        }
        scene::Functions::MaximumEntropy { gamma } => Functions::MaximumEntropy { gamma },
    }
}
