//! Materials. (FEBio User Manual 4, 4.1; FEBio Theory Manual, 5.)

use roxmltree::Node;

use super::curves::Controllers;
use super::fields::{Fields, Scaled, Source};
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
    keys: Keys,
    /// Active stress along the fibres.
    active: Option<Scaled<'a>>,
}

impl<'a> Material<'a> {
    /// Adds the keys of the law to a table.
    pub fn keys(&self, part: Part, controllers: &Controllers<'a, '_>, units: Units) -> Option<Part> {
        let mut part = self.keys.iter().fold(part, |part, (name, value)| part.key(name, value.clone()));
        if let Some(active) = self.active {
            let course = controllers.course(active)?;
            part = part.key("active", units.pressures(active.value * course.factor));
            part = part.maybe("active_curve", course.curve.map(|curve| quoted(&curve)));
        }
        Some(part.key("density", units.densities(self.density)))
    }
}

type Keys = Vec<(&'static str, String)>;

/// A law of a scene.
struct Law<'a> {
    keys: Keys,
    /// Whether it separates volume and shape.
    uncoupled: bool,
    /// Active stress along the fibres.
    active: Option<Scaled<'a>>,
}

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
    let Some(Law { keys, uncoupled, active }) = law(kind, &fields, &axes) else {
        if !source.findings.refuses() || !KNOWN.contains(&kind) {
            let help = format!("read are {}", KNOWN.join(", "));
            source.refuse(node, format!("material '{kind}' is no law of a scene"), &help);
        }
        return None;
    };
    fields.finish();
    if keys.iter().any(|(_, value)| value.contains("inf") || value.contains("NaN")) {
        source.refuse(node, format!("the constants of '{kind}' give no finite law"), "");
        return None;
    }
    Some(Material { name, node, uncoupled, density, keys, active })
}

/// Materials that are read.
const KNOWN: [&str; 11] = [
    "neo-Hookean",
    "isotropic elastic",
    "natural neo-Hookean",
    "porous neo-Hookean",
    "Mooney-Rivlin",
    "Ogden",
    "Ogden unconstrained",
    "Arruda-Boyce",
    "trans iso Mooney-Rivlin",
    "coupled trans-iso Mooney-Rivlin",
    "solid mixture",
];

fn law<'a>(kind: &str, fields: &Fields<'a, '_>, axes: &Axes) -> Option<Law<'a>> {
    let units = axes.units;
    let pressure = |value: f64| units.pressures(value);
    let named = |law: &str| ("law", quoted(law));
    let coupled = |keys: Keys| Law { keys, uncoupled: false, active: None };
    let elastic = |law: &str| -> Option<Law> {
        let (young, poisson) = (fields.needed("E"), fields.needed("v"));
        Some(coupled(vec![named(law), ("young", pressure(young?)), ("poisson", number(poisson?))]))
    };
    let uncoupled = |mut keys: Keys| -> Option<Law> {
        if fields.text("pressure_model").is_some_and(|model| !["0", "default"].contains(&model)) {
            fields.source.refuse(fields.node, "<pressure_model> is not the default", "");
        }
        if fields.flag("laugon") {
            fields.source.refuse(fields.node, "<laugon> augments the pressure", "give 0");
        }
        keys.push(("bulk", pressure(fields.needed("k")?)));
        keys.push(("volumetric", quoted("logarithmic")));
        Some(Law { keys, uncoupled: true, active: None })
    };
    match kind {
        "neo-Hookean" => elastic("neo-hookean"),
        "isotropic elastic" => elastic("saint-venant-kirchhoff"),
        "natural neo-Hookean" => elastic("hencky"),
        "porous neo-Hookean" => {
            let (young, solid) = (fields.needed("E")?, fields.needed("phi0")?);
            let law = named("porous-neo-hookean");
            Some(coupled(vec![law, ("young", pressure(young)), ("solid", number(solid))]))
        }
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
            // beta = 0 leaves -m ln J of the volumetric term; c = 2 mu.
            let terms = terms(fields);
            let mu = list(terms.iter().map(|[c, _]| pressure(c / 2.0)));
            let alpha = list(terms.iter().map(|[_, m]| number(*m)));
            let nu = list(terms.iter().map(|_| number(0.0)));
            let mut keys = vec![named("hyperfoam"), ("mu", mu), ("alpha", alpha), ("nu", nu)];
            if let Some(cp) = fields.number("cp").filter(|cp| *cp != 0.0) {
                keys.push(("kappa", pressure(cp)));
            }
            Some(coupled(keys))
        }
        "Arruda-Boyce" => {
            let (mu, chain) = (fields.needed("mu")?, fields.needed("N")?);
            let c = list(arruda_boyce(mu, chain).map(pressure));
            uncoupled(vec![named("yeoh"), ("c", c)])
        }
        "trans iso Mooney-Rivlin" => trans_iso(fields, axes).and_then(uncoupled),
        "coupled trans-iso Mooney-Rivlin" => coupled_trans_iso(fields, axes).map(coupled),
        "solid mixture" => mixture(fields, axes),
        _ => None,
    }
}

/// Constants of powers of `I1 - 3` of the series of Arruda and Boyce,
/// `mu sum_i a_i / N^(i - 1) (I1^i - 3^i)`: a law of Yeoh. (`FEArrudaBoyce.cpp`)
fn arruda_boyce(mu: f64, chain: f64) -> [f64; 5] {
    const A: [f64; 5] = [0.5, 0.1, 11.0 / 350.0, 19.0 / 1750.0, 519.0 / 134_750.0];
    let mut constants = [0.0; 5];
    for (i, a) in (1..).zip(A) {
        // (3 + x)^i by the binomial theorem.
        let mut binomial = 1.0;
        for k in 1..=i {
            binomial *= f64::from(i - k + 1) / f64::from(k);
            constants[k as usize - 1] += mu * a / chain.powi(i - 1) * binomial * 3f64.powi(i - k);
        }
    }
    constants
}

/// A matrix with fibres that see the whole stretch. `c1 (I1 - 3) - 2 c1 ln J + k/2 (ln J)^2` is the
/// neo-Hookean law with `mu = 2 c1` and `lambda = k`.
fn coupled_trans_iso(fields: &Fields, axes: &Axes) -> Option<Keys> {
    let (mu, lambda) = (2.0 * fields.needed("c1")?, fields.needed("k")?);
    if fields.number("c2").is_some_and(|c2| c2 != 0.0) {
        fields.source.refuse(fields.node, "<c2> is not 0", "a scene has this law for c2 = 0");
    }
    let mut keys = vec![
        ("law", quoted("trans-iso-neo-hookean")),
        ("young", axes.units.pressures(mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu))),
        ("poisson", number(lambda / (2.0 * (lambda + mu)))),
    ];
    let fibre = ["c3", "c4", "c5"].map(|tag| fields.number(tag).unwrap_or(0.0));
    keys.extend(straightening(fibre, fields.needed("lam_max")?, fields, axes)?);
    Some(keys)
}

/// Keys of fibres with the constants `c3` to `c5` that are straight at the stretch `lm`, along `<fiber>` or
/// `<mat_axis>`.
fn straightening([c3, c4, c5]: [f64; 3], lm: f64, fields: &Fields, axes: &Axes) -> Option<Keys> {
    let pressure = |value: f64| axes.units.pressures(value);
    Some(vec![
        ("c3", pressure(c3)),
        ("c4", number(c4)),
        ("c5", pressure(c5)),
        ("lm", number(lm)),
        ("fibers", axes.of(fields)?),
    ])
}

/// Reads a mixture of a neo-Hookean law with fibres or with an active stress, whose energies add up.
fn mixture<'a>(fields: &Fields<'a, '_>, axes: &Axes) -> Option<Law<'a>> {
    let source = fields.source;
    let mut parts = Vec::new();
    while let Some(solid) = fields.take("solid") {
        parts.push((solid.attribute("type").unwrap_or_default(), Fields::of(solid, source)));
    }
    let kinds: Vec<&str> = parts.iter().map(|(kind, _)| *kind).collect();
    let at = |kind: &str| parts.iter().position(|(other, _)| *other == kind);
    let fibres = at("fiber-exp-linear").or_else(|| at("prescribed uniaxial active contraction"));
    let (Some(matrix), Some(fibres), 2) = (at("neo-Hookean"), fibres, parts.len()) else {
        let help = "read is neo-Hookean with fiber-exp-linear or with prescribed uniaxial active contraction";
        source.refuse(fields.node, format!("the mixture of {} can't be expressed", kinds.join(", ")), help);
        return None;
    };
    let Law { mut keys, .. } = law("neo-Hookean", &parts[matrix].1, axes)?;
    let own = &parts[fibres].1;
    let active = match kinds[fibres] {
        "fiber-exp-linear" => {
            let [mut c3, c4, c5, lm] = ["c3", "c4", "c5", "lambda"].map(|tag| own.number(tag).unwrap_or(0.0));
            // Without a constant the slope is continuous. (FEFiberExpLinear.cpp)
            if c3 == 0.0 {
                c3 = c5 / c4 * (-c4 * (lm - 1.0)).exp();
            }
            keys.extend(straightening([c3, c4, c5], lm, own, axes)?);
            None
        }
        _ => {
            // Fibres without stiffness, along which the stress acts.
            keys.extend(straightening([0.0, 1.0, 0.0], 1.0, own, axes)?);
            own.scaled("T0")
        }
    };
    keys[0].1 = quoted("trans-iso-neo-hookean");
    for (_, part) in parts {
        // Mass counts once, as that of the mixture.
        part.pass(&["density"]);
        part.finish();
    }
    Some(Law { keys, uncoupled: false, active })
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
    keys.push(("fibers", axes.of(fields)?));
    Some(keys)
}

/// Directions of a material: the parts of the mesh that have it.
struct Axes<'s, 'a> {
    mesh: &'s Mesh<'a>,
    parts: &'s [&'s str],
    units: Units,
}

impl Axes<'_, '_> {
    /// Direction of a law as a value of the scene: that of `<fiber>` or `<mat_axis>`, x without them.
    fn of(&self, fields: &Fields) -> Option<String> {
        match fields.take("fiber").or_else(|| fields.take("mat_axis")) {
            None => Some(list([1.0, 0.0, 0.0].map(number))),
            Some(node) => self.direction(node, fields.source),
        }
    }

    /// Direction of `<fiber>` or of the first axis of `<mat_axis>`, as a value of the scene.
    fn direction(&self, node: Node, source: &Source) -> Option<String> {
        let kind = node.attribute("type").unwrap_or("vector");
        if kind == "user" && node.has_tag_name("fiber") && self.mesh.has_fibres {
            return Some(format!("{{ data = {} }}", quoted("fiber")));
        }
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
        let help = "a constant vector, angles, the same local nodes, spherical fibres, and fibres of elements are read";
        source.refuse(node, what, help);
        None
    }
}

/// Numbers of an element's text.
fn values(node: Node) -> Option<Vec<f64>> {
    let words = node.text()?.split(',').map(|word| word.trim().parse().ok());
    words.collect::<Option<Vec<f64>>>().filter(|values| values.iter().all(|value| value.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::arruda_boyce;

    /// The series in powers of `I1` against that in powers of `I1 - 3`.
    #[test]
    fn the_chains_of_arruda_and_boyce_are_a_law_of_yeoh() {
        let (mu, chain) = (2.5, 7.0);
        for first in [3.0_f64, 3.2, 5.0, 9.0] {
            let a = [0.5, 0.1, 11.0 / 350.0, 19.0 / 1750.0, 519.0 / 134_750.0];
            let term = |(i, a): (i32, f64)| mu * a / f64::powi(chain, i - 1) * (first.powi(i) - 3f64.powi(i));
            let expected: f64 = (1..).zip(a).map(term).sum();
            let c = arruda_boyce(mu, chain);
            let found: f64 = (1..).zip(c).map(|(k, c)| c * (first - 3.0).powi(k)).sum();
            assert!((found - expected).abs() <= 1e-13 * expected, "{first}: {found} {expected}");
        }
    }
}
