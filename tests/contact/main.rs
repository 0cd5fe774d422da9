//! Contact with rigid tools: shapes, the law at a point, and over surfaces.

mod law;
mod passage;
mod search;
mod shapes;
mod surface;
