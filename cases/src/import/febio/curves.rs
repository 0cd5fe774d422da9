//! Load controllers, as curves of the scene. (FEBio User Manual 4, 3.15; `PointCurve.cpp`.)

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};

use roxmltree::Node;

use super::control::Control;
use super::fields::{Scaled, Source};
use crate::import::document::{Part, list, quoted};
use crate::import::units::{Units, number};

/// Largest difference from a straight line that is rounding, relative to the largest factor.
const ROUNDING: f64 = 1e-12;

#[derive(Clone, Copy, PartialEq)]
enum Between {
    Linear,
    Step,
    Smooth,
}

#[derive(Clone, Copy, PartialEq)]
enum Beyond {
    Constant,
    Extrapolate,
    Repeat,
}

struct Controller<'a> {
    node: Node<'a, 'a>,
    points: Vec<[f64; 2]>,
    between: Between,
    beyond: Beyond,
}

/// How a value follows its load controller.
pub(super) struct Course {
    /// Factor of the value in the scene.
    pub factor: f64,
    /// Curve that the value follows; the common growth unless given.
    pub curve: Option<String>,
}

/// Curves in use by name: times with factors, and their origin.
type Used = BTreeMap<String, (Vec<[f64; 2]>, String)>;

/// All load controllers of a model.
pub(super) struct Controllers<'a, 's> {
    all: HashMap<&'a str, Controller<'a>>,
    source: &'s Source<'s>,
    control: Control,
    /// Curves in use.
    used: RefCell<Used>,
}

impl<'a, 's> Controllers<'a, 's> {
    /// Reads `<LoadData>`. A controller of a kind that is not known is refused when it is used.
    pub fn read(section: Option<Node<'a, 'a>>, control: Control, source: &'s Source<'s>) -> Self {
        let nodes = section.into_iter().flat_map(|section| section.children());
        let read = |node: Node<'a, 'a>| Some((node.attribute("id")?, controller(node)?));
        let all = nodes.filter(Node::is_element).filter_map(read).collect();
        Controllers { all, source, control, used: RefCell::default() }
    }

    /// Course of a value. Without a controller it is constant: in statics it may then grow with the rest,
    /// because only its end counts.
    pub fn course(&self, scaled: Scaled) -> Option<Course> {
        let Some(id) = scaled.controller else {
            return Some(self.constant());
        };
        let Some(controller) = self.all.get(id) else {
            let what = format!("load controller {id} is no curve of points");
            self.source.refuse(scaled.node, what, "give LINEAR, STEP or SMOOTH points");
            return None;
        };
        let points = controller.points(&self.control);
        let end = points.last().map_or(0.0, |point| point[1]);
        let most = points.iter().fold(0.0, |most: f64, point| most.max(point[1].abs()));
        let all =
            |same: &dyn Fn(f64) -> f64| points.iter().all(|[t, f]| (f - same(*t)).abs() <= ROUNDING * most);
        if all(&|t| end * t / self.control.end) && !self.control.dynamic {
            return Some(Course { factor: end, curve: None });
        }
        if all(&|_| end) {
            return Some(Course { factor: end, ..self.constant() });
        }
        let name = controller.node.attribute("name").map_or_else(|| format!("LC{id}"), String::from);
        let origin = format!("Load controller {id} (line {})", self.source.line(controller.node));
        self.used.borrow_mut().insert(name.clone(), (points, origin));
        Some(Course { factor: 1.0, curve: Some(name) })
    }

    fn constant(&self) -> Course {
        if !self.control.dynamic {
            return Course { factor: 1.0, curve: None };
        }
        let name = "constant".to_string();
        let points = vec![[0.0, 1.0], [self.control.end, 1.0]];
        self.used
            .borrow_mut()
            .insert(name.clone(), (points, "Loads that are constant from the start".into()));
        Course { factor: 1.0, curve: Some(name) }
    }

    /// The curves in use.
    pub fn parts(&self, units: Units) -> Vec<Part> {
        let part = |(name, (points, origin)): (&String, &(Vec<[f64; 2]>, String))| {
            let part = Part::new("[[curve]]").note(origin).key("name", quoted(name));
            let part = match self.control.dynamic {
                true => part.key("time", list(points.iter().map(|point| units.times(point[0])))),
                false => {
                    part.key("part", list(points.iter().map(|point| number(point[0] / self.control.end))))
                }
            };
            part.key("factor", list(points.iter().map(|point| number(point[1]))))
        };
        self.used.borrow().iter().map(part).collect()
    }
}

fn controller<'a>(node: Node<'a, 'a>) -> Option<Controller<'a>> {
    if node.attribute("type") != Some("loadcurve") {
        return None;
    }
    let text = |tag| node.children().find(|child| child.has_tag_name(tag)).and_then(|child| child.text());
    let between = match text("interpolate").map(str::trim) {
        None | Some("LINEAR") => Between::Linear,
        Some("STEP") => Between::Step,
        Some("SMOOTH") => Between::Smooth,
        Some(_) => return None,
    };
    let beyond = match text("extend").map(str::trim) {
        None | Some("CONSTANT") => Beyond::Constant,
        Some("EXTRAPOLATE") => Beyond::Extrapolate,
        Some("REPEAT") => Beyond::Repeat,
        Some(_) => return None,
    };
    let points = node.children().find(|child| child.has_tag_name("points"))?;
    let mut read = Vec::new();
    for point in points.children().filter(Node::is_element) {
        let mut words = point.text()?.split(',').map(|word| word.trim().parse::<f64>());
        let (Some(Ok(t)), Some(Ok(f)), None) = (words.next(), words.next(), words.next()) else {
            return None;
        };
        if !t.is_finite() || !f.is_finite() || read.last().is_some_and(|[before, _]: &[f64; 2]| *before >= t)
        {
            return None;
        }
        read.push([t, f]);
    }
    (!read.is_empty()).then_some(Controller { node, points: read, between, beyond })
}

impl Controller<'_> {
    /// Points of the curve from 0 to the end. A straight one keeps its own points; others are taken at the
    /// ends of the steps, where the source takes them.
    fn points(&self, control: &Control) -> Vec<[f64; 2]> {
        let mut times: Vec<f64> = vec![0.0];
        if self.between == Between::Linear && self.beyond == Beyond::Constant {
            times.extend(self.points.iter().map(|point| point[0]).filter(|t| *t > 0.0 && *t < control.end));
        } else {
            times.extend((1..control.steps).map(|step| control.end * step as f64 / control.steps as f64));
        }
        times.push(control.end);
        let mut points: Vec<[f64; 2]> = times.into_iter().map(|t| [t, self.at(t)]).collect();
        // The source never sees the value at 0: a load that steps up acts from there.
        if self.between == Between::Step && control.dynamic {
            points[0][1] = points[1][1];
        }
        points
    }

    fn at(&self, t: f64) -> f64 {
        let points = &self.points;
        let (first, last) = (points[0], points[points.len() - 1]);
        if points.len() == 1 {
            return first[1];
        }
        if t >= first[0] && t <= last[0] {
            return self.inside(t);
        }
        match self.beyond {
            Beyond::Constant => {
                if t < first[0] {
                    first[1]
                } else {
                    last[1]
                }
            }
            Beyond::Repeat => {
                let length = last[0] - first[0];
                self.inside(first[0] + (t - first[0]).rem_euclid(length))
            }
            Beyond::Extrapolate => {
                let small = 0.001 * (last[0] - first[0]);
                let ends = match (self.between, t < first[0]) {
                    (Between::Step, true) => return first[1],
                    (Between::Step, false) => return last[1],
                    (Between::Linear, true) => [first, points[1]],
                    (Between::Linear, false) => [points[points.len() - 2], last],
                    (Between::Smooth, true) => [first, [first[0] + small, self.inside(first[0] + small)]],
                    (Between::Smooth, false) => [[last[0] - small, self.inside(last[0] - small)], last],
                };
                line(t, ends)
            }
        }
    }

    fn inside(&self, t: f64) -> f64 {
        let points = &self.points;
        if let Some(point) = points.iter().find(|point| point[0] == t) {
            return point[1];
        }
        let n = points.partition_point(|point| point[0] < t).clamp(1, points.len() - 1);
        let parabola = |from: usize| quadratic(t, [points[from], points[from + 1], points[from + 2]]);
        match self.between {
            Between::Step => points[n][1],
            Between::Linear => line(t, [points[n - 1], points[n]]),
            Between::Smooth if points.len() == 2 => line(t, [points[0], points[1]]),
            Between::Smooth if points.len() == 3 || n == 1 => parabola(0),
            Between::Smooth if n == points.len() - 1 => parabola(n - 2),
            Between::Smooth => {
                let ends = [[points[n - 1][0], parabola(n - 2)], [points[n][0], parabola(n - 1)]];
                line(t, ends)
            }
        }
    }
}

fn line(t: f64, [[t0, f0], [t1, f1]]: [[f64; 2]; 2]) -> f64 {
    f0 + (f1 - f0) * ((t - t0) / (t1 - t0))
}

/// Quadratic interpolation with the weights of the source, which are no Lagrange polynomials.
fn quadratic(t: f64, [[t0, f0], [t1, f1], [t2, f2]]: [[f64; 2]; 3]) -> f64 {
    let q0 = ((t2 - t) * (t1 - t)) / ((t2 - t0) * (t1 - t0));
    let q1 = ((t2 - t) * (t - t0)) / ((t2 - t1) * (t1 - t0));
    let q2 = ((t - t1) * (t - t0)) / ((t2 - t1) * (t2 - t0));
    f0 * q0 + f1 * q1 + f2 * q2
}
