//! A body's surface at recorded states, for a view in three dimensions: single precision, packed as text.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

/// The surface of a body, as its elements have it: faces of quadratic ones are curved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Coordinates of its points in the reference configuration, metres: [`pack`]ed.
    pub points: String,
    /// Faces by their number of nodes.
    pub faces: Vec<Faces>,
    /// How far each point is from where the reference or the exact solution has it at the end, metres,
    /// packed; empty where neither is known.
    #[serde(default)]
    pub off: String,
    /// Values shown by a cut through the body; `None` if they were left out.
    #[serde(default)]
    pub inside: Option<Inside>,
    /// Nodes of a cloud at the end, metres, packed; empty for elements, whose nodes their faces show.
    #[serde(default)]
    pub cloud: String,
    /// The tools where they start.
    pub tools: Vec<Skin>,
    /// States kept of the run, in order; the last is its end.
    pub states: Vec<BodyState>,
    /// Number of states that were left out, evenly.
    pub left_out: usize,
}

/// The cells of a body, with its points that are on no face.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Inside {
    /// Coordinates of these points in the reference configuration, metres, packed.
    pub points: String,
    /// Cells by their number of nodes (4, 8, 10 or 20), of the points on faces and then these.
    pub cells: Vec<Faces>,
    /// At each state of the body.
    pub states: Vec<InsideState>,
}

/// Points that are on no face at a state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InsideState {
    /// Displacement of each, metres, packed.
    pub u: String,
    /// As those of the points on faces.
    pub values: Option<[String; 3]>,
}

/// Faces, or cells, of one kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Faces {
    /// Nodes of each: 3, 4, 6 or 8 of faces, corners first, then the middles of edges.
    pub nodes: usize,
    /// Their points, packed.
    pub indices: String,
}

/// A tool's surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Skin {
    /// Metres, packed.
    pub points: String,
    /// Four corners each, packed.
    pub quads: String,
    /// Unit direction of its way.
    pub along: [f64; 3],
}

/// A state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyState {
    /// Time (s) in dynamics, part of the load in statics.
    pub time: f64,
    /// Displacement of each point, metres, packed.
    pub u: String,
    /// Way of each tool from its start, metres.
    pub closures: Vec<f64>,
    /// Contact points that lie within a tool: three coordinates and the depth of each, metres, packed.
    #[serde(default)]
    pub touching: String,
    /// How deep the deepest point of the body lies within a tool, metres: contact does not act there.
    #[serde(default)]
    pub deepest_node: f64,
    /// Pressure (Pa, positive in compression), von Mises stress (Pa) and determinant of the deformation
    /// gradient at each point, packed, where they are known.
    pub values: Option<[String; 3]>,
}

/// Numbers as base64 of their four bytes each, the lowest first.
pub fn pack<T: Word>(numbers: impl IntoIterator<Item = T>) -> String {
    let bytes: Vec<u8> = numbers.into_iter().flat_map(Word::bytes).collect();
    STANDARD.encode(bytes)
}

/// What is packed.
pub trait Word {
    /// The four bytes, the lowest first.
    fn bytes(self) -> [u8; 4];
}

impl Word for f32 {
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

impl Word for u32 {
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_packed_with_their_lowest_byte_first() {
        assert_eq!(pack([1.0f32, -2.5]), "AACAPwAAIMA=");
        assert_eq!(pack(Vec::<u32>::new()), "");
    }
}
