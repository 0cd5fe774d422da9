//! `<Control>`: the procedure of the scene. (FEBio User Manual 4, 3.3.)

use roxmltree::Node;

use super::fields::{Fields, Source};
use crate::import::document::{Part, quoted};
use crate::import::units::{Units, number};

/// Time of a model.
#[derive(Clone, Copy)]
pub(super) struct Control {
    /// End of the time axis.
    pub end: f64,
    /// Number of equal steps.
    pub steps: usize,
    /// Whether mass acts.
    pub dynamic: bool,
    /// Spectral radius of the time integration at infinite frequency; negative for Newmark's trapezoidal
    /// rule.
    radius: f64,
}

/// Largest number of steps.
const MOST_STEPS: f64 = 1e6;
/// Rounding of a number of steps.
const ROUNDING: f64 = 1e-9;

/// Parts of `<Control>` that steer Newton's method and the output.
const STEERING: [&str; 9] = [
    "plot_zero_state",
    "plot_range",
    "plot_level",
    "plot_stride",
    "output_level",
    "output_stride",
    "adaptor_re_solve",
    "integration",
    "linear_solver",
];

/// Reads `<Control>`.
pub(super) fn read(node: Node, source: &Source) -> Option<Control> {
    let fields = Fields::of(node, source);
    let dynamic = match fields.text("analysis") {
        None | Some("STATIC" | "0" | "static") => false,
        Some("DYNAMIC" | "1" | "dynamic") => true,
        Some(other) => {
            source.refuse(node, format!("<analysis> is '{other}'"), "STATIC and DYNAMIC are read");
            return None;
        }
    };
    let steps = fields.needed("time_steps")?;
    let size = fields.needed("step_size")?;
    if !(1.0..=MOST_STEPS).contains(&steps) || steps.fract() != 0.0 || size <= 0.0 {
        let help = "give 1 to 1,000,000 steps of a positive size";
        source.refuse(node, format!("{steps} steps of {size}"), help);
        return None;
    }
    let stepper = fields.take("time_stepper");
    let radius = fields.take("solver").map_or(Some(-2.0), |solver| solver_radius(solver, dynamic, source))?;
    fields.pass(&STEERING);
    fields.finish();
    let line = source.line(node);
    source.findings.leave_out(line, "tolerances, line search and output of <Control>");
    if dynamic && radius >= 0.0 {
        let what = "the forces of the mean deformation of each step (rhoi 0 to 1), with energy conserved for rhoi = 1: \
            the scene takes the mean of the forces at both ends";
        source.findings.leave_out(line, what);
    }
    let end = steps * size;
    // The automatic time stepper never exceeds its largest step.
    let most = stepper.and_then(|stepper| inner(stepper, "dtmax")).filter(|most| dynamic && *most > 0.0);
    let steps = most.map_or(steps, |most| steps.max((end / most - ROUNDING).ceil())).min(MOST_STEPS);
    Some(Control { end, steps: steps as usize, dynamic, radius })
}

/// Spectral radius of a solver; negative for Newmark's method.
fn solver_radius(solver: Node, dynamic: bool, source: &Source) -> Option<f64> {
    if let Some(kind) = solver.attribute("type").filter(|kind| *kind != "solid") {
        source.refuse(solver, format!("<solver> is '{kind}'"), "the solver 'solid' is read");
        return None;
    }
    let value = |tag: &str| inner(solver, tag);
    for (tag, usual) in [("arc_length", 0.0), ("mass_lumping", 0.0), ("dyn_damping", 1.0), ("alpha", 1.0)] {
        if let Some(found) = value(tag).filter(|found| *found != usual) {
            source.refuse(solver, format!("<{tag}> is {found}"), &format!("{usual} is read"));
        }
    }
    let radius = value("rhoi").unwrap_or(-2.0);
    for (tag, usual) in [("beta", 0.25), ("gamma", 0.5)].into_iter().filter(|_| dynamic && radius < 0.0) {
        if let Some(found) = value(tag).filter(|found| *found != usual) {
            source.refuse(solver, format!("<{tag}> is {found}"), &format!("{usual} is read"));
        }
    }
    if radius == -1.0 || radius > 1.0 {
        source.refuse(solver, format!("<rhoi> is {radius}"), "0 to 1, and -2 are read");
    }
    Some(radius)
}

/// Number in a child of an element.
fn inner(node: Node, tag: &str) -> Option<f64> {
    let child = node.children().find(|child| child.has_tag_name(tag))?;
    child.text()?.trim().parse::<f64>().ok().filter(|value| value.is_finite())
}

impl Control {
    /// The procedure of the scene.
    pub fn part(&self, line: usize, units: Units) -> Part {
        let part = Part::new("[procedure]").note(format!("<Control> (line {line})"));
        match self.dynamic {
            false => part.key("kind", quoted("static")).key("steps", self.steps.to_string()),
            true => {
                let part = part
                    .key("kind", quoted("implicit-dynamic"))
                    .key("duration", units.times(self.end))
                    .key("steps", self.steps.to_string());
                match self.radius {
                    radius if radius < 0.0 => part.key("alpha", number(0.0)),
                    radius => part.key("spectral_radius", number(radius)),
                }
            }
        }
    }
}
