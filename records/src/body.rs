//! A body's surface at recorded states for a three-dimensional view, in single precision and packed as text.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

/// Surface of a body, composed of element faces; the faces of quadratic elements are curved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RecordedBody {
    /// Coordinates of the points in the reference configuration (m), [`pack`]ed.
    pub points: String,
    /// Faces by their number of nodes.
    pub faces: Vec<Faces>,
    /// Distance (m) of each point from its position in the reference or exact solution at the end, packed;
    /// empty if neither is known.
    #[serde(default)]
    pub off: String,
    /// Part of the error of output.error_of that each cell causes per volume, over the mean of the body,
    /// averaged over the cells around each point, on faces and then inside, packed; empty unless it was
    /// traced.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// Values on a cut through the body; `None` if they were omitted.
    #[serde(default)]
    pub inside: Option<Inside>,
    /// Positions (m) of cloud nodes at the end, packed; empty for elements, whose faces show the nodes.
    #[serde(default)]
    pub cloud: String,
    /// Tools at their start.
    pub tools: Vec<Skin>,
    /// Recorded states of the run, in order; the last is the end.
    pub states: Vec<BodyState>,
    /// Number of states omitted at regular intervals.
    pub left_out: usize,
}

/// Cells of a body, and the points that are on no face.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Inside {
    /// Coordinates (m) of the interior points in the reference configuration, packed.
    pub points: String,
    /// Cells by their number of nodes (4, 6, 8, 10, 15 or 20). Indices refer to the points on faces, followed
    /// by the interior points.
    pub cells: Vec<Faces>,
    /// Values at each state of the body.
    pub states: Vec<InsideState>,
}

/// Interior points at one state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InsideState {
    /// Displacement of each point (m), packed.
    pub u: String,
    /// Values as in [`BodyState::values`].
    pub values: Option<[String; 3]>,
}

/// Faces, or cells, of one kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Faces {
    /// Number of nodes of each; 3, 4, 6 or 8 for faces, corners first, then mid-edge nodes.
    pub nodes: usize,
    /// Indices of the points, packed.
    pub indices: String,
}

/// Surface of a tool.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Skin {
    /// Positions of the points (m), packed.
    pub points: String,
    /// Four corners of each quadrilateral, packed.
    pub quads: String,
    /// Unit vector of the tool's travel at the start.
    pub along: [f64; 3],
}

/// State of a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyState {
    /// Time (s) in dynamics, load fraction in statics.
    pub time: f64,
    /// Displacement of each point, metres, packed.
    pub u: String,
    /// Displacement of each tool, m; after its rotation about the origin, if it turns.
    pub tools: Vec<[f64; 3]>,
    /// Rotation of each tool about the origin, a unit quaternion (x, y, z, w); empty if no tool turns.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub turns: Vec<[f64; 4]>,
    /// Contact points inside a tool: three coordinates and the penetration depth of each (m), packed.
    #[serde(default)]
    pub touching: String,
    /// Largest depth (m) of a node inside a tool. Contact acts at contact points, not at nodes.
    #[serde(default)]
    pub deepest_node: f64,
    /// Pressure (Pa, positive in compression), von Mises stress (Pa) and determinant of the deformation
    /// gradient at each point, packed, if known.
    pub values: Option<[String; 3]>,
}

/// Encodes numbers as base64 of their four bytes each, least significant byte first.
pub fn pack<T: Word>(numbers: impl IntoIterator<Item = T>) -> String {
    let bytes: Vec<u8> = numbers.into_iter().flat_map(Word::bytes).collect();
    STANDARD.encode(bytes)
}

/// A number that can be packed.
pub trait Word {
    /// Returns the four bytes, least significant byte first.
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
