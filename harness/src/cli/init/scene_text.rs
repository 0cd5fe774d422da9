//! The text of a scene: the template `scene.toml`, filled in.

use geometry::Point3;

use super::args::{Method, Side, Strain, word};
use super::tool::{STICK, Tool};
use crate::cli::args::LengthUnit;

const TEMPLATE: &str = include_str!("scene.toml");
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
    /// Line of the body's key for the treatment of its surface; empty without one.
    pub treatment: String,
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
    pub tool: Tool,
    /// Path of the tool's file in the scene; empty without one.
    pub tool_path: String,
    /// Coulomb's coefficient, if there is friction.
    pub friction: Option<f64>,
    /// Position of the tool's centre across its way, m.
    pub across: Point3,
    pub drive: Drive,
    /// Initial distance of the tool, m.
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
    let pressed = match (wanted.strain, &wanted.drive) {
        (Strain::Large, _) => "tool",
        (Strain::Small, Drive::Closure(_)) => "moved",
        (Strain::Small, Drive::Load(_)) => "loaded",
    };
    let values = wanted.values();
    let held = match wanted.hold {
        Hold::Where(_) => part("held").to_string(),
        Hold::On(_) => part("held").replace("where = ", "on = "),
    };
    let one = |name| filled(part(name), &values);
    let mut parts = vec![one("head"), filled(&held, &values), one(pressed)];
    if wanted.strain == Strain::Large {
        parts.extend(wanted.tools());
        parts.push(one("steps"));
    }
    parts.extend([one("compared"), one("methods")]);
    for &method in &wanted.methods {
        let name = word(method);
        let (about, table) = part(&name).split_once('\n').expect("a line about the method");
        let tables = SIZES.iter().zip(wanted.parts).map(|(fineness, part)| {
            // Half of the nodes of tet10 are on edges: small meshes have few cells.
            let doubled = if method == Method::Tet10 { 2.0 } else { 1.0 };
            let size = wanted.size_table(wanted.size.times(doubled * part));
            filled(table, &[("id", quoted(&format!("{name}-{fineness}"))), ("size", size)])
        });
        parts.push(format!("{about}\n{}", tables.collect::<Vec<_>>().join("\n\n")));
    }
    parts.join("\n\n") + "\n"
}

/// Returns a part of the template.
fn part(name: &str) -> &'static str {
    let mut parts = TEMPLATE.split("\n#: ").filter_map(|part| part.split_once('\n'));
    parts.find(|(known, _)| *known == name).expect("the template has the part").1.trim_end()
}

/// Replaces every `<value>` of a part of the template, together with its quotes. Values are not searched,
/// because they may contain any text.
fn filled(part: &str, values: &[(&str, String)]) -> String {
    let bare = part.replace("\"<", "<").replace(">\"", ">");
    let value = |name: &str| {
        values.iter().find(|(known, _)| *known == name).expect("a part has known values").1.as_str()
    };
    let pieces = bare.split(['<', '>']).enumerate();
    pieces.map(|(at, piece)| if at % 2 == 0 { piece } else { value(piece) }).collect()
}

/// Quotes a text for TOML.
pub(super) fn quoted(text: &str) -> String {
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

impl Wanted {
    fn length(&self, metres: f64) -> String {
        length(metres, self.unit, (self.bounds[1] - self.bounds[0]).amax())
    }

    fn height(&self) -> f64 {
        let axis = self.side.axis();
        self.bounds[1][axis] - self.bounds[0][axis]
    }

    /// Returns a point for a scene.
    fn point(&self, point: Point3) -> String {
        format!("[{}]", [0, 1, 2].map(|axis| quoted(&self.length(point[axis]))).join(", "))
    }

    /// Returns the tables of the tools, one for each side from which they come.
    fn tools(&self) -> Vec<String> {
        let sides = self.tool.sides(self.side);
        let of_side = |(at, side): (usize, &Side)| {
            filled(part("one-tool"), &self.tool_values(*side, &self.tool.name(at)))
        };
        sides.iter().enumerate().map(of_side).collect()
    }

    fn tool_values(&self, side: Side, name: &str) -> Vec<(&'static str, String)> {
        let (axis, sign) = (side.axis(), side.sign());
        let along = [0, 1, 2].map(|other| if other == axis { format!("{}", -sign) } else { "0".into() });
        let drive = match &self.drive {
            Drive::Closure(by) => format!("closure = {}", quoted(&self.length(by + self.gap))),
            Drive::Load(load) => format!("force = {}", quoted(load)),
        };
        let extents = self.bounds[1] - self.bounds[0];
        let shape = self
            .tool
            .shape(side, &quoted(&self.tool_path), self.unit.name, extents.min(), |l| self.length(l));
        // MPa/mm is 1e9 Pa/m.
        let penalty = STIFF * self.young_value / self.height() / 1e9;
        let slope = |value: f64| format!("{value:.2e} MPa/mm");
        let friction = self.friction.map_or(String::new(), |coefficient| {
            format!("\nfriction = {coefficient}\nstick = {}", quoted(&slope(STICK * penalty)))
        });
        vec![
            ("name", quoted(name)),
            ("shape", shape),
            ("at", self.place(side)),
            ("along", format!("[{}]", along.join(", "))),
            ("drive", format!("{{ {drive} }}")),
            ("penalty", quoted(&slope(penalty))),
            ("friction", friction),
        ]
    }

    /// Returns the position of a tool: a plate's is known, others stand where they touch the body.
    fn place(&self, side: Side) -> String {
        let (axis, sign) = (side.axis(), side.sign());
        if self.tool == Tool::Plate {
            let mut at = nalgebra::center(&self.bounds[0], &self.bounds[1]);
            at[axis] = self.bounds[usize::from(sign > 0.0)][axis] + sign * self.gap;
            return self.point(at);
        }
        let across = (0..3).filter(|&other| other != axis);
        let across = across.map(|other| {
            format!("{} = {}", ["x", "y", "z"][other], quoted(&self.length(self.across[other])))
        });
        let across: Vec<String> = across.collect();
        let gap = if self.gap > 0.0 {
            format!(", gap = {}", quoted(&self.length(self.gap)))
        } else {
            String::new()
        };
        format!("{{ touch = {}, {}{gap} }}", quoted(&side.name()), across.join(", "))
    }

    fn size_table(&self, size: Size) -> String {
        match size {
            Size::Nodes(count) => format!("{{ nodes = {count:.0} }}"),
            Size::Spacing(length) => format!("{{ spacing = {} }}", quoted(&self.length(length))),
        }
    }

    /// Returns the values of the template, except those of its methods.
    fn values(&self) -> Vec<(&'static str, String)> {
        let (axis, sign) = (self.side.axis(), self.side.sign());
        let name = ["x", "y", "z"][axis];
        let law = match self.strain {
            Strain::Large => "neo-hookean",
            Strain::Small => "linear",
        };
        let (Hold::Where(hold) | Hold::On(hold)) = &self.hold;
        let [low, high] = self.bounds;
        let spans = |axis: usize| format!("{} to {}", self.length(low[axis]), self.length(high[axis]));
        // The outermost point on the side of the plate.
        let end = self.bounds[usize::from(sign > 0.0)][axis];
        let than = if sign > 0.0 { ">=" } else { "<=" };
        let from = end - sign * PRESSED * self.height();
        let (moved, load) = match &self.drive {
            Drive::Closure(by) => (-sign * by, String::new()),
            Drive::Load(load) => (0.0, quoted(load)),
        };
        let preferred = [Method::Tet10, Method::Efg, Method::Tet4Nodal, Method::Tet4];
        let reference = preferred.into_iter().find(|method| self.methods.contains(method));
        vec![
            ("title", quoted(&self.title)),
            ("path", quoted(&self.path)),
            ("unit", quoted(self.unit.name)),
            ("treatment", self.treatment.clone()),
            ("law", quoted(law)),
            ("young", quoted(&self.young)),
            ("poisson", self.poisson.to_string()),
            ("x", spans(0)),
            ("y", spans(1)),
            ("z", spans(2)),
            ("hold", quoted(hold)),
            ("side", word(self.side)),
            ("tool", self.tool.words().into()),
            ("end", quoted(&format!("{name} {than} {}", self.length(from)))),
            ("move", format!("{{ {name} = {} }}", quoted(&self.length(moved)))),
            ("pressure", load),
            (
                "reference",
                quoted(&reference.map_or(String::new(), |method| format!("{}-fine", word(method)))),
            ),
            ("finer", self.size_table(self.size.times(FINER))),
            ("probes", format!("[{}]", self.probes.map(|probe| self.point(probe)).join(", "))),
        ]
    }
}
