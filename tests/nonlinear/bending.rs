//! A block bent by one radian.
//!
//! ```text
//! Source      cases::exact::FiniteBending (Rivlin's flexure, compressible).
//! Body        10 x 20 x 5 mm, neo-Hookean, nu = 0.3; strains up to a quarter.
//! Conditions  Y = 0 and both Z: no normal displacement; exact displacement at Y = 20 mm; X = -5, 5 mm free.
//! Must hold   the largest nodal error, relative to the largest displacement, converges with the theoretical
//!             order (2 for linear, 3 for quadratic elements, within 0.4 in the maximum norm) and is below
//!             2 % (linear) and 0.02 % (quadratic).
//! ```

use cases::exact::{Elastic, Exact as _, FiniteBending, Hyperelastic};
use geometry::CellKind;
use geometry::generate::box_mesh;
use integration::model::*;
use material::{Law, NeoHookean};
use shape::{Point3, Vector3};
use statics::StaticProblem;

const POISSON: f64 = 0.3;

fn bend(exact: &FiniteBending, (kind, projection): (CellKind, Projection), n: usize) -> f64 {
    let (low, high) = (Point3::new(-0.005, 0.0, 0.0), Point3::new(0.005, 0.02, 0.005));
    let model = Model::new(box_mesh(kind, low, high, [n, 2 * n, n / 2], [1.0; 3], None).unwrap(), projection);
    let mut fixed = model.hold(&["y-max"], &[0, 1, 2], |x| exact.displacement(x));
    fixed.extend(model.hold(&["y-min"], &[1], |_| Vector3::zeros()));
    let walls = model.hold(&["z-min", "z-max"], &[2], |_| Vector3::zeros());
    fixed.extend(walls.into_iter().filter(|f| model.mesh.points()[f.node as usize].y < high.y));
    let law = Law::NeoHookean(NeoHookean::new(YOUNG, POISSON).unwrap());
    let problem = StaticProblem { fixed: &fixed, ..model.problem(&law) };
    let path = solve(&format!("{kind:?} {projection:?} {n}"), &problem, &steps(4));
    model.error(&path.u, |x| exact.displacement(x))
}

#[test]
fn blocks_bend_into_sectors() {
    let law = Hyperelastic::NeoHookean(Elastic::new(YOUNG, POISSON).unwrap());
    let exact = FiniteBending::new(&law, 0.01, 50.0).unwrap();
    for method in METHODS.into_iter().filter(|m| *m != (CellKind::Tet10, Projection::Element)) {
        let (cells, order, allowed) =
            if method.0.order() == 1 { ([4, 8], 2.0, 2e-2) } else { ([2, 4], 3.0, 2e-4) };
        let [coarse, fine] = cells.map(|n| bend(&exact, method, n));
        let found = (coarse / fine).log2();
        assert!(found > order - 0.4, "{method:?}: order {found} of {coarse:e}, {fine:e}");
        assert!(fine < allowed, "{method:?}: {fine:e}");
    }
}
