//! Errors of sizes that wrap nothing.

use crate::surface::digits::rounded;

/// Problem of the size of a wrap.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WrapProblem {
    /// A size that is not positive and finite.
    #[error("the size of the wrap is {size} m; it has to be positive and finite")]
    Size {
        /// Size, m.
        size: f64,
    },
    /// Cells as large as the triangles' bounding box.
    #[error(
        "the size of the wrap, {} m, is larger than the body: its smallest extent is {} m; give a fraction of it",
        rounded(*size), rounded(*narrowest)
    )]
    Coarse {
        /// Size, m.
        size: f64,
        /// Smallest extent of the triangles, m.
        narrowest: f64,
    },
    /// Too many cells.
    #[error(
        "a wrap of {} m takes {points:.1e} lattice points, which is too many; give {} m or more",
        rounded(*size), rounded(*least)
    )]
    Fine {
        /// Size, m.
        size: f64,
        /// Number of lattice points.
        points: f64,
        /// Smallest size, m.
        least: f64,
    },
    /// No inner point of the lattice.
    #[error(
        "a wrap of {} m encloses nothing: the triangles surround no position, or only parts thinner than the wrap; \
         give a smaller size, or a surface that surrounds a body",
        rounded(*size)
    )]
    Empty {
        /// Size, m.
        size: f64,
    },
}
