//! Discretises the method of a scenario: the only module that distinguishes finite elements from clouds.

use std::sync::Arc;

use cases::scene::{self, Family};
use geometry::generate::raise_order;
use geometry::stuffing::fitted;
use geometry::{Mesh, Point3, Vector3, quality};
use shape::HourglassModulus;

use super::{Scenario, body_mesh, file_body};
use crate::discretise::place::{self, tolerance};
use crate::discretise::{Adapt, Discretisation};
use crate::error::{Failure, Key};

impl Scenario<'_> {
    /// Discretises the scenario's method: its nodes, cells and rules.
    ///
    /// # Errors
    /// Returns an error, located at its scene key, if the mesh or cloud cannot be made or the method does not
    /// suit the body.
    pub fn discretise(&self) -> Result<Discretisation, Failure> {
        let found = match &self.method.family {
            Family::Fem(fem) => self.elements(fem),
            Family::Efg(efg) => self.cloud(efg),
            Family::External(external) => self.external(external),
        };
        found.map_err(|failure| self.locate(failure))
    }

    pub(super) fn elements(&self, fem: &scene::Fem) -> Result<Discretisation, Failure> {
        let mesh = body_mesh::mesh_of(&self.scene.body, fem.element, &fem.size, fem.jitter)?;
        let mesh = Arc::new(self.with_regions(mesh)?);
        let elements = Discretisation::of_elements(mesh, fem.element.order(), fem.reduced, fem.dilation);
        let adapt = fem.adapt.map(|adapt| self.adapt(fem, adapt)).transpose()?;
        let elements = Discretisation { adapt, ..elements };
        Ok(match fem.hourglass {
            Some(scene::Hourglass { coefficient, modulus }) => {
                let modulus = match modulus {
                    scene::HourglassModulus::PWave => HourglassModulus::PWave,
                    scene::HourglassModulus::Shear => HourglassModulus::Shear,
                };
                elements.controlled(coefficient, modulus)
            }
            None => elements,
        })
    }

    /// Refinement of the mesh, whose new nodes on the boundary move onto the surface that it fills.
    fn adapt(&self, fem: &scene::Fem, adapt: scene::Adapt) -> Result<Adapt, Failure> {
        let scene::Adapt { by, error, rounds } = adapt;
        let surface = match (&self.scene.body, &fem.size) {
            (_, scene::Size::File(_)) => None,
            (scene::Body::File(file), _) => Some(file_body::load(file)?.surface.clone()),
            _ => None,
        };
        let (order, dilation) = (fem.element.order(), fem.dilation);
        let on = move |mesh: Mesh| {
            let mesh = match &surface {
                Some(surface) => fitted(mesh, surface, order == 2),
                None if order == 2 => raise_order(&mesh),
                None => mesh,
            };
            let bad = |bad| Failure::Run(format!("the refined mesh has an inverted cell: {bad}"));
            quality::check_inversion(&mesh).map_err(bad)?;
            Ok(Discretisation::of_elements(Arc::new(mesh), order, false, dilation))
        };
        Ok(Adapt { by, error, rounds, on: Arc::new(on) })
    }

    /// Numbers the cells by material: 0 for the scene's material, k + 1 for its k-th region.
    pub(super) fn with_regions(&self, mesh: Mesh) -> Result<Mesh, Failure> {
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
                    scene::Place::On(names) => names.iter().any(|name| mesh.is_in(cell, name)),
                    at => {
                        let n = mesh.cell(cell).len() as f64;
                        let sum = mesh.cell_points(cell).fold(Vector3::zeros(), |s, p| s + p.coords);
                        place::holds(at, &Point3::from(sum / n), tolerance)
                    }
                };
                if inside {
                    let before = usize::from(std::mem::replace(slot, index as u16 + 1));
                    hit = true;
                    if before > 0 {
                        self.one_material([before - 1, index], cell)?;
                    }
                }
            }
            if !hit {
                let (key, help) = match &region.place {
                    scene::Place::On(_) => {
                        let groups = mesh.cell_groups().map(|(name, _)| name.to_string());
                        let names: Vec<String> = mesh.region_names().iter().cloned().chain(groups).collect();
                        ("on", format!("the mesh has {}", names.join(", ")))
                    }
                    _ => ("where", format!("{}; check the signs and the unit", place::extent(&mesh))),
                };
                let key = Key::Scene(format!("region[{index}].{key}"));
                return Err(Failure::input(key, "contains no cell of the mesh", &help));
            }
        }
        let names = std::iter::once("body".into()).chain(self.scene.regions.iter().map(|r| r.name.clone()));
        Ok(mesh.with_regions(regions, names.collect()))
    }

    /// Refuses a cell in two named regions with different materials. For regions given by comparisons the
    /// later one applies.
    fn one_material(&self, regions: [usize; 2], cell: usize) -> Result<(), Failure> {
        let [first, second] = regions.map(|index| &self.scene.regions[index]);
        if !matches!((&first.place, &second.place), (scene::Place::On(_), scene::Place::On(_))) {
            return Ok(());
        }
        let key = Key::Scene(format!("region[{}].on", regions[1]));
        let names = [first, second].map(|region| place::words(&region.place));
        let problem = format!(
            "'{}' ({}) and '{}' ({}) both contain cell {cell} of the mesh, but a cell has one material",
            second.name, names[1], first.name, names[0]
        );
        Err(Failure::input(key, problem, "name groups that share no cell"))
    }
}
