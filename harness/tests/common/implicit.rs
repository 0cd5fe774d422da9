//! Closed surfaces in STL, from functions that are negative inside, and from outlines that turn about an
//! axis.

use std::fmt::Write as _;

pub type Vector = [f64; 3];
pub type Triangle = [Vector; 3];

/// Smallest distance of a triangle's corner from the ends of its grid edge, relative to the edge. It prevents
/// needles.
const OFF: f64 = 0.05;

pub fn sub(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|x| a[x] - b[x])
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|x| a[x] * b[x]).sum()
}

pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Approximate distance to an ellipsoid with these half axes.
pub fn ellipsoid(p: Vector, at: Vector, half: Vector) -> f64 {
    let scaled: Vector = std::array::from_fn(|x| (p[x] - at[x]) / half[x]);
    (length(scaled) - 1.0) * half.into_iter().fold(f64::MAX, f64::min)
}

/// Approximate distance to a rod with round ends and these radii at its ends.
pub fn rod(p: Vector, [a, b]: [Vector; 2], [from, to]: [f64; 2]) -> f64 {
    let (along, off) = (sub(b, a), sub(p, a));
    let t = (dot(off, along) / dot(along, along)).clamp(0.0, 1.0);
    length(std::array::from_fn(|x| off[x] - t * along[x])) - (from + (to - from) * t)
}

/// Union of bodies, with fillets of about this size.
pub fn union(parts: impl IntoIterator<Item = f64>, fillet: f64) -> f64 {
    let join = |a: f64, b: f64| {
        let h = (0.5 + 0.5 * (b - a) / fillet).clamp(0.0, 1.0);
        b + (a - b) * h - fillet * h * (1.0 - h)
    };
    parts.into_iter().reduce(join).unwrap()
}

/// Zero surface of a function in a box, as STL.
pub fn surface(inside: &dyn Fn(Vector) -> f64, bounds: [Vector; 2], cells: usize) -> String {
    stl("body", &triangles(inside, bounds, cells))
}

/// Zero surface of a function in a box, by marching tetrahedra on a grid with this many cells along the
/// longest side.
pub fn triangles(inside: &dyn Fn(Vector) -> f64, [low, high]: [Vector; 2], cells: usize) -> Vec<Triangle> {
    let size = sub(high, low);
    let step = size.into_iter().fold(0.0, f64::max) / cells as f64;
    let count = size.map(|side| (side / step).ceil() as usize + 1);
    let number = |[i, j, k]: [usize; 3]| i + count[0] * (j + count[1] * k);
    let place = |n: usize| -> Vector {
        let k = [n % count[0], n / count[0] % count[1], n / count[0] / count[1]];
        std::array::from_fn(|x| low[x] + step * k[x] as f64)
    };
    let values: Vec<f64> = (0..count.iter().product()).map(|n| inside(place(n))).collect();
    let between = |a: usize, b: usize| -> Vector {
        let (a, b) = (a.min(b), a.max(b));
        let t = (values[a] / (values[a] - values[b])).clamp(OFF, 1.0 - OFF);
        let (from, to) = (place(a), place(b));
        std::array::from_fn(|x| from[x] + t * (to[x] - from[x]))
    };
    let mut triangles = Vec::new();
    for k in 0..count[2] - 1 {
        for j in 0..count[1] - 1 {
            for i in 0..count[0] - 1 {
                for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                    let mut at = [i, j, k];
                    let mut tet = [number(at); 4];
                    for (corner, axis) in order.into_iter().enumerate() {
                        at[axis] += 1;
                        tet[corner + 1] = number(at);
                    }
                    let (within, without): (Vec<usize>, Vec<usize>) =
                        tet.into_iter().partition(|&n| values[n] < 0.0);
                    let ring: Vec<Vector> = match (within.as_slice(), without.as_slice()) {
                        ([a, b], [c, d]) => {
                            vec![between(*a, *c), between(*a, *d), between(*b, *d), between(*b, *c)]
                        }
                        ([], _) | (_, []) => continue,
                        _ => {
                            let ends = within.iter().flat_map(|&a| without.iter().map(move |&b| (a, b)));
                            ends.map(|(a, b)| between(a, b)).collect()
                        }
                    };
                    let outwards = sub(place(without[0]), place(within[0]));
                    for two in ring[1..].windows(2) {
                        let [a, b, c] = [ring[0], two[0], two[1]];
                        let turned = dot(cross(sub(b, a), sub(c, a)), outwards) < 0.0;
                        triangles.push(if turned { [a, c, b] } else { [a, b, c] });
                    }
                }
            }
        }
    }
    triangles
}

/// A body that turns about z: radius and height of its outline, from the bottom up, with flat ends or tips.
pub fn turned(outline: &[[f64; 2]], sectors: usize) -> String {
    let at = |[r, z]: [f64; 2], k: usize| {
        let angle = std::f64::consts::TAU * (k % sectors) as f64 / sectors as f64;
        [r * angle.cos(), r * angle.sin(), z]
    };
    let ends = [outline[0], outline[outline.len() - 1]].map(|[_, z]| [0.0, z]);
    let closed = [&ends[..1], outline, &ends[1..]].concat();
    let mut triangles: Vec<Triangle> = Vec::new();
    for two in closed.windows(2) {
        for k in 0..sectors {
            let [a, b, c, d] = [at(two[0], k), at(two[0], k + 1), at(two[1], k + 1), at(two[1], k)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    stl("body", &triangles)
}

/// Writes triangles as the text of an STL file with one solid of that name.
pub fn stl(name: &str, triangles: &[Triangle]) -> String {
    let mut text = format!("solid {name}\n");
    for corners in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in corners {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid\n"
}
