//! Rigid bodies that do not rotate: the nodes attached to one move with it. (FEBio User Manual 4, 3.13.)

use std::collections::HashSet;

use roxmltree::Node;

use super::conditions::Conditions;
use super::curves::Course;
use super::fields::{Fields, Scaled, Source};
use crate::import::document::{Part, quoted};

/// A rigid body with its conditions.
pub(super) struct Body<'a> {
    pub name: &'a str,
    pub id: &'a str,
    pub node: Node<'a, 'a>,
    /// Its parts of the mesh.
    pub parts: Vec<&'a str>,
    /// Groups of attached nodes.
    pub groups: Vec<String>,
    fixed: [bool; 6],
    moved: Vec<(usize, Scaled<'a>)>,
}

const DOFS: [&str; 6] = ["Rx", "Ry", "Rz", "Ru", "Rv", "Rw"];

impl<'a> Body<'a> {
    /// A rigid material.
    pub fn of(material: Node<'a, 'a>, parts: Vec<&'a str>) -> Body<'a> {
        Body {
            name: material.attribute("name").unwrap_or_default(),
            id: material.attribute("id").unwrap_or_default(),
            node: material,
            parts,
            groups: Vec::new(),
            fixed: [false; 6],
            moved: Vec::new(),
        }
    }

    /// Displacement along each axis; `None`, and refused, if the body is free or rotates.
    pub fn motion(&self, source: &Source) -> Option<[Option<Scaled<'a>>; 3]> {
        let mut motion: [Option<Scaled<'a>>; 3] = [None; 3];
        let mut held = self.fixed;
        for &(dof, value) in &self.moved {
            if dof < 3 {
                motion[dof] = Some(value);
            } else if value.value != 0.0 {
                source.refuse(value.node, "a rigid body rotates", "a support of a scene does not");
            }
            held[dof] = true;
        }
        if let Some(free) = held.iter().position(|held| !held) {
            let what = format!("rigid body '{}' is free in {}", self.name, DOFS[free]);
            source.refuse(self.node, what, "a scene takes a rigid body whose whole motion is prescribed");
            return None;
        }
        Some(motion)
    }
}

/// Reads the conditions of rigid bodies and adds the supports of their nodes.
pub(super) fn read<'a>(
    bodies: &mut [Body<'a>],
    attached: &[Node<'a, 'a>],
    section: Vec<Node<'a, 'a>>,
    conditions: &mut Conditions<'a, '_>,
) {
    let source = conditions.source;
    for &node in attached {
        let fields = Fields::of(node, source);
        let name = fields.text("rb").unwrap_or_default();
        let group = conditions.mesh.nodes_of(node, source);
        match (bodies.iter_mut().find(|body| body.name == name || body.id == name), group) {
            (Some(body), Some(group)) => body.groups.push(group),
            (None, _) => source.refuse(node, format!("rigid body '{name}' is no material"), ""),
            _ => {}
        }
        fields.pass(&["clamp_shells"]);
        fields.finish();
    }
    for node in section {
        condition(node, bodies, conditions);
    }
    let mut seen = HashSet::new();
    for body in bodies.iter().filter(|body| !body.groups.is_empty()) {
        supports(body, conditions, &mut seen);
    }
}

fn condition<'a>(node: Node<'a, 'a>, bodies: &mut [Body<'a>], conditions: &Conditions<'a, '_>) {
    let source = conditions.source;
    let fields = Fields::of(node, source);
    let kind = node.attribute("type").unwrap_or_default();
    let name = fields.text("rb").unwrap_or_default();
    let body = bodies.iter_mut().find(|body| body.name == name || body.id == name);
    match (kind, body) {
        ("rigid_fixed", Some(body)) => {
            for (dof, fixed) in DOFS.iter().zip(&mut body.fixed) {
                *fixed |= fields.flag(&format!("{dof}_dof"));
            }
        }
        ("rigid_displacement" | "rigid_rotation", Some(body)) => {
            fields.pass(&["relative"]);
            let dof = fields.text("dof").unwrap_or_default();
            let index = DOFS.iter().position(|name| *name == dof || name.strip_prefix('R') == Some(dof));
            match (index, fields.scaled("value")) {
                (Some(index), Some(value)) => body.moved.push((index, value)),
                _ => source.refuse(node, format!("<dof> is '{dof}'"), "x, y, z, Ru, Rv and Rw are read"),
            }
        }
        (_, None) if ["rigid_fixed", "rigid_displacement", "rigid_rotation"].contains(&kind) => {
            source.refuse(node, format!("rigid body '{name}' is no material"), "");
        }
        _ => {
            let what = format!("<{}> '{kind}' can't be expressed", node.tag_name().name());
            source.refuse(node, what, "rigid bodies whose motion is prescribed are read");
            return;
        }
    }
    fields.finish();
}

/// Adds the supports of a body's nodes.
fn supports<'a>(body: &Body<'a>, conditions: &mut Conditions<'a, '_>, seen: &mut HashSet<String>) {
    let source = conditions.source;
    let Some(motion) = body.motion(source) else { return };
    for group in body.groups.iter().filter(|group| seen.insert((*group).clone())) {
        let origin = format!("rigid body '{}' (line {})", body.name, source.line(body.node));
        let part = || Part::new("[[support]]").note(&origin).key("on", quoted(group));
        let still: String =
            ["x", "y", "z"].iter().zip(&motion).filter(|(_, m)| m.is_none()).map(|(axis, _)| *axis).collect();
        if !still.is_empty() {
            conditions.supports.push(part().key("fix", quoted(&still)));
        }
        for (axis, value) in ["x", "y", "z"].into_iter().zip(motion) {
            let Some(value) = value else { continue };
            let Some(Course { factor, curve }) = conditions.controllers.course(value) else { continue };
            let part = conditions.motion(part(), axis, value.value, Course { factor, curve });
            conditions.supports.push(part);
        }
    }
}
