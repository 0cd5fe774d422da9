//! The long table as a data frame and as files: Parquet, from which it is read, and CSV beside it for people and other programs.

use std::borrow::Cow;
use std::io::{self, BufRead, BufReader, Cursor, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use disk::Kind;
use polars::prelude::*;
use serde::Serialize;

use crate::cell::{guarded, unguarded};
use crate::columns;
use crate::error::RecordError;
use crate::provenance::Provenance;
use crate::record::Record;
use crate::store::unwritten;

/// File of the table, in the folder of a run.
const PARQUET: &str = "records.parquet";

/// The same table as text.
const CSV: &str = "records.csv";

/// Longest first line of a CSV file in bytes, and the size of its read buffer.
const LONGEST_HEADER: usize = 1 << 16;

/// Columns of a row that are no fields of its record: where the number comes from, so that tables of several machines can be joined.
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

/// Writes both files of the table: the fields of each record, then those of its origin.
pub(crate) fn write(dir: &Path, records: Vec<Record>, from: &Provenance) -> Result<(), RecordError> {
    let (program, machine) = (&from.program, &from.machine);
    let commit = program.revision();
    let texts =
        [&commit, &program.rustc, &program.profile, &machine.cpu, &machine.model, &machine.instructions];
    let threads = |record: &Record| if record.is_measured() { machine.threads } else { 0 };
    write_parquet(&dir.join(PARQUET), &records, &texts, threads)?;
    write_csv(&dir.join(CSV), records, &texts, threads)
}

fn write_parquet(
    path: &Path,
    records: &[Record],
    origin: &[&String; 6],
    threads: impl Fn(&Record) -> u32,
) -> Result<(), RecordError> {
    let mut all = columns::of(records);
    for (name, text) in ["commit", "rustc", "profile", "cpu", "model", "instructions"].iter().zip(origin) {
        all.push(Column::new_scalar(
            (*name).into(),
            Scalar::from(PlSmallStr::from(text.as_str())),
            records.len(),
        ));
    }
    all.push(Column::new("threads".into(), records.iter().map(threads).collect::<Vec<u32>>()));
    let mut frame = DataFrame::new(records.len(), all)?;
    let mut bytes = Vec::new();
    ParquetWriter::new(&mut bytes)
        .with_compression(ParquetCompression::Uncompressed)
        .set_parallel(false)
        .finish(&mut frame)?;
    disk::replace(path, |file| file.write_all(&bytes)).map_err(|source| unwritten(path, source))
}

/// Numbers have the fewest digits that give the same bits when they are read again; texts that a spreadsheet would take for a formula are
/// guarded.
fn write_csv(
    path: &Path,
    mut records: Vec<Record>,
    origin: &[&String; 6],
    threads: impl Fn(&Record) -> u32,
) -> Result<(), RecordError> {
    for text in records.iter_mut().flat_map(Record::texts_mut) {
        if let Cow::Owned(cell) = guarded(text) {
            *text = cell;
        }
    }
    let [commit, rustc, profile, cpu, model, instructions] = origin.map(|text| guarded(text));
    let rows = |file: &mut dyn Write| -> io::Result<()> {
        let mut file = csv::Writer::from_writer(file);
        for record in &records {
            let origin = Origin {
                commit: &commit,
                rustc: &rustc,
                profile: &profile,
                cpu: &cpu,
                model: &model,
                instructions: &instructions,
                threads: threads(record),
            };
            file.serialize((record, origin))?;
        }
        file.flush()
    };
    disk::replace(path, |file| rows(file)).map_err(|source| unwritten(path, source))
}

/// Reads the table of a folder: its Parquet file, or the CSV file of a folder that has none.
pub(crate) fn read(dir: &Path) -> Result<Vec<Record>, RecordError> {
    let path = dir.join(PARQUET);
    if path.exists() { read_parquet(&path) } else { read_csv(&dir.join(CSV)) }
}

fn read_parquet(path: &Path) -> Result<Vec<Record>, RecordError> {
    let bytes =
        disk::read(path, Kind::RESULTS).map_err(|source| RecordError::Io { path: path.into(), source })?;
    let content = |reason: String| RecordError::Content { path: path.into(), reason };
    // The reader trusts lengths in the file: damaged ones end it in a panic.
    let read = || ParquetReader::new(Cursor::new(bytes)).read_parallel(ParallelStrategy::None).finish();
    let frame = catch_unwind(AssertUnwindSafe(read)).map_err(|_| content("is damaged".into()))?;
    frame.and_then(|frame| columns::records(&frame)).map_err(|bad| content(bad.to_string()))
}

fn read_csv(path: &Path) -> Result<Vec<Record>, RecordError> {
    let io = |source| RecordError::Io { path: path.into(), source };
    let mut file = BufReader::with_capacity(LONGEST_HEADER, disk::open(path, Kind::RESULTS).map_err(io)?);
    // A file of zeros would be read to its end as one name of a column.
    let begin = file.fill_buf().map_err(io)?;
    if begin.len() == LONGEST_HEADER && !begin.contains(&b'\n') {
        let reason = format!("its first line has more than {LONGEST_HEADER} bytes");
        return Err(RecordError::Content { path: path.into(), reason });
    }
    let mut file = csv::Reader::from_reader(file);
    // Any file without rows would pass for a table without records, whose file is empty.
    let header = file.headers().map_err(|e| content(path, &e))?;
    if !header.is_empty() && header.iter().all(|name| name != "value") {
        return Err(RecordError::Content { path: path.into(), reason: "no column `value`".into() });
    }
    let mut records: Vec<Record> =
        file.deserialize().collect::<Result<_, _>>().map_err(|e| content(path, &e))?;
    for text in records.iter_mut().flat_map(Record::texts_mut).filter(|text| text.starts_with('\'')) {
        *text = unguarded(text).to_string();
    }
    Ok(records)
}

fn content(path: &Path, error: &csv::Error) -> RecordError {
    RecordError::Content { path: path.into(), reason: error.to_string() }
}
