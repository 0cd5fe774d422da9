//! Appearance of a method, the same in every figure of every report, independent of the order of methods.
//!
//! The name determines the colour and the marker, the family the dash and the filling. External solvers have
//! a colour each and the marker of the element. A name that is not in the table takes the colour of its
//! longest known prefix, as `efg-gauss-lumped` does of `efg-gauss`, and a marker by a hash. Two labels of one
//! figure never look the same: [`distinct`] gives the label of lower precedence another marker or shade.

use catalogue::element;
use plotters::style::RGBColor;
use records::Family;

/// Names of the markers in pages.
pub(crate) const MARKERS: [&str; 7] =
    ["circle", "square", "triangle", "diamond", "down", "pentagon", "hexagon"];

/// Colours of Okabe and Ito (2008) without yellow, which vanishes on white, followed by darker colours of Tol
/// (2021).
const COLOURS: [u32; 12] = [
    0xd55e00, 0x0072b2, 0xe69f00, 0x56b4e9, 0x009e73, 0xcc79a7, 0x4d4d4d, 0x882255, 0x999933, 0x332288,
    0x8c510a, 0x7f7f7f,
];

/// Name, colour and marker of the known methods. Methods that compete in one case differ in both.
const KNOWN: [(&str, u32, usize); 44] = [
    (element::TET4.name, 0xd55e00, 0),
    ("tet4-nodal", 0x8c510a, 4),
    (element::TET10.name, 0x0072b2, 1),
    ("tet10-mean", 0x332288, 5),
    ("tet10-p1", 0x6a51a3, 6),
    ("tet10-mixed", 0x7a9fd0, 5),
    (element::HEX8.name, 0xe69f00, 2),
    ("hex8-mean", 0xa88400, 4),
    (element::HEX20.name, 0x56b4e9, 3),
    ("hex20-reduced", 0xaa3377, 0),
    ("hex20-p1", 0x2c9c9c, 1),
    ("efg", 0x009e73, 0),
    ("efg-gauss", 0x009e73, 0),
    ("efg-smoothed", 0x66a61e, 1),
    ("efg-quadratic", 0x882255, 3),
    ("efg-projected", 0x1b7837, 2),
    ("efg-smoothed-projected", 0x999933, 5),
    ("efg-consistent", 0xcc79a7, 4),
    ("efg-coupled", 0x4d4d4d, 6),
    ("efg-eliminated", 0x5ab4ac, 3),
    ("efg-entropy", 0xe7298a, 5),
    ("efg-multipliers", 0x8da0cb, 1),
    ("efg-near", 0x7f7f7f, 2),
    ("efg-node-smoothed", 0x7570b3, 2),
    ("efg-node-stabilised", 0xb2182b, 6),
    ("efg-penalty", 0xa6761d, 0),
    ("efg-graded", 0xa6761d, 4),
    ("efg-refined", 0xb2182b, 3),
    ("efg-uniform", 0x7f7f7f, 1),
    ("cubic-spline", 0x009e73, 0),
    ("quartic-spline", 0x0072b2, 1),
    ("gaussian", 0xd55e00, 2),
    ("wendland-c2", 0xcc79a7, 3),
    ("measured", 0x4d4d4d, 0),
    ("reference", 0x4d4d4d, 0),
    ("work of loads and tools", 0x4d4d4d, 0),
    ("work on the body", 0x7f7f7f, 1),
    ("strain", 0x0072b2, 2),
    ("work of the stress", 0x56b4e9, 3),
    ("kinetic", 0xd55e00, 4),
    ("contact springs", 0x009e73, 5),
    ("lost in friction", 0xcc79a7, 6),
    ("lost in damping", 0x882255, 0),
    ("lost in the scheme", 0xe69f00, 1),
];

/// External solvers with the index of their colour in [`COLOURS`]; the marker is that of the element.
const SOLVERS: [(&str, usize); 6] =
    [("calculix", 4), ("dolfinx", 0), ("scikit-fem", 1), ("felupe", 7), ("ngsolve", 10), ("tissuebench", 6)];

/// Appearance of a label: colour, marker, dash and filling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    pub(crate) colour: RGBColor,
    /// Index into [`MARKERS`].
    pub(crate) marker: usize,
    /// Alternating drawn and omitted lengths in points; empty for a solid line.
    pub(crate) dash: &'static [f64],
    /// Whether the marker is only an outline, as for clouds, which distinguishes clouds from elements even in
    /// grey.
    pub(crate) open: bool,
}

impl Look {
    /// Appearance of a label such as `tet4`, `efg-gauss-lumped` or `efg (neighbours 12)`.
    pub(crate) fn of(label: &str, family: Family) -> Look {
        let name = label.split(" (").next().unwrap_or(label);
        let (colour, marker) = match longest(name) {
            Some((known, _, marker)) if family == Family::External && known != name => {
                (solver(&name[known.len() + 1..]), marker)
            }
            Some((known, colour, marker)) if known == label => (colour, marker),
            Some((_, colour, marker)) => {
                (colour, (marker + 1 + hash(label) % (MARKERS.len() - 1)) % MARKERS.len())
            }
            None => (COLOURS[hash(name) % COLOURS.len()], hash(label) / COLOURS.len() % MARKERS.len()),
        };
        let [_, red, green, blue] = colour.to_be_bytes();
        let dash: &[f64] = match family {
            Family::Fem | Family::Reference => &[],
            Family::Efg => &[5.0, 2.0],
            Family::External => &[6.0, 1.8, 1.5, 1.8],
            Family::Interp => &[1.5, 1.8],
        };
        Look {
            colour: RGBColor(red, green, blue),
            marker,
            dash,
            open: matches!(family, Family::Efg | Family::Interp),
        }
    }
}

/// Fractions of white mixed into a colour (negative: black), beginning with the colour itself.
const SHADES: [f64; 4] = [0.0, 0.35, -0.3, 0.6];

impl Look {
    /// The `k`-th alternative look of the same family: other markers first, then other shades. The 0-th is
    /// the look itself.
    fn other(self, k: usize) -> Look {
        let shade = SHADES[k / MARKERS.len() % SHADES.len()];
        let mixed = |c: u8| match shade < 0.0 {
            true => (f64::from(c) * (1.0 + shade)) as u8,
            false => (f64::from(c) + shade * (255.0 - f64::from(c))) as u8,
        };
        Look {
            colour: RGBColor(mixed(self.colour.0), mixed(self.colour.1), mixed(self.colour.2)),
            marker: (self.marker + k) % MARKERS.len(),
            ..self
        }
    }
}

/// Looks of labels, distinct among labels that are drawn `together`.
///
/// A name in the table takes precedence over a name matched by its prefix, and an earlier name over a later
/// one.
pub(crate) fn distinct(labels: &[(String, Family)], together: impl Fn(usize, usize) -> bool) -> Vec<Look> {
    let known = |label: &str| KNOWN.iter().position(|entry| entry.0 == label).unwrap_or(KNOWN.len());
    let mut order: Vec<usize> = (0..labels.len()).collect();
    order.sort_by_key(|&i| (known(&labels[i].0), &labels[i].0));
    let mut looks: Vec<Option<Look>> = vec![None; labels.len()];
    for &i in &order {
        let own = Look::of(&labels[i].0, labels[i].1);
        let taken: Vec<Look> =
            (0..labels.len()).filter(|&j| together(i, j)).filter_map(|j| looks[j]).collect();
        let all = MARKERS.len() * SHADES.len();
        looks[i] = (0..all).map(|k| own.other(k)).find(|look| !taken.contains(look)).or(Some(own));
    }
    looks.into_iter().flatten().collect()
}

/// Colour of an external solver.
fn solver(name: &str) -> u32 {
    let known = SOLVERS.into_iter().find(|entry| entry.0 == name);
    COLOURS[known.map_or(hash(name) % COLOURS.len(), |entry| entry.1)]
}

/// The table entry with the longest name that equals the given name or is a prefix of its words.
fn longest(name: &str) -> Option<(&'static str, u32, usize)> {
    let begins =
        |known: &str| name.strip_prefix(known).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'));
    KNOWN.into_iter().filter(|entry| begins(entry.0)).max_by_key(|entry| entry.0.len())
}

/// FNV-1a hash, the same on every machine.
fn hash(text: &str) -> usize {
    let mixed =
        text.bytes().fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    (mixed >> 33) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_of_one_family_that_compete_differ_in_colour_or_marker() {
        for (i, a) in KNOWN.iter().enumerate() {
            for b in &KNOWN[..i] {
                let aliases = [("efg-gauss", "efg"), ("reference", "measured")].contains(&(a.0, b.0));
                let comparable = a.0.split('-').next() == b.0.split('-').next();
                assert!(aliases || !comparable || (a.1, a.2) != (b.1, b.2), "{} {}", a.0, b.0);
            }
        }
    }

    #[test]
    fn no_two_labels_drawn_together_look_alike() {
        // Both kinds of integration, and four support scales, once looked the same.
        let names =
            ["efg", "efg-gauss", "efg (integration gauss-1)", "efg (integration gauss-4)", "cubic-spline"];
        let scales = ["efg-gauss-1.2", "efg-gauss-2.0", "efg-gauss-2.5", "efg-flat", "efg-separate"];
        let labels: Vec<_> = names.iter().chain(&scales).map(|n| (n.to_string(), Family::Efg)).collect();
        let looks = distinct(&labels, |_, _| true);
        for i in 0..looks.len() {
            assert!(looks[..i].iter().all(|look| *look != looks[i]), "{}", labels[i].0);
        }
        // The first name of the table keeps its own look, and so does every label that shares no figure with
        // another.
        assert_eq!(looks[0], Look::of("efg", Family::Efg));
        assert_eq!(distinct(&labels, |_, _| false)[3], Look::of(&labels[3].0, Family::Efg));
    }

    #[test]
    fn a_name_that_is_not_known_has_the_colour_of_its_beginning() {
        let of = |label| Look::of(label, Family::Efg);
        assert_eq!(of("efg-gauss-lumped").colour, of("efg-gauss").colour);
        assert_ne!(of("efg-gauss-lumped").marker, of("efg-gauss").marker);
        assert_eq!(of("efg (neighbours 12)").colour, of("efg").colour);
        let theirs = |label| Look::of(label, Family::External);
        assert_eq!(theirs("tet4-calculix").colour, theirs("hex20-calculix").colour);
        assert_eq!(theirs("tet4-calculix").marker, theirs("tet4-felupe").marker);
        assert_ne!(theirs("tet4-calculix").colour, theirs("tet4-felupe").colour);
        // `tet4x` does not begin with the word `tet4`.
        assert_eq!(longest("tet4x"), None);
        assert_ne!(Look::of("hex20", Family::Fem).dash, Look::of("hex20", Family::External).dash);
        assert_eq!(of("efg").dash, Look::of("other", Family::Efg).dash);
    }
}
