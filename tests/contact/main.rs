//! Contact with rigid tools: shapes, the law at a point, and over surfaces.

mod law;
mod shapes;
mod surface;
