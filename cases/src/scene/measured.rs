//! A measured curve: a CSV file with a header of metrics and their units.
//!
//! ```csv
//! closure [mm],tool-force [N],sd [N]
//! 1,0.21,0.02
//! 2,0.55,0.02
//! ```

use std::path::{Path, PathBuf};

use catalogue::metric::{self, Address};
use catalogue::{Problem, clip};

use super::error::{ErrorKind, SceneError, unread};

/// Most rows of a curve.
const MOST_ROWS: usize = 10_000;
/// Header of the column of standard deviations.
const SD: &str = "sd";

/// A measured curve, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Path of the file.
    pub path: PathBuf,
    /// Metric along which it was measured, such as `closure`.
    pub along: Address,
    /// Measured metric.
    pub of: Address,
    /// Values along the curve, which don't decrease.
    pub x: Vec<f64>,
    /// Measured values.
    pub y: Vec<f64>,
    /// Standard deviations of the measured values; `None` if the file has none.
    pub sd: Option<Vec<f64>>,
    /// Line of each row, from 1.
    pub lines: Vec<usize>,
}

/// A column: its metric, or that of the values whose standard deviation it has, and the factor to SI.
struct Column {
    of: Address,
    factor: f64,
    title: String,
}

/// Errors of a curve, at their lines.
struct Errors<'p> {
    path: &'p Path,
    found: Vec<SceneError>,
}

impl Errors<'_> {
    fn add(&mut self, line: usize, Problem { problem, found, help, .. }: Problem) {
        let file = self.path.display().to_string();
        let kind = ErrorKind::Invalid;
        let (column, key) = (usize::from(line > 0), String::new());
        self.found.push(SceneError { kind, file, line, column, key, found, problem, help });
    }
}

/// Reads a curve.
///
/// # Errors
/// All lines at fault; or that the file can't be read.
pub(crate) fn read(path: &Path) -> Result<Measured, Vec<SceneError>> {
    let mut errors = Errors { path, found: Vec::new() };
    match disk::read_text(path, disk::Kind::CURVE) {
        Ok(text) => match parse(path, &text, &mut errors) {
            Some(curve) if errors.found.is_empty() => return Ok(curve),
            _ => {}
        },
        Err(bad) => {
            let help = "paths are relative to the folder of the scene";
            errors.add(0, Problem::new(format!("can't be read: {}", unread(&bad))).help(help));
        }
    }
    Err(errors.found)
}

fn parse(path: &Path, text: &str, errors: &mut Errors) -> Option<Measured> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let Some((first, header)) = lines.next() else {
        errors
            .add(1, Problem::new("is empty").help("begin with a header such as closure [mm],tool-force [N]"));
        return None;
    };
    let columns = header_of(header).map_err(|bad| errors.add(first, bad)).ok()?;
    let mut of = Measured {
        path: path.into(),
        along: columns[0].of,
        of: columns[1].of,
        x: Vec::new(),
        y: Vec::new(),
        sd: columns.get(2).map(|_| Vec::new()),
        lines: Vec::new(),
    };
    for (line, text) in lines {
        let row = match row(text, &columns) {
            Ok(row) => row,
            Err(bad) => {
                errors.add(line, bad);
                continue;
            }
        };
        if let (Some(before), Some(at)) = (of.x.last().filter(|x| **x > row[0]), of.lines.last()) {
            let problem = format!(
                "in column 1, {}, is below {} in line {at}",
                columns[0].title,
                before / columns[0].factor
            );
            let help = "give the rows in the order of loading, and unloading in another file or along time";
            errors
                .add(line, Problem::new(problem).found((row[0] / columns[0].factor).to_string()).help(help));
        }
        of.x.push(row[0]);
        of.y.push(row[1]);
        of.sd.iter_mut().for_each(|sd| sd.push(row[2]));
        of.lines.push(line);
        if of.x.len() > MOST_ROWS {
            errors.add(line, Problem::new("is one row too many").help(format!("give {MOST_ROWS} or less")));
            break;
        }
    }
    if errors.found.is_empty() && of.y.iter().all(|y| *y == of.y[0]) {
        let problem = format!("{} has no two different values", columns[1].title);
        errors.add(first, Problem::new(problem).help("give the measured rows below the header"));
    }
    Some(of)
}

/// Columns of a header: the metric along the curve, the measured metric, and maybe `sd`.
fn header_of(header: &str) -> Result<Vec<Column>, Problem> {
    let example = "such as closure [mm],tool-force [N] or closure [mm],tool-force [N],sd [N]";
    let titles: Vec<&str> = header.split(',').map(str::trim).collect();
    if let (1, Some(other)) = (titles.len(), [';', '\t'].into_iter().find(|c| header.contains(*c))) {
        let problem = Problem::new(format!("separates columns by {other:?}")).found(clip(header));
        return Err(problem.help("separate them by commas, and write decimal points"));
    }
    if !(2..=3).contains(&titles.len()) {
        let problem = Problem::new(format!("is a header of {} columns", titles.len())).found(clip(header));
        return Err(problem.help(format!("give two or three, {example}")));
    }
    let mut columns: Vec<Column> = Vec::new();
    for (i, title) in titles.iter().enumerate() {
        let (name, unit) = match title.split_once('[') {
            Some((name, unit)) => (name.trim(), unit.trim_end_matches(']').trim()),
            None => (*title, ""),
        };
        let of = match (i, name == SD) {
            (2, true) => columns[1].of,
            (2, false) => {
                return Err(Problem::new("is no third column").found(name).help("name it sd, with its unit"));
            }
            _ => metric::named(name)?,
        };
        let dimension = of.metric.dimension;
        let plain = dimension.is_plain() && ["", "1"].contains(&unit);
        let factor = match unit {
            _ if plain => 1.0,
            "" => {
                let units = dimension.offered().join("], [");
                return Err(Problem::new("has no unit").found(*title).help(format!("add one of [{units}]")));
            }
            unit => dimension.read_unit(unit)?,
        };
        columns.push(Column { of, factor, title: name.into() });
    }
    if columns[0].of == columns[1].of {
        return Err(Problem::new("is given twice")
            .found(titles[0])
            .help(format!("give two metrics, {example}")));
    }
    Ok(columns)
}

/// Values of a row, SI.
fn row(text: &str, columns: &[Column]) -> Result<Vec<f64>, Problem> {
    let fields: Vec<&str> = text.split(',').map(str::trim).collect();
    if fields.len() != columns.len() {
        let problem = format!("has {} values for {} columns", fields.len(), columns.len());
        return Err(Problem::new(problem)
            .found(clip(text))
            .help("separate values by commas, and write decimal points"));
    }
    let value = |(i, (field, column)): (usize, (&&str, &Column))| {
        let at = format!("in column {}, {},", i + 1, column.title);
        let number: Option<f64> =
            field.parse().ok().map(|v: f64| v * column.factor).filter(|v| v.is_finite());
        match number {
            Some(number) if i == 2 && !(number > 0.0) => {
                let problem = Problem::new(format!("{at} is not above zero")).found(*field);
                Err(problem.help("give the standard deviation of the measured value"))
            }
            Some(number) => Ok(number),
            None => {
                let problem = Problem::new(format!("{at} is not a finite number")).found(clip(field));
                Err(problem.help("write numbers as 1.5 or 2e-3, with the unit in the header"))
            }
        }
    };
    fields.iter().zip(columns).enumerate().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Measured, String> {
        let path = Path::new("curve.csv");
        let mut errors = Errors { path, found: Vec::new() };
        let curve = parse(path, text, &mut errors);
        let messages: Vec<String> = errors.found.iter().map(ToString::to_string).collect();
        curve.filter(|_| messages.is_empty()).ok_or_else(|| messages.join("\n"))
    }

    #[test]
    fn a_curve_is_read_in_si_units() {
        let curve = of(
            "\u{feff}# by hand\r\nclosure [mm], tool-force-2 [mN] ,sd [N]\r\n1,2e3,0.1\r\n\r\n2,3e3,0.2\r\n",
        );
        let curve = curve.unwrap();
        assert_eq!((curve.x, curve.y), (vec![1e-3, 2e-3], vec![2.0, 3.0]));
        assert_eq!((curve.sd, curve.lines), (Some(vec![0.1, 0.2]), vec![3, 5]));
        assert_eq!(
            (curve.along.to_string(), curve.of.to_string()),
            ("closure".into(), "tool-force-2".into())
        );
        assert_eq!(of("load-carried,mean-z [um]\n0.5,1\n1,2").unwrap().x, [0.5, 1.0]);
    }

    #[test]
    fn faults_are_reported_with_line_and_column() {
        let head = "closure [mm],tool-force [N]\n";
        for (text, message) in [
            (String::new(), "curve.csv:1: is empty; begin with a header"),
            ("closure [mm]\n1\n".into(), "curve.csv:1: 'closure [mm]' is a header of 1 columns"),
            ("closure [mm];tool-force [N]\n".into(), "separates columns by ';'; separate them by commas"),
            ("closure,tool-force [N]\n".into(), "curve.csv:1: 'closure' has no unit; add one of [mm]"),
            ("closure [kPa],tool-force [N]\n".into(), "is a pressure, where a length belongs"),
            ("closure [mm],closure [mm]\n".into(), "is given twice"),
            ("clsure [mm],tool-force [N]\n".into(), "did you mean 'closure'"),
            ("closure [mm],tool-force [N],error [N]\n".into(), "'error' is no third column; name it sd"),
            (format!("{head}1,2\n2\n"), "curve.csv:3: '2' has 1 values for 2 columns"),
            (format!("{head}1,2\n2,3,5\n"), "curve.csv:3: '2,3,5' has 3 values for 2 columns"),
            (format!("{head}1,2\n2,x\n"), "curve.csv:3: 'x' in column 2, tool-force, is not a finite number"),
            (format!("{head}1,2\n2,NaN\n"), "'NaN' in column 2, tool-force, is not a finite number"),
            (format!("{head}2,2\n1,3\n"), "curve.csv:3: '1' in column 1, closure, is below 2 in line 2"),
            (format!("{head}1,2\n2,2\n"), "tool-force has no two different values"),
            (head.into(), "tool-force has no two different values"),
            ("closure [mm],tool-force [N],sd [N]\n1,2,0\n".into(), "'0' in column 3, sd, is not above zero"),
        ] {
            let found = of(&text).unwrap_err();
            assert!(found.contains(message), "{text}\n{found}");
        }
    }
}
