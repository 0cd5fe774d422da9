//! Loads at the integration points of their surfaces.

use fem::SurfaceRule;
use geometry::{Facet, Point3, Vector3};
use shape::{FixedDof, FluxRows, RowSource, SurfaceRows};
use statics::{FollowingLoad, Load};

use super::Prepared;
use super::region_check::loaded;
use super::surfaces::{cut_surface, flux};
use super::values::{Values, not_finite};
use crate::discretise::place::Patch;
use crate::discretise::{Discretisation, node_set};
use crate::error::Failure;
use crate::scenario::setup::{self, Applied, SurfaceLoad};

impl Prepared {
    /// Returns the loads for the solver.
    pub fn loads(&self) -> Vec<Load<'_>> {
        let surfaces = self.surfaces.iter().map(|(surface, values)| match values {
            Values::Traction(values) => Load::Traction { surface, values: values.clone() },
            Values::Pressure(values) => Load::Pressure { surface, values: values.clone() },
        });
        let body = self.body_force.iter().map(|values| Load::Body { values: values.clone() });
        let nodal = self.nodal.iter().map(|forces| Load::Nodal { forces: forces.clone() });
        surfaces.chain(body).chain(nodal).collect()
    }

    /// Returns the tables with the conditions of a problem in files: prescribed degrees of freedom and nodal
    /// forces (N).
    pub(crate) fn under(self, fixed: Vec<FixedDof>, forces: Vec<Vector3>) -> Prepared {
        Prepared { fixed, nodal: vec![forces], ..self }
    }

    /// Returns the resultant of all loads at the end of the loading, at the nodal parameters `u` (m), N.
    pub fn resultant(&self, u: &[Vector3]) -> Vector3 {
        let mut nodal = vec![Vector3::zeros(); u.len()];
        let own = &self.own_curves;
        for (index, pressure) in self.following.iter().enumerate() {
            pressure.add_force(u, own.at_end(&own.following, index), &mut nodal);
        }
        let mut sum: Vector3 = nodal.iter().sum();
        for (index, (surface, values)) in self.surfaces.iter().enumerate() {
            let factor = own.at_end(&own.loads, index);
            for (q, w) in surface.weights().iter().enumerate() {
                sum += factor
                    * *w
                    * match values {
                        Values::Traction(t) => t[q],
                        Values::Pressure(p) => surface.normals()[q] * -p[q],
                    };
            }
        }
        let mut index = self.surfaces.len();
        for values in &self.body_force {
            let factor = own.at_end(&own.loads, index);
            for (b, w) in values.iter().zip(self.volume.rows.weights()) {
                sum += b * (factor * *w);
            }
            index += 1;
        }
        for forces in &self.nodal {
            sum += forces.iter().sum::<Vector3>() * own.at_end(&own.loads, index);
            index += 1;
        }
        sum
    }

    /// Evaluates a load at its points.
    pub(super) fn load(&mut self, method: &Discretisation, load: &setup::Load) -> Result<(), Failure> {
        match &load.applied {
            Applied::Surface(field) => match (field, node_set::alone(&load.place, method.mesh())) {
                (SurfaceLoad::Force(force), Some(nodes)) => {
                    let at: Vec<Point3> =
                        nodes.iter().map(|&node| method.mesh().points()[node as usize]).collect();
                    self.load_at_points(&at, force / at.len() as f64, load)
                }
                _ => self.load_on_surface(method, load, field),
            },
            Applied::Points { at, force } => self.load_at_points(at, *force, load),
            Applied::Body(field) => {
                let values = self.volume.rows.points().iter().map(field).collect::<Result<_, _>>();
                self.body_force.push(values.map_err(not_finite(&load.key, "body"))?);
                Ok(())
            }
        }
    }

    /// Adds a force (N) at each of some points (m).
    fn load_at_points(&mut self, at: &[Point3], force: Vector3, load: &setup::Load) -> Result<(), Failure> {
        let (rows, _) = self.source.at_points(at)?;
        let added = rows.rows().apply_transposed(&vec![force; at.len()]);
        let same = self.own_curves.nodal.iter().position(|curve| *curve == load.curve);
        match same.map(|index| &mut self.nodal[index]) {
            Some(forces) => forces.iter_mut().zip(added).for_each(|(force, added)| *force += added),
            None => self.nodal.push(added),
        }
        Ok(())
    }

    fn load_on_surface(
        &mut self,
        method: &Discretisation,
        load: &setup::Load,
        field: &SurfaceLoad,
    ) -> Result<(), Failure> {
        let patch = loaded(load, method.mesh())?;
        match (field, load.follows) {
            (SurfaceLoad::Pressure(field), true) => {
                return self.follow(&patch, |surface| {
                    let values = surface.points().iter().map(field).collect::<Result<Vec<f64>, _>>();
                    let values = values.map_err(not_finite(&load.key, "pressure"))?;
                    Ok(FollowingLoad::pressure(surface, &values)?)
                });
            }
            (SurfaceLoad::Traction(field), true) => {
                return self.follow(&patch, |surface| {
                    let at = surface.points().iter().zip(surface.normals());
                    let values = at.map(|(x, n)| field(x, n)).collect::<Result<Vec<Vector3>, _>>();
                    let values = values.map_err(not_finite(&load.key, "traction"))?;
                    Ok(FollowingLoad::traction(surface, &values)?)
                });
            }
            _ => {}
        }
        let area = area(&*self.source, field, &patch)?;
        let at_points = |surface| at_points(&load.key, field, area, surface);
        if !patch.whole.is_empty() {
            let table = match (load.varies, self.is_smoothed_by_centres()?) {
                (false, _) => at_points(self.source.surface(&patch.whole)?)?,
                (true, false) => at_points(self.source.field_surface(&patch.whole)?)?,
                (true, true) => self.by_means(&patch.whole, at_points)?,
            };
            self.surfaces.push(table);
        }
        if !patch.cut.is_empty() {
            self.surfaces.push(at_points(cut_surface(&*self.source, &patch.cut)?)?);
        }
        Ok(())
    }

    /// Adds a load on the deformed surface, which needs the gradients of the shape functions.
    fn follow(
        &mut self,
        patch: &Patch,
        load: impl Fn(&FluxRows) -> Result<FollowingLoad, Failure>,
    ) -> Result<(), Failure> {
        for surface in flux(&*self.source, patch)? {
            self.following.push(load(&surface)?);
        }
        Ok(())
    }

    /// Whether gradients are smoothed with one point per face, its centre.
    fn is_smoothed_by_centres(&self) -> Result<bool, Failure> {
        Ok(self.source.face_points() == 1 && self.source.trace(&[])?.is_some())
    }

    /// Returns the mean of a load over each facet, at the facet's centre. The integration constraint requires
    /// the load at the point that smooths the gradients. The value at the centre alone gives 6.5 % too much
    /// of a Saint-Venant traction on 4 x 4 faces.
    fn by_means(
        &self,
        facets: &[Facet],
        at_points: impl Fn(SurfaceRows) -> Result<(SurfaceRows, Values), Failure>,
    ) -> Result<(SurfaceRows, Values), Failure> {
        let surface = self.source.surface(facets)?;
        let fine = fem::surface_rows(self.source.mesh(), facets, &SurfaceRule::FINE)?;
        let each = fine.weights().len() / facets.len();
        let weights = fine.weights().to_vec();
        let mean = |facet: usize, value: &dyn Fn(usize) -> Vector3| -> Vector3 {
            let points = each * facet..each * (facet + 1);
            let area: f64 = weights[points.clone()].iter().sum();
            points.map(|q| value(q) * weights[q]).sum::<Vector3>() / area
        };
        let values = match at_points(fine)?.1 {
            Values::Traction(t) => {
                Values::Traction((0..facets.len()).map(|facet| mean(facet, &|q| t[q])).collect())
            }
            Values::Pressure(p) => {
                let plain = |q: usize| Vector3::new(p[q], 0.0, 0.0);
                Values::Pressure((0..facets.len()).map(|facet| mean(facet, &plain).x).collect())
            }
        };
        Ok((surface, values))
    }
}

/// Area of a patch, m^2, over which a total force is spread; 0 for a load given by its field.
fn area(source: &dyn RowSource, field: &SurfaceLoad, patch: &Patch) -> Result<f64, Failure> {
    if !matches!(field, SurfaceLoad::Force(_)) {
        return Ok(0.0);
    }
    let cut: f64 = patch.cut.iter().map(|triangle| triangle.area_vector().norm()).sum();
    let whole: f64 = source.surface(&patch.whole)?.weights().iter().sum();
    Ok(whole + cut)
}

/// Evaluates the load of a key at every point of a surface, part of a place of this area, m^2.
fn at_points(
    key: &str,
    field: &SurfaceLoad,
    area: f64,
    surface: SurfaceRows,
) -> Result<(SurfaceRows, Values), Failure> {
    let at = surface.points().iter().zip(surface.normals());
    let values = match field {
        SurfaceLoad::Traction(field) => {
            let values = at.map(|(x, n)| field(x, n)).collect::<Result<_, _>>();
            Values::Traction(values.map_err(not_finite(key, "traction"))?)
        }
        SurfaceLoad::Pressure(field) => {
            let values = at.map(|(x, _)| field(x)).collect::<Result<_, _>>();
            Values::Pressure(values.map_err(not_finite(key, "pressure"))?)
        }
        SurfaceLoad::Force(force) => Values::Traction(vec![force / area; surface.weights().len()]),
    };
    Ok((surface, values))
}
