//! The text of a scene, with comments on the purpose of each part and on changes to try next.

use std::fmt::Write as _;

use geometry::Point3;

use super::args::{Method, Side, Strain, word};
use crate::cli::args::LengthUnit;

/// Names of the sizes of each method.
const SIZES: [&str; 3] = ["coarse", "medium", "fine"];
/// Ratio of the reference's node count to that of the finest size.
const FINER: f64 = 6.0;
/// Contact stiffness of the plate (pressure per penetration), over Young's modulus divided by the body's
/// height. A tip of few contact points then sinks in by up to 4 % of the plate's travel, a broad surface by
/// 0.2 to 0.5 %. A tenth of this stiffness costs a quarter less time, but a tip sinks in by 20 %.
const STIFF: f64 = 5000.0;
/// Fraction of the height that is displaced or loaded at small strain, in place of contact with a plate.
const PRESSED: f64 = 0.1;

/// All values of the scene.
pub(super) struct Wanted {
    pub title: String,
    /// Path of the file in the scene.
    pub path: String,
    pub unit: LengthUnit,
    pub strain: Strain,
    pub young: String,
    /// Young's modulus, Pa.
    pub young_value: f64,
    pub poisson: f64,
    /// Constrained part: comparisons or a named surface.
    pub hold: Hold,
    pub side: Side,
    /// Bounding box of the body, m.
    pub bounds: [Point3; 2],
    pub drive: Drive,
    /// Initial distance of the plate, m.
    pub gap: f64,
    pub methods: Vec<Method>,
    pub size: Size,
    /// Node counts of each method's sizes relative to its finest size.
    pub parts: [f64; 3],
    /// Probes close to the plate and in the middle, m.
    pub probes: [Point3; 2],
}

/// The constrained part of the body.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Hold {
    Where(String),
    On(String),
}

/// Displacement or load of the plate.
pub(super) enum Drive {
    /// Displacement into the body, m.
    Closure(f64),
    /// Force, or pressure at small strain.
    Load(String),
}

/// Finest size of each method.
#[derive(Clone, Copy)]
pub(super) enum Size {
    Nodes(f64),
    /// Mean edge length, m.
    Spacing(f64),
}

impl Size {
    /// Describes the size.
    pub fn described(self) -> String {
        match self {
            Size::Nodes(count) => format!("{count} nodes"),
            Size::Spacing(length) => format!("{length} m"),
        }
    }

    /// Returns the size with `nodes` times the node count.
    pub fn times(self, nodes: f64) -> Size {
        match self {
            Size::Nodes(count) => Size::Nodes((count * nodes).round()),
            Size::Spacing(length) => Size::Spacing(length / nodes.cbrt()),
        }
    }
}

/// Returns the text of the whole scene.
pub(super) fn text(wanted: &Wanted) -> String {
    let parts = [head(wanted), wanted.held(), wanted.pressed(), wanted.compared(), wanted.run_by()];
    parts.join("\n")
}

/// Quotes a text for TOML.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// Formats a length in a unit, with decimals down to a thousandth of the body's size rounded down to a power
/// of ten.
pub(super) fn length(metres: f64, unit: LengthUnit, largest: f64) -> String {
    let decimals = (3.0 - (largest / unit.metres).log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{:.decimals$}", metres / unit.metres);
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    let text = if text == "-0" { "0" } else { text };
    format!("{text} {}", unit.name)
}

fn head(wanted: &Wanted) -> String {
    let law = match wanted.strain {
        Strain::Large => "neo-hookean",
        Strain::Small => "linear",
    };
    format!(
        r#"# Written by `tissuebench init`. Run it:  tissuebench run THIS --out RESULTS   (then open RESULTS/report/report.html)
# `tissuebench plan THIS` prints the stages of a run, and `tissuebench list` prints all names that a scene can use.
title = {title}

# The body. A closed surface, or the boundary of a mesh, is filled with tetrahedra of the size that each method gives.
[body]
shape = "file"
path = {path}
unit = "{unit}"

# The tissue. With a Poisson's ratio near 0.5 the tissue is nearly incompressible, and simple elements lock: try 0.49.
# `tissuebench list laws` prints the other laws.
[material]
law = "{law}"
young = {young}
poisson = {poisson}
"#,
        title = quoted(&wanted.title),
        path = quoted(&wanted.path),
        unit = wanted.unit.name,
        young = quoted(&wanted.young),
        poisson = wanted.poisson,
    )
}

impl Wanted {
    fn length(&self, metres: f64) -> String {
        length(metres, self.unit, (self.bounds[1] - self.bounds[0]).amax())
    }

    fn axis(&self) -> &'static str {
        ["x", "y", "z"][self.side.axis()]
    }

    fn height(&self) -> f64 {
        let axis = self.side.axis();
        self.bounds[1][axis] - self.bounds[0][axis]
    }

    /// Returns the coordinate of the outermost point on the side of the plate, m.
    fn end(&self) -> f64 {
        self.bounds[usize::from(self.side.sign() > 0.0)][self.side.axis()]
    }

    fn held(&self) -> String {
        let place = match &self.hold {
            Hold::Where(region) => format!("where = {}", quoted(region)),
            Hold::On(name) => format!("on = {}", quoted(name)),
        };
        let [low, high] = self.bounds.map(|p| [0, 1, 2].map(|axis| self.length(p[axis])));
        format!(
            r#"# The constrained part: nodes that satisfy comparisons joined by 'and', or `on` a named surface of the file.
# The body is x = {} to {}, y = {} to {}, z = {} to {}. fix = "xy" lets the body slide along z.
[[support]]
{place}
fix = "xyz"
"#,
            low[0], high[0], low[1], high[1], low[2], high[2]
        )
    }

    fn pressed(&self) -> String {
        match (self.strain, &self.drive) {
            (Strain::Large, drive) => self.plate(drive),
            (Strain::Small, drive) => {
                let (than, inside) = if self.side.sign() > 0.0 { (">=", -1.0) } else { ("<=", 1.0) };
                let from = self.length(self.end() + inside * PRESSED * self.height());
                let place = format!("where = \"{} {than} {from}\"", self.axis());
                match drive {
                    Drive::Closure(by) => format!(
                        r#"# The end of the body, moved as if bonded to a plate. Small strain has no contact search: for a plate in
# contact, run `tissuebench init --strain large`.
[[support]]
{place}
move = {{ {} = "{}" }}
"#,
                        self.axis(),
                        self.length(-self.side.sign() * by)
                    ),
                    Drive::Load(pressure) => format!(
                        r#"# The end of the body, under pressure.
[[load]]
{place}
pressure = {}
"#,
                        quoted(pressure)
                    ),
                }
            }
        }
    }

    fn plate(&self, drive: &Drive) -> String {
        let mut at = nalgebra::center(&self.bounds[0], &self.bounds[1]);
        at[self.side.axis()] = self.end() + self.side.sign() * self.gap;
        let at = [0, 1, 2].map(|axis| format!("\"{}\"", self.length(at[axis]))).join(", ");
        let along = [0, 1, 2].map(|axis| match axis == self.side.axis() {
            true if self.side.sign() > 0.0 => "-1",
            true => "1",
            false => "0",
        });
        let along = along.join(", ");
        let drive = match drive {
            Drive::Closure(by) => format!("closure = \"{}\"", self.length(by + self.gap)),
            Drive::Load(force) => format!("force = {}", quoted(force)),
        };
        // MPa/mm is 1e9 Pa/m.
        let penalty = STIFF * self.young_value / self.height() / 1e9;
        format!(
            r#"# A rigid plate from the {side}: `closure` is its displacement, `force` its force, `penalty` its pressure per penetration. Other shapes:
# sphere, cylinder, capsule, rounded-box; friction = 0.3 also needs `stick`.
[[tool]]
name = "plate"
shape = "plate"
at = [{at}]
along = [{along}]
drive = {{ {drive} }}
penalty = "{penalty:.2e} MPa/mm"

# Load steps, each solved to equilibrium and recorded. A step that fails is halved.
[procedure]
kind = "static"
steps = 4
"#,
            side = word(self.side),
        )
    }

    fn compared(&self) -> String {
        let preferred = [Method::Tet10, Method::Efg, Method::Tet4Nodal, Method::Tet4];
        let method = preferred.into_iter().find(|method| self.methods.contains(method));
        let method = method.map_or(String::new(), |method| format!("{}-fine", word(method)));
        let [near, middle] =
            self.probes.map(|p| [0, 1, 2].map(|axis| format!("\"{}\"", self.length(p[axis]))).join(", "));
        format!(
            r#"# The reference for the errors: a method below on a finer mesh. Refine the reference until the errors no longer change. Then
# `tissuebench reference` can store the solution, and `record = "FILE"` reads the stored file.
[reference]
method = "{method}"
size = {{ {size} }}

# Points at which displacements are reported: close to the plate, and in the middle.
[output]
probes = [[{near}], [{middle}]]
"#,
            size = self.size_key(self.size.times(FINER)),
        )
    }

    fn size_key(&self, size: Size) -> String {
        match size {
            Size::Nodes(count) => format!("nodes = {count:.0}"),
            Size::Spacing(length) => format!("spacing = \"{}\"", self.length(length)),
        }
    }

    /// Returns the tables of all methods, each in three sizes.
    fn run_by(&self) -> String {
        let mut text = String::from(
            "# The methods. Each method in three sizes gives one curve of run time against error. Remove methods that you do not need.\n\
             # `nodes` is met within a few per cent; `spacing = \"3 mm\"` is the mean length of the edges.\n",
        );
        for &method in &self.methods {
            writeln!(text, "\n# {}", about(method)).expect("a string");
            for (name, part) in SIZES.iter().zip(self.parts) {
                // Half of the nodes of tet10 are on edges: small meshes have few cells.
                let doubled = if method == Method::Tet10 { 2.0 } else { 1.0 };
                let size = self.size.times(doubled * part);
                let id = word(method);
                writeln!(text, "[[method]]\nid = \"{id}-{name}\"\nseries = \"{id}\"").expect("a string");
                writeln!(text, "{}size = {{ {} }}\n", keys(method), self.size_key(size)).expect("a string");
            }
            text.truncate(text.trim_end().len());
            text.push('\n');
        }
        text
    }
}

fn about(method: Method) -> &'static str {
    match method {
        Method::Tet4 => "tet4: the simplest element; too stiff for nearly incompressible tissue.",
        Method::Tet4Nodal => "tet4-nodal: tet4 with volume changes averaged at nodes, which does not lock.",
        Method::Tet10 => {
            "tet10: quadratic displacements, fewer elements for the same error. Twice the nodes of the other methods, because edges have nodes too."
        }
        Method::Efg => {
            "efg: element-free Galerkin on the nodes of a mesh, whose cells serve for integration only. Try basis = \"quadratic\" with \
             support_scale = 2.2."
        }
    }
}

fn keys(method: Method) -> &'static str {
    match method {
        Method::Tet4 => "family = \"fem\"\nelement = \"tet4\"\n",
        Method::Tet4Nodal => "family = \"fem\"\nelement = \"tet4\"\ndilation = \"nodal-mean\"\n",
        Method::Tet10 => "family = \"fem\"\nelement = \"tet10\"\n",
        Method::Efg => {
            "family = \"efg\"\nkernel = \"cubic-spline\"\nsupport_scale = 1.6\nbasis = \"linear\"\n\
             integration = { rule = \"cell-smoothed\", points = 1 }\nessential = \"penalty\"\n"
        }
    }
}
