//! The writer: appended raw data in blocks of zlib, which ParaView, VTK and meshio open.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::{CellKind, FaceKind, Mesh};

/// Bytes of a block before they are packed, as VTK has them.
const BLOCK: usize = 1 << 15;

/// An XML head that names arrays by their offset in the bytes behind.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// Packs an array and returns its element.
    fn array(&mut self, name: &str, kind: &str, components: usize, bytes: &[u8]) -> String {
        let offset = self.bytes.len();
        let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK).map(packed).collect();
        let last = bytes.len() % BLOCK;
        let sizes = blocks.iter().map(Vec::len);
        for word in [blocks.len(), BLOCK, last].into_iter().chain(sizes) {
            self.bytes.extend((word as u64).to_le_bytes());
        }
        blocks.iter().for_each(|block| self.bytes.extend(block));
        let of = if components > 1 { format!(" NumberOfComponents=\"{components}\"") } else { String::new() };
        format!("<DataArray type=\"{kind}\" Name=\"{name}\"{of} format=\"appended\" offset=\"{offset}\"/>\n")
    }
}

fn packed(block: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    // Writing to memory can't fail.
    encoder.write_all(block).expect("memory takes it");
    encoder.finish().expect("memory takes it")
}

/// The file's bytes, in lengths of `unit` metres; or a name that it can't hold. Faces of groups are cells behind the solids.
pub(in crate::files) fn bytes(mesh: &Mesh, unit: f64) -> Result<Vec<u8>, String> {
    let groups: Vec<&str> = mesh.group_names().collect();
    let names = mesh.region_names().iter().map(String::as_str).chain(groups.iter().copied());
    if let Some(name) = names.into_iter().find(|name| name.is_empty() || name.contains(['\0', '\n', '\r'])) {
        return Err(name.into());
    }
    let (mut list, mut ends, mut types) = (Vec::<i64>::new(), Vec::<i64>::new(), Vec::<u8>::new());
    let (mut regions, mut surfaces) = (Vec::<i32>::new(), Vec::<i32>::new());
    for cell in 0..mesh.cell_count() {
        list.extend(mesh.cell(cell).iter().map(|&node| i64::from(node)));
        ends.push(list.len() as i64);
        types.push(type_number(mesh.kind(cell)));
        regions.push(mesh.region(cell).into());
        surfaces.push(-1);
    }
    for (surface, name) in groups.iter().enumerate() {
        for &facet in mesh.group(name).unwrap_or_default() {
            list.extend(mesh.facet_nodes(facet).map(i64::from));
            ends.push(list.len() as i64);
            types.push(face_number(mesh.kind(facet.cell as usize).face_kind()));
            regions.push(-1);
            surfaces.push(surface as i32);
        }
    }
    let points: Vec<u8> = mesh
        .points()
        .iter()
        .flat_map(|p| p.coords.iter().flat_map(|x| (x / unit).to_le_bytes()).collect::<Vec<_>>())
        .collect();
    let mut data = Appended::default();
    let mut head = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n",
    );
    head += &text_array("region-names", mesh.region_names().iter().map(String::as_str));
    head += &text_array("surface-names", groups.iter().copied());
    head += &format!(
        "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
        mesh.points().len(),
        types.len()
    );
    head += &data.array("Points", "Float64", 3, &points);
    head += "</Points>\n<Cells>\n";
    head += &data.array("connectivity", "Int64", 1, &little(&list, |v| v.to_le_bytes()));
    head += &data.array("offsets", "Int64", 1, &little(&ends, |v| v.to_le_bytes()));
    head += &data.array("types", "UInt8", 1, &types);
    head += "</Cells>\n<CellData>\n";
    head += &data.array("region", "Int32", 1, &little(&regions, |v| v.to_le_bytes()));
    head += &data.array("surface", "Int32", 1, &little(&surfaces, |v| v.to_le_bytes()));
    head += "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    let mut file = head.into_bytes();
    file.extend(data.bytes);
    file.extend(b"\n</AppendedData>\n</VTKFile>\n");
    Ok(file)
}

fn little<T: Copy, const N: usize>(values: &[T], bytes: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(|&value| bytes(value)).collect()
}

/// Texts as numbers of their characters, a zero behind each. An array of texts, which VTK has too, stops other readers (meshio).
fn text_array<'a>(name: &str, texts: impl Iterator<Item = &'a str>) -> String {
    let codes: Vec<String> = texts
        .flat_map(|text| text.bytes().chain([0]).collect::<Vec<_>>())
        .map(|code| code.to_string())
        .collect();
    let (count, codes) = (codes.len(), codes.join(" "));
    format!(
        "<DataArray type=\"UInt8\" Name=\"{name}\" NumberOfTuples=\"{count}\" format=\"ascii\">\n{codes}\n</DataArray>\n"
    )
}

fn type_number(kind: CellKind) -> u8 {
    match kind {
        CellKind::Tet4 => 10,
        CellKind::Hex8 => 12,
        CellKind::Tet10 => 24,
        CellKind::Hex20 => 25,
    }
}

fn face_number(kind: FaceKind) -> u8 {
    match kind {
        FaceKind::Tri3 => 5,
        FaceKind::Quad4 => 9,
        FaceKind::Tri6 => 22,
        FaceKind::Quad8 => 23,
    }
}
