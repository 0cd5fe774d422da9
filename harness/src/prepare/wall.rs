//! Directions in a wall between two surfaces, by its depth: a field that satisfies Laplace's equation on the method's
//! own shape functions, from 0 on one surface to 1 on the other.
//!
//! The gradient of the depth is the direction through the wall; the circumference lies across it and across a long
//! axis. Rules of this kind: Potse et al., IEEE Trans. Biomed. Eng. 53 (2006) 2425; Bayer et al., Ann. Biomed. Eng. 40
//! (2012) 2243.

use cases::scene::{Place, WallHelix, WallRule};
use geometry::{Facet, Vector3};
use shape::{RowSource, VolumeRows, position_alone};
use statics::{LaplaceProblem, SolveError, solve_laplace};

use crate::discretise::{Discretisation, Essential, place};
use crate::error::{Failure, Key};

/// Stabilisation of the depth on surfaces of a cloud, over the spacing of its nodes.
const STABILISATION: f64 = 100.0;
/// Gradient of the depth, relative to the largest in the body, below which there is no direction through the wall.
const FLAT: f64 = 1e-6;
/// Sine of the angle between long axis and gradient below which the circumference has no direction.
const ON_AXIS: f64 = 1e-6;

/// The depths of the walls of one run, each solved once.
pub(super) struct Walls<'a> {
    method: &'a Discretisation,
    source: &'a dyn RowSource,
    volume: &'a VolumeRows,
    known: Vec<Wall>,
}

struct Wall {
    from: Vec<String>,
    to: Vec<String>,
    /// Depth at each point of the volume, 0 to 1.
    depth: Vec<f64>,
    /// Gradient of the depth at each point, 1/m.
    gradient: Vec<Vector3>,
}

impl<'a> Walls<'a> {
    pub fn new(method: &'a Discretisation, source: &'a dyn RowSource, volume: &'a VolumeRows) -> Walls<'a> {
        Walls { method, source, volume, known: Vec::new() }
    }

    /// Returns the unit directions of a rule at some points of the volume, by their indices; `key` is that of the
    /// direction in the scene.
    ///
    /// # Errors
    /// Returns an error if the surfaces do not bound a wall, or, with the position, if the depth has no gradient at a
    /// point.
    pub fn directions(
        &mut self,
        key: &str,
        rule: &WallRule,
        points: &[usize],
    ) -> Result<Vec<Vector3>, Failure> {
        let known = self.known.iter().position(|wall| wall.from == rule.from && wall.to == rule.to);
        let wall = match known {
            Some(at) => &self.known[at],
            None => {
                let wall = self.solve(key, rule)?;
                self.known.push(wall);
                &self.known[self.known.len() - 1]
            }
        };
        let steepest = wall.gradient.iter().map(Vector3::norm).fold(0.0, f64::max);
        let direction = |&q: &usize| {
            let through = wall.gradient[q].try_normalize(FLAT * steepest).ok_or_else(|| {
                let at = position_alone(&self.volume.points()[q]);
                let problem =
                    format!("has no direction through the wall at {at}: the depth does not change there");
                refuse(key, problem, "name two surfaces that face each other across the whole material")
            })?;
            Ok(rule.helix.map_or(through, |helix| turned(&helix, wall.depth[q], through)))
        };
        points.iter().map(direction).collect()
    }

    /// Solves for the depth of a wall.
    fn solve(&self, key: &str, rule: &WallRule) -> Result<Wall, Failure> {
        let from = self.surface(&format!("{key}.depth.from"), &rule.from)?;
        let to = self.surface(&format!("{key}.depth.to"), &rule.to)?;
        let mesh = self.method.mesh();
        let nodes = [&from, &to].map(|facets| mesh.facet_group_nodes(facets));
        if let Some(&both) = nodes[0].iter().find(|node| nodes[1].binary_search(node).is_ok()) {
            let at = position_alone(&mesh.points()[both as usize]);
            let problem = format!("meets the surface of depth 0 at {at}, where the depth would be 0 and 1");
            let help = "name two surfaces that do not touch";
            return Err(Failure::input(Key::Scene(format!("{key}.depth.to")), problem, help));
        }
        let (mut fixed, mut surfaces) = (Vec::new(), Vec::new());
        for (value, (facets, nodes)) in [from, to].iter().zip(nodes).enumerate() {
            match self.method.essential {
                Essential::Nodal => fixed.extend(nodes.into_iter().map(|node| (node, value as f64))),
                _ => surfaces.push((self.source.flux(facets)?, value as f64)),
            }
        }
        // A reduced quadrature leaves fields without energy.
        let fine = if self.method.reduced { Some(self.source.fine_volume()?) } else { None };
        let stabilisation = STABILISATION / self.source.spacing(self.volume);
        let volume = fine.as_ref().unwrap_or(self.volume);
        let problem = LaplaceProblem { volume, fixed: &fixed, surfaces: &surfaces, stabilisation };
        let field = solve_laplace(&problem).map_err(|bad| unsolved(key, bad))?;
        let points = 0..self.volume.weights().len();
        let depth = |q: usize| -> f64 {
            let (nodes, values) = self.volume.rows().row(q);
            nodes.iter().zip(values).map(|(&node, value)| value * field[node as usize]).sum()
        };
        let gradient = |q: usize| -> Vector3 {
            let (nodes, grads) = self.volume.row(q);
            nodes.iter().zip(grads).map(|(&node, grad)| grad * field[node as usize]).sum()
        };
        Ok(Wall {
            from: rule.from.clone(),
            to: rule.to.clone(),
            depth: points.clone().map(depth).collect(),
            gradient: points.map(gradient).collect(),
        })
    }

    /// Facets of the named surfaces, which have to be on the boundary.
    fn surface(&self, key: &str, names: &[String]) -> Result<Vec<Facet>, Failure> {
        let mesh = self.method.mesh();
        let named = Place::On(names.to_vec());
        let facets = place::facets(key, &named, mesh).map_err(|failure| match failure {
            Failure::At(mut finding) => {
                finding.key = Key::Scene(key.into());
                Failure::At(finding)
            }
            failure => failure,
        })?;
        let boundary = mesh.boundary();
        let problem = match facets.iter().filter(|facet| boundary.binary_search(facet).is_err()).count() {
            _ if facets.is_empty() => "contains no face of the mesh".to_string(),
            0 => return Ok(facets),
            inside => format!("has {inside} of its {} faces inside the body", facets.len()),
        };
        Err(Failure::input(Key::Scene(key.into()), problem, "name surfaces of the body"))
    }
}

/// The direction at an angle from the circumference towards the end of the axis, linear in the depth. On the axis, where
/// the circumference has no direction, any direction across the wall's normal takes its place.
fn turned(helix: &WallHelix, depth: f64, through: Vector3) -> Vector3 {
    let axis = Vector3::from(helix.axis);
    let axis = axis / axis.norm();
    let around = axis.cross(&through).try_normalize(ON_AXIS).unwrap_or_else(|| {
        let other = Vector3::ith(through.iamin(), 1.0);
        through.cross(&other).normalize()
    });
    let [first, last] = helix.angles;
    let angle = first + depth * (last - first);
    around * angle.cos() + through.cross(&around) * angle.sin()
}

fn refuse(key: &str, problem: String, help: &str) -> Failure {
    Failure::input(Key::Scene(format!("{key}.depth")), problem, help)
}

fn unsolved(key: &str, bad: SolveError) -> Failure {
    let help = "name surfaces that every piece of the body has";
    let problem = match bad {
        SolveError::NotPositiveDefinite
        | SolveError::Algebra(algebra::AlgebraError::NearlySingular { .. }) => {
            "can't be determined: a piece of the body touches neither of the two surfaces".to_string()
        }
        bad => format!("can't be determined: {bad}"),
    };
    refuse(key, problem, help)
}
