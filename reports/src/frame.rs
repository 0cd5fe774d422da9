//! The long table to and from CSV. The only file that names the CSV library.

use std::io;
use std::path::Path;

use serde::Serialize;

use crate::error::ReportError;
use crate::provenance::Provenance;
use crate::record::Record;
use crate::store::replace;

/// What every row of the file carries beyond its record, so that tables of several machines can be joined.
#[derive(Serialize)]
struct Origin<'a> {
    commit: &'a str,
    rustc: &'a str,
    profile: &'a str,
    cpu: &'a str,
    model: &'a str,
    instructions: &'a str,
    /// 0 for values: only times and memory depend on the number of threads.
    threads: u32,
}

/// Writes `records.csv`: the fields of a record, then those of its origin. Numbers have the fewest digits that give the same
/// bits when they are read again.
pub(crate) fn write(dir: &Path, records: &[Record], from: &Provenance) -> Result<(), ReportError> {
    replace(&dir.join("records.csv"), |file| rows(csv::Writer::from_writer(file), records, from))
}

fn rows<W: io::Write>(mut file: csv::Writer<W>, records: &[Record], from: &Provenance) -> io::Result<()> {
    let (program, machine, commit) = (&from.program, &from.machine, from.program.revision());
    for record in records {
        let origin = Origin {
            commit: &commit,
            rustc: &program.rustc,
            profile: &program.profile,
            cpu: &machine.cpu,
            model: &machine.model,
            instructions: &machine.instructions,
            threads: if record.is_measured() { machine.threads } else { 0 },
        };
        file.serialize((record, origin))?;
    }
    file.flush()
}

/// Reads the records of `records.csv`; their provenance is in a file of its own.
pub(crate) fn read(path: &Path) -> Result<Vec<Record>, ReportError> {
    let mut file = csv::Reader::from_path(path).map_err(|e| content(path, &e))?;
    // Any file without rows would pass for a table without records, whose file is empty.
    let header = file.headers().map_err(|e| content(path, &e))?;
    if !header.is_empty() && header.iter().all(|name| name != "value") {
        return Err(ReportError::Content { path: path.into(), reason: "no column `value`".into() });
    }
    file.deserialize().collect::<Result<_, _>>().map_err(|e| content(path, &e))
}

fn content(path: &Path, error: &csv::Error) -> ReportError {
    ReportError::Content { path: path.into(), reason: error.to_string() }
}
