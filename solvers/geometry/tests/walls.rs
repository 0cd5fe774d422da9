//! Regions of nested and touching surfaces: volumes, conforming walls, angles, and refusals.

mod common;

use std::collections::{BTreeMap, BTreeSet};

use common::{block, bumpy, moved, sphere_like};
use tissuebench_geometry::stuffing::{Stuffing, stuff, stuff_quadratic, stuff_with_nodes};
use tissuebench_geometry::surface::{Soup, SurfaceProblem};
use tissuebench_geometry::{Mesh, Surface, Vector3, quality};

/// Bounds proven for the angles of the lattice, in degrees.
const ANGLES: [f64; 2] = [10.7, 164.8];

fn surface(soup: Soup) -> Surface {
    Surface::with_regions(soup, 1.0).unwrap_or_else(|bad| panic!("{bad}"))
}

fn refused(soup: Soup) -> SurfaceProblem {
    match Surface::with_regions(soup, 1.0) {
        Ok(surface) => panic!("{} regions", surface.regions().len()),
        Err(problem) => problem,
    }
}

fn turned(soup: Soup) -> Soup {
    Soup { triangles: soup.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(), ..soup }
}

/// Two soups merged into one soup, with their names.
fn joined(mut a: Soup, b: Soup) -> Soup {
    for t in 0..b.triangles.len() {
        let names: Vec<&str> =
            b.groups.of(t).iter().map(|&group| &*b.groups.names()[group as usize]).collect();
        let set = a.groups.set(names);
        let none = a.groups.set([]);
        a.groups.fill(a.triangles.len() + t, none);
        a.groups.fill(a.triangles.len() + t + 1, set);
    }
    let groups = a.groups.clone();
    Soup { groups, ..common::joined(a, b) }
}

fn named(mut soup: Soup, name: &str) -> Soup {
    let set = soup.groups.set([name]);
    soup.groups.fill(soup.triangles.len(), set);
    soup
}

/// One half of a ball with the flat face z = 0.
fn half_ball(upper: bool) -> Soup {
    let ball = sphere_like(4, |n| n);
    let sign = if upper { 1.0 } else { -1.0 };
    let is_own = |t: &&[u32; 3]| t.iter().all(|&p| sign * ball.points[p as usize].z > -1e-12);
    let mut soup = Soup { points: ball.points.clone(), ..Soup::default() };
    soup.triangles = ball.triangles.iter().filter(is_own).copied().collect();
    let centre = soup.points.len() as u32;
    soup.points.push(Vector3::zeros().into());
    for t in soup.triangles.clone() {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            if [a, b].iter().all(|&p| soup.points[p as usize].z.abs() < 1e-12) {
                soup.triangles.push([b, a, centre]);
            }
        }
    }
    soup.faces = (1..=soup.triangles.len() as u32).collect();
    soup
}

/// Volume of each region by its name.
fn volumes(mesh: &Mesh) -> BTreeMap<&str, f64> {
    let mut found = BTreeMap::new();
    for (cell, volume) in quality::volumes(mesh).into_iter().enumerate() {
        *found.entry(&*mesh.region_names()[usize::from(mesh.region(cell))]).or_insert(0.0) += volume;
    }
    found
}

/// Checks that every face belongs to at most two cells, and that the boundary of each region is closed: each
/// of its edges has an even number of faces. Returns the Euler characteristics of the regions' boundaries.
fn conforming(mesh: &Mesh) -> Vec<i64> {
    let mut cells: BTreeMap<[u32; 3], Vec<usize>> = BTreeMap::new();
    for cell in 0..mesh.cell_count() {
        let c = mesh.cell(cell);
        for skipped in 0..4 {
            let mut face: [u32; 3] = std::array::from_fn(|i| c[(skipped + 1 + i) % 4]);
            face.sort_unstable();
            cells.entry(face).or_default().push(cell);
        }
    }
    assert!(cells.values().all(|of| of.len() <= 2));
    (0..mesh.region_names().len())
        .map(|region| {
            let is_own = |cell: &&usize| usize::from(mesh.region(**cell)) == region;
            let faces: Vec<[u32; 3]> = (cells.iter())
                .filter(|(_, of)| of.iter().filter(is_own).count() == 1)
                .map(|(face, _)| *face)
                .collect();
            let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
            for [a, b, c] in &faces {
                [[*a, *b], [*b, *c], [*a, *c]].iter().for_each(|edge| *edges.entry(*edge).or_default() += 1);
            }
            assert!(edges.values().all(|count| count.is_multiple_of(2)));
            let corners: BTreeSet<u32> = faces.iter().flatten().copied().collect();
            corners.len() as i64 - edges.len() as i64 + faces.len() as i64
        })
        .collect()
}

fn has_angles(mesh: &Mesh) -> [f64; 2] {
    let quality = quality::check(mesh).unwrap();
    let found = [quality.min_dihedral.value, quality.max_dihedral.value];
    assert!(found[0] >= ANGLES[0] && found[1] <= ANGLES[1], "{found:?}");
    found
}

/// Bodies with smooth walls, and those whose walls meet the outer surface.
fn bodies() -> Vec<(&'static str, Soup)> {
    let ball = |r: f64| sphere_like(4, move |n| r * n);
    let shells = joined(named(ball(1.0), "skin"), joined(named(ball(0.8), "fat"), named(ball(0.5), "core")));
    let egg = |at: [f64; 3]| moved(sphere_like(4, |n| [0.3 * n.x, 0.25 * n.y, 0.2 * n.z].into()), at);
    let organ = joined(named(bumpy(4), "organ"), named(egg([-0.4, 0.1, 0.0]), "tumour"));
    let two = joined(organ.clone(), egg([0.4, 0.1, 0.0]));
    let cyst = joined(ball(1.0), joined(ball(0.7), turned(ball(0.4))));
    let halves = joined(named(half_ball(true), "upper"), named(half_ball(false), "lower"));
    let filled = joined(ball(1.0), joined(turned(ball(0.6)), ball(0.6)));
    vec![
        ("shells", shells),
        ("organ", organ),
        ("organ with two", two),
        ("cyst in a tumour", cyst),
        ("halves of a ball", halves),
        ("a filled cavity", filled),
    ]
}

#[test]
fn nested_and_touching_bodies_become_regions_with_their_volumes() {
    for (name, soup) in bodies() {
        let surface = surface(soup);
        for (spacing, doublings, allowed) in
            [(0.16, 0, [4e-3, 1.5e-2]), (0.1, 0, [1e-3, 5e-3]), (0.1, 2, [1e-3, 5e-3])]
        {
            let mesh = stuff(&surface, Stuffing { spacing, doublings }).unwrap().mesh;
            let quadratic = stuff_quadratic(&surface, Stuffing { spacing, doublings }).unwrap().mesh;
            has_angles(&mesh);
            conforming(&mesh);
            let ratio = quality::check(&quadratic).unwrap().min_det_ratio;
            assert!(ratio.value > 0.149, "{name}: {ratio:?}");
            let [found, curved] = [&mesh, &quadratic].map(volumes);
            for region in surface.regions() {
                for (volume, allowed) in
                    [&found, &curved].map(|of| of[&*region.name]).into_iter().zip(allowed)
                {
                    let off = volume / region.surface.volume() - 1.0;
                    assert!(off.abs() < allowed, "{name} {spacing} {doublings}: {} {off}", region.name);
                }
            }
        }
    }
}

/// The boundary of a ball has the characteristic 2, that of a hollow ball 4.
#[test]
fn names_volumes_and_topology_of_regions() {
    let expected: [(&str, &[(&str, i64)]); 6] = [
        ("shells", &[("skin", 4), ("fat", 4), ("core", 2)]),
        ("organ", &[("organ", 4), ("tumour", 2)]),
        ("organ with two", &[("organ", 6), ("tumour", 2), ("inner-2", 2)]),
        ("cyst in a tumour", &[("outer", 4), ("inner-1", 4)]),
        ("halves of a ball", &[("upper", 2), ("lower", 2)]),
        ("a filled cavity", &[("part-1", 4), ("part-2", 2)]),
    ];
    for ((name, soup), (same, regions)) in bodies().into_iter().zip(expected) {
        assert_eq!(name, same);
        let surface = surface(soup);
        let mesh = stuff(&surface, Stuffing { spacing: 0.1, doublings: 1 }).unwrap().mesh;
        let found: Vec<(&str, i64)> =
            mesh.region_names().iter().map(String::as_str).zip(conforming(&mesh)).collect();
        assert_eq!(found, regions, "{name}");
        let of_regions: f64 = surface.regions().iter().map(|region| region.surface.volume()).sum();
        assert!((of_regions / surface.volume() - 1.0).abs() < 1e-12, "{name}");
    }
}

#[test]
fn bodies_that_cross_are_refused_and_bodies_apart_are_one() {
    let cross = refused(joined(block([1.0; 3]), moved(block([1.0; 3]), [0.5, 0.2, 0.3])));
    assert!(matches!(cross, SurfaceProblem::Crossing { bodies: true, .. }), "{cross}");
    assert!(
        cross.to_string().contains("triangles 3 and 18 intersect near (0.6666667, 0.3333333, 1) (6 such places); they belong to two bodies"),
        "{cross}"
    );
    // The common square of two faces with other triangles.
    let beside = refused(joined(block([1.0; 3]), moved(block([0.5; 3]), [1.0, 0.2, 0.2])));
    assert!(matches!(beside, SurfaceProblem::Crossing { bodies: true, .. }), "{beside}");
    let edge = refused(joined(block([1.0; 3]), moved(block([1.0; 3]), [1.0, 1.0, 0.0])));
    assert!(matches!(edge, SurfaceProblem::Branched { .. }), "{edge}");
    let outside = refused(joined(block([1.0; 3]), moved(turned(block([1.0; 3])), [2.0, 0.0, 0.0])));
    assert!(matches!(outside, SurfaceProblem::InsideOut { within: 0, .. }), "{outside}");
    let apart = surface(joined(block([1.0; 3]), moved(block([1.0; 3]), [2.0, 0.0, 0.0])));
    assert!(apart.regions().is_empty() && (apart.volume() - 2.0).abs() < 1e-12);
    let hollow = surface(joined(block([1.0; 3]), moved(turned(block([0.5; 3])), [0.2; 3])));
    assert!(hollow.regions().is_empty() && (hollow.volume() - 0.875).abs() < 1e-12);
}

#[test]
fn a_region_smaller_than_the_cells_is_refused_by_name() {
    let grain = named(sphere_like(2, |n| 0.02 * n), "grain");
    let surface = surface(joined(sphere_like(4, |n| n), grain));
    let bad = stuff(&surface, Stuffing { spacing: 0.2, doublings: 0 }).unwrap_err();
    assert!(bad.to_string().contains("too large for the region 'grain'"), "{bad}");
}

fn in_box(size: [f64; 3], at: [f64; 3], name: &str) -> Soup {
    named(moved(block(size), at), name)
}

#[test]
fn boxes_in_and_beside_boxes_are_regions() {
    let outer = || in_box([10.0; 3], [0.0; 3], "organ");
    let row = |at: f64, size: f64, name: &str| in_box([size, 10.0, 10.0], [at, 0.0, 0.0], name);
    let bodies = [
        ("nested", joined(outer(), in_box([3.0; 3], [2.0, 4.0, 3.0], "tumour"))),
        ("two in a row", joined(row(0.0, 10.0, "left"), row(10.0, 10.0, "right"))),
        ("layers", joined(row(0.0, 4.0, "a"), joined(row(4.0, 3.0, "b"), row(7.0, 5.0, "c")))),
    ];
    for (name, soup) in bodies {
        let surface = surface(soup);
        let of_regions: f64 = surface.regions().iter().map(|region| region.surface.volume()).sum();
        assert!((of_regions - surface.volume()).abs() < 1e-9 * of_regions);
        for nodes in [400, 1000, 6000] {
            let mesh = stuff_with_nodes(&surface, nodes, 0).unwrap().0.mesh;
            has_angles(&mesh);
            let characteristics: &[i64] = if name == "nested" { &[4, 2] } else { &[2, 2, 2] };
            let found = conforming(&mesh);
            assert_eq!(found, characteristics[..found.len()], "{name} {nodes}");
            let found = volumes(&mesh);
            for region in surface.regions() {
                let off = found[&*region.name] / region.surface.volume() - 1.0;
                // The small box is 1.5 to 4 cells wide.
                let allowed = match (&*region.name, nodes) {
                    ("tumour", 6000) => 0.01,
                    ("tumour", _) => 0.1,
                    _ => 3e-3,
                };
                assert!(off.abs() < allowed, "{name} {nodes}: {} {off}", region.name);
            }
        }
    }
}
