//! Detection of free rigid motions from the supports themselves, before factorisation: a zero pivot
//! identifies neither the motion nor the node.
//!
//! The node graph consists of connected pieces; constraint rows join pieces into clusters. A cluster of m
//! pieces has 6 m rigid modes. Each support gives a row over these modes, and the null space of the rows is
//! free to move.

use algebra::Connectivity;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use shape::{Point3, Rows, Vector3};

use crate::body::LinearBody;
use crate::constraint::Row;
use crate::error::SolveError;
use crate::rigid_mode::RigidMode;
use crate::weak::{Weak, WeakSupport};

/// Squared relative size below which a motion counts as free: supports resist motions from 1e-6 of their
/// size.
const FREE: f64 = 1e-12;

/// Returns the values of the six modes at a node: three translations, then the rotations about x, y, z
/// through `centre`. Rotations are divided by the size of the piece, so all modes are dimensionless.
fn modes_at(x: &Point3, centre: &Point3, size: f64, axis: usize) -> [f64; 6] {
    let r = (x - centre) / size;
    let mut m = [0.0; 6];
    m[axis] = 1.0;
    for k in 0..3 {
        m[3 + k] = Vector3::ith(k, 1.0).cross(&r)[axis];
    }
    m
}

/// Union-find with the lowest index as representative.
struct Pieces(Vec<usize>);

impl Pieces {
    fn find(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    /// Joins two sets and returns whether they were separate.
    fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b)] = a.min(b);
        a != b
    }
}

/// A connected piece: lowest node, number of nodes, centre and size (m), cluster, and place in the cluster.
struct Piece {
    first: usize,
    count: usize,
    centre: Point3,
    size: f64,
    cluster: usize,
    place: usize,
}

/// Receives the terms (node, axis, factor) of a row prescribed by a support.
pub(crate) type AddRow<'a> = &'a mut dyn FnMut(&mut dyn Iterator<Item = (usize, usize, f64)>);

/// Returns the free motions of the first cluster with free motions as an error.
pub(crate) fn check(
    body: &LinearBody,
    points: Connectivity,
    prescribed: &[Option<f64>],
    rows: &[Row],
    weak: &[WeakSupport],
) -> Result<(), SolveError> {
    check_rows(body.nodes, points, rows, |add| add_all(prescribed, rows, weak, add))
}

/// Adds the rows of prescribed degrees of freedom.
pub(crate) fn add_prescribed(prescribed: &[Option<f64>], add: AddRow) {
    for dof in (0..prescribed.len()).filter(|&dof| prescribed[dof].is_some()) {
        add(&mut std::iter::once((dof / 3, dof % 3, 1.0)));
    }
}

/// Adds the rows of displacements along `axes` at the points of a table.
pub(crate) fn add_surface(table: &Rows, axes: [bool; 3], add: AddRow) {
    for q in 0..table.len() {
        let (nodes, values) = table.row(q);
        for axis in (0..3).filter(|&a| axes[a]) {
            add(&mut nodes.iter().zip(values).map(|(&n, &v)| (n as usize, axis, v)));
        }
    }
}

/// Adds the rows of displacements along the normals at the points of a table.
pub(crate) fn add_normals(table: &Rows, normals: &[Vector3], add: AddRow) {
    for (q, normal) in normals.iter().enumerate() {
        let (nodes, values) = table.row(q);
        let along = |(&n, &v): (&u32, &f64)| (0..3).map(move |axis| (n as usize, axis, v * normal[axis]));
        add(&mut nodes.iter().zip(values).flat_map(along));
    }
}

/// Checks as [`check`] does, with the rows that `supports` adds; `joints` join pieces into clusters.
pub(crate) fn check_rows(
    positions: &[Point3],
    points: Connectivity,
    joints: &[Row],
    supports: impl FnOnce(AddRow),
) -> Result<(), SolveError> {
    let Motions { pieces, clusters, free } = motions(positions, points, joints, supports);
    for (members, free) in clusters.iter().zip(free) {
        // The message names the piece that moves most.
        let motion = |place: usize| free.iter().map(|v| v.rows(6 * place, 6).norm_squared()).sum::<f64>();
        if let Some(place) = (0..members.len()).rev().max_by(|&a, &b| motion(a).total_cmp(&motion(b))) {
            if free.is_empty() {
                continue;
            }
            let piece = &pieces[members[place]];
            let null = DMatrix::from_fn(6, free.len(), |i, j| free[j][6 * place + i]);
            let modes = name(&null);
            let nodes = positions.len();
            return Err(SolveError::RigidMotion {
                modes,
                node: piece.first,
                piece_nodes: piece.count,
                nodes,
            });
        }
    }
    Ok(())
}

/// Adds the rows of all supports of a linear problem.
fn add_all(prescribed: &[Option<f64>], rows: &[Row], weak: &[WeakSupport], add: AddRow) {
    add_prescribed(prescribed, add);
    for r in rows {
        add(&mut r.terms.iter().map(|&(dof, c)| (dof / 3, dof % 3, c)));
    }
    for support in weak {
        match support.method {
            Weak::Spring { along_normal: true, .. } => {
                add_normals(support.flux.at().rows(), support.flux.normals(), add);
            }
            _ => add_surface(support.flux.at().rows(), support.axes, add),
        }
    }
}

/// Pieces, clusters of pieces, and the free motions of each cluster.
struct Motions {
    pieces: Vec<Piece>,
    clusters: Vec<Vec<usize>>,
    free: Vec<Vec<DVector<f64>>>,
}

fn motions(
    positions: &[Point3],
    points: Connectivity,
    joints: &[Row],
    supports: impl FnOnce(AddRow),
) -> Motions {
    let (pieces, piece_of, clusters) = pieces(positions, points, joints);
    // Gram matrix of the support rows over each cluster's modes.
    let mut gram: Vec<DMatrix<f64>> =
        clusters.iter().map(|c| DMatrix::zeros(6 * c.len(), 6 * c.len())).collect();
    let mut row: Vec<(usize, [f64; 6])> = Vec::new();
    let mut add = |terms: &mut dyn Iterator<Item = (usize, usize, f64)>| {
        row.clear();
        let mut scale = 0.0;
        for (node, axis, c) in terms {
            let id = piece_of[node];
            if id == NOWHERE {
                continue;
            }
            let piece = &pieces[id];
            let m = modes_at(&positions[node], &piece.centre, piece.size, axis).map(|m| c * m);
            scale += c.abs();
            match row.iter_mut().find(|r| r.0 == id) {
                Some((_, sum)) => (0..6).for_each(|k| sum[k] += m[k]),
                None => row.push((id, m)),
            }
        }
        if !(scale > 0.0) {
            return;
        }
        for (a, ma) in &row {
            let gram = &mut gram[pieces[*a].cluster];
            for (b, mb) in &row {
                for k in 0..6 {
                    for l in 0..6 {
                        gram[(6 * pieces[*a].place + k, 6 * pieces[*b].place + l)] +=
                            ma[k] * mb[l] / (scale * scale);
                    }
                }
            }
        }
    };
    supports(&mut add);
    let free = gram.into_iter().map(|gram| {
        let eigen = SymmetricEigen::new(gram);
        let limit = FREE * eigen.eigenvalues.max();
        // `!(e > limit)` includes 0 > 0, the case of no support.
        let free = (0..eigen.eigenvalues.len()).filter(|&k| !(eigen.eigenvalues[k] > limit));
        free.map(|k| eigen.eigenvectors.column(k).into_owned()).collect()
    });
    let free = free.collect();
    Motions { pieces, clusters, free }
}

/// Marks a node that belongs to no piece because no integration point contributes to it. Such a node is
/// constrained along all axes (otherwise it was refused as an orphan).
const NOWHERE: usize = usize::MAX;

/// Returns the connected pieces of the quadrature's node graph, the piece of each node, and the clusters as
/// lists of pieces.
fn pieces(nodes: &[Point3], points: Connectivity, rows: &[Row]) -> (Vec<Piece>, Vec<usize>, Vec<Vec<usize>>) {
    let mut find = Pieces((0..nodes.len()).collect());
    let mut seen = vec![false; nodes.len()];
    let mut joints = 0;
    for range in points.offsets.windows(2) {
        let row = &points.nodes[range[0]..range[1]];
        for &node in row {
            seen[node as usize] = true;
            joints += usize::from(find.join(row[0] as usize, node as usize));
        }
        // All nodes are in one piece, so further points join nothing new. For a cloud this happens after a
        // tenth of its points.
        if joints + 1 == nodes.len() {
            break;
        }
    }
    let mut piece_of = vec![NOWHERE; nodes.len()];
    let mut pieces: Vec<Piece> = Vec::new();
    for i in (0..nodes.len()).filter(|&i| seen[i]) {
        let root = find.find(i);
        if root == i {
            piece_of[i] = pieces.len();
            let centre = Point3::origin();
            pieces.push(Piece { first: i, count: 0, centre, size: 0.0, cluster: 0, place: 0 });
        }
        piece_of[i] = piece_of[root];
        let piece = &mut pieces[piece_of[i]];
        piece.count += 1;
        piece.centre += nodes[i].coords;
    }
    for piece in &mut pieces {
        piece.centre /= piece.count as f64;
    }
    for (x, &p) in nodes.iter().zip(&piece_of).filter(|(_, p)| **p != NOWHERE) {
        pieces[p].size = pieces[p].size.max((x - pieces[p].centre).norm());
    }
    for piece in &mut pieces {
        // All nodes coincide, so there is no size to divide by. Rotations are then not resisted and are
        // refused as free.
        piece.size = if piece.size > 0.0 { piece.size } else { 1.0 };
    }
    let mut find = Pieces((0..pieces.len()).collect());
    for row in rows {
        let mut ids = row.terms.iter().map(|t| piece_of[t.0 / 3]).filter(|&p| p != NOWHERE);
        if let Some(first) = ids.next() {
            ids.for_each(|p| {
                find.join(first, p);
            });
        }
    }
    let mut clusters: Vec<Vec<usize>> = Vec::new();
    for p in 0..pieces.len() {
        let root = find.find(p);
        if root == p {
            pieces[p].cluster = clusters.len();
            clusters.push(Vec::new());
        }
        pieces[p].cluster = pieces[root].cluster;
        let cluster = &mut clusters[pieces[root].cluster];
        pieces[p].place = cluster.len();
        cluster.push(p);
    }
    (pieces, piece_of, clusters)
}

/// Identifies the motions of a null space (6, k): pure translations first, then rotations, along coordinate
/// axes where possible.
fn name(null: &DMatrix<f64>) -> Vec<RigidMode> {
    let rotation = null.rows(3, 3).into_owned();
    // Eigenvectors of R^T R with eigenvalue zero combine the null vectors into pure translations.
    let eigen = SymmetricEigen::new(rotation.transpose() * &rotation);
    let (mut moves, mut turns) = (Vec::new(), Vec::new());
    for k in 0..null.ncols() {
        let v = null * eigen.eigenvectors.column(k);
        if eigen.eigenvalues[k] < 1e-9 {
            moves.push(Vector3::new(v[0], v[1], v[2]));
        } else {
            turns.push(Vector3::new(v[3], v[4], v[5]));
        }
    }
    let translations = along_axes(&moves).into_iter().map(RigidMode::Translation);
    translations.chain(along_axes(&turns).into_iter().map(RigidMode::Rotation)).collect()
}

/// Returns an orthonormal basis of the same span: the coordinate axes in the span first, then the rest.
fn along_axes(span: &[Vector3]) -> Vec<Vector3> {
    let mut basis: Vec<Vector3> = Vec::new();
    let reduce = |basis: &[Vector3], v: &Vector3| basis.iter().fold(*v, |v, b| v - b * b.dot(&v));
    for v in span {
        let v = reduce(&basis, v);
        if v.norm() > 1e-6 {
            basis.push(v.normalize());
        }
    }
    let axes = (0..3).map(|k| Vector3::ith(k, 1.0)).filter(|e| reduce(&basis, e).norm() < 1e-5);
    let mut named: Vec<Vector3> = axes.collect();
    for b in &basis {
        let rest = reduce(&named, b);
        if named.len() < basis.len() && rest.norm() > 1e-3 {
            // Both signs of a direction are reported as the same vector.
            let unit = rest.normalize();
            named.push(if unit[unit.iamax()] < 0.0 { -unit } else { unit });
        }
    }
    named
}
