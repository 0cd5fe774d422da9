//! Artificial surfaces of a kidney, at rest and between jaws.

use records::{Family, Section, SectionCell, SurfaceField, ToolHull};

/// A ball mapped to a bean, compressed in the middle of its length.
pub fn bean((method, family): (&str, Family), title: &str, n: u32, amplitude: f64) -> SurfaceField {
    let (mut points, mut displacement, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    let around = 2 * n;
    for i in 0..=n {
        for j in 0..around {
            let (t, p) = (
                std::f64::consts::PI * i as f64 / n as f64,
                std::f64::consts::TAU * j as f64 / around as f64,
            );
            let (x, y, z) = (t.sin() * p.cos(), t.cos(), t.sin() * p.sin());
            points.push([16e-3 * x + 16e-3 * y * y, 37.5e-3 * y, 15e-3 * z]);
            let press = (-8.0 * (y + 0.5) * (y + 0.5)).exp();
            displacement.push([amplitude * 0.5 * press, -amplitude * 0.2 * press, -amplitude * z * press]);
        }
    }
    for i in 0..n {
        for j in 0..around {
            let at = |i: u32, j: u32| i * around + j % around;
            let (a, b, c, d) = (at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
            triangles.push([a, b, c]);
            triangles.push([b, d, c]);
        }
    }
    SurfaceField {
        case: "kidney-paper".into(),
        method: method.into(),
        family,
        title: title.into(),
        points,
        triangles,
        displacement,
        tools: Vec::new(),
        section: None,
        body: None,
    }
}

/// The bean between two jaws, with its middle plane divided into squares of alternating pressure.
pub fn grasped(of @ (method, _): (&str, Family), wild: f64) -> SurfaceField {
    let jaw = |side: f64| ToolHull {
        name: "jaw".into(),
        points: (0..8)
            .map(|k| {
                let at = |bit: u32, half: f64| if k >> bit & 1 == 0 { -half } else { half };
                [at(0, 5e-3), at(1, 10e-3), side * 18e-3 + at(2, 4e-3)]
            })
            .collect(),
    };
    let mut cells = Vec::new();
    for i in -12..12 {
        for j in -5..5 {
            let (y, z) = (3e-3 * f64::from(i), 3e-3 * f64::from(j));
            let corner = |a: f64, b: f64| [0.0, y + 3e-3 * a, z + 3e-3 * b];
            let sign = if (i + j) % 2 == 0 { 1.0 } else { -1.0 };
            let pressure = 4e3 * (-(y / 15e-3).powi(2)).exp() + sign * wild;
            let corners = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
            cells.push(SectionCell { corners, pressure });
        }
    }
    SurfaceField {
        case: "kidney-grasped".into(),
        tools: vec![jaw(1.0), jaw(-1.0)],
        section: Some(Section { right: [0.0, 0.0, -1.0], up: [0.0, 1.0, 0.0], cells }),
        ..bean(of, &format!("{method} (99 nodes)"), 12, 6e-3)
    }
}
