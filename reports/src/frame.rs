//! The long table as one polars frame, to and from Parquet and CSV. The only file that names polars.

use std::fs::File;
use std::path::Path;

use polars::prelude::*;

use crate::error::ReportError;
use crate::record::{Provenance, Record};

/// Writes `records.parquet` and `records.csv`.
///
/// Beside a record's own fields every row carries `commit`, `rustc`, `cpu`, `features`, `profile` and `threads`, so that tables
/// of several machines can be joined. `threads` is 0 for values: they don't depend on it, only times and memory do.
pub(crate) fn write(dir: &Path, records: &[Record], from: &Provenance) -> Result<(), ReportError> {
    let parquet = dir.join("records.parquet");
    let mut frame = frame(records, from).map_err(|e| content(&parquet, &e))?;
    let text = serde_json::to_string(from).map_err(|e| content(&parquet, &e))?;
    let provenance = KeyValueMetadata::from_static(vec![("provenance".to_string(), text)]);
    ParquetWriter::new(create(&parquet)?)
        .with_compression(ParquetCompression::Uncompressed)
        .with_key_value_metadata(Some(provenance))
        .finish(&mut frame)
        .map_err(|e| content(&parquet, &e))?;
    let csv = dir.join("records.csv");
    CsvWriter::new(create(&csv)?).finish(&mut frame).map_err(|e| content(&csv, &e))
}

/// Reads the records of `records.parquet`; their provenance stands in a file of its own.
pub(crate) fn read(path: &Path) -> Result<Vec<Record>, ReportError> {
    let file = File::open(path).map_err(|source| ReportError::Io { path: path.into(), source })?;
    let frame = ParquetReader::new(file).finish().map_err(|e| content(path, &e))?;
    records(&frame).map_err(|e| content(path, &e))
}

fn create(path: &Path) -> Result<File, ReportError> {
    File::create(path).map_err(|source| ReportError::Io { path: path.into(), source })
}

fn content(path: &Path, error: &dyn std::fmt::Display) -> ReportError {
    ReportError::Content { path: path.into(), reason: error.to_string() }
}

fn frame(records: &[Record], from: &Provenance) -> PolarsResult<DataFrame> {
    let text = |f: fn(&Record) -> &str| records.iter().map(f).collect::<Vec<_>>();
    let count = |f: fn(&Record) -> u64| records.iter().map(f).collect::<Vec<_>>();
    let number = |f: fn(&Record) -> f64| records.iter().map(f).collect::<Vec<_>>();
    let constant = |s: &str| vec![s.to_string(); records.len()];
    df!(
        "case" => text(|r| &r.case),
        "method" => text(|r| &r.method),
        "family" => text(|r| &r.family),
        "variant" => text(|r| &r.variant),
        "parameters" => text(|r| &r.parameters),
        "poisson" => number(|r| r.poisson),
        "level" => records.iter().map(|r| r.level).collect::<Vec<_>>(),
        "nodes" => count(|r| r.nodes),
        "elements" => count(|r| r.elements),
        "points" => count(|r| r.points),
        "dofs" => count(|r| r.dofs),
        "spacing" => number(|r| r.spacing),
        "seed" => count(|r| r.seed),
        "quantity" => text(|r| &r.quantity),
        "unit" => text(|r| &r.unit),
        "phase" => text(|r| &r.phase),
        "statistic" => text(|r| &r.statistic),
        "value" => number(|r| r.value),
        "commit" => constant(&from.commit),
        "rustc" => constant(&from.rustc),
        "cpu" => constant(&from.cpu),
        "features" => constant(&from.features),
        "profile" => constant(&from.profile),
        "threads" => records.iter().map(|r| if r.is_measured() { from.threads } else { 0 }).collect::<Vec<_>>(),
    )
}

fn records(frame: &DataFrame) -> PolarsResult<Vec<Record>> {
    let text = |name: &str| -> PolarsResult<Vec<String>> {
        let column = frame.column(name)?.str()?;
        column.iter().map(|v| v.map(str::to_string).ok_or_else(|| empty(name))).collect()
    };
    let count = |name: &str| -> PolarsResult<Vec<u64>> {
        frame.column(name)?.u64()?.iter().map(|v| v.ok_or_else(|| empty(name))).collect()
    };
    let number = |name: &str| -> PolarsResult<Vec<f64>> {
        frame.column(name)?.f64()?.iter().map(|v| v.ok_or_else(|| empty(name))).collect()
    };
    let level: Vec<u32> = frame
        .column("level")?
        .u32()?
        .iter()
        .map(|v| v.ok_or_else(|| empty("level")))
        .collect::<PolarsResult<_>>()?;
    let (case, method, family) = (text("case")?, text("method")?, text("family")?);
    let (variant, parameters, quantity) = (text("variant")?, text("parameters")?, text("quantity")?);
    let (unit, phase, statistic) = (text("unit")?, text("phase")?, text("statistic")?);
    let (nodes, elements, points) = (count("nodes")?, count("elements")?, count("points")?);
    let (dofs, seed) = (count("dofs")?, count("seed")?);
    let (poisson, spacing, value) = (number("poisson")?, number("spacing")?, number("value")?);
    let record = |i: usize| Record {
        case: case[i].clone(),
        method: method[i].clone(),
        family: family[i].clone(),
        variant: variant[i].clone(),
        parameters: parameters[i].clone(),
        poisson: poisson[i],
        level: level[i],
        nodes: nodes[i],
        elements: elements[i],
        points: points[i],
        dofs: dofs[i],
        spacing: spacing[i],
        seed: seed[i],
        quantity: quantity[i].clone(),
        unit: unit[i].clone(),
        phase: phase[i].clone(),
        statistic: statistic[i].clone(),
        value: value[i],
    };
    Ok((0..frame.height()).map(record).collect())
}

fn empty(name: &str) -> PolarsError {
    PolarsError::NoData(format!("an empty cell in column {name}").into())
}
