//! Clouds of an exact number of nodes in a closed-form body.

use super::Cloud;
use super::error::CloudError;
use super::farthest::Farthest;
use super::sizes::Sizes;
use crate::random::Uniform;
use crate::search::Search;
use crate::shapes::Shape;
use crate::{Point3, Vector3};

/// Number of random candidates per node. The smallest over the mean nearest distance, averaged over kidney
/// clouds of 83 to 1330 nodes, is 0.70 with 20 candidates, 0.75 with 60 and 0.75 with 200 (at five times the
/// run time of 60).
const CANDIDATES_PER_NODE: usize = 60;
/// Rounds of Lloyd's relaxation (Lloyd 1982), which moves each node to the mean of the candidates nearest to
/// it. With 8 rounds the ratio above is the same to two digits.
const ROUNDS: usize = 4;
const FEWEST: usize = 4;
const MOST: usize = 1 << 20;

/// A region of closer nodes around a point. The target spacing is divided by `ratio` within `radius` of
/// `centre` and grows linearly back to its full size over a further distance `reach`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Centre of the refined ball (m).
    pub centre: Point3,
    /// Radius of the refined ball (m), 0 or more.
    pub radius: f64,
    /// Width of the transition (m), positive.
    pub reach: f64,
    /// Coarse over fine spacing, 1 to 10.
    pub ratio: f64,
}

/// Generates exactly `n` quasi-uniform nodes in `shape` and on its surface, denser within `refinements`.
///
/// Corners are placed first. Nodes on edges, on the surface and inside follow by farthest-point sampling over
/// random candidates drawn with `seed`. A few rounds of Lloyd's relaxation then move each node within its own
/// class (surface nodes are projected back). Equal arguments give bitwise equal clouds. Surface nodes come
/// before inner nodes.
///
/// # Errors
/// `n` out of range, a refinement parameter out of range, or a body without an inside.
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

/// Generates a cloud of exactly `n` nodes as [`cloud`] does, graded by `sizes` instead of by refinements.
///
/// # Errors
/// `n` out of range, or a body without an inside.
pub fn cloud_of_sizes(
    shape: &(impl Shape + ?Sized),
    n: usize,
    seed: u64,
    sizes: &Sizes,
) -> Result<Cloud, CloudError> {
    check(shape, n)?;
    generate(shape, n, seed, sizes.finest(), |p| sizes.at(p))
}

/// Generates `n` nodes. `size` is the target spacing relative to the coarsest, from `finest` to 1.
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

    // Candidates with the density required of the nodes: drawn uniformly, kept with probability (finest /
    // size)^dimension.
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
        Farthest::new(points.iter().flat_map(|list| list.iter().map(|p| (*p, size(p)))), spacing)
    };

    // The spacing that `n` nodes reach if surface and inside are sampled together. Edges and surface get as
    // many nodes as this spacing allows; the inside gets the rest.
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

/// Adds candidates, up to `n` nodes, until no candidate is farther than `least` from all nodes.
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

/// Moves each node of `range` to the mean of the samples that are nearer to it than to any other of the first
/// `present` nodes. A node without such samples stays.
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

/// Target spacing at `p` relative to the coarsest, in (0, 1].
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
            return bad("the transition width", r.reach, "positive");
        }
        if !(1.0..=10.0).contains(&r.ratio) {
            return bad("the ratio", r.ratio, "between 1 and 10");
        }
    }
    Ok(())
}
