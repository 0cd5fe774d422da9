//! Quadrature rules on the reference tetrahedron, triangle, cube and square.
