//! Patch test at finite strain.
//!
//! ```text
//! Source      Irons' patch test; Belytschko, Liu & Moran, Nonlinear Finite Elements (2000), ch. 8.3.
//! Body        jittered box of 2 x 2 x 2 cells, every law, every method.
//! Conditions  u = (F - I) x on the whole boundary, F = R U, with U of the stretches 2, 0.5 and 1.3 about
//!             oblique axes and R a quarter turn. u is linear in time, so every F on the way is affine too
//!             (det F >= 0.3).
//! Must hold   u = (F - I) x inside, P = P(F) at every quadrature point, and the energy V W(F): 1e-10; the
//!             pressure of the mixed method is P : F / (3 J) everywhere.
//! ```

use integration::model::*;
use material::Material as _;
use shape::{Matrix3, Point3, Vector3};
use statics::StaticProblem;

/// Returns a quarter turn about z times a stretch with the principal values 2, 0.5, 1.3, rotated by 0.3 about
/// x.
fn deformation() -> Matrix3 {
    let quarter = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let (s, c) = 0.3f64.sin_cos();
    let oblique = Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c);
    let stretch = Matrix3::from_diagonal(&Vector3::new(2.0, 0.5, 1.3));
    quarter * oblique * stretch * oblique.transpose()
}

#[test]
fn affine_deformations_are_exact_at_any_size() {
    let gradient = deformation() - Matrix3::identity();
    let field = |x: &Point3| gradient * x.coords;
    for method in METHODS {
        let model = Model::block(method, [2, 2, 2]);
        let fixed = model.hold(&ALL_SIDES, &[0, 1, 2], field);
        for law in laws(YOUNG, 0.45) {
            let name = format!("{method:?} {}", law.name());
            let problem = StaticProblem { fixed: &fixed, ..model.problem(&law) };
            let path = solve(&name, &problem, &steps(4));
            let error = model.error(&path.u, field);
            assert!(error < 1e-12, "{name}: displacement off by {error:e}");
            let exact = law.stress(&gradient);
            for (q, found) in model.volume.at().displacement_gradients(&path.u).iter().enumerate() {
                let error = (law.stress(found) - exact).norm() / exact.norm();
                assert!(error < 1e-10, "{name}: stress off by {error:e} at point {q}");
            }
            let volume: f64 = model.volume.weights().iter().sum();
            let (energy, found) = (volume * law.energy(&gradient), path.steps.last().unwrap().energy);
            assert!((found / energy - 1.0).abs() < 1e-10, "{name}: energy {found} for {energy}");
            let pressure = if law.is_small_strain() {
                exact.trace() / 3.0
            } else {
                exact.dot(&deformation()) / (3.0 * deformation().determinant())
            };
            for found in &path.pressure {
                assert!((found / pressure - 1.0).abs() < 1e-10, "{name}: pressure {found} for {pressure}");
            }
        }
    }
}
