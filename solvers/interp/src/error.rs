//! Errors of a transfer. Lengths are in metres.

use shape::ShapeError;

/// Reason why a transfer is impossible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InterpError {
    /// Fewer nodes than the scheme needs.
    #[error("{scheme} needs at least {needed} nodes; {found} are given")]
    TooFewNodes {
        /// Scheme.
        scheme: &'static str,
        /// Number of nodes given.
        found: usize,
        /// Number of nodes needed.
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
        /// Name of the parameter.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Description of the allowed values.
        allowed: &'static str,
    },
    /// Two nodes at (almost) the same place, at which an interpolant would need two values.
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
    /// Radial functions so wide that those of neighbouring nodes cannot be distinguished.
    #[error(
        "{scheme}: {what} {width} (in mean node spacings) makes the system nearly singular: the values at \
         the nodes are reproduced with a relative error of {miss:e} only; take a smaller value"
    )]
    TooWide {
        /// Scheme.
        scheme: &'static str,
        /// Name of the width.
        what: &'static str,
        /// Ratio of width to mean spacing.
        width: f64,
        /// Largest error of the values at the nodes for given values of 1 and -1; infinite if the system is
        /// not positive definite.
        miss: f64,
    },
    /// Nodes in a plane, on a line or at a point, which do not determine a linear field in space.
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
        "{scheme}: {nodes} nodes and {targets} targets give a dense table of {entries} entries; at most \
         {limit} are allowed"
    )]
    TooLarge {
        /// Scheme.
        scheme: &'static str,
        /// Number of nodes given.
        nodes: usize,
        /// Number of targets given.
        targets: usize,
        /// Number of entries of system and table.
        entries: usize,
        /// Largest allowed number of entries.
        limit: usize,
    },
    /// A scheme without gradients in closed form.
    #[error(
        "{scheme} has no gradients; take moving least squares, a radial basis or barycentric interpolation"
    )]
    NoGradient {
        /// Scheme.
        scheme: &'static str,
    },
    /// A scheme that needs a mesh but was given none.
    #[error("{scheme} needs a mesh of tetrahedra over the nodes, but no mesh is given")]
    NeedsMesh {
        /// Scheme.
        scheme: &'static str,
    },
    /// A mesh whose points differ from the nodes.
    #[error(
        "the {nodes} nodes are not the {mesh} points of the mesh: the first difference is at number \
         {first}"
    )]
    MeshMismatch {
        /// Number of points of the mesh.
        mesh: usize,
        /// Number of nodes given.
        nodes: usize,
        /// First index at which they differ.
        first: usize,
    },
    /// A mesh in which points cannot be located, because it has other cells than tetrahedra or flat cells.
    #[error(transparent)]
    Locate(#[from] geometry::LocateError),
    /// Nodes without a spacing, because two of them coincide.
    #[error(transparent)]
    Cloud(#[from] geometry::CloudError),
    /// More nodes than the search supports.
    #[error(transparent)]
    Search(#[from] geometry::SearchError),
    /// Moving least squares failed.
    #[error(transparent)]
    Mls(#[from] efg::EfgError),
    /// A table that violates its own conditions.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}
