//! Errors of clouds.

use crate::search::SearchError;

/// Errors of cloud generation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CloudError {
    /// Fewer nodes than the least number.
    #[error("a cloud of {nodes} nodes was requested; at least {least} are needed")]
    TooFew {
        /// Number asked for.
        nodes: usize,
        /// Least number.
        least: usize,
    },
    /// More nodes than the generator supports.
    #[error("a cloud of {nodes} nodes was requested; at most {most} can be generated")]
    TooMany {
        /// Number asked for.
        nodes: usize,
        /// Largest number.
        most: usize,
    },
    /// A refinement parameter outside its range.
    #[error("{what} of refinement {index} is {found}; it has to be {needed}")]
    Refinement {
        /// Index in the list given.
        index: usize,
        /// Name of the parameter.
        what: &'static str,
        /// Value of the parameter.
        found: f64,
        /// Admissible range, in words.
        needed: &'static str,
    },
    /// A body whose bounding box is empty or not finite.
    #[error(
        "the body's bounding box measures {x} x {y} x {z} m; a cloud needs a body of nonzero extent \
         along every axis"
    )]
    NoExtent {
        /// Extent along x (m).
        x: f64,
        /// Extent along y (m).
        y: f64,
        /// Extent along z (m).
        z: f64,
    },
    /// Two nodes at the same position.
    #[error("nodes {first} and {second} are at the same position")]
    Coincident {
        /// Lower index.
        first: usize,
        /// Higher index.
        second: usize,
    },
    /// Nodes that cannot be searched.
    #[error(transparent)]
    Search(#[from] SearchError),
}
