//! The long table as files: CSV, which is read back, and Parquet for data-frame programs.

use std::borrow::Cow;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;

use disk::Kind;
use polars::prelude::*;
use serde::Serialize;

use crate::cell::{guarded, unguarded};
use crate::columns;
use crate::error::{RecordError, unwritten};
use crate::provenance::Provenance;
use crate::record::Record;

/// File of the table in the folder of a run.
const CSV: &str = "records.csv";

/// The same table as a data frame.
const PARQUET: &str = "records.parquet";

/// Longest first line of a CSV file in bytes, and the size of its read buffer.
const LONGEST_HEADER: usize = 1 << 16;

/// Columns of a row that are no fields of its record: the origin of the number, so that tables of several
/// machines can be joined.
#[derive(Serialize)]
struct Origin<'a> {
    commit: &'a str,
    rustc: &'a str,
    profile: &'a str,
    cpu: &'a str,
    model: &'a str,
    instructions: &'a str,
    /// 0 for values, because only times and memory depend on the number of threads.
    threads: u32,
}

/// Writes both files of the table: the fields of each record, followed by those of its origin.
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

/// Writes the CSV file. Numbers have the fewest digits that preserve their bits. Texts that a spreadsheet
/// would evaluate as a formula are guarded.
fn write_csv(
    path: &Path,
    mut records: Vec<Record>,
    origin: &[&String; 6],
    threads: impl Fn(&Record) -> u32,
) -> Result<(), RecordError> {
    for text in records.iter_mut().flat_map(columns::texts) {
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

/// Reads the records of `records.csv`; their provenance is in a separate file.
pub(crate) fn read(dir: &Path) -> Result<Vec<Record>, RecordError> {
    let path = dir.join(CSV);
    let path = path.as_path();
    let io = |source| RecordError::Io { path: path.into(), source };
    let mut file = BufReader::with_capacity(LONGEST_HEADER, disk::open(path, Kind::RESULTS).map_err(io)?);
    // A file of zeros would be read to its end as the name of one column.
    let begin = file.fill_buf().map_err(io)?;
    if begin.len() == LONGEST_HEADER && !begin.contains(&b'\n') {
        let reason = format!("its first line has more than {LONGEST_HEADER} bytes");
        return Err(RecordError::Content { path: path.into(), reason });
    }
    let mut file = csv::Reader::from_reader(file);
    // The file of a table without records is empty. Without this check, any file without rows would pass for
    // such a table.
    let header = file.headers().map_err(|e| content(path, &e))?;
    if !header.is_empty() && header.iter().all(|name| name != "value") {
        return Err(RecordError::Content { path: path.into(), reason: "no column `value`".into() });
    }
    // Tables of older programs have the component and the index in the name of the quantity.
    let has_components = header.iter().any(|name| name == "component");
    let mut records: Vec<Record> =
        file.deserialize().collect::<Result<_, _>>().map_err(|e| content(path, &e))?;
    for text in records.iter_mut().flat_map(columns::texts).filter(|text| text.starts_with('\'')) {
        *text = unguarded(text).to_string();
    }
    if !has_components {
        let named = |mut record: Record| {
            let name = std::mem::take(&mut record.quantity);
            record.named(&name)
        };
        records = records.into_iter().map(named).collect();
    }
    Ok(records)
}

fn content(path: &Path, error: &csv::Error) -> RecordError {
    RecordError::Content { path: path.into(), reason: error.to_string() }
}

#[cfg(test)]
mod tests {
    use catalogue::metric;

    use super::*;

    #[test]
    fn both_files_have_every_digit_and_every_column() {
        let value = f64::from_bits(0.1_f64.to_bits() + 1);
        let one =
            Record { run: "a".into(), quantity: "=rms".into(), value, step: Some(3), ..Record::default() };
        let other =
            Record { value: -0.0, basis: Some("linear".into()), polynomial: Some(true), ..one.clone() };
        let records = vec![one, other];
        let dir = tempfile::tempdir().unwrap();
        write(dir.path(), records.clone(), &Provenance::default()).unwrap();
        assert_eq!(read(dir.path()).unwrap(), records);
        let file = std::fs::File::open(dir.path().join(PARQUET)).unwrap();
        let frame = ParquetReader::new(file).finish().unwrap();
        for column in columns::of(&records) {
            assert!(frame.column(column.name()).unwrap().equals_missing(&column), "{}", column.name());
        }
        let csv = std::fs::read_to_string(dir.path().join(CSV)).unwrap();
        let names: Vec<&str> = frame.get_column_names().iter().map(|name| name.as_str()).collect();
        assert_eq!(csv.lines().next().unwrap().split(',').collect::<Vec<_>>(), names);
    }

    #[test]
    fn a_table_of_an_older_program_is_read_as_one_of_today() {
        let of = |name: &str| metric::find(name).unwrap();
        let names = ["rms", "rms-z", "tool-force", "tool-force-2", "reaction-y-3", "l2"];
        let mut records: Vec<Record> = names.iter().map(|name| Record::default().with(of(name))).collect();
        records.push(Record { quantity: "of-another-program".into(), ..Record::default() });
        let dir = tempfile::tempdir().unwrap();
        write(dir.path(), records.clone(), &Provenance::default()).unwrap();
        let path = dir.path().join(CSV);
        let mut today = csv::Reader::from_path(&path).unwrap();
        let is_kept = |name: &&str| !["component", "index"].contains(name);
        let header = today.headers().unwrap().clone();
        let rows: Vec<csv::StringRecord> = today.records().map(Result::unwrap).collect();
        let mut older = csv::Writer::from_path(&path).unwrap();
        older.write_record(header.iter().filter(is_kept)).unwrap();
        for (row, record) in rows.iter().zip(&records) {
            let cells = header.iter().zip(row).filter(|(name, _)| is_kept(name));
            let name = record.name();
            let cell = |(head, cell)| if head == "quantity" { name.as_str() } else { cell };
            older.write_record(cells.map(cell)).unwrap();
        }
        older.flush().unwrap();
        assert_eq!(read(dir.path()).unwrap(), records);
    }
}
