//! Expected node counts of a size, before a mesh is made: a mesh of a hundred million cells is refused at
//! once.

use cases::scene::{self, Body, Cloud, Family, Size};
use geometry::CellKind;
use geometry::shapes::Kidney;
use geometry::stuffing::expected_nodes;

use super::{Scenario, file_body};

/// Cells along a side of the core around a ventricle's apex for each cell through its wall.
pub(super) const VENTRICLE: usize = 4;

impl Scenario<'_> {
    /// Returns the approximate number of nodes of the method's meshes and clouds, including its background; 0
    /// for files.
    pub fn expected_nodes(&self) -> f64 {
        let body = &self.scene.body;
        match &self.method.family {
            Family::Fem(fem) => of_elements(body, fem),
            Family::External(external) => of_elements(body, &external.elements),
            Family::Efg(efg) => {
                let background =
                    efg.background.as_ref().map_or(0.0, |size| nodes(body, CellKind::Tet4, size));
                background + cloud(body, &efg.cloud)
            }
        }
    }
}

/// Returns the number of nodes of finite elements; 0 for cells of several kinds, which a file has.
fn of_elements(body: &Body, fem: &scene::Fem) -> f64 {
    fem.element.kind().map_or(0.0, |kind| nodes(body, kind, &fem.size))
}

fn cloud(body: &Body, cloud: &scene::Cloud) -> f64 {
    match cloud {
        Cloud::Mesh { size, .. } => nodes(body, CellKind::Tet4, size),
        Cloud::Uniform { nodes, .. } | Cloud::Graded { nodes, .. } | Cloud::Refined { nodes, .. } => {
            *nodes as f64
        }
        Cloud::File { .. } => 0.0,
    }
}

/// Returns the number of nodes of a mesh of the body; 0 for a mesh file.
pub(super) fn nodes(body: &Body, kind: CellKind, size: &Size) -> f64 {
    match *size {
        // The coarsest mesh of a box a million times as long as it is narrow has more nodes than requested.
        Size::Nodes(wanted) => of_family(body, kind, 1.0).max(wanted as f64),
        Size::Spacing(spacing) if matches!(body, Body::File(_)) => of_spacing(body, kind, spacing),
        Size::Spacing(spacing) => of_family(body, kind, (narrowest(body) / spacing).round().max(1.0)),
        Size::Level(level) => of_family(body, kind, 2f64.powi(level as i32)),
        Size::Cells { cells, .. } => of_box(kind, cells.map(|n| n as f64)),
        Size::File(_) => 0.0,
    }
}

/// Returns the number of nodes of a mesh with `n` cells across the body's narrowest extent: exact for a box,
/// a close lower bound for other bodies.
pub(super) fn of_family(body: &Body, kind: CellKind, n: f64) -> f64 {
    let layers = (n / 2.0).ceil();
    let cells = match *body {
        Body::Box { min, max } => {
            let extent: [f64; 3] = std::array::from_fn(|a| max[a] - min[a]);
            let narrow = extent.iter().copied().fold(f64::MAX, f64::min);
            return of_box(kind, extent.map(|e| (e / narrow * n).round().max(1.0)));
        }
        Body::Cylinder { radius, height } => {
            (n * n + 4.0 * n * layers) * (height / radius * n).round().max(1.0)
        }
        Body::Ball { .. } | Body::Kidney { half: false, .. } => n * n * n + 6.0 * n * n * layers,
        // Half of a body with 3 n by 7 n / 2 by n cells in the core and n layers around them. Mild grading
        // has a quarter more.
        Body::Kidney { half: true, .. } => 20.0 * n * n * n,
        Body::Ventricle(_) => {
            let across = VENTRICLE as f64 * n;
            (across * across + 4.0 * across * (across / 2.0).ceil()) * n
        }
        Body::SphereShell { octant, .. } => n * n * n * if octant { 3.0 } else { 6.0 },
        Body::File(_) => return of_spacing(body, kind, narrowest(body) / n),
    };
    // Nodes per cube, with shared nodes counted once: corners and edge midpoints.
    let midpoints = if kind.order() == 2 { 3 + kind.entry().cell.diagonals.iter().sum::<usize>() } else { 0 };
    cells * (1 + midpoints) as f64
}

/// Returns the number of nodes of a box with `cells` cells along x, y and z.
pub(super) fn of_box(kind: CellKind, cells: [f64; 3]) -> f64 {
    let [x, y, z] = cells;
    let corners = (x + 1.0) * (y + 1.0) * (z + 1.0);
    let edges = x * (y + 1.0) * (z + 1.0) + (x + 1.0) * y * (z + 1.0) + (x + 1.0) * (y + 1.0) * z;
    let places = [x * y * (z + 1.0), x * (y + 1.0) * z, (x + 1.0) * y * z, x * y * z];
    let diagonals: f64 =
        places.iter().zip(kind.entry().cell.diagonals).map(|(n, each)| n * each as f64).sum();
    if kind.order() == 2 { corners + edges + diagonals } else { corners }
}

/// Returns the length (m) that the number of cells of a size divides.
pub(super) fn narrowest(body: &Body) -> f64 {
    match *body {
        Body::Box { min, max } => (0..3).map(|a| max[a] - min[a]).fold(f64::MAX, f64::min),
        Body::Cylinder { radius, .. } | Body::Ball { radius } => radius,
        Body::SphereShell { inner, outer, .. } => outer - inner,
        Body::Ventricle(ref wall) => wall.outer[0] - wall.inner[0],
        Body::Kidney { .. } => Kidney::C,
        Body::File(ref file) => file_body::load(file).map_or(0.0, |body| body.narrowest()),
    }
}

/// Returns the approximate number of nodes of a mesh inside a surface file; 0 if the file cannot be read.
pub(super) fn of_spacing(body: &Body, kind: CellKind, spacing: f64) -> f64 {
    let Body::File(file) = body else { return 0.0 };
    let corners = file_body::load(file)
        .map_or(0.0, |body| expected_nodes(body.surface.volume(), body.surface.area(), spacing));
    if kind.order() == 2 { 8.0 * corners } else { corners }
}

#[cfg(test)]
mod tests {
    use super::super::body_mesh;
    use super::*;

    /// Any mesh refused by the estimate would be refused after meshing: no estimate exceeds the true count,
    /// and none is far below.
    #[test]
    fn nodes_are_foreseen() {
        let bodies = [
            Body::Box { min: [0.0; 3], max: [0.02, 0.05, 0.01] },
            Body::Cylinder { radius: 0.01, height: 0.05 },
            Body::Ball { radius: 0.01 },
            Body::Kidney { half: false, mildly_graded: false },
            Body::Kidney { half: true, mildly_graded: false },
            Body::Kidney { half: true, mildly_graded: true },
            Body::SphereShell { inner: 0.01, outer: 0.03, octant: true },
            Body::SphereShell { inner: 0.01, outer: 0.03, octant: false },
        ];
        for (body, kind) in bodies.iter().flat_map(|body| CellKind::ALL.map(|kind| (body, kind))) {
            let size = Size::Level(3);
            let made = body_mesh::mesh(body, kind, &size, None).unwrap().points().len() as f64;
            let foreseen = nodes(body, kind, &size);
            assert!(foreseen <= made && foreseen > 0.5 * made, "{body:?} {kind:?}: {foreseen} of {made}");
        }
    }
}
