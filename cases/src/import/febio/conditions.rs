//! Supports and loads. (FEBio User Manual 4, 3.10 and 3.11.)

use roxmltree::Node;

use super::curves::{Controllers, Course};
use super::fields::{Fields, Scaled, Source};
use super::mesh::Mesh;
use crate::import::document::{Part, list, quoted};
use crate::import::units::Units;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Reader of supports and loads, which become parts of the scene.
pub(super) struct Conditions<'a, 's> {
    pub mesh: &'s Mesh<'a>,
    pub controllers: &'s Controllers<'a, 's>,
    pub source: &'s Source<'s>,
    pub units: Units,
    /// Mass per volume, if all materials have the same.
    pub density: Option<f64>,
    pub supports: Vec<Part>,
    pub loads: Vec<Part>,
    pub tools: Vec<Part>,
}

impl<'a> Conditions<'a, '_> {
    /// Comment with the name and the line of a part.
    pub fn origin(&self, node: Node) -> String {
        let tag = node.tag_name().name();
        let kind = node.attribute("type").unwrap_or_default();
        let name = node.attribute("name").map_or(String::new(), |name| format!(" '{name}'"));
        format!("<{tag}> {kind}{name} (line {})", self.source.line(node))
    }

    /// Reads a `<bc>`; returns `false` for one that concerns a rigid body.
    pub fn boundary(&mut self, node: Node<'a, 'a>) -> bool {
        let fields = Fields::of(node, self.source);
        match node.attribute("type").unwrap_or_default() {
            "rigid" => return false,
            "zero displacement" | "fix" => self.fixed(&fields),
            "prescribed displacement" | "prescribe" => self.moved(&fields),
            // Solids have neither rotations nor displacements of shells; shells are refused elsewhere.
            kind @ ("zero rotation" | "zero shell displacement") => {
                self.source.findings.leave_out(self.source.line(node), format!("<bc> '{kind}'"));
                return true;
            }
            kind => {
                let help = "zero displacement and prescribed displacement are read";
                self.source.refuse(node, format!("<bc> '{kind}' can't be expressed"), help);
                return true;
            }
        }
        fields.finish();
        true
    }

    fn fixed(&mut self, fields: &Fields<'a, '_>) {
        let node = fields.node;
        let flags = AXES.iter().filter(|axis| fields.flag(&format!("{axis}_dof"))).copied().collect();
        let axes: String = match fields.text("dofs") {
            None => flags,
            Some(dofs) => {
                let dofs: Vec<&str> = dofs.split(',').map(str::trim).collect();
                AXES.into_iter().filter(|axis| dofs.contains(axis)).collect()
            }
        };
        if axes.is_empty() {
            self.source.findings.leave_out(self.source.line(node), "zero displacement without an axis");
            return;
        }
        let Some((key, place)) = self.mesh.place_of(node, self.units, self.source) else { return };
        let part = Part::new("[[support]]").note(self.origin(node));
        self.supports.push(part.key(key, place).key("fix", quoted(&axes)));
    }

    fn moved(&mut self, fields: &Fields<'a, '_>) {
        let node = fields.node;
        // There is one step, at whose beginning nothing has moved.
        fields.pass(&["relative"]);
        let axis = self.axis(fields);
        let value = fields.scaled("value").or_else(|| fields.scaled("scale"));
        let Some((key, place)) = self.mesh.place_of(node, self.units, self.source) else { return };
        let (Some(axis), Some(value)) = (axis, value) else { return };
        let Some(course) = self.controllers.course(value) else { return };
        let part = Part::new("[[support]]").note(self.origin(node)).key(key, place);
        let part = self.motion(part, axis, value.value, course);
        self.supports.push(part);
    }

    /// Adds a motion along an axis to a support.
    pub fn motion(&self, part: Part, axis: &str, value: f64, course: Course) -> Part {
        let value = value * course.factor;
        if value == 0.0 {
            return part.key("fix", quoted(axis));
        }
        let part = part.key("move", format!("{{ {axis} = {} }}", self.units.lengths(value)));
        part.maybe("curve", course.curve.map(|curve| quoted(&curve)))
    }

    /// Axis that `<dof>` names.
    fn axis(&self, fields: &Fields) -> Option<&'static str> {
        let text = fields.text("dof").unwrap_or_default();
        let axis = AXES.into_iter().find(|axis| *axis == text);
        if axis.is_none() {
            self.source.refuse(fields.node, format!("<dof> is '{text}'"), "x, y and z are read");
        }
        axis
    }

    /// Reads a part of `<Loads>`.
    pub fn load(&mut self, node: Node<'a, 'a>) {
        let fields = Fields::of(node, self.source);
        match (node.tag_name().name(), node.attribute("type").unwrap_or_default()) {
            ("surface_load", "pressure") => self.pressure(&fields),
            ("surface_load", "traction") => self.traction(&fields),
            ("nodal_load", "nodal_force") => self.nodal_forces(&fields),
            ("nodal_load", "nodal_load") => self.nodal_component(&fields),
            ("body_load", "const") => self.body_components(&fields),
            ("body_load", "body force") => self.body_force(&fields),
            (tag, kind) => {
                let help = "pressure, traction, nodal_force and body force are read";
                self.source.refuse(node, format!("<{tag}> '{kind}' can't be expressed"), help);
                return;
            }
        }
        fields.finish();
    }

    fn pressure(&mut self, fields: &Fields<'a, '_>) {
        let node = fields.node;
        let pressure = fields.field("pressure");
        let dead = fields.flag("linear");
        self.refuse_bottom(fields);
        fields.pass(&["symmetric_stiffness"]);
        let (Some(pressure), Some(surface)) = (pressure, self.mesh.surface_of(node, self.source)) else {
            return;
        };
        let (pressure, formula) = pressure;
        let Some(course) = self.controllers.course(pressure) else { return };
        let part = Part::new("[[load]]").note(self.origin(node)).key("on", quoted(surface));
        let value = match formula {
            None => self.units.pressures(pressure.value * course.factor),
            Some(formula) => formula.pressure(pressure.value * course.factor, self.units),
        };
        let part = part.key("pressure", value);
        let part = part.maybe("dead", dead.then(|| "true".into()));
        self.loads.push(part.maybe("curve", course.curve.map(|curve| quoted(&curve))));
    }

    fn refuse_bottom(&self, fields: &Fields) {
        if fields.flag("shell_bottom") {
            self.source.refuse(fields.node, "<shell_bottom> loads the bottom of shells", "");
        }
    }

    fn traction(&mut self, fields: &Fields<'a, '_>) {
        let node = fields.node;
        let traction = fields.vector("traction");
        let scale = fields.scaled("scale");
        let dead = fields.flag("linear");
        self.refuse_bottom(fields);
        let surface = self.mesh.surface_of(node, self.source);
        let (Some((traction, vector)), Some(surface)) = (traction, surface) else { return };
        let scale = scale.unwrap_or(vector);
        let Some(course) = self.controllers.course(scale) else { return };
        let part = Part::new("[[load]]").note(self.origin(node)).key("on", quoted(surface));
        let value = traction.map(|t| self.units.pressures(t * scale.value * course.factor));
        let part = part.key("traction", list(value));
        // A traction of a scene is per undeformed area unless it says otherwise.
        let part = part.maybe("dead", (!dead).then(|| "false".into()));
        self.loads.push(part.maybe("curve", course.curve.map(|curve| quoted(&curve))));
    }

    fn nodal_forces(&mut self, fields: &Fields<'a, '_>) {
        self.refuse_bottom(fields);
        fields.pass(&["relative"]);
        let Some((force, scaled)) = fields.vector("value") else { return };
        self.forces(fields.node, force, scaled);
    }

    fn nodal_component(&mut self, fields: &Fields<'a, '_>) {
        let axis = self.axis(fields);
        let scale = fields.scaled("scale").or_else(|| fields.scaled("value"));
        let (Some(axis), Some(scale)) = (axis, scale) else { return };
        let force = AXES.map(|other| if other == axis { 1.0 } else { 0.0 });
        self.forces(fields.node, force, scale);
    }

    /// Adds a force at each node of a set.
    fn forces(&mut self, node: Node<'a, 'a>, force: [f64; 3], scaled: Scaled<'a>) {
        let places = self.mesh.places_of(node, self.source);
        let (Some(places), Some(course)) = (places, self.controllers.course(scaled)) else { return };
        let at = places.iter().map(|place| list(place.map(|x| self.units.lengths(x))));
        let set = node.attribute("node_set").unwrap_or_default();
        let part = Part::new("[[load]]").note(self.origin(node)).note(format!("at the nodes of '{set}'"));
        let value = force.map(|f| self.units.forces(f * scaled.value * course.factor));
        let part = part.key("force", list(value)).key("at", list(at));
        self.loads.push(part.maybe("curve", course.curve.map(|curve| quoted(&curve))));
    }

    fn body_components(&mut self, fields: &Fields<'a, '_>) {
        for (axis, tag) in AXES.iter().enumerate() {
            if let Some(scaled) = fields.scaled(tag).filter(|scaled| scaled.value != 0.0) {
                let force = [0, 1, 2].map(|other| if other == axis { 1.0 } else { 0.0 });
                self.body(fields.node, force, scaled);
            }
        }
    }

    fn body_force(&mut self, fields: &Fields<'a, '_>) {
        if let Some((force, scaled)) = fields.vector("force") {
            self.body(fields.node, force, scaled);
        }
    }

    /// Adds a body force, which is given per mass and acts against its own direction.
    fn body(&mut self, node: Node<'a, 'a>, force: [f64; 3], scaled: Scaled<'a>) {
        let Some(density) = self.density else {
            let help = "a body force of a scene is the same everywhere";
            self.source.refuse(node, "a body force per mass on materials of different densities", help);
            return;
        };
        let Some(course) = self.controllers.course(scaled) else { return };
        let value = force.map(|f| self.units.body_forces(-density * f * scaled.value * course.factor));
        let part = Part::new("[[load]]").note(self.origin(node)).note("per mass, against its own direction");
        let part = part.key("body", list(value));
        self.loads.push(part.maybe("curve", course.curve.map(|curve| quoted(&curve))));
    }
}
