//! Elements of a model with their children as fields: a field that nobody takes is refused.

use std::cell::RefCell;

use mesh_files::Lines;
use roxmltree::Node;

use super::formula::Formula;
use crate::import::finding::Findings;

/// The model that is being read.
pub(super) struct Source<'a> {
    pub lines: Lines,
    pub findings: &'a Findings,
}

impl Source<'_> {
    pub fn line(&self, node: Node) -> usize {
        self.lines.at(node)
    }

    /// Refuses an element.
    pub fn refuse(&self, node: Node, what: impl Into<String>, help: &str) {
        self.findings.refuse(self.line(node), what, help);
    }
}

/// A number of the model and the load controller that scales it.
#[derive(Clone, Copy)]
pub(super) struct Scaled<'a> {
    pub value: f64,
    pub controller: Option<&'a str>,
    pub node: Node<'a, 'a>,
}

/// Children of an element that have not been taken yet.
pub(super) struct Fields<'a, 's> {
    pub node: Node<'a, 'a>,
    pub source: &'s Source<'s>,
    rest: RefCell<Vec<Node<'a, 'a>>>,
}

impl<'a, 's> Fields<'a, 's> {
    pub fn of(node: Node<'a, 'a>, source: &'s Source<'s>) -> Fields<'a, 's> {
        Fields { node, source, rest: RefCell::new(node.children().filter(Node::is_element).collect()) }
    }

    /// Takes the child with this tag.
    pub fn take(&self, tag: &str) -> Option<Node<'a, 'a>> {
        let mut rest = self.rest.borrow_mut();
        let at = rest.iter().position(|node| node.has_tag_name(tag))?;
        Some(rest.remove(at))
    }

    /// Takes children that do not change the answer.
    pub fn pass(&self, tags: &[&str]) {
        tags.iter().for_each(|tag| while self.take(tag).is_some() {});
    }

    /// Text of a child.
    pub fn text(&self, tag: &str) -> Option<&'a str> {
        self.take(tag).map(|node| node.text().unwrap_or_default().trim())
    }

    /// Whether a child is 1; false if it is missing.
    pub fn flag(&self, tag: &str) -> bool {
        self.number(tag).is_some_and(|value| value != 0.0)
    }

    /// A number that no load controller may scale.
    pub fn number(&self, tag: &str) -> Option<f64> {
        let scaled = self.scaled(tag)?;
        if scaled.controller.is_some() {
            let what = format!("<{tag}> of {} varies over time", self.name());
            self.source.refuse(scaled.node, what, "constants of a scene do not");
        }
        Some(scaled.value)
    }

    /// A number with its load controller.
    pub fn scaled(&self, tag: &str) -> Option<Scaled<'a>> {
        let node = self.take(tag)?;
        let value = *numbers(node, self.source, 1)?.first()?;
        Some(Scaled { value, controller: node.attribute("lc"), node })
    }

    /// A number, or 1 with the formula that multiplies it, with its load controller.
    pub fn field(&self, tag: &str) -> Option<(Scaled<'a>, Option<Formula>)> {
        let formula = |node: &Node| node.has_tag_name(tag) && node.attribute("type") == Some("math");
        if !self.rest.borrow().iter().any(formula) {
            return self.scaled(tag).map(|scaled| (scaled, None));
        }
        let node = self.take(tag)?;
        let text = node.text().unwrap_or_default().trim();
        let Some(formula) = Formula::read(text) else {
            let help = "sums and products of numbers, X, Y and Z are read";
            self.source.refuse(node, format!("<{tag}> is the formula '{text}'"), help);
            return None;
        };
        Some((Scaled { value: 1.0, controller: node.attribute("lc"), node }, Some(formula)))
    }

    /// Three numbers with their load controller.
    pub fn vector(&self, tag: &str) -> Option<([f64; 3], Scaled<'a>)> {
        let node = self.take(tag)?;
        let values = numbers(node, self.source, 3)?;
        let scaled = Scaled { value: 1.0, controller: node.attribute("lc"), node };
        Some((values.try_into().ok()?, scaled))
    }

    /// A number that has to be there.
    pub fn needed(&self, tag: &str) -> Option<f64> {
        let has = self.rest.borrow().iter().any(|node| node.has_tag_name(tag));
        if !has {
            self.source.refuse(self.node, format!("{} has no <{tag}>", self.name()), "");
        }
        self.number(tag)
    }

    /// Name of the element in messages.
    pub fn name(&self) -> String {
        let tag = self.node.tag_name().name();
        let of = self.node.attribute("type").or(self.node.attribute("name"));
        of.map_or_else(|| format!("<{tag}>"), |of| format!("<{tag}> '{of}'"))
    }

    /// Refuses all children that have not been taken.
    pub fn finish(self) {
        for node in self.rest.borrow().iter() {
            let what = format!("<{}> of {} can't be expressed", node.tag_name().name(), self.name());
            self.source.refuse(*node, what, "");
        }
    }
}

/// Numbers of an element's text, of which there have to be `count`.
pub(super) fn numbers(node: Node, source: &Source, count: usize) -> Option<Vec<f64>> {
    let tag = node.tag_name().name();
    if let Some(kind) = node.attribute("type").filter(|kind| !["const", "vector"].contains(kind)) {
        source.refuse(node, format!("<{tag}> is given by '{kind}'"), "a scene takes a constant here");
        return None;
    }
    let text = node.text().unwrap_or_default();
    let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    let values: Option<Vec<f64>> =
        words.map(|word| word.parse().ok().filter(|value: &f64| value.is_finite())).collect();
    match values {
        Some(values) if values.len() == count => Some(values),
        _ => {
            let help = if count == 1 { "give one number" } else { "give three numbers" };
            source.refuse(node, format!("<{tag}> is '{}'", text.trim()), help);
            None
        }
    }
}
