//! Materials. (FEBio User Manual 4, 4.1; FEBio Theory Manual, 5.)

use roxmltree::Node;

use super::fields::{Fields, Source};
use super::mesh::Mesh;
use crate::import::document::{Part, list, quoted};
use crate::import::units::{Units, number};

/// A material with the keys of its law.
pub(super) struct Material<'a> {
    pub name: &'a str,
    pub node: Node<'a, 'a>,
    /// Whether the law separates volume and shape, so that hexahedra have one dilation each.
    pub uncoupled: bool,
    /// Mass per volume, in the units of the model.
    pub density: f64,
    keys: Vec<(&'static str, String)>,
}

impl Material<'_> {
    /// Adds the keys of the law to a table.
    pub fn keys(&self, part: Part, units: Units) -> Part {
        let part = self.keys.iter().fold(part, |part, (name, value)| part.key(name, value.clone()));
        part.key("density", units.densities(self.density))
    }
}

/// Keys of a law, and whether it separates volume and shape.
type Law = (Vec<(&'static str, String)>, bool);

/// Reads a deformable material.
pub(super) fn read<'a>(
    node: Node<'a, 'a>,
    (mesh, parts): (&Mesh, &[&str]),
    units: Units,
    source: &Source,
) -> Option<Material<'a>> {
    let fields = Fields::of(node, source);
    let axes = Axes { mesh, parts, units };
    let name = node.attribute("name").unwrap_or_default();
    let density = fields.number("density").unwrap_or(1.0);
    let kind = node.attribute("type").unwrap_or_default();
    let Some((keys, uncoupled)) = law(kind, &fields, &axes) else {
        if !source.findings.refuses() || !KNOWN.contains(&kind) {
            let help = format!("read are {}", KNOWN.join(", "));
            source.refuse(node, format!("material '{kind}' is no law of a scene"), &help);
        }
        return None;
    };
    fields.finish();
    Some(Material { name, node, uncoupled, density, keys })
}

/// Materials that are read.
const KNOWN: [&str; 7] = [
    "neo-Hookean",
    "isotropic elastic",
    "natural neo-Hookean",
    "Mooney-Rivlin",
    "Ogden",
    "Ogden unconstrained",
    "trans iso Mooney-Rivlin",
];

fn law(kind: &str, fields: &Fields, axes: &Axes) -> Option<Law> {
    let units = axes.units;
    let pressure = |value: f64| units.pressures(value);
    let named = |law: &str| ("law", quoted(law));
    let elastic = |law: &str| -> Option<Law> {
        let (young, poisson) = (fields.needed("E"), fields.needed("v"));
        Some((vec![named(law), ("young", pressure(young?)), ("poisson", number(poisson?))], false))
    };
    let uncoupled = |mut keys: Vec<(&'static str, String)>| -> Option<Law> {
        if fields.text("pressure_model").is_some_and(|model| !["0", "default"].contains(&model)) {
            fields.source.refuse(fields.node, "<pressure_model> is not the default", "");
        }
        if fields.flag("laugon") {
            fields.source.refuse(fields.node, "<laugon> augments the pressure", "give 0");
        }
        keys.push(("bulk", pressure(fields.needed("k")?)));
        keys.push(("volumetric", quoted("logarithmic")));
        Some((keys, true))
    };
    match kind {
        "neo-Hookean" => elastic("neo-hookean"),
        "isotropic elastic" => elastic("saint-venant-kirchhoff"),
        "natural neo-Hookean" => elastic("hencky"),
        "Mooney-Rivlin" => {
            let (c1, c2) = (fields.needed("c1")?, fields.number("c2").unwrap_or(0.0));
            uncoupled(vec![named("mooney-rivlin"), ("c10", pressure(c1)), ("c01", pressure(c2))])
        }
        "Ogden" => {
            let terms = terms(fields);
            let mu = list(terms.iter().map(|[c, m]| pressure(c / m)));
            let alpha = list(terms.iter().map(|[_, m]| number(*m)));
            uncoupled(vec![named("ogden"), ("mu", mu), ("alpha", alpha)])
        }
        "Ogden unconstrained" => {
            if fields.number("cp").is_some_and(|cp| cp != 0.0) {
                let help = "a scene has this law for cp = 0";
                fields.source.refuse(fields.node, "<cp> of 'Ogden unconstrained' is not 0", help);
            }
            // beta = 0 leaves -m ln J of the volumetric term; c = 2 mu.
            let terms = terms(fields);
            let mu = list(terms.iter().map(|[c, _]| pressure(c / 2.0)));
            let alpha = list(terms.iter().map(|[_, m]| number(*m)));
            let nu = list(terms.iter().map(|_| number(0.0)));
            Some((vec![named("hyperfoam"), ("mu", mu), ("alpha", alpha), ("nu", nu)], false))
        }
        "trans iso Mooney-Rivlin" => trans_iso(fields, axes).and_then(uncoupled),
        _ => None,
    }
}

/// Terms `c_i`, `m_i` of Ogden's law that are not zero.
fn terms(fields: &Fields) -> Vec<[f64; 2]> {
    const NAMES: [[&str; 2]; 6] =
        [["c1", "m1"], ["c2", "m2"], ["c3", "m3"], ["c4", "m4"], ["c5", "m5"], ["c6", "m6"]];
    let all = NAMES.map(|[c, m]| [fields.number(c).unwrap_or(0.0), fields.number(m).unwrap_or(1.0)]);
    all.into_iter().filter(|[c, m]| *c != 0.0 && *m != 0.0).collect()
}

fn trans_iso(fields: &Fields, axes: &Axes) -> Option<Vec<(&'static str, String)>> {
    let pressure = |value: f64| axes.units.pressures(value);
    let value = |tag: &str| fields.number(tag).unwrap_or(0.0);
    let mut keys = vec![
        ("law", quoted("trans-iso-mooney-rivlin")),
        ("c10", pressure(value("c1"))),
        ("c01", pressure(value("c2"))),
        ("c3", pressure(value("c3"))),
        ("c4", number(value("c4"))),
        ("c5", pressure(value("c5"))),
        ("lm", number(fields.needed("lam_max")?)),
    ];
    let fiber = fields.take("fiber").or_else(|| fields.take("mat_axis"));
    let direction = match fiber {
        None => Some(list([1.0, 0.0, 0.0].map(number))),
        Some(node) => axes.direction(node, fields.source),
    };
    keys.push(("fibers", direction?));
    Some(keys)
}

/// Directions of a material: the parts of the mesh that have it.
struct Axes<'s, 'a> {
    mesh: &'s Mesh<'a>,
    parts: &'s [&'s str],
    units: Units,
}

impl Axes<'_, '_> {
    /// Direction of `<fiber>` or of the first axis of `<mat_axis>`, as a value of the scene.
    fn direction(&self, node: Node, source: &Source) -> Option<String> {
        let kind = node.attribute("type").unwrap_or("vector");
        let inner = |tag: &str| node.children().find(|child| child.has_tag_name(tag)).and_then(values);
        let vector = |values: Option<Vec<f64>>| <[f64; 3]>::try_from(values?).ok();
        let constant = match kind {
            "angles" => {
                let angle = |tag: &str| inner(tag).and_then(|values| values.first().copied());
                let [theta, phi] = [angle("theta").unwrap_or(0.0), angle("phi").unwrap_or(90.0)];
                let [theta, phi] = [theta.to_radians(), phi.to_radians()];
                Some([theta.cos() * phi.sin(), theta.sin() * phi.sin(), phi.cos()])
            }
            "vector" => vector(inner("a").or_else(|| inner("vector")).or_else(|| values(node))),
            "local" => {
                let ends = inner("local").or_else(|| values(node)).unwrap_or_else(|| vec![1.0, 2.0]);
                let ends = <[f64; 2]>::try_from(ends).ok().map(|ends| ends.map(|end| end as usize));
                ends.and_then(|ends| self.mesh.local_direction(self.parts, ends, source))
            }
            _ => None,
        };
        if let Some(constant) = constant {
            return Some(list(constant.map(number)));
        }
        let first = vector(inner("vector")).is_none_or(|vector| vector == [1.0, 0.0, 0.0]);
        if kind == "spherical" && first {
            let centre = vector(inner("center")).unwrap_or_default();
            let axes = ["x", "y", "z"].into_iter().zip(centre);
            // Expressions are in metres.
            return Some(list(axes.map(|(axis, at)| quoted(&format!("{axis} - {}", self.units.metres(at))))));
        }
        let what = format!("<{}> is given by '{kind}'", node.tag_name().name());
        let help = "a constant vector, angles, the same local nodes, and spherical fibres are read";
        source.refuse(node, what, help);
        None
    }
}

/// Numbers of an element's text.
fn values(node: Node) -> Option<Vec<f64>> {
    let words = node.text()?.split(',').map(|word| word.trim().parse().ok());
    words.collect::<Option<Vec<f64>>>().filter(|values| values.iter().all(|value| value.is_finite()))
}
