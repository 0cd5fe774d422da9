//! Clouds of an exact number of nodes in a closed-form body.

use super::{Cloud, Sizes, farthest::Farthest};
use crate::random::Uniform;
use crate::search::{Search, SearchError};
use crate::shapes::Shape;
use crate::{Point3, Vector3};

/// Candidates per node. Smallest over mean nearest distance, averaged over kidney clouds of 83 to 1330 nodes: 0.70
/// with 20, 0.75 with 60, 0.75 with 200 (and five times the run time of 60).
const CANDIDATES_PER_NODE: usize = 60;
/// Rounds of moving each node to the mean of the candidates nearest to it (Lloyd 1982); 8 change nothing in the
/// second digit of the distances above.
const ROUNDS: usize = 4;
const FEWEST: usize = 4;
const MOST: usize = 1 << 20;

/// Nodes drawn closer together around a point: the target spacing is divided by `ratio` within `radius` of `centre`
/// and grows linearly back to its full size over a further `reach`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Centre of the refined ball (m).
    pub centre: Point3,
    /// Its radius (m), 0 or more.
    pub radius: f64,
    /// Width of the transition (m), positive.
    pub reach: f64,
    /// Coarse over fine spacing, 1 to 10.
    pub ratio: f64,
}

/// What makes a cloud impossible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CloudError {
    /// Too few nodes to be of use.
    #[error("a cloud of {nodes} nodes was asked for; at least {least} are needed")]
    TooFew {
        /// Number asked for.
        nodes: usize,
        /// Least number.
        least: usize,
    },
    /// More nodes than the generator takes on.
    #[error("a cloud of {nodes} nodes was asked for; at most {most} can be generated")]
    TooMany {
        /// Number asked for.
        nodes: usize,
        /// Largest number.
        most: usize,
    },
    /// A refinement parameter outside its range.
    #[error("{what} of refinement {index} is {found}; it has to be {needed}")]
    Refinement {
        /// Index in the list given.
        index: usize,
        /// Which parameter.
        what: &'static str,
        /// Its value.
        found: f64,
        /// The range it needs.
        needed: &'static str,
    },
    /// A body with no extent, or none that is finite.
    #[error("the body's bounding box measures {x} x {y} x {z} m; a cloud needs a body with an inside")]
    NoExtent {
        /// Extent along x (m).
        x: f64,
        /// Extent along y (m).
        y: f64,
        /// Extent along z (m).
        z: f64,
    },
    /// Two nodes in one place.
    #[error("nodes {first} and {second} are in the same place")]
    Coincident {
        /// Lower index.
        first: usize,
        /// Higher index.
        second: usize,
    },
    /// Nodes that can't be searched.
    #[error(transparent)]
    Search(#[from] SearchError),
}

/// Exactly `n` quasi-uniform nodes in `shape`, its surface included; denser within `refinements`.
///
/// Corners first, then edges, surface and inside by farthest-point sampling over seeded random candidates, then a
/// few rounds of Lloyd's relaxation, each node within its own class (surface nodes are projected back). The same
/// arguments give the same bits. Surface nodes come before inner ones.
pub fn cloud(
    shape: &(impl Shape + ?Sized),
    n: usize,
    seed: u64,
    refinements: &[Refinement],
) -> Result<Cloud, CloudError> {
    check(shape, n)?;
    check_refinements(refinements)?;
    let finest = refinements.iter().fold(1.0, |s: f64, r| s.min(1.0 / r.ratio));
    generate(shape, n, seed, finest, |p| target_size(refinements, p))
}

/// As [`cloud`], with nodes as close as `sizes` has it.
pub fn cloud_of_sizes(
    shape: &(impl Shape + ?Sized),
    n: usize,
    seed: u64,
    sizes: &Sizes,
) -> Result<Cloud, CloudError> {
    check(shape, n)?;
    generate(shape, n, seed, sizes.finest(), |p| sizes.at(p))
}

/// `size`: target spacing over the coarsest, from `finest` to 1.
fn generate(
    shape: &(impl Shape + ?Sized),
    n: usize,
    seed: u64,
    finest: f64,
    size: impl Fn(&Point3) -> f64 + Copy,
) -> Result<Cloud, CloudError> {
    let mut random = Uniform::new(seed);
    let mut unit = || random.unit();
    let count = CANDIDATES_PER_NODE * n;

    // Candidates as dense as the nodes shall be: drawn uniformly, kept with the chance (finest / size)^dimension.
    let mut draw =
        |dimension: i32, count: usize, sample: &mut dyn FnMut(&mut dyn FnMut() -> f64) -> Point3| {
            let mut points = Vec::with_capacity(count);
            while points.len() < count {
                let p = sample(&mut unit);
                if finest == 1.0 || unit() < (finest / size(&p)).powi(dimension) {
                    points.push(p);
                }
            }
            points
        };
    let edges: Vec<Point3> = if shape.edge_sample(&mut || 0.25).is_some() {
        draw(1, count / 2, &mut |u| shape.edge_sample(u).unwrap_or_else(Point3::origin))
    } else {
        Vec::new()
    };
    let surface = draw(2, count, &mut |u| shape.surface_sample(u));
    let volume = draw(3, count, &mut |u| shape.volume_sample(u));

    let spacing = (shape.volume() / n as f64).cbrt();
    let farthest = |points: &[&[Point3]]| {
        Farthest::new(points.iter().flat_map(|list| list.iter().copied()), size, spacing)
    };

    // The spacing that n nodes can have when surface and inside are taken alike; edges and surface get as many
    // nodes as keep to it, the inside gets the rest.
    let mut both = farthest(&[&edges, &surface, &volume]);
    let mut seeds = shape.corners();
    seeds.truncate(n);
    for p in &seeds {
        both.choose(p);
    }
    for _ in seeds.len()..n {
        if let Some((p, _)) = both.farthest() {
            both.choose(&p);
        }
    }
    let reached = both.farthest().map_or(spacing, |(_, gap)| gap);

    let mut nodes = seeds;
    grow(&mut nodes, farthest(&[&edges]), n, reached);
    let fixed = nodes.len();
    grow(&mut nodes, farthest(&[&surface]), n, reached);
    let outer = nodes.len();
    grow(&mut nodes, farthest(&[&volume]), n, 0.0);

    for _ in 0..ROUNDS {
        relax(&mut nodes, fixed..outer, outer, &surface, &|p| shape.project_to_surface(&p))?;
        relax(&mut nodes, outer..n, n, &volume, &|p| p)?;
    }
    Cloud::from_points(nodes)
}

/// Adds candidates while one is farther than `least` from all nodes, up to `n` nodes.
fn grow(nodes: &mut Vec<Point3>, mut candidates: Farthest, n: usize, least: f64) {
    for p in nodes.iter() {
        candidates.choose(p);
    }
    while nodes.len() < n {
        match candidates.farthest() {
            Some((p, gap)) if gap > least => {
                candidates.choose(&p);
                nodes.push(p);
            }
            _ => break,
        }
    }
}

/// Moves the nodes of `range` to the mean of the samples nearer to them than to any other of the first `present`
/// nodes. A node that no sample is nearest to stays.
fn relax(
    nodes: &mut [Point3],
    range: std::ops::Range<usize>,
    present: usize,
    samples: &[Point3],
    place: &dyn Fn(Point3) -> Point3,
) -> Result<(), CloudError> {
    if range.is_empty() {
        return Ok(());
    }
    let search = Search::new(&nodes[..present])?;
    let mut sum = vec![(Vector3::zeros(), 0u32); present];
    for p in samples {
        let slot = &mut sum[search.nearest_one(p)];
        slot.0 += p.coords;
        slot.1 += 1;
    }
    for node in range {
        let (total, count) = sum[node];
        if count > 0 {
            nodes[node] = place(Point3::from(total / f64::from(count)));
        }
    }
    Ok(())
}

/// Target spacing at `p` as a share of the coarsest, in (0, 1].
fn target_size(refinements: &[Refinement], p: &Point3) -> f64 {
    refinements.iter().fold(1.0, |size: f64, r| {
        let away = ((nalgebra::distance(p, &r.centre) - r.radius) / r.reach).clamp(0.0, 1.0);
        size.min(1.0 / r.ratio + (1.0 - 1.0 / r.ratio) * away)
    })
}

fn check(shape: &(impl Shape + ?Sized), n: usize) -> Result<(), CloudError> {
    if n < FEWEST {
        return Err(CloudError::TooFew { nodes: n, least: FEWEST });
    }
    if n > MOST {
        return Err(CloudError::TooMany { nodes: n, most: MOST });
    }
    let [min, max] = shape.bounds();
    let extent = max - min;
    if !extent.iter().all(|&e| e > 0.0 && e.is_finite()) {
        return Err(CloudError::NoExtent { x: extent.x, y: extent.y, z: extent.z });
    }
    Ok(())
}

fn check_refinements(refinements: &[Refinement]) -> Result<(), CloudError> {
    for (index, r) in refinements.iter().enumerate() {
        let bad = |what, found, needed| Err(CloudError::Refinement { index, what, found, needed });
        if let Some(&c) = r.centre.coords.iter().find(|c| !c.is_finite()) {
            return bad("the centre", c, "finite");
        }
        if !(0.0..f64::INFINITY).contains(&r.radius) {
            return bad("the radius", r.radius, "0 or more");
        }
        if r.reach.is_nan() || r.reach <= 0.0 || r.reach.is_infinite() {
            return bad("the reach", r.reach, "positive");
        }
        if !(1.0..=10.0).contains(&r.ratio) {
            return bad("the ratio", r.ratio, "between 1 and 10");
        }
    }
    Ok(())
}
