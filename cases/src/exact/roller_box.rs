//! A box on rollers all around: every mode of vibration in closed form.
//!
//! ```text
//! Source      separation of variables (Graff, Wave Motion in Elastic Solids, 1975, ch. 5: plane waves
//!             between smooth walls)
//!
//!     o o o o
//!   o +-------+ o
//!   o |       | o      from the origin to (L1, L2, L3); faces slip freely and do not move along their normal
//!   o +-------+ o
//!     o o o o
//!
//! Fields      u = cos(omega t) (A sin ax cos by cos cz, B cos ax sin by cos cz, C cos ax cos by sin cz),
//!             (a, b, c) = k = pi (i / L1, j / L2, l / L3),  i, j, l = 0, 1, 2 ...
//! Frequency   compression, (A, B, C) along k:   omega = |k| sqrt((lambda + 2 mu) / rho)
//!             shear, (A, B, C) across k:        omega = |k| sqrt(mu / rho)
//! Conditions  u_x = 0 on the faces across x, and sigma_xy, sigma_xz there are products of sin ax.
//! Must hold   each k has one mode of compression and, if n of i, j, l are positive, n - 1 of shear: a
//!             component with the number zero vanishes. These fields are a basis, so there is no other mode,
//!             and none at zero frequency.
//! ```

use std::f64::consts::PI;

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::error::ExactError;
use super::solution::{Exact, SolutionEntry, Vibrations, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// The lowest mode. As a field it is fixed at its largest amplitude until [`Exact::at`] sets a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollerBox {
    elastic: Elastic,
    size: [f64; 3],
    density: f64,
    amplitude: f64,
    time: f64,
}

/// A mode of vibration.
#[derive(Clone, Copy)]
struct Mode {
    omega: f64,
    /// Wave vector `k`, 1/m.
    wave: Vector3,
    /// `(A, B, C)`, of length 1.
    along: Vector3,
}

impl RollerBox {
    /// A box at time 0 with the given sides (m), density (kg/m^3) and amplitude (m).
    ///
    /// # Errors
    ///
    /// A side or density that is not positive.
    pub fn new(
        elastic: Elastic,
        size: [f64; 3],
        density: f64,
        amplitude: f64,
    ) -> Result<RollerBox, ExactError> {
        let [x, y, z] = size;
        for (name, value) in [("length", x), ("depth", y), ("width", z), ("density", density)] {
            if !(value > 0.0 && value.is_finite()) {
                let need = "above zero".into();
                return Err(ExactError::BadParameter { solution: ENTRY.name, name, value, need });
            }
        }
        Ok(RollerBox { elastic, size, density, amplitude, time: 0.0 })
    }

    /// Frequencies of compression and of shear (rad/s) for three numbers of half waves, with the wave vector.
    fn of(&self, numbers: [usize; 3]) -> (f64, f64, Vector3) {
        let wave = Vector3::from_fn(|a, _| PI * numbers[a] as f64 / self.size[a]);
        let (lambda, mu) = (self.elastic.lambda(), self.elastic.mu());
        let speed = |modulus: f64| (modulus / self.density).sqrt();
        (wave.norm() * speed(lambda + 2.0 * mu), wave.norm() * speed(mu), wave)
    }

    /// The lowest mode: one half wave of compression along the longest side, or of shear along each of the
    /// two longest.
    fn first(&self) -> Mode {
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| self.size[b].total_cmp(&self.size[a]));
        let [mut one, mut two] = [[0; 3]; 2];
        one[axes[0]] = 1;
        (two[axes[0]], two[axes[1]]) = (1, 1);
        let (compression, _, along) = self.of(one);
        let (_, shear, wave) = self.of(two);
        if compression < shear {
            return Mode { omega: compression, wave: along, along: along.normalize() };
        }
        let mut across = Vector3::zeros();
        (across[axes[0]], across[axes[1]]) = (wave[axes[1]], -wave[axes[0]]);
        Mode { omega: shear, wave, along: across.normalize() }
    }

    fn now(&self) -> f64 {
        self.amplitude * (self.omega() * self.time).cos()
    }
}

impl Mode {
    /// Displacement of the mode, with amplitude 1.
    fn value(&self, p: &Point3) -> Vector3 {
        let (sin, cos) = self.waves(p);
        Vector3::from_fn(|i, _| self.along[i] * sin[i] * cos[(i + 1) % 3] * cos[(i + 2) % 3])
    }

    /// Displacement gradient of the mode, 1/m.
    fn slope(&self, p: &Point3) -> Matrix3 {
        let (sin, cos) = self.waves(p);
        Matrix3::from_fn(|i, j| {
            let factor = |axis: usize| match (axis == i, axis == j) {
                (true, true) => self.wave[axis] * cos[axis],
                (true, false) => sin[axis],
                (false, true) => -self.wave[axis] * sin[axis],
                (false, false) => cos[axis],
            };
            self.along[i] * factor(0) * factor(1) * factor(2)
        })
    }

    fn waves(&self, p: &Point3) -> (Vector3, Vector3) {
        let phase = self.wave.component_mul(&p.coords);
        (phase.map(f64::sin), phase.map(f64::cos))
    }
}

impl Exact for RollerBox {
    fn displacement(&self, p: &Point3) -> Vector3 {
        self.first().value(p) * self.now()
    }

    fn gradient(&self, p: &Point3) -> Matrix3 {
        self.first().slope(p) * self.now()
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic.stress(&self.gradient(x))
    }

    fn body_force(&self, p: &Point3) -> Vector3 {
        self.displacement(p) * (self.density * self.omega().powi(2))
    }

    fn at(&self, time: f64) -> Option<Box<dyn Exact>> {
        Some(Box::new(RollerBox { time, ..*self }))
    }

    fn vibrations(&self) -> Option<&dyn Vibrations> {
        Some(self)
    }
}

impl Vibrations for RollerBox {
    fn omega(&self) -> f64 {
        self.first().omega
    }

    fn shapes(&self, x: &Point3) -> Vec<Vector3> {
        vec![self.first().value(x)]
    }

    fn lowest(&self, count: usize) -> Option<Vec<f64>> {
        // Shear modes with one half wave along y and 1 to `count` along x: these `count` modes are no faster
        // than this.
        let highest = self.of([count, 1, 0]).1 * (1.0 + 1e-9);
        let mut modes = Vec::new();
        let within = |axis: usize, numbers: [usize; 3]| {
            let mut alone = [0; 3];
            alone[axis] = numbers[axis];
            self.of(alone).1 <= highest
        };
        for i in (0..).take_while(|&i| within(0, [i, 0, 0])) {
            for j in (0..).take_while(|&j| within(1, [0, j, 0])) {
                for l in (0..).take_while(|&l| within(2, [0, 0, l])) {
                    let numbers = [i, j, l];
                    let alive = numbers.iter().filter(|&&n| n > 0).count();
                    if alive == 0 {
                        continue;
                    }
                    let (compression, shear, _) = self.of(numbers);
                    modes.push(compression);
                    modes.extend(std::iter::repeat_n(shear, alive - 1));
                }
            }
        }
        modes.sort_by(f64::total_cmp);
        modes.truncate(count);
        Some(modes)
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "roller-box",
    meaning: "vibrations of a box with rollers on all faces",
    source: "Graff, Wave Motion in Elastic Solids (1975), ch. 5",
    parameters: &[
        Parameter::required("length", Dimension::Length, "side along x, from 0"),
        Parameter::required("depth", Dimension::Length, "side along y, from 0"),
        Parameter::required("width", Dimension::Length, "side along z, from 0"),
        Parameter::required("density", Dimension::Density, "mass per volume"),
        Parameter::default("amplitude", Dimension::Length, 1e-3, "approximate largest displacement"),
    ],
    build: |medium, values| {
        let [length, depth, width] = numbers(values, ["length", "depth", "width"])?;
        let [density, amplitude] = numbers(values, ["density", "amplitude"])?;
        Ok(Box::new(RollerBox::new(medium.elastic, [length, depth, width], density, amplitude)?))
    },
};
