//! Integration rules of clouds.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::report::Report;
use crate::scene::units::{Length, Q};

#[derive(Deserialize, JsonSchema)]
#[serde(tag = "rule", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum IntegrationKeys {
    /// Gauss points in the tetrahedra or hexahedra of the background mesh
    Gauss {
        /// Points per cell; tetrahedra have rules of 1, 4, 8, 14, 15, 24, 35 and 46 points
        points: u32,
    },
    /// Gauss points in the cells of a grid, without the points outside the body
    Grid {
        /// Points per cell, a cube number
        points: u32,
        /// Edge length of a cell; the mean node spacing unless given
        spacing: Option<Q<Length>>,
    },
    /// Conforming strain smoothing over the tetrahedra of the background mesh
    CellSmoothed {
        /// Points per face: 1, 3 or 6; 1 unless given, and 6 with order 2
        points: Option<u32>,
        /// Order of exactness: 1 (unless given) for linear displacements, 2 for quadratic displacements
        /// (variationally consistent integration of second order), as the quadratic basis requires
        order: Option<u32>,
    },
    /// Strain smoothing over the quarters of the tetrahedra around each vertex of the background mesh
    NodeSmoothed {
        /// Fraction of the weight that stays on the tetrahedra, from 0 to below 1; 0.05 is usual
        stabilisation: f64,
        /// Points per face: 1, 3 or 6; 1 unless given
        points: Option<u32>,
    },
}

/// Integration rules of element-free Galerkin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// Gauss points in the cells of the background mesh.
    Gauss {
        /// Points per cell.
        points: usize,
    },
    /// Gauss points in the cells of a grid, without the points outside the body.
    Grid {
        /// Points per cell, a cube number.
        points: usize,
        /// Edge length of a cell in metres; the mean node spacing if `None`.
        spacing: Option<f64>,
    },
    /// Conforming smoothing over the tetrahedra of the background mesh.
    CellSmoothed {
        /// Order of exactness: 1 for linear displacements (constant gradients per cell), 2 for quadratic ones
        /// (linear gradients).
        order: u32,
        /// Points per face: 1, 3 or 6.
        face_points: usize,
    },
    /// Smoothing over the quarters of the tetrahedra around each vertex of the background mesh.
    NodeSmoothed {
        /// Share of the weight that stays on the tetrahedra, from 0 to below 1.
        stabilisation: f64,
        /// Points per face: 1, 3 or 6.
        face_points: usize,
    },
}

impl IntegrationKeys {
    pub fn read(self, report: &Report) -> Integration {
        match self {
            IntegrationKeys::Gauss { points } => {
                let help = "a tetrahedron has rules of 1, 4, 8, 14, 15, 24, 35 and 46 points";
                report.require(points > 0, "points", "is zero", help);
                Integration::Gauss { points: points as usize }
            }
            IntegrationKeys::Grid { points, spacing } => {
                let sound = (1u32..=10).any(|n| n.pow(3) == points);
                let help = "points per grid cell are 1, 8, 27, 64, ... 1000";
                report.require(sound, "points", "is not a cube number", help);
                let spacing = spacing.map(|q| report.positive("spacing", q.0));
                Integration::Grid { points: points as usize, spacing }
            }
            IntegrationKeys::CellSmoothed { points, order } => {
                let order = order.unwrap_or(1);
                let help = "1 is exact for linear displacements, 2 for quadratic displacements";
                report.require([1, 2].contains(&order), "order", "is not known", help);
                let points = points.unwrap_or(if order == 2 { 6 } else { 1 });
                let sound = order != 2 || ![1, 3].contains(&points);
                let help = "6 points per face have the required degree";
                report.require(sound, "points", "is too coarse for order 2", help);
                Integration::CellSmoothed { order, face_points: face_points(points, report) }
            }
            IntegrationKeys::NodeSmoothed { stabilisation, points } => {
                let sound = (0.0..1.0).contains(&stabilisation);
                let help = "0 is none, 0.05 is usual; for the full weight take rule = \"cell-smoothed\"";
                report.require(sound, "stabilisation", "is not a valid fraction of the weight", help);
                let face_points = face_points(points.unwrap_or(1), report);
                Integration::NodeSmoothed { stabilisation, face_points }
            }
        }
    }
}

fn face_points(points: u32, report: &Report) -> usize {
    let sound = [1, 3, 6].contains(&points);
    report.require(sound, "points", "is not a face rule", "points per face are 1, 3 or 6");
    points as usize
}
