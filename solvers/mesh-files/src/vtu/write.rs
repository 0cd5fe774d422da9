//! Writer: appended raw data in zlib blocks, readable by ParaView, VTK and meshio.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use geometry::{FaceKind, Mesh, Point3};

use super::grid::GROUP;

/// Size of an uncompressed block in bytes, as in VTK.
const BLOCK: usize = 1 << 15;

/// Appended data, to which the XML head refers by offset.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// Compresses an array and returns its XML element.
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

    fn values(&mut self, values: &Data) -> String {
        match values {
            Data::Whole(name, values) => self.array(name, "Int32", 1, &little(values, i32::to_le_bytes)),
            Data::Real(Values { name, components, numbers }) => {
                self.array(name, "Float64", *components, &little(numbers, f64::to_le_bytes))
            }
        }
    }
}

fn packed(block: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    // Writing to memory cannot fail.
    encoder.write_all(block).expect("memory takes it");
    encoder.finish().expect("memory takes it")
}

/// Nodes of each cell, in VTK's order.
#[derive(Default)]
struct Cells {
    list: Vec<i64>,
    ends: Vec<i64>,
    types: Vec<u8>,
}

impl Cells {
    fn push(&mut self, nodes: impl Iterator<Item = u32>, kind: u8) {
        self.list.extend(nodes.map(i64::from));
        self.ends.push(self.list.len() as i64);
        self.types.push(kind);
    }

    fn of(mesh: &Mesh) -> Cells {
        let mut cells = Cells::default();
        for cell in 0..mesh.cell_count() {
            let nodes = mesh.cell(cell);
            let files = &mesh.kind(cell).entry().files;
            cells.push(files.vtk_order.iter().map(|&node| nodes[node]), files.vtk);
        }
        cells
    }
}

/// Named integers or reals of a grid, its points or its cells.
enum Data<'a> {
    Whole(&'a str, Vec<i32>),
    Real(&'a Values),
}

/// A data array of a file, with values at its points or in its cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    /// Name of the array in the file.
    pub name: &'static str,
    /// Number of components per point or cell; six are a symmetric tensor: xx, yy, zz, xy, yz, xz.
    pub components: usize,
    /// All values, with the components of a point or cell adjacent.
    pub numbers: Vec<f64>,
}

/// Returns the bytes of the file with lengths in units of `unit` metres. Faces of groups are cells after the
/// solids.
///
/// # Errors
/// A name that the format cannot represent.
pub(crate) fn bytes(mesh: &Mesh, unit: f64) -> Result<Vec<u8>, String> {
    let groups: Vec<&str> = mesh.group_names().collect();
    let further: Vec<(&str, &[u32])> = mesh.cell_groups().collect();
    let of_cells = further.iter().map(|(name, _)| *name);
    let names =
        mesh.region_names().iter().map(String::as_str).chain(of_cells.clone()).chain(groups.iter().copied());
    if let Some(name) = names.into_iter().find(|name| name.is_empty() || name.contains(['\0', '\n', '\r'])) {
        return Err(name.into());
    }
    let mut cells = Cells::of(mesh);
    let mut regions: Vec<i32> = (0..mesh.cell_count()).map(|cell| mesh.region(cell).into()).collect();
    let mut surfaces = vec![-1; mesh.cell_count()];
    for (surface, name) in groups.iter().enumerate() {
        for &facet in mesh.group(name).unwrap_or_default() {
            cells.push(mesh.facet_nodes(facet), mesh.facet_kind(facet).vtk());
            regions.push(-1);
            surfaces.push(surface as i32);
        }
    }
    let mut field = text_array("region-names", mesh.region_names().iter().map(String::as_str))
        + &text_array("surface-names", groups.iter().copied());
    if !further.is_empty() {
        field += &text_array("group-names", of_cells);
    }
    let arrays: Vec<String> = (0..further.len()).map(|at| format!("{GROUP}{at}")).collect();
    let mut data = vec![Data::Whole("region", regions), Data::Whole("surface", surfaces)];
    for ((_, members), array) in further.iter().zip(&arrays) {
        let mut is_in = vec![0; cells.types.len()];
        members.iter().for_each(|&cell| is_in[cell as usize] = 1);
        data.push(Data::Whole(array, is_in));
    }
    Ok(file(&field, (mesh.points(), unit), &cells, &[], &data))
}

/// Returns a .vtu file of a body with values of a solution at its points and in its cells, in SI units.
/// `time` is the instant, the load fraction or the mode number of the solution.
pub fn solution_vtu(mesh: &Mesh, time: f64, at_points: &[Values], in_cells: &[Values]) -> Vec<u8> {
    let regions = (0..mesh.cell_count()).map(|cell| mesh.region(cell).into()).collect();
    let at_points: Vec<Data> = at_points.iter().map(Data::Real).collect();
    let mut of_cells = vec![Data::Whole("region", regions)];
    of_cells.extend(in_cells.iter().map(Data::Real));
    file(&time_array(time), (mesh.points(), 1.0), &Cells::of(mesh), &at_points, &of_cells)
}

/// Returns a .vtu file of a surface of quadrilaterals, with points in m and values at the points. `bodies`
/// has the body index of each quadrilateral.
pub fn surface_vtu(
    points: &[Point3],
    quads: &[[u32; 4]],
    bodies: &[u32],
    time: f64,
    at_points: &[Values],
) -> Vec<u8> {
    let mut cells = Cells::default();
    quads.iter().for_each(|quad| cells.push(quad.iter().copied(), FaceKind::Quad4.vtk()));
    let at_points: Vec<Data> = at_points.iter().map(Data::Real).collect();
    let bodies = bodies.iter().map(|&body| body as i32).collect();
    file(&time_array(time), (points, 1.0), &cells, &at_points, &[Data::Whole("body", bodies)])
}

/// XML element with ParaView's name of the time.
fn time_array(time: f64) -> String {
    format!(
        "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">\n{time:e}\n</DataArray>\n"
    )
}

fn file(field: &str, (points, unit): (&[Point3], f64), cells: &Cells, at: &[Data], of: &[Data]) -> Vec<u8> {
    let coordinates: Vec<f64> = points.iter().flat_map(|p| p.coords.map(|x| x / unit).data.0[0]).collect();
    let mut data = Appended::default();
    let mut head = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n",
    );
    head += field;
    head += &format!(
        "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        points.len(),
        cells.types.len()
    );
    if !at.is_empty() {
        head += "<PointData>\n";
        at.iter().for_each(|values| head += &data.values(values));
        head += "</PointData>\n";
    }
    head += "<Points>\n";
    head += &data.array("Points", "Float64", 3, &little(&coordinates, f64::to_le_bytes));
    head += "</Points>\n<Cells>\n";
    head += &data.array("connectivity", "Int64", 1, &little(&cells.list, i64::to_le_bytes));
    head += &data.array("offsets", "Int64", 1, &little(&cells.ends, i64::to_le_bytes));
    head += &data.array("types", "UInt8", 1, &cells.types);
    head += "</Cells>\n<CellData>\n";
    of.iter().for_each(|values| head += &data.values(values));
    head += "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    let mut file = head.into_bytes();
    file.extend(data.bytes);
    file.extend(b"\n</AppendedData>\n</VTKFile>\n");
    file
}

fn little<T: Copy, const N: usize>(values: &[T], bytes: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(|&value| bytes(value)).collect()
}

/// XML array of strings as character codes, each terminated by a zero. VTK's own string arrays stop other
/// readers (meshio).
fn text_array<'a>(name: &str, texts: impl Iterator<Item = &'a str>) -> String {
    let codes: Vec<String> = texts
        .flat_map(|text| text.bytes().chain([0]).collect::<Vec<_>>())
        .map(|code| code.to_string())
        .collect();
    let count = codes.len();
    let codes = codes.join(" ");
    format!(
        "<DataArray type=\"UInt8\" Name=\"{name}\" NumberOfTuples=\"{count}\" format=\"ascii\">\n{codes}\n</DataArray>\n"
    )
}
