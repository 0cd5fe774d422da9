//! Mesh files, surfaces and lists of points: read, filled, measured, converted, written and read again.

use std::path::Path;

use geometry::generate::{raise_order, to_tets};
use geometry::stuffing::{Stuffing, stuff};
use geometry::surface::Treatment;
use geometry::{CellKind, Mesh, Surface, cloud_from_mesh, quality, read_points_text};
use mesh_files::{Format, GmshVersion};

pub(crate) fn run(data: &[u8]) {
    let points = std::str::from_utf8(data).map(|text| read_points_text(text, Path::new("fuzz.csv"), 1e-3));
    if let Ok(Ok(points)) = points {
        assert_eq!(points.points.len(), points.lines.len());
        if points.points.len() <= 300 {
            let _ = geometry::Cloud::from_points(points.points);
        }
    }
    if let Ok(surface) = mesh_files::read_surface_bytes(data, Path::new("fuzz.stl"), 1e-3) {
        fill(&surface);
    }
    let treated = |treatment| mesh_files::read_treated_bytes(data, Path::new("fuzz.stl"), 1e-3, treatment);
    if let Ok(repaired) = treated(Treatment::Repair) {
        let [low, high] = repaired.surface.bounds();
        let wrapped = treated(Treatment::Wrap { size: (high - low).amax() / 8.0 });
        assert!(
            wrapped.is_ok_and(|wrap| wrap.surface.volume() > 0.0)
                || (high - low).min() <= (high - low).amax() / 4.0
        );
        fill(&repaired.surface);
    }
    // The folder for included files of an input deck is empty.
    match mesh_files::read_bytes(data, Path::new("/nonexistent/fuzz.msh"), 1e-3) {
        Err(bad) => assert!(!bad.to_string().is_empty()),
        Ok((mesh, rows)) => {
            assert_eq!(rows.len(), mesh.cell_count());
            take(&mesh);
        }
    }
    match mesh_files::read_vectors_bytes(data, Path::new("/nonexistent/fuzz.msh"), 1e-3, "fibers") {
        Err(bad) => assert!(!bad.to_string().is_empty()),
        Ok((mesh, found)) => {
            let items = if found.of_cells { mesh.cell_count() } else { mesh.points().len() };
            assert_eq!((found.vectors.len(), found.numbers.len()), (items, items));
        }
    }
}

/// Fills a surface with a few cells.
fn fill(surface: &Surface) {
    let [low, high] = surface.bounds();
    if surface.triangles().len() > 300 {
        return;
    }
    let how = Stuffing { spacing: (high - low).amax() / 6.0, doublings: 1 };
    if let Ok(stuffed) = stuff(surface, how) {
        assert!(quality::check(&stuffed.mesh).is_ok(), "an inverted cell inside a surface");
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
    for name in ["again.msh", "again-4.1.msh", "again.inp", "again.vtu"] {
        let file = folder.path().join(name);
        let written = match name {
            "again-4.1.msh" => mesh_files::write_as(mesh, &file, 1.0, Format::Gmsh(GmshVersion::FourOne)),
            _ => mesh_files::write(mesh, &file, 1.0),
        };
        if written.is_ok() {
            let again = mesh_files::read(&file, 1.0).expect("what is written can be read");
            assert!(again.points() == mesh.points() && again.cell_count() == mesh.cell_count());
            assert!(again.region_names() == mesh.region_names(), "{name}: names of regions");
        }
    }
}
