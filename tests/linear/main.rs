//! Linear statics: patch tests, stiffness, solutions, and refused problems.

mod digits;
mod multigrid;
mod patch;
mod refusals;
mod solve;
mod stiffness;
