//! Linear statics: patch tests, stiffness, solutions, and problems that are refused.

mod digits;
mod multigrid;
mod patch;
mod refusals;
mod solve;
mod stiffness;
