//! Surface quadrature rows of facets: values only for loads, values and gradients for Nitsche's method.

use geometry::element::{Element, with_element};
use geometry::quadrature::{Parts, Rule};
use geometry::{CellKind, FaceKind, Facet, Mesh, Point3, Vector3};
use shape::{FluxRows, GradRows, PointRows, Rows, SurfaceRows};

use crate::error::FemError;
use crate::face::{Face, into_cell, with_face};
use crate::map::{Nodes, inverse, physical};
use crate::rule::SurfaceRule;
use crate::volume::UNITY;

/// Returns shape values, weights `w |dx/ds x dx/dt|` (m^2) and outward unit normals at the points of every
/// facet, in the order given. Curved faces are integrated as they are. Rows have the facet's own nodes, in
/// the order of [`Mesh::facet_nodes`]: the functions of all other nodes of the cell vanish on the facet.
///
/// # Errors
///
/// [`FemError::NoSuchFacet`] or [`FemError::FlatFacet`] for an invalid facet.
pub fn surface_rows(mesh: &Mesh, facets: &[Facet], rule: &SurfaceRule) -> Result<SurfaceRows, FemError> {
    divided_surface_rows(mesh, facets, rule, &[])
}

/// Returns rows as [`surface_rows`] on subdivided facets. `parts` holds one entry per facet: with `n` equal
/// parts along each edge, the points are the points of the rule on each of the `n * n` parts
/// ([`Parts::Inside`]) or the corners of the parts ([`Parts::Corners`]). An empty `parts` leaves all facets
/// whole.
///
/// # Errors
///
/// As [`surface_rows`].
pub fn divided_surface_rows(
    mesh: &Mesh,
    facets: &[Facet],
    rule: &SurfaceRule,
    parts: &[Parts],
) -> Result<SurfaceRows, FemError> {
    let rules = rules(rule)?;
    let mut table = Table::new();
    for (k, &facet) in facets.iter().enumerate() {
        let kind = check(mesh, facet)?.face_kind(facet.face as usize);
        let divided = match parts.get(k) {
            Some(&parts) if parts != Parts::WHOLE => Some(rule.divided(kind, parts)?),
            _ => None,
        };
        let rule = divided.as_ref().unwrap_or(&rules[kind as usize]);
        with_face!(kind, F, N => {
            let nodes = facet_nodes::<N>(mesh, facet);
            let x = Nodes::gather(mesh, &nodes);
            for (&s, &w) in rule.points.iter().zip(&rule.weights) {
                let n = <F as Face<N>>::shape(s);
                table.push_area(facet, x.tangents(&<F as Face<N>>::shape_grad(s)), w)?;
                table.push_row(x.position(&n), &nodes, &n);
            }
        });
    }
    let rows = Rows::new(mesh.points().len(), table.offsets, table.nodes, table.values, UNITY)?;
    Ok(SurfaceRows::new(PointRows::new(table.points, rows)?, table.weights, table.normals)?)
}

/// Returns shape values at the nodes of the facets, in ascending order, and then at the middle of each facet.
///
/// # Errors
///
/// [`FemError::NoSuchFacet`] if the mesh does not have a facet.
pub fn outline_rows(mesh: &Mesh, facets: &[Facet]) -> Result<PointRows, FemError> {
    let mut table = Table::new();
    for node in mesh.facet_group_nodes(facets) {
        table.push_row(mesh.points()[node as usize], &[node], &[1.0]);
    }
    for &facet in facets {
        let kind = check(mesh, facet)?.face_kind(facet.face as usize);
        let s = kind.centre();
        with_face!(kind, F, N => {
            let nodes = facet_nodes::<N>(mesh, facet);
            let n = <F as Face<N>>::shape(s);
            table.push_row(Nodes::gather(mesh, &nodes).position(&n), &nodes, &n);
        });
    }
    let rows = Rows::new(mesh.points().len(), table.offsets, table.nodes, table.values, UNITY)?;
    Ok(PointRows::new(table.points, rows)?)
}

/// Returns rows as [`surface_rows`], but each row has all nodes of the facet's cell, in the cell's order,
/// with gradients (1/m), because the boundary stress depends on all of them.
///
/// # Errors
///
/// As [`surface_rows`], and [`FemError::InvertedElement`] if a cell is inverted at a point.
pub fn flux_rows(mesh: &Mesh, facets: &[Facet], rule: &SurfaceRule) -> Result<FluxRows, FemError> {
    let rules = rules(rule)?;
    let mut table = Table::new();
    let mut grads = Vec::new();
    for &facet in facets {
        let kind = check(mesh, facet)?;
        let rule = &rules[kind.face_kind(facet.face as usize) as usize];
        let element = facet.cell as usize;
        with_element!(kind, E, N => {
            let nodes = &mesh.cell(element).as_chunks::<N>().0[0];
            let x = Nodes::gather(mesh, nodes);
            for (&s, &w) in rule.points.iter().zip(&rule.weights) {
                let xi = into_cell(kind, facet.face as usize, s);
                let (n, dn) = (<E as Element<N>>::shape(xi), <E as Element<N>>::shape_grad(xi));
                let (_, grad_xi) = inverse(&x.tangents(&dn))
                    .map_err(|det_j| FemError::InvertedElement { element, det_j })?;
                table.push_area(facet, facet_tangents(mesh, facet, s), w)?;
                table.push_row(x.position(&n), nodes, &n);
                grads.extend(dn.iter().map(|dn| physical(dn, &grad_xi)));
            }
        });
    }
    let rows = Rows::new(mesh.points().len(), table.offsets, table.nodes, table.values, UNITY)?;
    Ok(FluxRows::new(GradRows::new(table.points, rows, grads)?, table.weights, table.normals)?)
}

/// Arrays under construction, one entry (or one run of entries) per point.
struct Table {
    points: Vec<Point3>,
    weights: Vec<f64>,
    normals: Vec<Vector3>,
    offsets: Vec<usize>,
    nodes: Vec<u32>,
    values: Vec<f64>,
}

impl Table {
    fn new() -> Table {
        Table {
            points: Vec::new(),
            weights: Vec::new(),
            normals: Vec::new(),
            offsets: vec![0],
            nodes: Vec::new(),
            values: Vec::new(),
        }
    }

    fn push_area(&mut self, facet: Facet, [t0, t1]: [Vector3; 2], weight: f64) -> Result<(), FemError> {
        let normal = t0.cross(&t1);
        let area = normal.norm();
        if area > 0.0 {
            self.weights.push(weight * area);
            self.normals.push(normal / area);
            Ok(())
        } else {
            Err(FemError::FlatFacet { cell: facet.cell, face: facet.face, area })
        }
    }

    fn push_row(&mut self, point: Point3, nodes: &[u32], values: &[f64]) {
        self.points.push(point);
        self.nodes.extend_from_slice(nodes);
        self.values.extend_from_slice(values);
        self.offsets.push(self.nodes.len());
    }
}

/// Returns one rule per face kind, indexed by `FaceKind as usize`.
fn rules(rule: &SurfaceRule) -> Result<[Rule<2>; 4], FemError> {
    Ok([
        rule.rule(FaceKind::Tri3)?,
        rule.rule(FaceKind::Tri6)?,
        rule.rule(FaceKind::Quad4)?,
        rule.rule(FaceKind::Quad8)?,
    ])
}

/// Returns the kind of a facet's cell, if the mesh has such a facet.
fn check(mesh: &Mesh, facet: Facet) -> Result<CellKind, FemError> {
    let cells = mesh.cell_count();
    let known =
        (facet.cell as usize) < cells && (facet.face as usize) < mesh.kind(facet.cell as usize).faces().len();
    if known {
        Ok(mesh.kind(facet.cell as usize))
    } else {
        Err(FemError::NoSuchFacet { cell: facet.cell, face: facet.face, cells })
    }
}

fn facet_nodes<const N: usize>(mesh: &Mesh, facet: Facet) -> [u32; N] {
    let mut nodes = [0; N];
    for (slot, node) in nodes.iter_mut().zip(mesh.facet_nodes(facet)) {
        *slot = node;
    }
    nodes
}

/// Returns `dx/ds` and `dx/dt` of a facet; their cross product points outwards.
fn facet_tangents(mesh: &Mesh, facet: Facet, s: [f64; 2]) -> [Vector3; 2] {
    with_face!(mesh.facet_kind(facet), F, N => {
        let x = Nodes::gather(mesh, &facet_nodes::<N>(mesh, facet));
        x.tangents(&<F as Face<N>>::shape_grad(s))
    })
}
