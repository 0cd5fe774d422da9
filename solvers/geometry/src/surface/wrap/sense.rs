//! The outer side of triangles that need not be closed, by votes of rays (Takayama et al. 2014).

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::surface::change::Change;
use crate::surface::orientation::consistent;
use crate::surface::sides::sides;
use crate::surface::soup::Soup;
use crate::surface::tree::Tree;
use crate::surface::winding::Winding;
use crate::{Point3, Vector3};

/// Largest number of triangles of a part that send rays.
const SENDERS: usize = 32;
/// Smallest number of rays of a part to either side, and of each triangle.
const RAYS: usize = 24;
const EACH: usize = 3;
/// Slope of the rays against the normal, and the angle between them around it.
const SLOPE: f64 = 0.8;
const GOLDEN: f64 = PI * 0.763_932_022_500_210_3;
/// Distance of the rays' origins from their triangles, over the diagonal.
const LIFTED: f64 = 1e-7;
/// Largest fraction of the rays that leave the body from a sheet inside, to either side.
const HIDDEN: f64 = 0.2;
/// Winding number of a part alone, on its inner side, below which it is a sheet: 1/2 is a flat sheet, 1 a
/// closed part.
const SHEET: f64 = 0.75;

/// Rays of a part to its two sides, in front and behind.
#[derive(Clone, Copy, Default)]
struct Votes {
    rays: usize,
    /// Rays that meet no triangle.
    free: [usize; 2],
}

/// The triangles with their normals outwards, without open sheets inside the body. Parts that no ray leaves
/// keep their orientation relative to most others.
pub(super) fn sensed(soup: &Soup) -> (Soup, Vec<Change>) {
    let mut soup = soup.clone();
    let sides = sides(&soup);
    let orientation = consistent(&soup, &sides);
    let single = orientation.reversed();
    orientation.apply(&mut soup);
    let mut open = vec![false; orientation.parts];
    for around in sides.chunk_by(|a, b| a.edge == b.edge).filter(|around| around.len() != 2) {
        around.iter().for_each(|side| open[orientation.part[side.triangle as usize] as usize] = true);
    }
    let mut lists: Vec<Vec<usize>> = vec![Vec::new(); orientation.parts];
    orientation.part.iter().enumerate().for_each(|(t, part)| lists[*part as usize].push(t));
    let tree = Tree::new(&soup.points, &soup.triangles);
    let votes: Vec<Votes> = lists.par_iter().map(|list| votes(&soup, &tree, list)).collect();
    let is_inner = |part: usize| {
        let Votes { rays, free } = votes[part];
        let hidden = free.iter().all(|&free| free as f64 <= HIDDEN * rays as f64);
        open[part] && hidden && is_sheet(&soup, &lists[part])
    };
    let inner: Vec<bool> = (0..lists.len()).map(is_inner).collect();
    let is_inner = |part: usize| inner[part];
    let area = |part: usize| -> f64 { lists[part].iter().map(|&t| normal(&soup, t).norm()).sum() };
    // Positive if most of the surface is right.
    let balance: f64 = (0..lists.len())
        .map(|part| match votes[part].free {
            [front, behind] if front > behind => area(part),
            [front, behind] if front < behind => -area(part),
            _ => 0.0,
        })
        .sum();
    let is_turned = |part: usize| match votes[part].free {
        [front, behind] if front == behind => balance < 0.0,
        [front, behind] => front < behind,
    };
    let places = |marked: &dyn Fn(usize) -> bool| -> Vec<Point3> {
        (0..lists.len()).filter(|&part| marked(part)).map(|part| soup.middle(lists[part][0])).collect()
    };
    let changes = [
        Change::at("triangles turned like their neighbours", single.iter().map(|&t| soup.middle(t))),
        Change::at("reversed parts turned", places(&|part| is_turned(part) && !is_inner(part))),
        Change::at("open sheets inside the body left out", places(&is_inner)),
    ];
    let kept: Vec<usize> =
        (0..soup.triangles.len()).filter(|&t| !is_inner(orientation.part[t] as usize)).collect();
    let mut sensed = soup.of_triangles(&kept);
    for (triangle, &t) in sensed.triangles.iter_mut().zip(&kept) {
        if is_turned(orientation.part[t] as usize) {
            triangle.swap(1, 2);
        }
    }
    (sensed, changes.into_iter().flatten().collect())
}

/// Normal of a triangle times twice its area.
fn normal(soup: &Soup, triangle: usize) -> Vector3 {
    let [a, b, c] = soup.corners(triangle);
    (b - a).cross(&(c - a))
}

/// Triangles of a part that stand for all.
fn senders(part: &[usize]) -> impl Iterator<Item = usize> {
    let count = part.len().min(SENDERS);
    (0..count).map(move |k| part[k * part.len() / count])
}

/// Whether a part is far from closed.
fn is_sheet(soup: &Soup, part: &[usize]) -> bool {
    let triangles: Vec<[u32; 3]> = part.iter().map(|&t| soup.triangles[t]).collect();
    let winding = Winding::new(Tree::new(&soup.points, &triangles));
    let [low, high] = winding.tree().bounds();
    let lift = LIFTED * (high - low).norm();
    let of_sender = |triangle: usize| {
        let normal = normal(soup, triangle).try_normalize(0.0).unwrap_or_default();
        [lift, -lift]
            .map(|by| winding.at(&(soup.middle(triangle) + normal * by)).abs())
            .into_iter()
            .fold(0.0, f64::max)
    };
    let all: Vec<f64> = senders(part).map(of_sender).collect();
    all.iter().sum::<f64>() < SHEET * all.len() as f64
}

/// Sends rays from some triangles of a part.
fn votes(soup: &Soup, tree: &Tree, part: &[usize]) -> Votes {
    let each = EACH.max(RAYS / part.len().min(SENDERS));
    let [low, high] = tree.bounds();
    let lift = LIFTED * (high - low).norm();
    let mut votes = Votes::default();
    for (k, triangle) in senders(part).enumerate() {
        let Some(normal) = normal(soup, triangle).try_normalize(0.0) else { continue };
        let across = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
        let other = normal.cross(&across);
        for ray in 0..each {
            let angle = GOLDEN * (k * each + ray) as f64;
            let aside = (across * angle.cos() + other * angle.sin()) * SLOPE;
            votes.rays += 1;
            for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                let mut free = true;
                let from = soup.middle(triangle) + normal * (sign * lift);
                tree.pierced(&from, &(normal * sign + aside), f64::INFINITY, |_| free = false);
                votes.free[side] += usize::from(free);
            }
        }
    }
    votes
}
