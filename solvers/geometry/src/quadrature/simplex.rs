//! Symmetric rules on the triangle and the tetrahedron, stored by orbit.
//!
//! A symmetric rule is a list of orbits: one representative in barycentric coordinates with all its distinct
//! permutations. The orbit parameters solve the moment equations (all barycentric monomials of the rule's
//! degree). They were refined by Newton's method in 40-digit arithmetic to a residual below 1e-39. Classic
//! rules among them are the degree-5 triangle (Radon 1948) and the 4-, 14- and 24-point tetrahedra (Hammer &
//! Stroud 1956, Walkington 2000, Keast 1986). The symmetric 11-point degree-4 tetrahedron has a negative
//! weight (Keast 1986), and a random search over its five parameters finds no positive solution. It is not
//! offered: 14 points give degree 5.

use super::Rule;

/// Weight (as a fraction of the reference measure) and a representative in barycentric coordinates.
type Orbit<const N: usize> = (f64, [f64; N]);

const fn s31(weight: f64, a: f64) -> Orbit<4> {
    (weight, [a, a, a, 1.0 - 3.0 * a])
}
const fn s22(weight: f64, a: f64) -> Orbit<4> {
    (weight, [a, a, 0.5 - a, 0.5 - a])
}
const fn s211(weight: f64, a: f64, b: f64) -> Orbit<4> {
    (weight, [a, a, b, 1.0 - 2.0 * a - b])
}
const fn s21(weight: f64, a: f64) -> Orbit<3> {
    (weight, [a, a, 1.0 - 2.0 * a])
}
const fn s111(weight: f64, a: f64, b: f64) -> Orbit<3> {
    (weight, [a, b, 1.0 - a - b])
}

const TET1: [Orbit<4>; 1] = [(1.0, [0.25; 4])];
const TRI1: [Orbit<3>; 1] = [(1.0, [1.0 / 3.0; 3])];
/// `a = (5 - sqrt 5) / 20`.
const TET4: [Orbit<4>; 1] = [s31(0.25, 0.1381966011250105)];
const TET8: [Orbit<4>; 2] =
    [s31(0.1589268308541531, 0.32757812100495043), s31(0.0910731691458469, 0.09569268091029959)];
const TET14: [Orbit<4>; 3] = [
    s31(0.07349304311636196, 0.09273525031089122),
    s31(0.11268792571801585, 0.3108859192633006),
    s22(0.042546020777081466, 0.04550370412564965),
];
const TET15: [Orbit<4>; 4] = [
    (0.17866729642555304, [0.25; 4]),
    s31(0.07007023480888269, 0.09101374920419507),
    s31(0.03848880381103951, 0.3319337797436422),
    s22(0.06451609151579302, 0.43428210757685426),
];
const TET24: [Orbit<4>; 4] = [
    s31(0.010077211055320643, 0.04067395853461135),
    s31(0.039922750258167494, 0.21460287125915203),
    s31(0.055357181543654724, 0.3223378901422755),
    s211(0.048214285714285716, 0.06366100187501753, 0.2696723314583158),
];
const TET35: [Orbit<4>; 5] = [
    (0.09548528946413085, [0.25; 4]),
    s31(0.04232958120996703, 0.3157011497782028),
    s22(0.03189692783285758, 0.05048982259839637),
    s211(0.03720713072833462, 0.18883383102600104, 0.5751716375870001),
    s211(0.008110770829903342, 0.021265472541483248, 0.14663881381848495),
];
const TET46: [Orbit<4>; 7] = [
    s31(0.009908987793288918, 0.04688418671511168),
    s31(0.0460753809882706, 0.31321997469325713),
    s31(0.03994223946025991, 0.1909305862216767),
    s31(0.03608296965851501, 0.12282947664379205),
    s22(0.03771957432814026, 0.06697784877990656),
    s211(0.007202675791193088, 0.021137448729713723, 0.2469833877829111),
    s211(0.013267677744625301, 0.20374782517213486, 0.5914538396633017),
];
const TRI3: [Orbit<3>; 1] = [s21(1.0 / 3.0, 1.0 / 6.0)];
const TRI6: [Orbit<3>; 2] =
    [s21(0.22338158967801147, 0.4459484909159649), s21(0.10995174365532187, 0.09157621350977074)];
const TRI7: [Orbit<3>; 3] = [
    (0.225, [1.0 / 3.0; 3]),
    s21(0.12593918054482714, 0.10128650732345634),
    s21(0.1323941527885062, 0.4701420641051151),
];
const TRI12: [Orbit<3>; 3] = [
    s21(0.17133312415298102, 0.21942998254978296),
    s21(0.08073108959303098, 0.48013796411221504),
    s111(0.040634559793660666, 0.019371724361240787, 0.14161901592396817),
];
const TRI16: [Orbit<3>; 5] = [
    (0.14431560767778717, [1.0 / 3.0; 3]),
    s21(0.03245849762319808, 0.05054722831703098),
    s21(0.09509163426728462, 0.4592925882927232),
    s21(0.10321737053471824, 0.1705693077517602),
    s111(0.027230314174434993, 0.008394777409957605, 0.2631128296346381),
];
const TRI25: [Orbit<3>; 6] = [
    (0.07989450474123971, [1.0 / 3.0; 3]),
    s21(0.008223818690464195, 0.023308867510000192),
    s21(0.07112380223237734, 0.42508621060209056),
    s111(0.04543059229617002, 0.223766973576973, 0.14792562620953445),
    s111(0.03088665688456399, 0.035632559587503485, 0.14329537042686716),
    s111(0.03735985623430527, 0.029946031954170886, 0.3587401418644315),
];

/// (Points, degree) of every tetrahedron rule.
pub const TET_RULES: [(usize, usize); 8] =
    [(1, 1), (4, 2), (8, 3), (14, 5), (15, 5), (24, 6), (35, 7), (46, 8)];

/// (Points, degree) of every triangle rule.
pub const TRI_RULES: [(usize, usize); 7] = [(1, 1), (3, 2), (6, 4), (7, 5), (12, 6), (16, 8), (25, 10)];

/// Returns the tetrahedron rule with this number of points, or `None` if [`TET_RULES`] has no such rule. The
/// weights sum to 1/6.
pub fn tet(points: usize) -> Option<Rule<3>> {
    let orbits: &[Orbit<4>] = match points {
        1 => &TET1,
        4 => &TET4,
        8 => &TET8,
        14 => &TET14,
        15 => &TET15,
        24 => &TET24,
        35 => &TET35,
        46 => &TET46,
        _ => return None,
    };
    let expanded = orbits.iter().flat_map(|&(w, l)| permutations(l).into_iter().map(move |l| (w, l)));
    let (points, weights) = expanded.map(|(w, l)| ([l[1], l[2], l[3]], w / 6.0)).unzip();
    Some(Rule { points, weights })
}

/// Returns the triangle rule with this number of points, or `None` if [`TRI_RULES`] has no such rule. The
/// weights sum to 1/2.
pub fn tri(points: usize) -> Option<Rule<2>> {
    let orbits: &[Orbit<3>] = match points {
        1 => &TRI1,
        3 => &TRI3,
        6 => &TRI6,
        7 => &TRI7,
        12 => &TRI12,
        16 => &TRI16,
        25 => &TRI25,
        _ => return None,
    };
    let expanded = orbits.iter().flat_map(|&(w, l)| permutations(l).into_iter().map(move |l| (w, l)));
    let (points, weights) = expanded.map(|(w, l)| ([l[1], l[2]], w / 2.0)).unzip();
    Some(Rule { points, weights })
}

/// All distinct orderings of `values`, in a fixed order.
fn permutations<const N: usize>(values: [f64; N]) -> Vec<[f64; N]> {
    fn extend<const N: usize>(
        values: &[f64; N],
        used: &mut [bool; N],
        prefix: &mut Vec<f64>,
        out: &mut Vec<[f64; N]>,
    ) {
        if prefix.len() == N {
            out.push(std::array::from_fn(|i| prefix[i]));
            return;
        }
        let mut tried = Vec::new();
        for i in 0..N {
            if used[i] || tried.contains(&values[i]) {
                continue;
            }
            tried.push(values[i]);
            used[i] = true;
            prefix.push(values[i]);
            extend(values, used, prefix, out);
            prefix.pop();
            used[i] = false;
        }
    }
    let mut out = Vec::new();
    extend(&values, &mut [false; N], &mut Vec::new(), &mut out);
    out
}
