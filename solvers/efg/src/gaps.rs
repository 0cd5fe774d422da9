//! Gaps in the body that supports would bridge: slits, folds, and pieces that lie close together.
//!
//! If two boundary faces that face each other lie within a support, the distance of a point from the node is
//! measured through the body: the straight distance plus a detour. At a vertex `v` of the background the
//! detour is
//!
//! ```text
//! d_I(v) = 2 max(0, g_I(v) - 1.5 |v - x_I|)
//! ```
//!
//! with the shortest path `g_I` along the edges of the cells. Within a cell the detour is linear between its
//! corners. Weights stay continuous in the body, all points of a cell depend on the same four numbers, and
//! the shape functions reproduce their basis. A path less than 1.5 times as long as the straight distance is
//! no detour: edges zigzag, and supports at obtuse re-entrant corners do not change. Distances are relative
//! to the support. A body without such faces is not affected. The detour around the end of a slit is that of
//! the diffraction method: Organ, Fleming, Terry and Belytschko (1996), Computational Mechanics 18, 225-235.

mod ways;

use geometry::{CellKind, Locator, Mesh};
use rayon::prelude::*;
use shape::{Point3, Vector3};

use crate::detour::Detour;
use crate::error::EfgError;
use crate::mls::Ball;
use crate::row_list::RowList;
use crate::supports::Supports;
use ways::{Graph, Ways};

/// Product of unit normals below which two faces face each other: at a re-entrant corner of less than 84
/// degrees.
const TURNED: f64 = -0.1;
/// Overlap of touching faces due to rounding, relative to their size.
const TOUCHING: f64 = 1e-6;
/// Ratio of path to straight distance below which a path is no detour.
const STRAIGHT: f64 = 1.5;
/// Factor on the excess length of a path.
const STEEP: f64 = 2.0;
/// Relative length up to which paths are searched: a point beyond is outside the support even next to the
/// node.
const FARTHEST: f64 = STRAIGHT + 1.0 / STEEP;

/// Gaps of a body: the nodes with detours, cell by cell.
pub(crate) struct Gaps {
    locator: Locator,
    graph: Graph,
    /// Corners of each cell.
    corners: Vec<[u32; 4]>,
    /// Cell of each node, or the closest cell.
    homes: Vec<u32>,
    /// Offsets of the detours to cell `c`, which are `cuts[offsets[c]..offsets[c + 1]]`, by ascending node.
    offsets: Vec<usize>,
    cuts: Vec<Cut>,
}

/// Relative detours of a node to the corners of a cell.
#[derive(Clone, Copy)]
struct Cut {
    node: u32,
    at: [f64; 4],
}

/// Returns, for each point (m), the nodes (ascending) within `reach` (m) across a gap of the body, whose tet4
/// cells are given: the path through the body is more than 1.5 times as long as the straight line. The list
/// is empty for a body without gaps.
///
/// # Errors
/// A point that is not finite, or a cell that is not a tetrahedron or has no volume.
pub fn across_gaps(
    nodes: &[Point3],
    cells: &Mesh,
    reach: f64,
    points: &[Point3],
) -> Result<Vec<Vec<u32>>, EfgError> {
    let balls = nodes.iter().map(|node| Ball { at: (*node).into(), radius: reach }).collect();
    let supports = Supports { balls, ellipsoids: Vec::new() };
    let Some(gaps) = Gaps::find(nodes, &supports, cells)? else { return Ok(Vec::new()) };
    let across = |(x, cell): (&Point3, u32)| {
        let detours = gaps.detours(x, cell, nodes, reach);
        let near = |&n: &u32| detours[n as usize] > 0.0 && (nodes[n as usize] - x).norm() < reach;
        (0..nodes.len() as u32).filter(near).collect()
    };
    Ok(points.par_iter().zip(gaps.cells(points, nodes)?).map(across).collect())
}

/// A boundary face: its centre, outward unit normal, and the radius of the ball around it, m.
struct Face {
    centre: Point3,
    normal: Vector3,
    radius: f64,
}

impl Gaps {
    /// Finds the gaps that supports bridge; `None` if there are none.
    pub fn find(nodes: &[Point3], supports: &Supports, background: &Mesh) -> Result<Option<Gaps>, EfgError> {
        let faces = facing(background, 2.0 * supports.widest());
        if faces.is_empty() {
            return Ok(None);
        }
        let locator = Locator::new(background)?;
        let corners: Vec<[u32; 4]> =
            (0..background.cell_count()).map(|cell| [0, 1, 2, 3].map(|k| background.cell(cell)[k])).collect();
        let homes = if nodes == background.points() {
            // Assigned by number, because touching pieces have cells at the same place.
            let mut homes = vec![u32::MAX; nodes.len()];
            for (cell, corners) in corners.iter().enumerate() {
                corners.iter().for_each(|&vertex| homes[vertex as usize] = cell as u32);
            }
            let others: Vec<usize> = (0..nodes.len()).filter(|&n| homes[n] == u32::MAX).collect();
            let places: Vec<Point3> = others.iter().map(|&n| nodes[n]).collect();
            let found = locator.locate(&places)?;
            others.iter().zip(found).for_each(|(&n, place)| homes[n] = place.cell);
            homes
        } else {
            locator.locate(nodes)?.into_iter().map(|place| place.cell).collect()
        };
        let graph = Graph::new(background, &corners);
        let mut gaps = Gaps { locator, graph, corners, homes, offsets: Vec::new(), cuts: Vec::new() };
        gaps.fill(nodes, supports, &faces);
        Ok(Some(gaps))
    }

    fn fill(&mut self, nodes: &[Point3], supports: &Supports, faces: &[Face]) {
        let all: Vec<u32> = (0..nodes.len() as u32).collect();
        let crossed = |&&node: &&u32| {
            let x = nodes[node as usize];
            let reach = supports.radius(node as usize);
            let near = |face: &&Face| (face.centre - x).norm() < reach + face.radius;
            let near: Vec<&Face> = faces.iter().filter(near).collect();
            near.iter().enumerate().any(|(k, a)| near[..k].iter().any(|b| a.faces(b)))
        };
        let balls: Vec<(Point3, f64)> = (0..self.corners.len()).map(|cell| self.ball(cell)).collect();
        let cuts_of = |ways: &mut Ways, &node: &u32| {
            let x = nodes[node as usize];
            let reach = supports.radius(node as usize);
            let length = |a: &Point3, b: &Point3| supports.length(node, &(a - b));
            ways.walk(&self.graph, &x, &self.corners[self.homes[node as usize] as usize], length, FARTHEST);
            let detour = |vertex: u32| {
                let straight = length(self.graph.place(vertex), &x);
                excess(ways.to(vertex).min(FARTHEST), straight)
            };
            let touched =
                balls.iter().enumerate().filter(|(_, (at, radius))| (at - x).norm() < reach + radius);
            let cut =
                touched.map(|(cell, _)| (cell as u32, Cut { node, at: self.corners[cell].map(detour) }));
            cut.filter(|(_, cut)| cut.at.iter().any(|&d| d > 0.0)).collect::<Vec<_>>()
        };
        let vertices = self.graph.vertices();
        let crossing: Vec<u32> = all.par_iter().filter(crossed).copied().collect();
        let found: Vec<Vec<(u32, Cut)>> =
            crossing.par_iter().map_init(|| Ways::new(vertices), cuts_of).collect();
        self.offsets = vec![0; self.corners.len() + 1];
        let mut found: Vec<(u32, Cut)> = found.into_iter().flatten().collect();
        found.sort_by_key(|(cell, cut)| (*cell, cut.node));
        found.iter().for_each(|(cell, _)| self.offsets[*cell as usize + 1] += 1);
        (0..self.corners.len()).for_each(|cell| self.offsets[cell + 1] += self.offsets[cell]);
        self.cuts = found.into_iter().map(|(_, cut)| cut).collect();
    }

    /// Returns the centre and radius (m) of a ball around the mean of a cell's corners that contains the
    /// cell.
    fn ball(&self, cell: usize) -> (Point3, f64) {
        let corners = self.locator.corners(cell);
        let centre = Point3::from(corners.iter().map(|p| p.coords / 4.0).sum::<Vector3>());
        (centre, corners.iter().map(|p| (p - centre).norm()).fold(0.0, f64::max))
    }

    /// Restricts the gaps to the nodes in `kept` (ascending), which are renumbered in this order.
    pub fn of_nodes(mut self, kept: impl Iterator<Item = usize>) -> Gaps {
        let mut number = vec![u32::MAX; self.homes.len()];
        let homes = kept.enumerate().map(|(new, old)| {
            number[old] = new as u32;
            self.homes[old]
        });
        self.homes = homes.collect();
        let (mut offsets, mut cuts) = (vec![0], Vec::new());
        for range in self.offsets.windows(2) {
            let renumbered = self.cuts[range[0]..range[1]]
                .iter()
                .map(|cut| Cut { node: number[cut.node as usize], ..*cut });
            cuts.extend(renumbered.filter(|cut| cut.node != u32::MAX));
            offsets.push(cuts.len());
        }
        Gaps { offsets, cuts, ..self }
    }

    /// Returns the cell of each point, or the closest cell. If the points are the nodes, these are the cells
    /// to which the nodes were assigned.
    pub fn cells(&self, points: &[Point3], nodes: &[Point3]) -> Result<Vec<u32>, EfgError> {
        if points == &nodes[..self.homes.len()] {
            return Ok(self.homes.clone());
        }
        Ok(self.locator.locate(points)?.into_iter().map(|place| place.cell).collect())
    }

    /// Removes the nodes of the last row whose supports no longer cover the point `x`, and appends the detour
    /// of every remaining node to `detours`. `relative` returns the straight distance of a node from the
    /// point, relative to the extent of its support in this direction.
    pub fn cut(
        &self,
        x: &Point3,
        cell: u32,
        relative: impl Fn(u32) -> f64,
        rows: &mut RowList,
        detours: &mut Vec<Detour>,
    ) {
        let first = detours.len();
        let cuts = &self.cuts[self.offsets[cell as usize]..self.offsets[cell as usize + 1]];
        if cuts.is_empty() {
            detours.resize(rows.nodes.len(), Detour::default());
            return;
        }
        let (values, slopes) =
            (self.locator.barycentric(cell as usize, x), self.locator.slopes(cell as usize));
        let mut n = first;
        for k in first..rows.nodes.len() {
            let node = rows.nodes[k];
            let detour = match cuts.binary_search_by_key(&node, |cut| cut.node) {
                Ok(found) => {
                    let at = cuts[found].at;
                    let longer = (0..4).map(|c| values[c] * at[c]).sum::<f64>().max(0.0);
                    Detour { longer, slope: (0..4).map(|c| slopes[c] * at[c]).sum() }
                }
                Err(_) => Detour::default(),
            };
            if detour.longer == 0.0 || relative(node) + detour.longer < 1.0 {
                rows.nodes[n] = node;
                detours.push(detour);
                n += 1;
            }
        }
        rows.shorten_last(n);
    }

    /// Returns the detour (m), as defined by `excess`, from the point `x` in `cell` to each of `nodes`.
    /// Paths are searched up to 1.5 times the length `farthest` (m). The detour is infinite if no such path
    /// reaches a corner of the node's cell.
    pub fn detours(&self, x: &Point3, cell: u32, nodes: &[Point3], farthest: f64) -> Vec<f64> {
        let mut ways = Ways::new(self.graph.vertices());
        let length = |a: &Point3, b: &Point3| (a - b).norm();
        ways.walk(&self.graph, x, &self.corners[cell as usize], length, STRAIGHT * farthest);
        let detour = |(node, &home): (&Point3, &u32)| {
            let straight = (node - x).norm();
            let over = |&vertex: &u32| ways.to(vertex) + (self.graph.place(vertex) - node).norm();
            let way = if home == cell {
                straight
            } else {
                self.corners[home as usize].iter().map(over).fold(f64::INFINITY, f64::min)
            };
            excess(way, straight)
        };
        nodes.iter().zip(&self.homes).map(detour).collect()
    }
}

impl Face {
    /// Whether the two faces face each other, in contact or with a gap between them.
    fn faces(&self, other: &Face) -> bool {
        let apart = other.centre - self.centre;
        let slack = TOUCHING * (self.radius + other.radius);
        self.normal.dot(&other.normal) < TURNED
            && apart.dot(&self.normal) > -slack
            && apart.dot(&other.normal) < slack
    }
}

/// Returns the detour (m) of a path of length `way` (m): `STEEP` times its excess over `STRAIGHT` times
/// the straight distance of its ends.
fn excess(way: f64, straight: f64) -> f64 {
    STEEP * (way - STRAIGHT * straight).max(0.0)
}

/// Returns the boundary faces that face another face closer than `reach` (m).
fn facing(mesh: &Mesh, reach: f64) -> Vec<Face> {
    let face = |facet| {
        let corners: Vec<Point3> = mesh.facet_nodes(facet).map(|node| mesh.points()[node as usize]).collect();
        let centre = Point3::from(corners.iter().map(|p| p.coords).sum::<Vector3>() / corners.len() as f64);
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
        let radius = corners.iter().map(|p| (p - centre).norm()).fold(0.0, f64::max);
        Face { centre, normal, radius }
    };
    let tets = mesh.uniform_kind() == Some(CellKind::Tet4);
    let mut faces: Vec<Face> =
        if tets { mesh.boundary().into_iter().map(face).collect() } else { Vec::new() };
    let spread = |axis: usize| {
        let ends =
            |fold: fn(f64, f64) -> f64, from| faces.iter().map(|face| face.centre[axis]).fold(from, fold);
        ends(f64::max, f64::NEG_INFINITY) - ends(f64::min, f64::INFINITY)
    };
    let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
    faces.sort_by(|a, b| a.centre[axis].total_cmp(&b.centre[axis]));
    let largest = faces.iter().map(|face| face.radius).fold(0.0, f64::max);
    let faced = |(k, a): (usize, &Face)| {
        let near = |b: &&Face| b.centre[axis] - a.centre[axis] <= reach + 2.0 * largest;
        let close = |b: &Face| (b.centre - a.centre).norm() <= reach + a.radius + b.radius;
        let later = faces[k + 1..].iter().take_while(near).enumerate();
        later.filter(|(_, b)| a.faces(b) && close(b)).map(|(j, _)| [k, k + 1 + j]).collect::<Vec<_>>()
    };
    let pairs: Vec<Vec<[usize; 2]>> = faces.par_iter().enumerate().map(faced).collect();
    let mut of_gaps = vec![false; faces.len()];
    pairs.into_iter().flatten().flatten().for_each(|k| of_gaps[k] = true);
    faces.into_iter().zip(of_gaps).filter_map(|(face, of_gap)| of_gap.then_some(face)).collect()
}
