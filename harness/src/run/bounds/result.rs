//! Results with their bounds.

use geometry::Vector3;

/// Two numbers that enclose the value of the exact solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bracket {
    /// Never above the exact value.
    pub lower: f64,
    /// Never below the exact value.
    pub upper: f64,
}

impl Bracket {
    /// Half the width divided by the larger magnitude of both ends' mean and the width, so that it is at most
    /// 1.
    pub fn half_width(&self) -> f64 {
        let (half, middle) = ((self.upper - self.lower) / 2.0, (self.upper + self.lower) / 2.0);
        if half == 0.0 { 0.0 } else { half / middle.abs().max(half) }
    }

    /// Distance of a value from the nearest value inside, relative to that value and with its sign; 0 inside.
    pub fn excess(&self, value: f64) -> f64 {
        let inside = value.clamp(self.lower, self.upper);
        if value == inside { 0.0 } else { (value - inside) / inside.abs() }
    }

    /// Multiplies both ends by a positive factor.
    pub fn scaled(&self, factor: f64) -> Bracket {
        Bracket { lower: factor * self.lower, upper: factor * self.upper }
    }
}

/// A bounded result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bounded {
    /// Strain energy, J.
    Energy,
    /// Force of the only moving support, which moves rigidly, along its motion, N.
    Force {
        /// Number of the support, from 0.
        support: usize,
        /// Unit vector of its motion.
        along: Vector3,
    },
    /// Mean displacement, along the only load, a uniform one, of the faces on which it acts, m.
    Displacement,
    /// Component of a mean displacement of `output.means`, m.
    Mean {
        /// Number of the mean, from 0.
        index: usize,
        /// Axis: 0, 1, 2 for x, y, z.
        axis: usize,
    },
}

/// Bounds on one mesh.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    /// All bounded results, the energy first.
    pub results: Vec<(Bounded, Bracket)>,
    /// Number of vertices of the tetrahedra.
    pub vertices: usize,
    /// Number of tetrahedra.
    pub cells: usize,
    /// Unknowns of the displacement field and of the stress field.
    pub dofs: [usize; 2],
}
