//! The long table to and from CSV. The only file that names the CSV library.

use std::borrow::Cow;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use disk::Kind;
use serde::Serialize;

use crate::cell::{guarded, unguarded};
use crate::error::ReportError;
use crate::provenance::Provenance;
use crate::record::Record;
use crate::store::unwritten;

/// More than the names of the columns take, and what is read at once.
const LONGEST_HEADER: usize = 1 << 16;

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
/// bits when they are read again; texts that a spreadsheet would take for a formula are guarded.
pub(crate) fn write(dir: &Path, mut records: Vec<Record>, from: &Provenance) -> Result<(), ReportError> {
    for text in records.iter_mut().flat_map(Record::texts_mut) {
        if let Cow::Owned(cell) = guarded(text) {
            *text = cell;
        }
    }
    let path = dir.join("records.csv");
    disk::replace(&path, |file| rows(csv::Writer::from_writer(file), &records, from))
        .map_err(|source| unwritten(&path, source))
}

fn rows<W: io::Write>(mut file: csv::Writer<W>, records: &[Record], from: &Provenance) -> io::Result<()> {
    let (program, machine, commit) = (&from.program, &from.machine, from.program.revision());
    let [commit, rustc, profile, cpu, model, instructions] =
        [&commit, &program.rustc, &program.profile, &machine.cpu, &machine.model, &machine.instructions]
            .map(|text| guarded(text));
    for record in records {
        let origin = Origin {
            commit: &commit,
            rustc: &rustc,
            profile: &profile,
            cpu: &cpu,
            model: &model,
            instructions: &instructions,
            threads: if record.is_measured() { machine.threads } else { 0 },
        };
        file.serialize((record, origin))?;
    }
    file.flush()
}

/// Reads the records of `records.csv`; their provenance is in a file of its own.
pub(crate) fn read(path: &Path) -> Result<Vec<Record>, ReportError> {
    let io = |source| ReportError::Io { path: path.into(), source };
    let mut file = BufReader::with_capacity(LONGEST_HEADER, disk::open(path, Kind::RESULTS).map_err(io)?);
    // A file of zeros would be read to its end as one name of a column.
    let begin = file.fill_buf().map_err(io)?;
    if begin.len() == LONGEST_HEADER && !begin.contains(&b'\n') {
        let reason = format!("its first line has more than {LONGEST_HEADER} bytes");
        return Err(ReportError::Content { path: path.into(), reason });
    }
    let mut file = csv::Reader::from_reader(file);
    // Any file without rows would pass for a table without records, whose file is empty.
    let header = file.headers().map_err(|e| content(path, &e))?;
    if !header.is_empty() && header.iter().all(|name| name != "value") {
        return Err(ReportError::Content { path: path.into(), reason: "no column `value`".into() });
    }
    let mut records: Vec<Record> =
        file.deserialize().collect::<Result<_, _>>().map_err(|e| content(path, &e))?;
    for text in records.iter_mut().flat_map(Record::texts_mut).filter(|text| text.starts_with('\'')) {
        *text = unguarded(text).to_string();
    }
    Ok(records)
}

fn content(path: &Path, error: &csv::Error) -> ReportError {
    ReportError::Content { path: path.into(), reason: error.to_string() }
}
