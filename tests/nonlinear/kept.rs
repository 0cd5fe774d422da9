//! Factors that Newton's method keeps from one tangent to the next.
//!
//! ```text
//! Source      none: the same problem with a factor of every tangent in double precision
//! Body        jittered box, tet10 and hex8 with one dilation per element; neo-Hookean, nu = 0.45
//! Conditions  two rough plates move by 1 and 3 mm; no normal displacement at x = 0 and y = 0
//! Must hold   Forces, displacements and reported stability agree with those of new factors (1e-8), with
//!             fewer factors than tangents.
//! ```

use contact::ContactLaw;
use geometry::CellKind;
use integration::model::*;
use material::{Law, NeoHookean};
use statics::{LinearSystems, NewtonParams, StaticParams};

use crate::contact_patch::press_by;

#[test]
fn kept_factors_lead_to_the_same_end() {
    let tet10 = ((CellKind::Tet10, Projection::Standard), [6, 4, 3]);
    let hex8 = ((CellKind::Hex8, Projection::Element), [9, 6, 5]);
    for (method, cells) in [tet10, hex8] {
        let model = Model::block(method, cells);
        let law = Law::NeoHookean(NeoHookean::new(YOUNG, 0.45).unwrap());
        let rough = ContactLaw::coulomb(1e7, 0.15, 1e6).unwrap();
        let path = |keeps: f64, loosest: Option<f64>| {
            let newton = NewtonParams { keeps, loosest, chords: false, ..steps(4).newton };
            press_by(
                &model,
                &law,
                rough,
                (&format!("{method:?}"), LinearSystems::Factored),
                &StaticParams { newton, ..steps(4) },
            )
            .0
        };
        let anew = path(f64::INFINITY, None);
        for loosest in [Some(NewtonParams::LOOSEST), None] {
            let kept = path(0.0, loosest);
            assert_eq!(anew.steps.len(), kept.steps.len());
            for (a, b) in anew.steps.iter().zip(&kept.steps) {
                assert_eq!(
                    (a.stable, a.gave_way),
                    (b.stable, b.gave_way),
                    "{method:?}: {:?} {:?}",
                    a.iterations,
                    b.iterations
                );
                for (a, b) in a.tools.iter().zip(&b.tools) {
                    assert!(
                        (a.force - b.force).norm() < 1e-8 * a.force.norm(),
                        "{method:?}: {} {}",
                        a.force,
                        b.force
                    );
                }
            }
            let far = anew.u.iter().zip(&kept.u).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            assert!(far < 1e-8 * 3e-3, "{method:?}: {far}");
            assert!(anew.work.factorisations >= anew.work.assemblies, "{:?}", anew.work);
            // One factor in double precision at the end of each step shows that the step is stable.
            let work = kept.work;
            assert!(
                work.factorisations < work.assemblies && work.factorisations >= 4 && work.inner > 0,
                "{work:?} {:?}",
                anew.work
            );
        }
    }
}
