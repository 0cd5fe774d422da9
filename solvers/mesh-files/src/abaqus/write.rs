//! Writer of flat decks. Each region becomes a section, each further group of cells a set, and each facet
//! group a surface of element faces, and each group of nodes a set.

use std::fmt::Write;

use geometry::{CellKind, Mesh};

/// Returns the text of the file with lengths in units of `unit` metres.
///
/// # Errors
/// A name that the format cannot represent.
pub(crate) fn text(mesh: &Mesh, unit: f64) -> Result<String, String> {
    let further: Vec<&str> = mesh.cell_groups().map(|(name, _)| name).collect();
    let of_cells: Vec<&str> = mesh.region_names().iter().map(String::as_str).chain(further).collect();
    let names = of_cells.iter().copied().chain(mesh.group_names());
    let names: Vec<&str> = names.chain(mesh.node_groups().map(|(name, _)| name)).collect();
    let bad = |name: &&&str| {
        name.is_empty() || name.trim() != **name || name.contains(['"', '\n', '\r', ',']) || !name.is_ascii()
    };
    if let Some(name) = names.iter().find(bad) {
        return Err((*name).into());
    }
    // Set names are compared without regard to case.
    let regions = mesh.region_names();
    let twin =
        |(at, name): &(usize, &&str)| of_cells[..*at].iter().any(|other| other.eq_ignore_ascii_case(name));
    if let Some((_, name)) = of_cells.iter().enumerate().find(twin) {
        return Err(name.to_string());
    }
    let mut out = String::from("*HEADING\nwritten by tissuebench\n*NODE\n");
    // Writing to a string cannot fail.
    macro_rules! line {
        ($($arg:tt)*) => { let _ = writeln!(out, $($arg)*); };
    }
    for (node, p) in mesh.points().iter().enumerate() {
        line!("{}, {:e}, {:e}, {:e}", node + 1, p.x / unit, p.y / unit, p.z / unit);
    }
    // Cells keep their order: a block ends at a change of kind or region.
    let key = |cell: usize| (mesh.kind(cell), mesh.region(cell));
    for cell in 0..mesh.cell_count() {
        let (kind, region) = key(cell);
        if cell == 0 || key(cell - 1) != (kind, region) {
            line!(
                "*ELEMENT, TYPE={}, ELSET=\"{}\"",
                kind.entry().files.abaqus,
                mesh.region_names()[region as usize]
            );
        }
        let order = kind.entry().files.abaqus_order.iter();
        let nodes: Vec<String> = order.map(|&node| (mesh.cell(cell)[node] + 1).to_string()).collect();
        // A line holds at most 16 numbers.
        let lines: Vec<String> =
            [vec![(cell + 1).to_string()], nodes].concat().chunks(15).map(|chunk| chunk.join(", ")).collect();
        line!("{}", lines.join(",\n"));
    }
    for (name, cells) in mesh.cell_groups() {
        line!("*ELSET, ELSET=\"{name}\"");
        let numbers: Vec<String> = cells.iter().map(|cell| (cell + 1).to_string()).collect();
        for chunk in numbers.chunks(15) {
            line!("{}", chunk.join(", "));
        }
    }
    for (name, nodes) in mesh.node_groups() {
        line!("*NSET, NSET=\"{name}\"");
        let numbers: Vec<String> = nodes.iter().map(|node| (node + 1).to_string()).collect();
        for chunk in numbers.chunks(15) {
            line!("{}", chunk.join(", "));
        }
    }
    // Sections preserve the order of the regions. Their materials have to be added elsewhere.
    let mut has = vec![false; regions.len()];
    (0..mesh.cell_count()).for_each(|cell| has[mesh.region(cell) as usize] = true);
    for (name, _) in regions.iter().zip(has).filter(|(_, has)| *has) {
        line!("*SOLID SECTION, ELSET=\"{name}\", MATERIAL=\"{name}\"");
    }
    for group in mesh.group_names() {
        line!("*SURFACE, NAME=\"{group}\", TYPE=ELEMENT");
        for facet in mesh.group(group).unwrap_or_default() {
            let face = number(mesh.kind(facet.cell as usize), facet.face as usize);
            line!("{}, S{face}", facet.cell + 1);
        }
    }
    Ok(out)
}

/// Face number in a deck of a face index of [`CellKind::faces`].
fn number(kind: CellKind, face: usize) -> usize {
    let corners = kind.face_corners(face);
    let same = |theirs: &&[usize]| {
        theirs.len() == corners.len() && theirs.iter().all(|corner| corners.contains(corner))
    };
    1 + kind.entry().cell.abaqus_faces.iter().position(same).expect("every face has a number")
}
