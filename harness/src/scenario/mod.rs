//! Converts a checked scene and one of its methods for the solvers: laws, supports, loads and the exact
//! solution.

mod body;
mod body_mesh;
mod cloud;
mod cloud_file;
mod discretise;
mod estimate;
mod expected;
mod external;
mod fibers;
mod file_body;
mod file_vectors;
mod grading;
mod identity;
mod law;
mod locate;
mod mesh_file;
mod notes;
mod same_body;
pub(crate) mod setup;
mod tools;

pub(crate) use body::point;
pub(crate) use body_mesh::coarse;
pub(crate) use estimate::{Estimate, estimate, of_reference, too_large};
pub(crate) use identity::{method_identity, purpose, rule};
pub(crate) use notes::{uncut, warnings};
pub(crate) use tools::{PlacedTool, tools};

use cases::exact::{Exact, Medium};
use cases::scene::{self, LoadKind, Prescribed, Procedure, Reference, Scene, VectorField};
use geometry::{Point3, Vector3};
use material::{Law, LinearElastic, Material as _, Prony};

use crate::error::{Failure, Key};
use file_vectors::FileVectors;
use setup::{Applied, Directions, Foundation, Load, Setup, Support, SurfaceLoad};

/// A scene's method with the changes of a study.
#[derive(Clone, Debug)]
pub struct Scenario<'a> {
    /// Case name: the stem of the scene's file.
    pub case: String,
    /// The scene.
    pub scene: &'a Scene,
    /// The method, with overridden sizes and kernel.
    pub method: scene::Method,
    /// Level of the size; 0 if the size is given otherwise.
    pub level: u32,
    /// Poisson's ratio that replaces the scene's.
    pub poisson: Option<f64>,
    /// Scene key of the size if that is not the method's own key.
    pub size_key: Option<String>,
}

impl Scenario<'_> {
    /// Returns the law of each region and its small-strain limit.
    fn laws(&self) -> Result<(Vec<Law>, Vec<LinearElastic>), Failure> {
        // A study varies Poisson's ratio of the body, not of its regions.
        let ratios = std::iter::once(self.poisson).chain(std::iter::repeat(None));
        let all = self.scene.materials().zip(ratios);
        all.map(|((key, material), poisson)| {
            let law = law::law(material, poisson, &key)?;
            let linear = law::small_strain(&law, &key)?;
            Ok((law, linear))
        })
        .collect()
    }

    /// Builds materials, supports, loads and the exact solution.
    ///
    /// # Errors
    /// Returns an error, located at its scene key, for invalid material constants or tools, or for "exact"
    /// values in a scene without an exact solution.
    pub fn setup(&self) -> Result<Setup, Failure> {
        self.acting().map_err(|failure| self.locate(failure))
    }

    fn acting(&self) -> Result<Setup, Failure> {
        let (laws, materials) = self.laws()?;
        let medium = self.medium(&laws[0], materials[0])?;
        let e = &medium;
        let exact = self.exact(e)?;
        let loads = self.loads(e, &laws)?;
        Ok(Setup {
            laws,
            materials,
            densities: self.scene.materials().map(|(_, material)| material.density).collect(),
            directions: self.directions()?,
            active: self.active(),
            active_curves: self.scene.materials().map(|(_, m)| m.active_curve.clone()).collect(),
            supports: self.supports(e)?,
            loads,
            foundations: self.foundations(),
            relaxation: self.relaxation()?,
            output: self.scene.output.clone(),
            tools: tools(self.scene)?,
            procedure: self.scene.procedure,
            mass: self.method.mass,
            contact: exact.as_ref().and_then(|exact| exact.contact()),
            exact: exact.filter(|exact| exact.contact().is_none()),
            pod: self.method.pod,
            training: if self.method.pod.is_some() { self.training()? } else { Vec::new() },
        })
    }

    /// Builds the problems of the training runs.
    fn training(&self) -> Result<Vec<Setup>, Failure> {
        let setup = |index: usize| {
            let scene = self
                .scene
                .at_training(&self.method.id, index)
                .map_err(|errors| Failure::Scene(errors[0].clone().into()))?;
            let method = scene::Method { pod: None, ..self.method.clone() };
            Scenario { scene: &scene, method, ..self.clone() }.setup()
        };
        (0..self.scene.training.len()).map(setup).collect()
    }

    fn supports(&self, e: &Medium) -> Result<Vec<Support>, Failure> {
        self.scene
            .supports
            .iter()
            .enumerate()
            .map(|(index, support)| {
                let motion = support.motion.clone();
                let exact = motion.iter().flatten().any(|p| matches!(p, Prescribed::Exact));
                let exact = if exact { Some(self.exact(e)?.ok_or_else(no_exact)?) } else { None };
                Ok(Support {
                    key: format!("support[{index}]"),
                    place: support.place.clone(),
                    curve: support.curve.clone(),
                    during: support.during.map(|span| [span.from, span.until]),
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
            .collect()
    }

    fn foundations(&self) -> Vec<Foundation> {
        let each = self.scene.foundations.iter().enumerate();
        each.map(|(index, foundation)| Foundation {
            key: format!("foundation[{index}]"),
            place: foundation.place.clone(),
            stiffness: foundation.stiffness,
            damping: foundation.damping,
            along_normal: foundation.along_normal,
        })
        .collect()
    }

    fn loads(&self, e: &Medium, laws: &[Law]) -> Result<Vec<Load>, Failure> {
        self.scene
            .loads
            .iter()
            .enumerate()
            .map(|(index, load)| {
                let on = Applied::Surface;
                let applied = match load.kind.clone() {
                    LoadKind::Traction(VectorField::Exact) => {
                        let exact = self.exact(e)?.ok_or_else(no_exact)?;
                        on(SurfaceLoad::Traction(Box::new(move |x, n| Ok(exact.traction(x, n)))))
                    }
                    LoadKind::Traction(VectorField::Components(c)) => {
                        on(SurfaceLoad::Traction(Box::new(move |x, _| components(&c, x))))
                    }
                    LoadKind::Pressure(field) => {
                        on(SurfaceLoad::Pressure(Box::new(move |x| value(&field, x))))
                    }
                    LoadKind::Force(force) => on(SurfaceLoad::Force(force.into())),
                    LoadKind::Points { at, force } => Applied::Points {
                        at: at.into_iter().map(Point3::from).collect(),
                        force: force.into(),
                    },
                    LoadKind::Body(VectorField::Exact) => {
                        let exact = self.exact(e)?.ok_or_else(no_exact)?;
                        Applied::Body(Box::new(move |x| Ok(exact.body_force(x))))
                    }
                    LoadKind::Body(VectorField::Components(c)) => {
                        Applied::Body(Box::new(move |x| components(&c, x)))
                    }
                };
                let varies = load.kind.varies();
                let along_normal =
                    matches!(load.kind, LoadKind::Pressure(_) | LoadKind::Traction(VectorField::Exact));
                Ok(Load {
                    key: format!("load[{index}]"),
                    place: load.place.clone(),
                    applied,
                    varies,
                    along_normal,
                    follows: self.follows(load, laws),
                    curve: load.curve.clone(),
                })
            })
            .collect()
    }

    /// Whether a load acts on the deformed surface: a pressure or a traction that the scene does not make
    /// dead, if the procedure is one of large displacements and a law one of large strain.
    fn follows(&self, load: &scene::Load, laws: &[Law]) -> bool {
        let linear = matches!(
            self.scene.procedure,
            Procedure::Prepare | Procedure::Linear { .. } | Procedure::Modes { .. }
        );
        !load.dead && !linear && laws.iter().any(|law| !law.is_small_strain())
    }

    fn active(&self) -> Vec<f64> {
        let each: Vec<f64> = self.scene.materials().map(|(_, material)| material.active).collect();
        if each.iter().all(|active| *active == 0.0) { Vec::new() } else { each }
    }

    fn directions(&self) -> Result<Vec<Option<Directions>>, Failure> {
        let each = self.scene.materials().map(|(key, material)| {
            let Some(scene::Directions { fibers, sheets }) = &material.directions else { return Ok(None) };
            let fibers = self.direction(fibers, &format!("{key}.fibers"))?;
            let sheets =
                sheets.as_ref().map(|of| self.direction(of, &format!("{key}.sheets"))).transpose()?;
            Ok(Some(Directions { key, fibers, sheets }))
        });
        each.collect()
    }

    /// Returns the direction of a scene's key.
    fn direction(&self, of: &scene::Direction, key: &str) -> Result<setup::Direction, Failure> {
        let other = |key: String, problem: &str| Failure::input(Key::Scene(key), problem, "");
        Ok(match (of.clone(), &self.scene.body) {
            (scene::Direction::Field(of), _) => {
                setup::Direction::Field(Box::new(move |x| components(&of, x)))
            }
            (scene::Direction::Helix(angles), scene::Body::Ventricle(wall)) => {
                let wall = *wall;
                setup::Direction::Field(Box::new(move |x| Ok(fibers::helix(&wall, angles, x))))
            }
            (scene::Direction::Helix(_), _) => {
                return Err(other(format!("{key}.helix"), "needs a ventricle as the body"));
            }
            (scene::Direction::Depth(wall), _) => setup::Direction::Wall(wall),
            (scene::Direction::Data(name), scene::Body::File(file)) => {
                let help = "name an array of vectors, one for each cell or node";
                let wrong = |bad| Failure::input(Key::Scene(format!("{key}.data")), bad, help);
                setup::Direction::File(Box::new(FileVectors::read(file, &name).map_err(wrong)?))
            }
            (scene::Direction::Data(_), _) => {
                return Err(other(format!("{key}.data"), "needs a mesh file as the body"));
            }
        })
    }

    fn relaxation(&self) -> Result<Vec<Option<Prony>>, Failure> {
        let series = self.scene.materials().map(|(key, material)| {
            let terms: Vec<(f64, f64)> = material.prony.iter().map(|t| (t.g, t.tau)).collect();
            let wrong = |bad: material::MaterialError| {
                Failure::input(Key::Scene(format!("{key}.prony")), bad.to_string(), "")
            };
            if terms.is_empty() { Ok(None) } else { Prony::new(&terms).map(Some).map_err(wrong) }
        });
        series.collect()
    }

    /// Returns the body's material in the form used by exact solutions.
    fn medium(&self, law: &Law, limit: LinearElastic) -> Result<Medium, Failure> {
        scene::medium(law, limit.young(), limit.poisson())
            .map_err(|bad| Failure::input(Key::Scene("material".into()), bad.to_string(), ""))
    }

    /// Returns the scene's exact solution for this run's material; `None` if the scene names none. A solution
    /// of a motion is evaluated at the end of the motion.
    fn exact(&self, medium: &Medium) -> Result<Option<Box<dyn Exact>>, Failure> {
        let Some(Reference::Exact { entry, values }) = &self.scene.reference else { return Ok(None) };
        let exact = (entry.build)(medium, values)
            .map_err(|bad| Failure::input(Key::Scene("reference".into()), bad.to_string(), ""))?;
        Ok(Some(self.scene.procedure.duration().and_then(|end| exact.at(end)).unwrap_or(exact)))
    }
}

fn no_exact() -> Failure {
    let problem = "needs the scene's exact solution for its \"exact\" values";
    Failure::input(Key::Scene("reference".into()), problem, "add [reference] exact = \"...\"")
}

fn value(field: &scene::ScalarField, x: &Point3) -> Result<f64, String> {
    field.value([x.x, x.y, x.z]).map_err(|bad| bad.to_string())
}

fn components(fields: &[scene::ScalarField; 3], x: &Point3) -> Result<Vector3, String> {
    Ok(Vector3::new(value(&fields[0], x)?, value(&fields[1], x)?, value(&fields[2], x)?))
}
