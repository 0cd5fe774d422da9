//! Mesh files and lists of points: read, measured, converted, written and read again.

use std::path::Path;

use geometry::generate::{raise_order, to_tets};
use geometry::{CellKind, Mesh, cloud_from_mesh, msh, quality, read_points_text};

pub(crate) fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    if let Ok(points) = read_points_text(text, Path::new("fuzz.csv"), 1e-3) {
        assert_eq!(points.points.len(), points.lines.len());
        if points.points.len() <= 300 {
            let _ = geometry::Cloud::from_points(points.points);
        }
    }
    match msh::read_text(text, Path::new("fuzz.msh"), 1e-3) {
        Err(bad) => assert!(!bad.to_string().is_empty()),
        Ok(mesh) => take(&mesh),
    }
}

fn take(mesh: &Mesh) {
    let facets = mesh.boundary();
    assert!(facets.iter().all(|facet| (facet.cell as usize) < mesh.cell_count()));
    if mesh.points().len() > 300 {
        return;
    }
    if let Ok(quality) = quality::check(mesh) {
        assert!(quality.volume > 0.0, "a sound mesh of no volume");
    }
    let _ = cloud_from_mesh(mesh);
    let tets = to_tets(mesh);
    assert!(tets.uniform_kind() == Some(CellKind::Tet4));
    let _ = raise_order(&tets);
    if mesh.uniform_kind() == Some(CellKind::Hex8) {
        let _ = raise_order(mesh);
    }
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let file = folder.path().join("again.msh");
    if msh::write(mesh, &file, 1.0).is_ok() {
        let again = msh::read(&file, 1.0).expect("what is written can be read");
        assert!(again.points() == mesh.points() && again.cell_count() == mesh.cell_count());
    }
}
