//! Every tool shape: a distance with its derivatives, inside and outside, with finite values on the medial
//! axis.

use contact::{Capsule, Cylinder, Distance, Plate, RoundedBox, Sphere, TOOL_SHAPES, ToolShape};
use integration::tools::{BOXED, SHAPES, differences, kink, vector};
use proptest::prelude::*;
use shape::Vector3;

/// Whether `p` is inside the shape, by the shape's own definition.
fn inside(shape: &ToolShape, p: &Vector3) -> bool {
    let rho = p.x.hypot(p.y);
    match *shape {
        ToolShape::RoundedSurface(_) => inside(&BOXED, p),
        ToolShape::Plate(Plate) => p.z < 0.0,
        // Within the rounding radius of the core box, or without rounding within the box itself.
        ToolShape::RoundedBox(RoundedBox { half, radius }) => {
            let core = Vector3::from_fn(|a, _| p[a].clamp(radius - half[a], half[a] - radius));
            if radius > 0.0 { (p - core).norm() < radius } else { (0..3).all(|a| p[a].abs() < half[a]) }
        }
        ToolShape::Sphere(Sphere { radius }) => p.norm() < radius,
        ToolShape::Cylinder(Cylinder { radius, half_length }) => rho < radius && p.z.abs() < half_length,
        ToolShape::Capsule(Capsule { radius, half_length }) => {
            let nearest = Vector3::new(0.0, 0.0, p.z.clamp(-half_length, half_length));
            (p - nearest).norm() < radius
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    #[test]
    fn distances_are_distances(p in vector(13e-3)) {
        for shape in SHAPES.iter() {
            let Distance { value, gradient, hessian } = shape.distance(&p);
            prop_assert!((gradient.norm() - 1.0).abs() < 1e-14, "{shape:?}");
            prop_assert_eq!(value < 0.0, inside(shape, &p), "{:?} {}", shape, value);
            // The nearest surface point lies on the surface and within the bounds.
            let foot = p - gradient * value;
            prop_assert!(shape.distance(&foot).value.abs() < 1e-16, "{shape:?}");
            let (low, high) = shape.bounds();
            for a in 0..3 {
                prop_assert!(foot[a] >= low[a] - 1e-16 && foot[a] <= high[a] + 1e-16, "{shape:?}");
            }
            prop_assert!(value >= -shape.inradius());
            // The gradient has constant length, so the Hessian has no component along it.
            prop_assert_eq!(hessian, hessian.transpose());
            prop_assert!((hessian * gradient).norm() < 1e-13 * hessian.norm().max(1.0), "{shape:?}");
        }
    }

    #[test]
    fn gradient_and_hessian_are_the_derivatives(p in vector(13e-3)) {
        // Steps of 1e-7 m at 3e-4 m from a kink or centre, where the Hessian is at most 1 / 3e-4. The
        // truncation error is (1e-7 / 3e-4)^2 = 1e-7 relative, the rounding error 1e-2 * 1e-16 / 1e-7 =
        // 1e-11.
        let h = 1e-7;
        for shape in SHAPES.iter().filter(|s| kink(s, &p) > 3e-4) {
            let Distance { gradient, hessian, .. } = shape.distance(&p);
            for a in 0..3 {
                let mut step = Vector3::zeros();
                step[a] = h;
                let slope = (shape.distance(&(p + step)).value - shape.distance(&(p - step)).value) / (2.0 * h);
                prop_assert!((slope - gradient[a]).abs() < 1e-6, "{shape:?}");
            }
            let slopes = differences(h, |step| shape.distance(&(p + step)).gradient);
            prop_assert!((slopes - hessian).norm() < 1e-6 * hessian.norm() + 1e-6, "{shape:?} {slopes} {hessian}");
        }
    }
}

#[test]
fn every_shape_that_a_scene_can_name_is_in_the_list() {
    for entry in TOOL_SHAPES {
        assert!(SHAPES.iter().any(|shape| shape.name() == entry.name), "{}", entry.name);
    }
}

/// Centres, axes, faces, edges of the core and ties: a unit gradient and finite numbers everywhere.
#[test]
fn medial_points_have_a_defined_branch() {
    let values = [0.0, 1e-300, 1e-160, 1e-20, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 4e-3, 5e-3, 6e-3, 8.5e-3];
    let signed: Vec<f64> = values.iter().flat_map(|&v| [v, -v]).collect();
    for shape in SHAPES.iter() {
        for &x in &signed {
            for &y in &signed {
                for &z in &signed {
                    let d = shape.distance(&Vector3::new(x, y, z));
                    assert!((d.gradient.norm() - 1.0).abs() < 1e-12, "{shape:?} {x} {y} {z}: {d:?}");
                    assert!(
                        d.value.is_finite() && d.hessian.iter().all(|h| h.is_finite()),
                        "{shape:?} {d:?}"
                    );
                }
            }
        }
    }
    let at = |shape: ToolShape, x, y, z| shape.distance(&Vector3::new(x, y, z)).gradient;
    assert_eq!(at(SHAPES[1].clone(), 0.0, 0.0, 0.0), Vector3::z(), "the nearest face of 5, 10, 4 mm");
    assert_eq!(at(SHAPES[3].clone(), 0.0, 0.0, 0.0), Vector3::z());
    assert_eq!(at(SHAPES[4].clone(), 0.0, 0.0, 1e-3), Vector3::x());
    assert_eq!(at(SHAPES[5].clone(), 0.0, 0.0, 1e-3), Vector3::x());
}

/// The bounds touch the tool on every side, i.e. they are as small as possible.
#[test]
fn bounds_are_tight() {
    for shape in &SHAPES[1..] {
        let (low, high) = shape.bounds();
        for a in 0..3 {
            for end in [low[a], high[a]] {
                let mut p = Vector3::zeros();
                p[a] = end;
                assert!(shape.distance(&p).value.abs() < 1e-17, "{shape:?} {p}");
            }
        }
    }
}

#[test]
fn the_jaw_of_the_kidney_case() {
    // sd(p) = |max(q, 0)| + min(max(q), 0) - r computed by hand, half (5, 10, 4), r 1.5 mm.
    let jaw = SHAPES[1].clone();
    let near = |x: f64, y: f64| (x - y).abs() < 1e-17;
    let mm = |x: f64, y: f64, z: f64| jaw.distance(&(Vector3::new(x, y, z) * 1e-3)).value;
    assert!(
        near(mm(0.0, 0.0, -4.0), 0.0) && near(mm(0.0, 0.0, -5.0), 1e-3) && near(mm(0.0, 0.0, 0.0), -4e-3)
    );
    // 3 and 4 mm beyond the core's edge: 5 - 1.5.
    assert!(near(mm(6.5, 0.0, 6.5), 3.5e-3));
}
