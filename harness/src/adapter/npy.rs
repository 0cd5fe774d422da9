//! Arrays in NumPy's file format (`.npy`, written as version 1.0).

use std::path::Path;

const MAGIC: &[u8] = b"\x93NUMPY";
/// The header is padded to a multiple of this many bytes.
const ALIGNED: usize = 64;
/// Longest header that is read, bytes.
const LONGEST_HEAD: usize = 1 << 16;

/// Writes an array of shape (n, `columns`), or (n) if `columns` is 1, given row by row.
pub(crate) fn write_floats(
    path: &Path,
    columns: usize,
    values: impl Iterator<Item = f64>,
) -> Result<(), String> {
    write(path, "<f8", columns, values.map(f64::to_le_bytes))
}

/// Writes an array of integers in the same shape.
pub(crate) fn write_integers(
    path: &Path,
    columns: usize,
    values: impl Iterator<Item = i64>,
) -> Result<(), String> {
    write(path, "<i8", columns, values.map(i64::to_le_bytes))
}

fn write(
    path: &Path,
    kind: &str,
    columns: usize,
    numbers: impl Iterator<Item = [u8; 8]>,
) -> Result<(), String> {
    let bytes: Vec<u8> = numbers.flatten().collect();
    let rows = bytes.len() / (8 * columns);
    let shape = if columns == 1 { format!("({rows},)") } else { format!("({rows}, {columns})") };
    let head = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    let fill = ALIGNED - (MAGIC.len() + 4 + head.len() + 1) % ALIGNED;
    let length = (head.len() + fill + 1) as u16;
    let mut file = [MAGIC, &[1, 0], &length.to_le_bytes(), head.as_bytes()].concat();
    file.extend(std::iter::repeat_n(b' ', fill));
    file.push(b'\n');
    file.extend_from_slice(&bytes);
    disk::write(path, file).map_err(|bad| format!("{}: can't be written: {bad}", path.display()))
}

/// An array of numbers in row-major order.
#[derive(Debug, PartialEq)]
pub(crate) struct Array {
    /// Length along each axis.
    pub(crate) shape: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

/// Reads an array of floating-point numbers or integers.
///
/// # Errors
/// Returns an error if the file is missing, is not an array, or differs in length from its header. The
/// message leaves out the file's name.
pub(crate) fn read(path: &Path, kind: disk::Kind) -> Result<Array, String> {
    let bytes = disk::read(path, kind).map_err(|bad| format!("can't be read: {bad}"))?;
    let (head, data) = parts(&bytes)?;
    let kind = after(head, "'descr':").ok_or("its header has no 'descr'")?;
    let kind = kind.trim_start().trim_start_matches('\'').split('\'').next().unwrap_or_default();
    let shape = after(head, "'shape':").and_then(shape).ok_or("its header has no 'shape'")?;
    let of_columns =
        after(head, "'fortran_order':").is_some_and(|text| text.trim_start().starts_with("True"));
    let size = match kind {
        "<f8" | "<i8" => 8,
        "<f4" | "<i4" => 4,
        _ => {
            return Err(format!(
                "has numbers of type '{kind}'; supported types are '<f8', '<f4', '<i8' and '<i4'"
            ));
        }
    };
    let count = shape.iter().try_fold(1usize, |product, n| product.checked_mul(*n));
    let wanted = count.and_then(|count| count.checked_mul(size));
    if wanted != Some(data.len()) {
        return Err(format!(
            "its header gives the shape {shape:?} with {size} bytes per number, but {} bytes follow",
            data.len()
        ));
    }
    let value = |bytes: &[u8]| match (kind, bytes) {
        ("<f8", &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        ("<i8", &[a, b, c, d, e, f, g, h]) => i64::from_le_bytes([a, b, c, d, e, f, g, h]) as f64,
        ("<f4", &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]).into(),
        (_, &[a, b, c, d]) => i32::from_le_bytes([a, b, c, d]).into(),
        _ => f64::NAN,
    };
    let values: Vec<f64> = data.chunks_exact(size).map(value).collect();
    let values = if of_columns { by_rows(&values, &shape) } else { values };
    Ok(Array { shape, values })
}

/// Splits a file into its header and its data.
fn parts(bytes: &[u8]) -> Result<(&str, &[u8]), String> {
    let rest = bytes.strip_prefix(MAGIC).ok_or("is not a .npy file")?;
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (u16::from_le_bytes([*a, *b]) as usize, rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        _ => return Err("is a .npy file of an unknown version".into()),
    };
    if length > LONGEST_HEAD || length > rest.len() {
        return Err(format!("ends within its header of {length} bytes"));
    }
    let (head, data) = rest.split_at(length);
    Ok((std::str::from_utf8(head).map_err(|_| "its header is not text")?, data))
}

fn after<'a>(head: &'a str, key: &str) -> Option<&'a str> {
    head.split_once(key).map(|(_, behind)| behind)
}

/// Parses a shape such as `(3, 4)`, `(3,)` or `()`.
fn shape(text: &str) -> Option<Vec<usize>> {
    let inside = text.trim_start().strip_prefix('(')?.split(')').next()?;
    inside.split(',').map(str::trim).filter(|n| !n.is_empty()).map(|n| n.parse().ok()).collect()
}

/// Reorders values from column-major to row-major order.
fn by_rows(values: &[f64], shape: &[usize]) -> Vec<f64> {
    let mut at = vec![0; shape.len()];
    let mut out = Vec::with_capacity(values.len());
    for _ in 0..values.len() {
        let index = shape.iter().zip(&at).rev().fold(0, |index, (length, at)| index * length + at);
        out.push(values[index]);
        for axis in (0..shape.len()).rev() {
            at[axis] += 1;
            if at[axis] < shape[axis] {
                break;
            }
            at[axis] = 0;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back_to_the_same_bits() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.npy");
        let values = [1.0, -2.5e-17, f64::MAX, 0.1, 5e-324, -0.0];
        write_floats(&path, 3, values.into_iter()).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(bytes.len() % ALIGNED, 6 * 8 % ALIGNED);
        assert_eq!(
            read(&path, disk::Kind::ARRAY).unwrap(),
            Array { shape: vec![2, 3], values: values.to_vec() }
        );
        write_integers(&path, 1, [7, -1, 1 << 40].into_iter()).unwrap();
        let expected = Array { shape: vec![3], values: vec![7.0, -1.0, (1u64 << 40) as f64] };
        assert_eq!(read(&path, disk::Kind::ARRAY).unwrap(), expected);
        write_floats(&path, 3, std::iter::empty()).unwrap();
        assert_eq!(read(&path, disk::Kind::ARRAY).unwrap().shape, [0, 3]);
    }

    fn file(head: &str, data: &[u8]) -> Result<Array, String> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.npy");
        let length = (head.len() as u16).to_le_bytes();
        std::fs::write(&path, [MAGIC, &[1, 0], &length, head.as_bytes(), data].concat()).unwrap();
        read(&path, disk::Kind::ARRAY)
    }

    #[test]
    fn columns_become_rows_and_short_numbers_long_ones() {
        let head = "{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }\n";
        let data: Vec<u8> =
            [0f32, 10.0, 1.0, 11.0, 2.0, 12.0].into_iter().flat_map(f32::to_le_bytes).collect();
        assert_eq!(file(head, &data).unwrap().values, [0.0, 1.0, 2.0, 10.0, 11.0, 12.0]);
        let whole: Vec<u8> = (-3..3i32).flat_map(i32::to_le_bytes).collect();
        let head = "{'descr': '<i4', 'fortran_order': False, 'shape': (6,), }\n";
        assert_eq!(file(head, &whole).unwrap().values, [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0]);
    }

    #[test]
    fn a_file_that_is_no_array_is_refused_before_memory_is_taken() {
        let says = |head: &str, data: &[u8], says: &str| {
            let bad = file(head, data).unwrap_err();
            assert!(bad.contains(says), "{says}: {bad}");
        };
        says(
            "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 99999999999), }",
            b"",
            "99999999999",
        );
        says("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }", &[0; 40], "40 bytes");
        says("{'descr': '>f8', 'fortran_order': False, 'shape': (1,), }", &[0; 8], "'>f8'");
        says("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }", &[0; 8], "'|O'");
        says("{'descr': '<f8', 'fortran_order': False }", &[0; 8], "no 'shape'");
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.npy");
        for (bytes, says) in
            [(&b"garbage"[..], "is not a .npy"), (b"\x93NUMPY\x01\x00\xff\x00{", "ends within")]
        {
            std::fs::write(&path, bytes).unwrap();
            assert!(read(&path, disk::Kind::ARRAY).unwrap_err().contains(says));
        }
        assert!(read(&dir.path().join("none.npy"), disk::Kind::ARRAY).unwrap_err().contains("can't be read"));
    }
}
