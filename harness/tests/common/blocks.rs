//! Meshes of tetrahedra on grids of blocks, as Gmsh files.

use std::collections::HashMap;
use std::fmt::Write;

/// Grid lines along each axis, mm.
pub type Lines<'a> = [&'a [f64]; 3];

/// A named surface: its name and a predicate for its points, mm.
pub type Named<'a> = (&'a str, &'a dyn Fn([f64; 3]) -> bool);

/// Cells of a grid. A cell is kept if `keeps` accepts its centre, and `places` maps its corners. Corners of
/// several cells at the same position are one node.
pub struct Blocks<'a> {
    pub lines: Lines<'a>,
    pub keeps: &'a dyn Fn([f64; 3]) -> bool,
    pub places: &'a dyn Fn([f64; 3], [f64; 3]) -> [f64; 3],
    /// Named surfaces: a face belongs to a surface if the predicate holds at all of its corners.
    pub surfaces: &'a [Named<'a>],
}

/// Edge directions from the first to the last corner of a block for its six tetrahedra (Kuhn 1960), and
/// whether the orientation must be reversed.
const WAYS: [([usize; 3], bool); 6] = [
    ([0, 1, 2], false),
    ([0, 2, 1], true),
    ([1, 0, 2], true),
    ([1, 2, 0], false),
    ([2, 0, 1], false),
    ([2, 1, 0], true),
];

impl Blocks<'_> {
    /// The mesh as Gmsh 2.2 text, in mm.
    pub fn gmsh(&self) -> String {
        let (mut nodes, mut numbers): (Vec<[f64; 3]>, HashMap<[i64; 3], usize>) = Default::default();
        let mut cells = Vec::new();
        let counts = self.lines.map(|lines| lines.len() - 1);
        for at in (0..counts.iter().product())
            .map(|n: usize| [n % counts[0], n / counts[0] % counts[1], n / counts[0] / counts[1]])
        {
            let middle: [f64; 3] =
                std::array::from_fn(|a| 0.5 * (self.lines[a][at[a]] + self.lines[a][at[a] + 1]));
            if !(self.keeps)(middle) {
                continue;
            }
            let mut node = |corner: [usize; 3]| {
                let on_grid = std::array::from_fn(|a| self.lines[a][corner[a]]);
                let place = (self.places)(on_grid, middle);
                *numbers.entry(place.map(|x| (x * 1e6).round() as i64)).or_insert_with(|| {
                    nodes.push(place);
                    nodes.len()
                })
            };
            for (way, turned) in WAYS {
                let mut corner = at;
                let mut cell = vec![node(corner)];
                for axis in way {
                    corner[axis] += 1;
                    cell.push(node(corner));
                }
                if turned {
                    cell.swap(1, 2);
                }
                cells.push(cell);
            }
        }
        let mut faces: HashMap<Vec<usize>, (usize, [usize; 3])> = HashMap::new();
        for cell in &cells {
            for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].map(|f| f.map(|k| cell[k])) {
                let mut key = face.to_vec();
                key.sort_unstable();
                faces.entry(key).or_insert((0, face)).0 += 1;
            }
        }
        let mut outer: Vec<[usize; 3]> =
            faces.into_values().filter(|(count, _)| *count == 1).map(|(_, face)| face).collect();
        outer.sort_unstable();
        let mut elements: Vec<(usize, usize, Vec<usize>)> = cells.into_iter().map(|c| (4, 1, c)).collect();
        for (group, (_, holds)) in self.surfaces.iter().enumerate() {
            let on = outer.iter().filter(|face| face.iter().all(|&n| holds(nodes[n - 1])));
            elements.extend(on.map(|face| (2, group + 2, face.to_vec())));
        }
        let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n");
        writeln!(text, "{}\n3 1 \"volume\"", self.surfaces.len() + 1).unwrap();
        for (group, (name, _)) in self.surfaces.iter().enumerate() {
            writeln!(text, "2 {} \"{name}\"", group + 2).unwrap();
        }
        writeln!(text, "$EndPhysicalNames\n$Nodes\n{}", nodes.len()).unwrap();
        for (n, [x, y, z]) in nodes.iter().enumerate() {
            writeln!(text, "{} {x} {y} {z}", n + 1).unwrap();
        }
        writeln!(text, "$EndNodes\n$Elements\n{}", elements.len()).unwrap();
        for (n, (kind, group, of)) in elements.iter().enumerate() {
            let of: Vec<String> = of.iter().map(usize::to_string).collect();
            writeln!(text, "{} {kind} 2 {group} {group} {}", n + 1, of.join(" ")).unwrap();
        }
        text + "$EndElements\n"
    }
}

/// Positions of `cells + 1` equally spaced grid lines from 0 to `length`.
pub fn even(length: f64, cells: usize) -> Vec<f64> {
    (0..=cells).map(|k| length * k as f64 / cells as f64).collect()
}
