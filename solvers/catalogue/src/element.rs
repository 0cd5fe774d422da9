//! Finite elements: the names that solvers record and reports draw.

/// Element as scenes, lists and records name it.
#[derive(Debug, PartialEq, Eq)]
pub struct Element {
    /// Name in files, records and tables.
    pub name: &'static str,
    /// Meaning, in one phrase.
    pub meaning: &'static str,
    /// Degree to which the shape functions are complete polynomials on an affine cell.
    pub degree: usize,
}

/// 4-node tetrahedron.
pub static TET4: Element = Element { name: "tet4", meaning: "Linear tetrahedron.", degree: 1 };
/// 10-node tetrahedron.
pub static TET10: Element = Element { name: "tet10", meaning: "Quadratic tetrahedron.", degree: 2 };
/// 8-node hexahedron.
pub static HEX8: Element = Element { name: "hex8", meaning: "Trilinear hexahedron.", degree: 1 };
/// 20-node hexahedron.
pub static HEX20: Element =
    Element { name: "hex20", meaning: "Quadratic serendipity hexahedron.", degree: 2 };
/// 6-node wedge.
pub static WEDGE6: Element =
    Element { name: "wedge6", meaning: "Linear wedge (triangular prism).", degree: 1 };
/// 15-node wedge.
pub static WEDGE15: Element =
    Element { name: "wedge15", meaning: "Quadratic serendipity wedge (triangular prism).", degree: 2 };

/// Linear cells of several shapes.
pub static MIXED_LINEAR: Element = Element {
    name: "mixed-linear",
    meaning: "Linear cells of any shapes, as a mesh file has them.",
    degree: 1,
};
/// Quadratic cells of several shapes.
pub static MIXED_QUADRATIC: Element = Element {
    name: "mixed-quadratic",
    meaning: "Quadratic cells of any shapes, as a mesh file has them or raised from its linear cells.",
    degree: 2,
};

/// All elements, in the order tables list them.
pub static ELEMENTS: [&Element; 8] =
    [&TET4, &TET10, &HEX8, &HEX20, &WEDGE6, &WEDGE15, &MIXED_LINEAR, &MIXED_QUADRATIC];

/// Returns the element with that name.
pub fn find(name: &str) -> Option<&'static Element> {
    ELEMENTS.into_iter().find(|element| element.name == name)
}
