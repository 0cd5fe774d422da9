//! Files of positions: accepted files, and errors with their line and column.

use tissuebench_geometry::{PointFileError, PointProblem, read_points};

fn read(text: &str) -> Result<tissuebench_geometry::PointFile, PointFileError> {
    let file = std::env::temp_dir().join(format!("points-{}-{}.csv", std::process::id(), text.len()));
    std::fs::write(&file, text).unwrap();
    let read = read_points(&file, 1e-3);
    std::fs::remove_file(&file).unwrap();
    read
}

#[test]
fn lines_names_and_comments() {
    let plain = read("1, 2, 3\r\n\n# a comment\n-4,5e-1 ,6").unwrap();
    assert_eq!(plain.lines, [1, 4]);
    assert_eq!(plain.points[0], tissuebench_geometry::Point3::new(1e-3, 2e-3, 3e-3));
    assert_eq!(plain.points[1], tissuebench_geometry::Point3::new(-4e-3, 0.5e-3, 6e-3));
    let named = read("\u{feff}\"id\",Z,\"x\",y\n7,3,1,2\n").unwrap();
    assert_eq!((named.points[0], named.lines), (plain.points[0], vec![2]));
}

#[test]
fn refusals_know_line_and_column() {
    let of = |text: &str| match read(text) {
        Err(PointFileError::Line { line, column, problem, .. }) => (line, column, problem),
        other => panic!("{text}: {other:?}"),
    };
    let [a, inf] = ["1.2.3", "nan"].map(String::from);
    assert_eq!(of("0,0,0\n0,1.2.3,0"), (2, 2, PointProblem::NotANumber { found: a }));
    assert_eq!(of("0,0,0\n\n0,0,nan"), (3, 3, PointProblem::NotFinite { found: inf }));
    assert_eq!(of("0,0,0\n1,2"), (2, 3, PointProblem::Missing { found: 2, expected: 3 }));
    assert_eq!(of("0,0,0,1"), (1, 4, PointProblem::TooMany { found: 4, expected: 3 }));
    assert_eq!(of("x,y,w\n0,0,0"), (1, 3, PointProblem::NoColumn { name: "z" }));
    assert!(matches!(read("x,y,z\n"), Err(PointFileError::Empty { .. })));
    assert!(matches!(read_points("no/such.csv".as_ref(), 1.0), Err(PointFileError::Io { .. })));
}
