//! Contact with rigid tools: shapes, the law at a point, and over surfaces.

mod law;
mod search;
mod shapes;
mod surface;
mod tool_travel;
mod turning;
