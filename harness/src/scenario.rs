//! From a checked scene and one of its methods to what the solvers take.

use cases::exact::{Exact, Params, exact_by_name};
use cases::scene::{
    self, ErrorKind, Family, LoadKind, OnStall, Prescribed, ProcedureKind, Reference, Scene, VectorField,
};
use geometry::{CellKind, Cloud, CloudError, Mesh, Point3, Vector3, cloud, cloud_from_mesh};
use mechanics::{Law, LinearElastic, NewtonParams, Prony, StaticParams, TimeParams};

use crate::discretise::{Coupled, Dilation, Discretisation, Efg, Essential, Fem, Functions, Integration};
use crate::error::Key;
use crate::explicit::ExplicitParams;
use crate::in_time::InTimeParams;
use crate::modes::ModesParams;
use crate::outcome::Identity;
use crate::place::{self, tolerance};
use crate::refine::Refine;
use crate::setup::{Acting, Applied, Held, Setup};
use crate::tools::tools;
use crate::{Failure, body, cloud_file, law};

/// Stabilisation of Nitsche's method with smoothed gradients where the scene gives none: times (lambda + 2 mu) / h with h
/// from the trace inequality. Above 1 the matrix is definite; 4 leaves half of the energy.
const NITSCHE_SMOOTHED: f64 = 4.0;
/// The same with other gradients and h the node spacing. 10 is too little at
/// dilatation 1.2 with one point per face and at 2.0 with three; from 20 on the matrix stayed definite.
const NITSCHE: f64 = 100.0;
/// Penalty where the scene gives none: times E / h.
const PENALTY: f64 = 1e4;

/// Part of a load step below which cutting it back is given up: six halvings.
const SMALLEST: f64 = 1.0 / 64.0;

/// A scene's method with what a study changes of it.
#[derive(Clone, Debug)]
pub struct Scenario<'a> {
    /// Case name: the stem of the scene's file.
    pub case: String,
    /// The scene.
    pub scene: &'a Scene,
    /// The method, sizes and kernel already overridden.
    pub method: scene::Method,
    /// Level of the size, 0 if it is given otherwise.
    pub level: u32,
    /// Poisson's ratio in place of the scene's.
    pub poisson: Option<f64>,
    /// The key that the size is from where it is not the method's own.
    pub size_key: Option<String>,
}

impl Scenario<'_> {
    /// Which run this is.
    pub fn identity(&self) -> Identity {
        let mut pairs: Vec<(&str, String)> = Vec::new();
        let (family, variant, seed) = match &self.method.family {
            Family::Fem(fem) => {
                pairs.push(("dilation", fem.dilation.name().into()));
                if fem.reduced {
                    pairs.push(("points", "2x2x2".into()));
                }
                ("fem", fem.element.name().to_string(), fem.jitter.map_or(0, |j| j.seed))
            }
            Family::Efg(efg) => {
                pairs.push(("dilation", efg.dilation.name().into()));
                pairs.push(("basis", efg.functions.basis().into()));
                let variant = match efg.functions {
                    scene::Functions::MovingLeastSquares { kernel, support, shape, .. } => {
                        match support {
                            scene::SupportRule::Dilatation(d) => pairs.push(("dilatation", d.to_string())),
                            scene::SupportRule::Neighbours { k, factor } => {
                                pairs.push(("neighbours", k.to_string()));
                                pairs.push(("factor", factor.to_string()));
                            }
                        }
                        if shape == scene::SupportShape::Adapted {
                            pairs.push(("support", shape.name().into()));
                        }
                        kernel.name.name()
                    }
                    scene::Functions::MaximumEntropy { gamma } => {
                        pairs.push(("gamma", gamma.to_string()));
                        efg.functions.basis()
                    }
                };
                if let scene::Cloud::Refined { refine, .. } = efg.cloud {
                    pairs.push(("refine", format!("gradient-error-{}-ratio-{}", refine.steps, refine.ratio)));
                }
                pairs.push((
                    "integration",
                    match efg.integration {
                        scene::Integration::Gauss { points } => format!("gauss-{points}"),
                        scene::Integration::Grid { points, .. } => format!("grid-{points}"),
                        scene::Integration::CellSmoothed { order: 1, face_points } => {
                            format!("cell-smoothed-{face_points}")
                        }
                        scene::Integration::CellSmoothed { order, face_points } => {
                            format!("cell-smoothed-{face_points}-order-{order}")
                        }
                        scene::Integration::NodeSmoothed { stabilisation, face_points } => {
                            format!("node-smoothed-{face_points}-stabilisation-{stabilisation}")
                        }
                    },
                ));
                let with = |name: &str, factor: Option<f64>| {
                    factor.map_or_else(|| name.to_string(), |factor| format!("{name}-{factor}"))
                };
                pairs.push((
                    "essential",
                    match efg.essential {
                        scene::Essential::Nitsche { factor } => with("nitsche", factor),
                        scene::Essential::Penalty { factor } => with("penalty", factor),
                        scene::Essential::Multipliers => "multipliers".into(),
                        scene::Essential::Coupling => "coupling".into(),
                        scene::Essential::Elimination { rows } => format!("elimination-{}", rows.name()),
                    },
                ));
                let seed = match &efg.cloud {
                    scene::Cloud::Mesh { jitter, .. } => jitter.map_or(0, |j| j.seed),
                    scene::Cloud::File { .. } => 0,
                    scene::Cloud::Uniform { seed, .. }
                    | scene::Cloud::Graded { seed, .. }
                    | scene::Cloud::Refined { seed, .. } => *seed,
                };
                ("efg", variant.to_string(), seed)
            }
        };
        let law = self.scene.material.name();
        if !matches!(self.scene.procedure.kind, ProcedureKind::Linear | ProcedureKind::Modes) {
            pairs.push(("law", law.into()));
        }
        if let Some(mass) = self.method.mass {
            pairs.push(("mass", mass.name().into()));
        }
        pairs.sort();
        Identity {
            case: self.case.clone(),
            method: self.method.id.clone(),
            family,
            variant,
            parameters: pairs.iter().map(|(k, v)| format!("{k}={v}")).collect::<Vec<_>>().join(";"),
            // From the moduli of a law it comes back as 0.49500000000000005: twelve digits are those of the scene.
            poisson: self.laws().map_or(0.0, |(_, materials)| (materials[0].poisson() * 1e12).round() / 1e12),
            level: self.level,
            seed,
        }
    }

    /// The laws by region, and their limits at small strain.
    fn laws(&self) -> Result<(Vec<Law>, Vec<LinearElastic>), Failure> {
        let regions = self.scene.regions.iter().enumerate();
        let regions = regions.map(|(i, r)| (format!("region[{i}].material"), &r.material, None));
        let all =
            std::iter::once(("material".to_string(), &self.scene.material, self.poisson)).chain(regions);
        all.map(|(key, material, poisson)| {
            let law = law::law(material, poisson, &key)?;
            let linear = law::small_strain(&law, &key)?;
            Ok((law, linear))
        })
        .collect()
    }

    fn statics(&self) -> Option<StaticParams> {
        let procedure = self.scene.procedure;
        let newton = procedure.newton;
        (procedure.kind == ProcedureKind::Static).then_some(StaticParams {
            steps: procedure.steps,
            smallest: SMALLEST,
            newton: NewtonParams { tolerance: newton.tolerance, iterations: newton.iterations, chords: true },
            augmentations: newton.augmentations,
            limit_within: procedure.limit_within,
        })
    }

    fn explicit(&self) -> Option<ExplicitParams> {
        let procedure = self.scene.procedure;
        let asked = procedure.explicit;
        let duration = procedure.duration.filter(|_| procedure.kind == ProcedureKind::Explicit)?;
        let materials =
            std::iter::once(&self.scene.material).chain(self.scene.regions.iter().map(|r| &r.material));
        Some(ExplicitParams {
            duration,
            ramp: procedure.over.unwrap_or(duration),
            states: procedure.steps,
            damping: procedure.damping,
            safety: asked.safety,
            step: asked.step,
            tool_mass: asked.tool_mass,
            density: materials.map(|m| m.density().unwrap_or(f64::NAN)).collect(),
            over: self.scene.tools.iter().map(|t| t.over.unwrap_or(duration)).collect(),
        })
    }

    fn modes(&self) -> Option<ModesParams> {
        let procedure = self.scene.procedure;
        let mass = self.method.mass.filter(|_| procedure.kind == ProcedureKind::Modes)?;
        let materials =
            std::iter::once(&self.scene.material).chain(self.scene.regions.iter().map(|r| &r.material));
        let density = materials.map(|m| m.density().unwrap_or(f64::NAN)).collect();
        Some(ModesParams { mass, count: procedure.modes, density })
    }

    fn in_time(&self) -> Result<Option<InTimeParams>, Failure> {
        let procedure = self.scene.procedure;
        let asked = procedure.implicit;
        let Some(end) = procedure.duration.filter(|_| procedure.kind == ProcedureKind::ImplicitDynamic)
        else {
            return Ok(None);
        };
        let regions = &self.scene.regions;
        let materials = std::iter::once(&self.scene.material).chain(regions.iter().map(|r| &r.material));
        let series = std::iter::once(("material".to_string(), &self.scene.prony))
            .chain(regions.iter().enumerate().map(|(i, r)| (format!("region[{i}].material"), &r.prony)));
        let relaxation = series.map(|(key, terms)| {
            let terms: Vec<(f64, f64)> = terms.iter().map(|t| (t.g, t.tau)).collect();
            let wrong = |bad: mechanics::MaterialError| {
                Failure::input(Key::Scene(format!("{key}.prony")), bad.to_string(), "")
            };
            if terms.is_empty() { Ok(None) } else { Prony::new(&terms).map(Some).map_err(wrong) }
        });
        Ok(Some(InTimeParams {
            time: TimeParams {
                end,
                steps: procedure.steps,
                // An accuracy asks for steps as short as it takes.
                smallest: if asked.accuracy.is_some() { 1e-6 } else { SMALLEST },
                accuracy: asked.accuracy,
                rho_inf: asked.spectral_radius,
                newton: NewtonParams {
                    tolerance: procedure.newton.tolerance,
                    iterations: procedure.newton.iterations,
                    chords: true,
                },
                augmentations: procedure.newton.augmentations,
            },
            density: asked.inertia.then(|| materials.map(|m| m.density().unwrap_or(f64::NAN)).collect()),
            damping: procedure.damping,
            ramp: procedure.over.unwrap_or(end),
            over: self.scene.tools.first().and_then(|t| t.over).unwrap_or(end),
            relaxation: relaxation.collect::<Result<_, _>>()?,
        }))
    }

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
                let refinement = crate::grading::refinement(shape, towards)?;
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
            scene::Functions::MovingLeastSquares { shape: scene::SupportShape::Adapted, .. }
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
            functions: functions(efg.functions)?,
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

    /// Materials, supports, loads and the exact solution.
    pub fn setup(&self) -> Result<Setup, Failure> {
        self.acting().map_err(|failure| self.locate(failure))
    }

    fn acting(&self) -> Result<Setup, Failure> {
        let (laws, materials) = self.laws()?;
        let e = materials[0];
        let exact = self.exact(e)?;
        let held = self
            .scene
            .supports
            .iter()
            .enumerate()
            .map(|(index, support)| {
                let motion = support.motion.clone();
                let exact = motion.iter().flatten().any(|p| matches!(p, Prescribed::Exact));
                let exact = if exact { Some(self.exact(e)?.ok_or_else(no_exact)?) } else { None };
                Ok(Held {
                    key: format!("support[{index}]"),
                    place: support.place.clone(),
                    axes: std::array::from_fn(|a| support.motion[a].is_some()),
                    value: Box::new(move |x| {
                        let known = exact.as_ref().map(|e| e.displacement(x));
                        let mut u = Vector3::zeros();
                        for axis in 0..3 {
                            u[axis] = match &motion[axis] {
                                Some(Prescribed::Field(field)) => value(field, x)?,
                                Some(Prescribed::Exact) => known.map_or(0.0, |u| u[axis]),
                                None => 0.0,
                            };
                        }
                        Ok(u)
                    }),
                })
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        let loads = self
            .scene
            .loads
            .iter()
            .enumerate()
            .map(|(index, load)| {
                let applied = match load.kind.clone() {
                    LoadKind::Traction(VectorField::Exact) => {
                        let exact = self.exact(e)?.ok_or_else(no_exact)?;
                        Applied::Traction(Box::new(move |x, n| Ok(exact.traction(x, n))))
                    }
                    LoadKind::Traction(VectorField::Components(c)) => {
                        Applied::Traction(Box::new(move |x, _| components(&c, x)))
                    }
                    LoadKind::Pressure(field) => Applied::Pressure(Box::new(move |x| value(&field, x))),
                    LoadKind::Body(VectorField::Exact) => {
                        let exact = self.exact(e)?.ok_or_else(no_exact)?;
                        Applied::Body(Box::new(move |x| Ok(exact.body_force(x))))
                    }
                    LoadKind::Body(VectorField::Components(c)) => {
                        Applied::Body(Box::new(move |x| components(&c, x)))
                    }
                };
                Ok(Acting { key: format!("load[{index}]"), place: load.place.clone(), applied })
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        let (tools, statics) = (tools(self.scene)?, self.statics());
        let (explicit, in_time) = (self.explicit(), self.in_time()?);
        let relax = self.scene.procedure.on_stall == OnStall::Relax;
        let prepare_only = self.scene.procedure.kind == ProcedureKind::Prepare;
        Ok(Setup {
            laws,
            materials,
            held,
            loads,
            tools,
            watch: None,
            prepare_only,
            modes: self.modes(),
            statics,
            relax,
            explicit,
            in_time,
            exact,
        })
    }

    /// The scene's exact solution for this run's material, one that moves at the end of its motion; `None` where the scene
    /// names none.
    fn exact(&self, e: LinearElastic) -> Result<Option<Box<dyn Exact>>, Failure> {
        let Some(Reference::Exact { name, parameters }) = &self.scene.reference else { return Ok(None) };
        let values = parameters.clone();
        let params = Params { young: e.young(), poisson: e.poisson(), values };
        let exact = exact_by_name(name, &params)
            .map_err(|bad| Failure::input(Key::Scene("reference".into()), bad.to_string(), ""))?;
        Ok(Some(self.scene.procedure.duration.and_then(|end| exact.at(end)).unwrap_or(exact)))
    }
}

fn no_exact() -> Failure {
    let problem = "has no exact solution, which \"exact\" values need";
    Failure::input(Key::Scene("reference".into()), problem, "add [reference] exact = \"...\"")
}

fn value(field: &scene::ScalarField, x: &Point3) -> Result<f64, String> {
    field.value([x.x, x.y, x.z]).map_err(|bad| bad.to_string())
}

fn components(fields: &[scene::ScalarField; 3], x: &Point3) -> Result<Vector3, String> {
    Ok(Vector3::new(value(&fields[0], x)?, value(&fields[1], x)?, value(&fields[2], x)?))
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
fn functions(functions: scene::Functions) -> Result<Functions, Failure> {
    Ok(match functions {
        scene::Functions::MovingLeastSquares { kernel, support, basis, .. } => {
            Functions::MovingLeastSquares {
                kernel: self::kernel(kernel)?,
                basis: match basis {
                    scene::Basis::Linear => efg::Basis::Linear,
                    scene::Basis::Quadratic => efg::Basis::Quadratic,
                },
                support: match support {
                    scene::SupportRule::Dilatation(factor) => efg::Support::Dilatation { factor },
                    scene::SupportRule::Neighbours { k, factor } => {
                        efg::Support::Neighbours { count: k, factor }
                    }
                },
            }
        }
        scene::Functions::MaximumEntropy { gamma } => Functions::MaximumEntropy { gamma },
    })
}

fn kernel(kernel: scene::Kernel) -> Result<efg::Kernel, Failure> {
    use efg::Kernel;
    let default = Kernel::from_name(kernel.name.name())
        .ok_or_else(|| Failure::unavailable(Key::Method("kernel"), "is not available", ""))?;
    Ok(match default {
        Kernel::Gaussian { alpha } => Kernel::Gaussian { alpha: kernel.alpha.unwrap_or(alpha) },
        Kernel::Exponential { alpha, power } => {
            Kernel::Exponential { alpha: kernel.alpha.unwrap_or(alpha), power: kernel.power.unwrap_or(power) }
        }
        Kernel::RegularisedInterpolating { eps } => {
            Kernel::RegularisedInterpolating { eps: kernel.eps.unwrap_or(eps) }
        }
        other => other,
    })
}
