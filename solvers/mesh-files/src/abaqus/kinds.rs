//! Element types of decks and their face numbers. Corners and mid-edge nodes have the order of [`CellKind`].

use geometry::CellKind;

/// Element types that are read, for the message about other types.
pub(super) fn known() -> String {
    let solids = CellKind::ALL.map(|kind| kind.entry().files.abaqus).join(", ");
    format!(
        "supported types: {solids} with their variants (R, I, H, M), and shells as faces; beams and others are skipped"
    )
}

/// Class of an element type.
pub(super) enum Type {
    Cell(CellKind),
    /// A shell or plane element, which may lie on a face of a solid: numbers of corners and of nodes.
    Face(usize, usize),
    /// An element without volume or area, which is skipped.
    Other,
}

pub(super) fn element_type(name: &str) -> Option<Type> {
    let name = name.to_ascii_uppercase();
    if let Some(rest) = name.strip_prefix("C3D") {
        let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (count, variant) = rest.split_at(digits);
        if !variant.chars().all(|c| "RIHMS".contains(c)) {
            return None;
        }
        let is = |kind: &CellKind| kind.entry().files.abaqus.strip_prefix("C3D") == Some(count);
        return CellKind::ALL.into_iter().find(is).map(Type::Cell);
    }
    let flat = ["STRI", "SFM3D", "M3D", "R3D", "CPS", "CPE", "CAX", "S"];
    if let Some(rest) = flat.iter().find_map(|prefix| name.strip_prefix(prefix)) {
        match rest.bytes().next() {
            Some(b'3') => return Some(Type::Face(3, 3)),
            Some(b'4') => return Some(Type::Face(4, 4)),
            Some(b'6') => return Some(Type::Face(3, 6)),
            Some(b'8') => return Some(Type::Face(4, 8)),
            _ => {}
        }
    }
    let thin = [
        "T2D", "T3D", "B2", "B3", "RB", "SPRING", "MASS", "DASHPOT", "CONN", "GAP", "ROTARY", "DC", "STRI",
        "SAX",
    ];
    thin.iter().any(|prefix| name.starts_with(prefix)).then_some(Type::Other)
}
