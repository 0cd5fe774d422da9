//! The approximation over a cloud: neighbour search, fits and tables.

mod fill;
mod ladder;

use geometry::Mesh;
use rayon::prelude::*;
use shape::{GradRows, Point3, PointRows, Rows, Unity, Vector3};

use crate::basis::Basis;
use crate::buckets::Buckets;
use crate::coupling::{Coupling, Layer, border_vertices};
use crate::detour::Detour;
use crate::ellipsoid::Ellipsoid;
use crate::error::EfgError;
use crate::gaps::Gaps;
use crate::info::{MlsInfo, Outcome, Tally};
use crate::kernel::Kernel;
use crate::max_entropy::{CUT, Neighbours};
use crate::mls::{Ball, Group};
use crate::row_list::{RowList, sample_step};
use crate::support;
use crate::supports::Supports;

/// Points per parallel task. The number is fixed, so results have the same bits at any number of threads.
const CHUNK: usize = 128;
/// Largest number of points whose table is made in one wave, with a counted instead of estimated size. Two
/// waves for 1331 points would leave threads idle at the end of each, and too low an estimate costs another
/// copy.
const SMALL: usize = 16 * CHUNK;
/// Tolerance of the row sums, which must be one. With sound supports the error is below 1e-14.
const UNITY: Unity = Unity::Within(1e-8);
/// Shape functions over a cloud of nodes with individual support radii, by moving least squares or maximum
/// entropy.
///
/// Node `I` contributes at `x` if `|x - x_I| < R_I` or, with ellipsoidal supports, if `x` lies in its
/// [`Ellipsoid`]. If the neighbours do not determine the basis at a point, these remedies are tried in order,
/// and each is counted in [`MlsInfo`]:
///
/// - All supports are enlarged at that point by a common factor of at most 3: 1.4 times the relative distance
///   `|x - x_I| / R_I` of the `2m`-th nearest node, with `m` the number of basis terms.
/// - The quadratic block is regularised.
/// - The quadratic basis is replaced by the linear basis.
///
/// A point at which the linear basis fails is an error. With maximum entropy, a point outside the convex hull
/// of its neighbours is also an error: no positive functions reproduce linear fields there.
pub struct Approximation {
    nodes: Vec<Point3>,
    supports: Supports,
    functions: Functions,
    buckets: Buckets,
    /// Coupled finite elements; their nodes follow those of the cloud.
    coupling: Option<Coupling>,
    /// Region of each node of the cloud, if nodes contribute only in their own region; empty otherwise.
    regions: Vec<u16>,
    /// Gaps in the body that supports would bridge, if there are any.
    gaps: Option<Gaps>,
}

/// Function that returns the background cell of each point, if the caller knows the cells. `None` lets them
/// be searched. Only a body with gaps needs the cells.
pub(crate) type Cells<'a> = Option<&'a dyn Fn() -> Vec<u32>>;

/// Kind of shape functions.
enum Functions {
    MovingLeastSquares(LeastSquares),
    /// `beta = gamma / h^2` of every node, 1/m^2.
    MaximumEntropy(Vec<f64>),
}

#[derive(Clone, Copy)]
struct LeastSquares {
    kernel: Kernel,
    basis: Basis,
    /// Regularisation of the quadratic block, relative to the sum of the weights.
    mu: f64,
}

/// Results and workspace of one chunk of points.
#[derive(Default)]
struct Chunk {
    rows: RowList,
    outcomes: Vec<Outcome>,
    /// Points in descending order of their number of neighbours. The lists of a group have the length of the
    /// longest list, so this order makes them grow only once.
    order: Vec<u32>,
    group: Group,
    neighbours: Neighbours,
    /// Finite-element part at each point; empty without coupling.
    layers: Vec<Layer>,
    /// Cell of each point, and detour of every neighbour; empty for a body without gaps.
    cells: Vec<u32>,
    detours: Vec<Detour>,
}

impl Approximation {
    /// Builds moving least squares from positions (m) and support radii (m), one per node.
    ///
    /// # Errors
    /// Lists of unequal length, fewer nodes than the basis has terms, a position that is not finite, or a
    /// radius that is not a positive number.
    pub fn new(
        nodes: Vec<Point3>,
        radii: Vec<f64>,
        kernel: Kernel,
        basis: Basis,
    ) -> Result<Approximation, EfgError> {
        let functions = Functions::MovingLeastSquares(LeastSquares { kernel, basis, mu: 0.0 });
        Approximation::over(nodes, radii, functions, basis.terms())
    }

    /// Builds local maximum-entropy functions from positions and spacings `h` (m), one per node, and the
    /// dimensionless locality `gamma = beta h^2`, usually 0.6 to 4. A larger `gamma` makes the functions
    /// narrower; they approach linear interpolation.
    ///
    /// # Errors
    /// A `gamma` that is not a positive number, and the errors of [`Approximation::new`].
    pub fn maximum_entropy(
        nodes: Vec<Point3>,
        spacing: &[f64],
        gamma: f64,
    ) -> Result<Approximation, EfgError> {
        if !(gamma > 0.0 && gamma.is_finite()) {
            return Err(EfgError::BadParameter { what: "gamma", value: gamma, allowed: "a positive number" });
        }
        let reach = (-CUT.ln() / gamma).sqrt();
        let radii = spacing.iter().map(|h| reach * h).collect();
        let beta = spacing.iter().map(|h| gamma / (h * h)).collect();
        Approximation::over(nodes, radii, Functions::MaximumEntropy(beta), Basis::Linear.terms())
    }

    fn over(
        nodes: Vec<Point3>,
        radii: Vec<f64>,
        functions: Functions,
        needed: usize,
    ) -> Result<Approximation, EfgError> {
        if radii.len() != nodes.len() {
            return Err(EfgError::Length {
                what: "support radii",
                found: radii.len(),
                expected: nodes.len(),
            });
        }
        if nodes.len() < needed {
            return Err(EfgError::TooFewNodes { found: nodes.len(), needed });
        }
        if let Some(node) = nodes.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(EfgError::NotFinite { node });
        }
        support::check(&radii)?;
        let balls: Vec<Ball> =
            nodes.iter().zip(&radii).map(|(p, &radius)| Ball { at: p.coords.into(), radius }).collect();
        let buckets = Buckets::new(&balls);
        let supports = Supports { balls, ellipsoids: Vec::new() };
        let regions = Vec::new();
        Ok(Approximation { nodes, supports, functions, buckets, coupling: None, regions, gaps: None })
    }

    /// Builds moving least squares as [`Approximation::new`] does, with one ellipsoidal support per node
    /// instead of a radius, usually from [`Support::ellipsoids`](crate::Support::ellipsoids).
    ///
    /// # Errors
    /// As for [`Approximation::new`].
    pub fn stretched(
        nodes: Vec<Point3>,
        ellipsoids: Vec<Ellipsoid>,
        kernel: Kernel,
        basis: Basis,
    ) -> Result<Approximation, EfgError> {
        let around = ellipsoids.iter().map(Ellipsoid::radius).collect();
        let approximation = Approximation::new(nodes, around, kernel, basis)?;
        let supports = Supports { ellipsoids, ..approximation.supports };
        Ok(Approximation { supports, ..approximation })
    }

    /// Regularises the quadratic block of the moment matrix at every point by `mu` times the sum of the
    /// weights (modified moving least squares; Joldes et al. 2015). Linear fields stay exact, quadratic
    /// fields nearly so. The setting is meant for the quadratic basis, and has no effect on maximum entropy.
    ///
    /// # Errors
    /// A `mu` outside 0 to 1.
    pub fn regularised(self, mu: f64) -> Result<Approximation, EfgError> {
        if !(0.0..=1.0).contains(&mu) {
            let what = "regularisation";
            return Err(EfgError::BadParameter { what, value: mu, allowed: "a value from 0 to 1" });
        }
        let functions = match self.functions {
            Functions::MovingLeastSquares(fit) => Functions::MovingLeastSquares(LeastSquares { mu, ..fit }),
            other => other,
        };
        Ok(Approximation { functions, ..self })
    }

    /// Restricts supports to paths through the body, whose tet4 cells are given: they do not cross slits or
    /// connect separate pieces. Supports of a convex body do not change. This method must precede
    /// [`Approximation::coupled`].
    pub fn within(self, background: &Mesh) -> Result<Approximation, EfgError> {
        let gaps = Gaps::find(&self.nodes, &self.supports, background)?;
        Ok(Approximation { gaps, ..self })
    }

    /// Couples the cloud to linear finite elements at the listed vertices (ascending) of a tet4 mesh.
    ///
    /// The vertices become nodes after those of the cloud, with the hat functions `N_h` of the cells as shape
    /// functions. The functions of the cloud restore the reproduction of linear fields:
    ///
    /// ```text
    /// phi_I(x) = (p(x) - sum_h N_h(x) p(x_h))^T A(x)^-1 p(x_I) w_I(x)
    /// ```
    ///
    /// They vanish on faces and in cells whose corners are all listed; the parameters of the vertices are
    /// displacements there. Nodes of the cloud at which the hats sum to one half or more are removed. The
    /// remaining neighbours of such a point may lie in one plane; their supports are then enlarged.
    ///
    /// The layer of cells is about as stiff as linear tetrahedra. On a bending prism of 4 cells of depth, the
    /// error of the displacement is 19 times that of constraints on the same cloud, and decreases with the
    /// spacing to the power 2.6. Only the linear basis can be coupled: for a quadratic basis the hats
    /// reproduce too little for the other functions to vanish. Source: Huerta and Fernandez-Mendez (2000),
    /// Int. J. Numer. Meth. Engng 48, 1615-1636.
    pub fn coupled(self, background: &Mesh, vertices: &[u32]) -> Result<Approximation, EfgError> {
        self.couple(background, vertices, false)
    }

    fn couple(self, background: &Mesh, vertices: &[u32], by_region: bool) -> Result<Approximation, EfgError> {
        let Functions::MovingLeastSquares(LeastSquares { basis: Basis::Linear, .. }) = self.functions else {
            return Err(EfgError::NotCoupled);
        };
        let coupling = Coupling::new(background, vertices)?;
        let kept = coupling.kept(&self.nodes)?;
        let balls: Vec<Ball> = kept.iter().map(|&(n, _)| self.supports.balls[n]).collect();
        let ellipsoids = kept.iter().filter_map(|&(n, _)| self.supports.ellipsoids.get(n).copied()).collect();
        let mut nodes: Vec<Point3> = kept.iter().map(|&(n, _)| self.nodes[n]).collect();
        if nodes.len() < Basis::Linear.terms() {
            return Err(EfgError::TooFewNodes { found: nodes.len(), needed: Basis::Linear.terms() });
        }
        let buckets = Buckets::new(&balls);
        let gaps = self.gaps.map(|gaps| gaps.of_nodes(kept.iter().map(|&(n, _)| n)));
        let regions =
            if by_region { kept.into_iter().map(|(_, region)| region).collect() } else { Vec::new() };
        nodes.extend(vertices.iter().map(|&v| background.points()[v as usize]));
        Ok(Approximation {
            nodes,
            supports: Supports { balls, ellipsoids },
            buckets,
            coupling: Some(coupling),
            regions,
            gaps,
            ..self
        })
    }

    /// Couples the cloud as [`Approximation::coupled`] does, by region. The [vertices of
    /// borders](crate::border_vertices) between regions of the background are added to the list, and nodes of
    /// the cloud contribute only at points of their own region. Across a border the field is continuous and
    /// its gradient may jump.
    pub fn coupled_by_region(self, background: &Mesh, vertices: &[u32]) -> Result<Approximation, EfgError> {
        let mut all = [vertices, &border_vertices(background)].concat();
        all.sort_unstable();
        all.dedup();
        self.couple(background, &all, true)
    }

    /// Node positions, m; finite-element nodes follow those of the cloud.
    pub fn nodes(&self) -> &[Point3] {
        &self.nodes
    }

    /// Returns the support radius of a node, m: the longest semi-axis of an ellipsoid, and zero for a
    /// finite-element node, whose support consists of cells.
    pub fn radius(&self, node: usize) -> f64 {
        self.supports.radius(node)
    }

    /// Computes shape values at points (m); nodes of a row are in ascending order.
    pub fn point_rows(&self, points: &[Point3]) -> Result<(PointRows, MlsInfo), EfgError> {
        self.point_rows_in(points.to_vec(), None)
    }

    /// Computes [`Approximation::point_rows`] for points whose background cells the caller may know.
    pub(crate) fn point_rows_in(
        &self,
        points: Vec<Point3>,
        cells: Cells,
    ) -> Result<(PointRows, MlsInfo), EfgError> {
        let (rows, _, info) = self.table::<false>(&points, cells)?;
        Ok((PointRows::new(points, rows)?, info))
    }

    /// Computes shape values and gradients (1/m) at points (m); nodes of a row are in ascending order.
    pub fn grad_rows(&self, points: &[Point3]) -> Result<(GradRows, MlsInfo), EfgError> {
        self.grad_rows_in(points.to_vec(), None)
    }

    /// Computes [`Approximation::grad_rows`] for points whose background cells the caller may know.
    pub(crate) fn grad_rows_in(
        &self,
        points: Vec<Point3>,
        cells: Cells,
    ) -> Result<(GradRows, MlsInfo), EfgError> {
        let (rows, grads, info) = self.table::<true>(&points, cells)?;
        Ok((GradRows::new(points, rows, grads)?, info))
    }

    fn table<const GRAD: bool>(
        &self,
        points: &[Point3],
        cells: Cells,
    ) -> Result<(Rows, Vec<Vector3>, MlsInfo), EfgError> {
        let cells = match (&self.gaps, cells) {
            (None, _) => Vec::new(),
            (Some(_), Some(known)) => known(),
            (Some(gaps), None) => gaps.cells(points, &self.nodes)?,
        };
        // Waves of chunks reuse their buffers: all chunks at once would touch twice the memory, and in a
        // single call fresh pages cost as much as the arithmetic. Results do not depend on the length of a
        // wave. One wave is appended to the table while the next is filled: appending is a quarter of the
        // work and uses a single thread.
        let small = points.len() <= SMALL;
        let wave = if small { SMALL } else { 4 * CHUNK * rayon::current_num_threads() };
        let expected = if small { 0 } else { self.expected_entries(points) };
        let mut rows = RowList::with_capacity(points.len(), expected, if GRAD { expected } else { 0 });
        let mut tally = Tally::with_capacity(points.len());
        let mut join = |chunks: &mut [Chunk]| {
            for outcome in chunks.iter().flat_map(|chunk| &chunk.outcomes) {
                tally.add(outcome);
            }
            if let [whole] = chunks
                && rows.is_empty()
            {
                rows = std::mem::take(&mut whole.rows);
                return;
            }
            let entries = chunks.iter().map(|chunk| chunk.rows.nodes.len()).sum();
            rows.reserve(entries, if GRAD { entries } else { 0 });
            chunks.iter().for_each(|chunk| rows.append(&chunk.rows));
        };
        let (mut next, mut filled) = (Vec::new(), Vec::new());
        for (number, part) in points.chunks(wave).enumerate() {
            let cells = cells.get(number * wave..).unwrap_or_default();
            let mut fill = || self.fill_wave::<GRAD>(part, cells, &mut next);
            // Nothing is to be appended during the first wave. A batch of one chunk therefore stays on the
            // calling thread.
            let done = if filled.is_empty() { fill() } else { rayon::join(fill, || join(&mut filled)).0 };
            done?;
            std::mem::swap(&mut next, &mut filled);
        }
        join(&mut filled);
        let RowList { offsets, nodes, values, grads } = rows;
        let rows = Rows::new(self.nodes.len(), offsets, nodes, values, UNITY)?;
        Ok((rows, grads, tally.info()))
    }

    /// Fills one chunk per `CHUNK` points, or returns the first error. There may be more cells than points,
    /// or none.
    fn fill_wave<const GRAD: bool>(
        &self,
        points: &[Point3],
        cells: &[u32],
        chunks: &mut Vec<Chunk>,
    ) -> Result<(), EfgError> {
        let parts = points.par_chunks(CHUNK);
        chunks.resize_with(parts.len(), Chunk::default);
        for (chunk, cells) in chunks.iter_mut().zip(cells.chunks(CHUNK)) {
            chunk.cells.clear();
            chunk.cells.extend_from_slice(cells);
        }
        if let [chunk] = &mut chunks[..] {
            return self.fill::<GRAD>(points, chunk);
        }
        let fill = |(chunk, part)| self.fill::<GRAD>(part, chunk);
        let done: Vec<Result<(), EfgError>> = chunks.par_iter_mut().zip(parts).map(fill).collect();
        done.into_iter().collect()
    }

    /// Estimates the number of entries of a table from the neighbours of a few points.
    fn expected_entries(&self, points: &[Point3]) -> usize {
        let mut found = RowList::default();
        for x in points.iter().step_by(sample_step(points.len())) {
            self.find(x, None, &mut found);
        }
        found.expected_entries(points.len())
    }

    /// Appends the nodes whose supports cover the point as a row; if nodes have regions, only those of the
    /// point's region.
    #[inline(always)]
    fn find(&self, x: &Point3, layer: Option<&Layer>, rows: &mut RowList) {
        let first = rows.nodes.len();
        self.buckets.find(x, &self.supports.balls, &mut rows.nodes);
        if !self.supports.ellipsoids.is_empty() {
            let kept = self.within_ellipsoids(x, &mut rows.nodes[first..]);
            rows.nodes.truncate(first + kept);
        }
        if let Some(layer) = layer.filter(|_| !self.regions.is_empty()) {
            let mut n = first;
            for k in first..rows.nodes.len() {
                rows.nodes[n] = rows.nodes[k];
                n += usize::from(self.counts_in(rows.nodes[k], layer));
            }
            rows.nodes.truncate(n);
        }
        rows.close();
    }

    /// Moves the nodes whose ellipsoids cover the point to the front and returns their number.
    fn within_ellipsoids(&self, x: &Point3, nodes: &mut [u32]) -> usize {
        let mut n = 0;
        for k in 0..nodes.len() {
            nodes[n] = nodes[k];
            n += usize::from(self.relative(nodes[k], x) < 1.0);
        }
        n
    }

    /// Whether a node contributes in the region of a layer.
    fn counts_in(&self, node: u32, layer: &Layer) -> bool {
        self.regions.get(node as usize).is_none_or(|region| *region == layer.region)
    }

    /// Returns the distance of a point from a node, relative to the extent of the node's support in this
    /// direction.
    fn relative(&self, node: u32, x: &Point3) -> f64 {
        self.supports.length(node, &(self.nodes[node as usize] - x))
    }
}

#[cfg(test)]
mod tests;
