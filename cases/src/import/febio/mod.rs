//! Models of FEBio, specification 4.0. (FEBio User Manual 4, chapter 3.)

mod conditions;
mod contact;
mod control;
mod curves;
mod fields;
mod formula;
mod material;
mod mesh;
mod rigid;

use std::collections::{HashMap, HashSet};

use roxmltree::{Document, Node};

use self::conditions::Conditions;
use self::control::Control;
use self::curves::Controllers;
use self::fields::{Fields, Source};
use self::material::Material;
use self::mesh::Mesh;
use self::rigid::Body;
use super::document::{Part, names, print, quoted};
use super::finding::{Finding, Findings};
use super::model::{Imported, Model, head};
use super::units::Units;

/// Sections that a scene has no use for.
const UNUSED: [&str; 2] = ["Output", "Globals"];
/// Sections that are read.
const READ: [&str; 14] = [
    "Module",
    "Control",
    "Material",
    "Mesh",
    "MeshDomains",
    "MeshData",
    "Boundary",
    "Loads",
    "LoadData",
    "Rigid",
    "Contact",
    "Constraints",
    "Output",
    "Globals",
];

/// Sections of a step that are read.
const OF_STEP: [&str; 6] = ["Control", "Boundary", "Loads", "Rigid", "Contact", "Constraints"];

/// Makes a scene of a model.
pub(super) fn import(bytes: &[u8], model: &Model) -> Result<Imported, Vec<Finding>> {
    let fault =
        |(line, what): (usize, String)| vec![Finding { file: model.file.into(), line, what, help: None }];
    let text = mesh_files::model_text(bytes).map_err(fault)?;
    let document =
        Document::parse(&text).map_err(|bad| fault((bad.pos().row as usize, format!("is no XML: {bad}"))))?;
    let findings = Findings::of(model.file);
    let scene = {
        let source = Source { lines: mesh_files::Lines::of(&text), findings: &findings };
        scene(document.root_element(), model, &source)
    };
    let left_out = findings.close()?;
    match scene {
        Some(parts) => {
            let head = head(model, "the FEBio model", &left_out);
            let parts: Vec<Part> = std::iter::once(head).chain(parts).collect();
            Ok(Imported { scene: print(&parts), left_out })
        }
        None => Err(fault((1, "is no model".into()))),
    }
}

fn scene<'a>(root: Node<'a, 'a>, model: &Model, source: &Source) -> Option<Vec<Part>> {
    if !version(root, source) {
        return None;
    }
    let step = only_step(root);
    let own = |tag: &str| root.children().find(|node| node.has_tag_name(tag));
    let in_step = |tag: &str| step.and_then(|step| step.children().find(|node| node.has_tag_name(tag)));
    let section = |tag: &str| in_step(tag).or_else(|| own(tag));
    let needed = |tag: &str| {
        section(tag).or_else(|| {
            source.refuse(root, format!("the model has no <{tag}>"), "");
            None
        })
    };
    let mesh_node = needed("Mesh");
    let control_node = needed("Control");
    for node in root.children().filter(|node| node.is_element()) {
        let tag = node.tag_name().name();
        if UNUSED.contains(&tag) {
            source.findings.leave_out(source.line(node), format!("<{tag}>"));
        } else if tag == "Step" && step.is_some() {
            let others = step.into_iter().flat_map(|step| step.children()).filter(Node::is_element);
            for node in others.filter(|node| !OF_STEP.contains(&node.tag_name().name())) {
                other_section(node, node.tag_name().name(), source);
            }
        } else if !READ.contains(&tag) && node.has_children() {
            other_section(node, tag, source);
        }
    }
    let mut mesh = Mesh::read(mesh_node?, source);
    own("MeshData").into_iter().for_each(|section| mesh.data(section, source));
    let materials = Materials::read(section("Material"), section("MeshDomains"), &mesh, model.units, source);
    let control: Control = control::read(control_node?, source)?;
    let controllers = Controllers::read(section("LoadData"), control, source);
    let mut conditions = Conditions {
        mesh: &mesh,
        controllers: &controllers,
        source,
        units: model.units,
        density: materials.density(),
        supports: Vec::new(),
        loads: Vec::new(),
        tools: Vec::new(),
    };
    let children = |tag: &str| {
        let sections = own(tag).into_iter().chain(in_step(tag));
        sections.flat_map(|section| section.children()).filter(Node::is_element).collect::<Vec<_>>()
    };
    let boundary = children("Boundary");
    let attached: Vec<Node> = boundary.into_iter().filter(|node| !conditions.boundary(*node)).collect();
    children("Loads").into_iter().for_each(|node| conditions.load(node));
    let body_parts = materials.body(&mesh, &controllers, model, source);
    let mut bodies = materials.rigid;
    rigid::read(&mut bodies, &attached, children("Rigid"), &mut conditions);
    children("Contact").into_iter().for_each(|node| contact::pair(node, &bodies, &mut conditions));
    children("Constraints").into_iter().for_each(|node| contact::wall(node, &mut conditions));
    let Conditions { supports, loads, tools, .. } = conditions;
    let mut parts = body_parts?;
    parts.extend(controllers.parts(model.units));
    parts.extend(supports);
    parts.extend(loads);
    parts.extend(tools);
    parts.push(control.part(source.line(control_node?), model.units));
    Some(parts)
}

/// The step of a model that has one.
fn only_step<'a>(root: Node<'a, 'a>) -> Option<Node<'a, 'a>> {
    let steps = root.children().find(|node| node.has_tag_name("Step"))?;
    let mut all = steps.children().filter(|node| node.has_tag_name("step"));
    all.next().filter(|_| all.next().is_none())
}

/// Refuses other versions and modules.
fn version(root: Node, source: &Source) -> bool {
    if !root.has_tag_name("febio_spec") {
        source.refuse(root, format!("<{}> is no FEBio model", root.tag_name().name()), "");
        return false;
    }
    let version = root.attribute("version").unwrap_or_default();
    if !["4.0", "3.0"].contains(&version) {
        let help = "save the model with FEBio Studio, which writes 4.0";
        source.refuse(root, format!("febio_spec version '{version}' is not read"), help);
        return false;
    }
    let module = root.children().find(|node| node.has_tag_name("Module"));
    let kind = module.and_then(|node| node.attribute("type")).unwrap_or("solid");
    if kind != "solid" {
        source.refuse(
            module.unwrap_or(root),
            format!("module '{kind}' can't be expressed"),
            "'solid' is read",
        );
        return false;
    }
    true
}

/// Refuses the parts of a section that is not read.
fn other_section(node: Node, tag: &str, source: &Source) {
    for child in node.children().filter(|child| child.is_element()) {
        let name = child.tag_name().name();
        let kind = child.attribute("type").map_or(String::new(), |kind| format!(" '{kind}'"));
        source.refuse(child, format!("<{name}>{kind} of <{tag}> can't be expressed"), "");
    }
}

/// The materials of a model and the parts of the mesh that have them.
struct Materials<'a> {
    deformable: Vec<(Material<'a>, Vec<&'a str>)>,
    rigid: Vec<Body<'a>>,
    /// Domains whose hexahedra do not follow their material.
    standard: HashSet<&'a str>,
}

impl<'a> Materials<'a> {
    fn read(
        section: Option<Node<'a, 'a>>,
        domains: Option<Node<'a, 'a>>,
        mesh: &Mesh<'a>,
        units: Units,
        source: &Source,
    ) -> Materials<'a> {
        let mut parts: HashMap<&str, Vec<&'a str>> = HashMap::new();
        let mut standard = HashSet::new();
        for node in domains.into_iter().flat_map(|section| section.children()).filter(Node::is_element) {
            let name = node.attribute("name").unwrap_or_default();
            parts.entry(node.attribute("mat").unwrap_or_default()).or_default().push(name);
            if domain(node, source) {
                standard.insert(name);
            }
        }
        let nodes = section.into_iter().flat_map(|section| section.children()).filter(Node::is_element);
        let all: Vec<Node> = nodes.collect();
        let is_rigid = |node: &Node| node.attribute("type") == Some("rigid body");
        let of = |node: &Node| parts.get(node.attribute("name").unwrap_or_default()).cloned();
        let stiff: HashSet<&str> =
            all.iter().filter(|node| is_rigid(node)).filter_map(of).flatten().collect();
        let mut read = Materials { deformable: Vec::new(), rigid: Vec::new(), standard };
        for node in all {
            let own = of(&node);
            if is_rigid(&node) {
                let mut body = Body::of(node, own.unwrap_or_default());
                let shared = body.parts.iter().filter(|part| mesh.shares_nodes(part, &stiff));
                body.groups.extend(shared.map(|part| part.to_string()));
                read.rigid.push(body);
            } else if let Some(own) = own {
                read.deformable.extend(
                    material::read(node, (mesh, &own), units, source).map(|material| (material, own)),
                );
            } else {
                let name = node.attribute("name").unwrap_or_default();
                source.findings.leave_out(source.line(node), format!("material '{name}', which no part has"));
            }
        }
        for part in mesh.parts.iter().filter(|part| part.solid.is_none() && !stiff.contains(part.name)) {
            let what = format!("elements {} '{}' can't be expressed", part.kind, part.name);
            source.refuse(part.node, what, "solids are read: tet4, tet10, hex8, hex20, penta6, penta15");
        }
        let known: HashSet<&str> = parts.values().flatten().copied().collect();
        for part in mesh.parts.iter().filter(|part| !known.contains(part.name)) {
            source.refuse(part.node, format!("part '{}' has no domain", part.name), "");
        }
        read
    }

    /// Mass per volume, if all materials have the same.
    fn density(&self) -> Option<f64> {
        let first = self.deformable.first()?.0.density;
        self.deformable.iter().all(|(material, _)| material.density == first).then_some(first)
    }

    /// The body, its materials and the method.
    fn body(
        &self,
        mesh: &Mesh<'a>,
        controllers: &Controllers<'a, '_>,
        model: &Model,
        source: &Source,
    ) -> Option<Vec<Part>> {
        let Some(((first, _), others)) = self.deformable.split_first() else {
            if !source.findings.refuses() {
                source.findings.refuse(1, "the model has no deformable solid", "");
            }
            return None;
        };
        let origin = |material: &Material| {
            let kind = material.node.attribute("type").unwrap_or_default();
            format!("<material> {kind} '{}' (line {})", material.name, source.line(material.node))
        };
        let body = Part::new("[body]")
            .note("The model itself is the mesh: its parts, node sets and surfaces keep their names.")
            .key("shape", quoted("file"))
            .key("path", quoted(model.path))
            .key("unit", quoted(model.units.length()));
        let mut parts =
            vec![body, first.keys(Part::new("[material]").note(origin(first)), controllers, model.units)?];
        for (material, own) in others {
            let part = Part::new("[[region]]").note(origin(material)).key("name", quoted(material.name));
            parts.push(part.key("on", names(own)));
            parts.push(material.keys(Part::new("[region.material]"), controllers, model.units)?);
        }
        parts.push(self.method(mesh, model, source)?);
        Some(parts)
    }

    /// The elements of the source, with one dilation each where the source has so.
    fn method(&self, mesh: &Mesh<'a>, model: &Model, source: &Source) -> Option<Part> {
        let (mut kinds, mut means) = (Vec::new(), HashSet::new());
        for (material, own) in &self.deformable {
            for part in mesh.parts.iter().filter(|part| own.contains(&part.name)) {
                let Some(kind) = part.solid else { continue };
                if !kinds.contains(&kind) {
                    kinds.push(kind);
                }
                // Quadratic hexahedra and linear tetrahedra have the standard dilation in any case.
                let three_field = ["hex8", "penta6", "tet10"].contains(&part.kind);
                means.insert(material.uncoupled && three_field && !self.standard.contains(part.name));
            }
        }
        let (linear, quadratic) = (["tet4", "hex8", "wedge6"], ["tet10", "hex20", "wedge15"]);
        let element = match &kinds[..] {
            [one] => one.name(),
            all if all.iter().all(|kind| linear.contains(&kind.name())) => "mixed-linear",
            all if all.iter().all(|kind| quadratic.contains(&kind.name())) => "mixed-quadratic",
            _ => {
                source.findings.refuse(1, "linear and quadratic elements in one body", "");
                return None;
            }
        };
        if means.len() > 1 {
            let what = "parts with one dilation in each element, and parts without";
            source.findings.refuse(1, what, "a method of a scene has one of them");
            return None;
        }
        let mean = means.contains(&true);
        let id = if mean { format!("{element}-mean") } else { element.to_string() };
        let part = Part::new("[[method]]").note("The elements of the model.").key("id", quoted(&id));
        let part = part.key("family", quoted("fem")).key("element", quoted(element));
        let part = part.maybe("dilation", mean.then(|| quoted("element-mean")));
        Some(part.key("size", model.size()))
    }
}

/// Quadrature that elements have unless a domain names another.
const FULL: [&str; 5] = ["HEX8G8", "HEX20G27", "TET4G1", "TET10G8", "PENTA6G6"];

/// Reads a domain; returns whether its elements have the standard dilation whatever their material.
fn domain(node: Node, source: &Source) -> bool {
    let tag = node.tag_name().name();
    let kind = node.attribute("type").unwrap_or_default();
    if let Some(rule) = node.attribute("elem_type").filter(|rule| !FULL.contains(rule)) {
        source.refuse(
            node,
            format!("quadrature '{rule}' can't be expressed"),
            "the full one of FEBio is read",
        );
    }
    let fields = Fields::of(node, source);
    if fields.flag("laugon") {
        let help = "a method of a scene has no multiplier of the pressure: give 0";
        source.refuse(node, format!("<laugon> of {} augments the pressure", fields.name()), help);
    }
    fields.pass(&["atol", "minaug", "maxaug"]);
    if tag == "SolidDomain" && kind != "ut4-solid" {
        fields.finish();
    }
    match (tag, kind) {
        // Other elements are refused by their type.
        ("SolidDomain", "" | "three-field-solid") | ("ShellDomain" | "BeamDomain", _) => false,
        ("SolidDomain", "elastic-solid" | "rigid-solid") => true,
        _ => {
            source.refuse(node, format!("<{tag}> '{kind}' can't be expressed"), "elastic-solid is read");
            false
        }
    }
}
