//! Regions of a surface: bodies within bodies, and bodies that touch at walls.

use std::collections::HashMap;

use super::error::SurfaceProblem;
use super::groups::Groups;
use super::nested::Nest;
use super::soup::Soup;
use super::{Region, Surface, closed, crossing, nested, walls, without_crossings};

impl Surface {
    /// Creates a surface as [`Surface::new`] does, of bodies that may lie within others or touch at common
    /// triangles. These bodies are the regions inside the surface.
    ///
    /// # Errors
    /// As for [`Surface::new`].
    pub fn with_regions(soup: Soup, unit: f64) -> Result<Surface, SurfaceProblem> {
        let (mut soup, mut neighbours) = closed::closed(soup, walls::neighbours)?;
        let opposite = walls::opposite(&soup);
        let has_walls = opposite.iter().any(Option::is_some);
        if has_walls {
            let is_first = |&t: &usize| opposite[t].is_none_or(|other| other as usize > t);
            let once: Vec<usize> = (0..soup.triangles.len()).filter(is_first).collect();
            crossing::refuse(&soup.of_triangles(&once), || {
                let parts = nested::parts(&neighbours);
                once.iter().map(|&t| parts[t]).collect()
            })?;
        } else {
            (soup, neighbours) = without_crossings(soup, neighbours)?;
        }
        let nest = nested::find(&soup, &neighbours, &opposite)?;
        if has_walls || (0..nest.triangles.len()).any(|part| nest.is_inner(part)) {
            return joined(&soup, &neighbours, &opposite, &nest, unit);
        }
        Ok(Surface::of(soup, &neighbours, unit))
    }
}

/// Creates the outer surface of nested and touching bodies, with their regions.
pub(super) fn joined(
    soup: &Soup,
    neighbours: &[[u32; 3]],
    opposite: &[Option<u32>],
    nest: &Nest,
    unit: f64,
) -> Result<Surface, SurfaceProblem> {
    let bodies: Vec<usize> = (0..nest.triangles.len()).filter(|&part| nest.is_body[part]).collect();
    let names = names(soup, nest, &bodies);
    let region = |(&body, name): (&usize, String)| {
        let own = nest.triangles[body].iter().map(|&t| (t, false));
        let within = (0..nest.triangles.len()).filter(|&part| nest.parent[part] == Some(body));
        let within =
            within.flat_map(|part| nest.triangles[part].iter().map(move |&t| (t, nest.is_body[part])));
        let triangles: Vec<(usize, bool)> = own.chain(within).collect();
        Region { name, surface: part_of(soup, neighbours, &triangles, unit) }
    };
    let regions = bodies.iter().zip(names).map(region).collect();
    let mut outer: Vec<usize> = (0..nest.triangles.len())
        .filter(|&part| !nest.is_inner(part))
        .flat_map(|part| nest.triangles[part].iter().copied().filter(|&t| opposite[t].is_none()))
        .collect();
    outer.sort_unstable();
    let outer = soup.of_triangles(&outer).used();
    let neighbours = closed::neighbours(&outer)?;
    Ok(Surface { regions, ..Surface::of(outer, &neighbours, unit) })
}

/// The closed surface of some triangles, some of them reversed.
fn part_of(soup: &Soup, neighbours: &[[u32; 3]], triangles: &[(usize, bool)], unit: f64) -> Surface {
    let index: HashMap<usize, u32> = triangles.iter().map(|(t, _)| *t).zip(0..).collect();
    let kept: Vec<usize> = triangles.iter().map(|(t, _)| *t).collect();
    let mut part = Soup { groups: Groups::default(), ..soup.of_triangles(&kept) }.used();
    let mut across: Vec<[u32; 3]> =
        kept.iter().map(|&t| neighbours[t].map(|other| index[&(other as usize)])).collect();
    for (at, _) in triangles.iter().enumerate().filter(|(_, (_, reversed))| *reversed) {
        part.triangles[at].swap(1, 2);
        across[at].swap(0, 2);
    }
    Surface::of(part, &across, unit)
}

/// Names of the bodies. A group names a body if it has all of its triangles and none of another body.
fn names(soup: &Soup, nest: &Nest, bodies: &[usize]) -> Vec<String> {
    let groups = &soup.groups;
    let mut numbers = [0; 2];
    let mut used: HashMap<u32, usize> = HashMap::new();
    let mut of_body = |body: usize| -> Vec<u32> {
        let mut of = nest.triangles[body].iter().map(|&t| groups.of(t));
        let mut common: Vec<u32> = of.next().unwrap_or_default().to_vec();
        let mut all = common.clone();
        for set in of {
            common.retain(|group| set.contains(group));
            all.extend(set.iter().filter(|group| !all.contains(group)).copied().collect::<Vec<_>>());
        }
        all.into_iter().for_each(|group| *used.entry(group).or_default() += 1);
        common
    };
    let common: Vec<Vec<u32>> = bodies.iter().map(|&body| of_body(body)).collect();
    let outermost = bodies.iter().filter(|&&body| !nest.is_inner(body)).count();
    let name = |(&body, common): (&usize, Vec<u32>)| {
        let own = common.into_iter().find(|group| used[group] == 1);
        let kind = usize::from(nest.is_inner(body));
        numbers[kind] += 1;
        match own {
            Some(group) => groups.names()[group as usize].clone(),
            None if kind == 1 => format!("inner-{}", numbers[1]),
            None if outermost == 1 => "outer".into(),
            None => format!("part-{}", numbers[0]),
        }
    };
    bodies.iter().zip(common).map(name).collect()
}
