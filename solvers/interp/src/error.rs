//! What makes a transfer impossible. Lengths in metres.

use shape::ShapeError;

/// What makes a transfer impossible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InterpError {
    /// Fewer nodes than the scheme needs.
    #[error("{scheme} needs at least {needed} nodes; there are {found}")]
    TooFewNodes {
        /// Scheme.
        scheme: &'static str,
        /// Nodes given.
        found: usize,
        /// Nodes needed.
        needed: usize,
    },
    /// A coordinate that is not a finite number.
    #[error("{what} {index} has a coordinate that is not finite")]
    NotFinite {
        /// `"node"` or `"target"`.
        what: &'static str,
        /// Its index.
        index: usize,
    },
    /// A parameter outside its range.
    #[error("{what} is {value}; {allowed} is needed")]
    BadParameter {
        /// Which parameter.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed, in words.
        allowed: &'static str,
    },
    /// Two nodes at (almost) one place: an interpolant has two values to meet there.
    #[error(
        "{scheme}: nodes {first} and {second} are {distance:e} m apart in a cloud of half-extent {extent:e} m; \
         the system is singular to working precision (pivot ratio {pivot_ratio:e})"
    )]
    CoincidentNodes {
        /// Scheme.
        scheme: &'static str,
        /// Lower index of the closest pair.
        first: usize,
        /// Higher index of the closest pair.
        second: usize,
        /// Their distance, m.
        distance: f64,
        /// Half-extent of the cloud, m.
        extent: f64,
        /// Smallest over largest pivot of the factorisation; zero if the distance alone decided.
        pivot_ratio: f64,
    },
    /// Radial functions so wide that those of neighbouring nodes can't be told apart.
    #[error(
        "{scheme}: {what} {width} (in mean spacings of the nodes) makes a system so nearly singular that values at \
         the nodes are missed by {miss:e} of themselves; take less"
    )]
    TooWide {
        /// Scheme.
        scheme: &'static str,
        /// What the width is called.
        what: &'static str,
        /// Width over mean spacing.
        width: f64,
        /// Largest difference between values of 1 and -1 given at the nodes and those found there; infinite if the
        /// system is not positive definite.
        miss: f64,
    },
    /// Nodes in one plane (or line, or point): they determine no linear field in space.
    #[error("{scheme}: the nodes lie in one plane (thickness {thickness:e} m, half-extent {extent:e} m)")]
    FlatCloud {
        /// Scheme.
        scheme: &'static str,
        /// Root-mean-square distance from the best plane, m.
        thickness: f64,
        /// Half-extent of the cloud, m.
        extent: f64,
    },
    /// A dense table that would not fit into memory.
    #[error(
        "{scheme}: {nodes} nodes and {targets} targets make a dense table of {entries} entries; \
         at most {limit} are allowed"
    )]
    TooLarge {
        /// Scheme.
        scheme: &'static str,
        /// Nodes given.
        nodes: usize,
        /// Targets given.
        targets: usize,
        /// Entries of system and table.
        entries: usize,
        /// Most entries allowed.
        limit: usize,
    },
    /// A scheme without gradients in closed form.
    #[error(
        "{scheme} has no gradients; moving least squares, radial bases and barycentric interpolation have"
    )]
    NoGradient {
        /// Scheme.
        scheme: &'static str,
    },
    /// A scheme that needs a mesh, without one.
    #[error("{scheme} needs a mesh of tetrahedra over the nodes; none is given")]
    NeedsMesh {
        /// Scheme.
        scheme: &'static str,
    },
    /// A mesh of other nodes than those given.
    #[error("the {nodes} nodes are not the {mesh} points of the mesh: they differ from number {first} on")]
    MeshMismatch {
        /// Points of the mesh.
        mesh: usize,
        /// Nodes given.
        nodes: usize,
        /// First index at which they differ.
        first: usize,
    },
    /// A mesh in which nothing can be located: other cells than tetrahedra, or flat ones.
    #[error(transparent)]
    Locate(#[from] geometry::LocateError),
    /// Nodes without a spacing: two of them in one place.
    #[error(transparent)]
    Cloud(#[from] geometry::CloudError),
    /// More nodes than can be searched.
    #[error(transparent)]
    Search(#[from] geometry::SearchError),
    /// Moving least squares failed.
    #[error(transparent)]
    Mls(#[from] efg::EfgError),
    /// A table that breaks a promise.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}
