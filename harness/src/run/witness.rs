//! Own error of a reference method: its distance to the same method on a coarser mesh; for a first-order
//! method also its distance to second-order elements. A mesh from a file has no coarser mesh: a first-order
//! method is compared with second-order elements on the same cells, a second-order method with nothing.
//!
//! The distance to a mesh of twice the spacing equals the remaining error if errors fall linearly with the
//! spacing (Richardson extrapolation at first order). Methods that lock converge more slowly and change
//! little from size to size. Second-order elements with as many nodes lock less, so that the two distances
//! together reveal locking. The sum is an estimate, not a bound: on 24 blocks each, the true error of a
//! first-order reference was 0.19 to 0.95 times the sum at a Poisson's ratio of 0.3, up to 2.3 times at 0.495
//! (5 above 1, all sheared) and up to 2.6 times at 0.4999 (10 above 1).

use cases::scene::{Cloud, Dilation, Element, Family, Fem, Method, Size};
use catalogue::Dimension;
use catalogue::metric::{self, Kind, Needs};
use catalogue::warning;
use geometry::CellKind;

use crate::error::Failure;
use crate::measure::{OwnError, Reference};
use crate::outcome::{Metric, Outcome, Warning};

/// Ratio of the nodes of a mesh to those of a mesh of twice the spacing.
const COARSER: usize = 8;

/// Estimates the own error of a reference, which was solved with `method`. `solve` solves a witness, which
/// may have to have fewer nodes than a limit, and returns its number of nodes and its metrics.
pub(super) fn own_error(
    method: &Method,
    reference: &Reference,
    mut solve: impl FnMut(Method, Option<usize>) -> Result<(usize, Vec<Metric>), Failure>,
) -> OwnError {
    let mut own = OwnError::default();
    let witnesses = witnesses(method, reference.nodes);
    let compared = witnesses.map_err(Failure::Run).and_then(|witnesses| {
        witnesses.into_iter().try_for_each(|witness| {
            let id = witness.id.clone();
            let most = is_first_order(&witness.family).then_some(reference.nodes);
            let (nodes, metrics) = solve(witness, most)?;
            own.by.push(format!("{id} with {nodes} nodes"));
            metrics.into_iter().filter(is_error).for_each(|metric| own.add(metric));
            Ok(())
        })
    });
    match compared {
        Ok(()) => own,
        Err(failure) => OwnError { unknown: failure.to_string(), ..OwnError::default() },
    }
}

/// Whether a number is a relative error against the reference.
fn is_error(metric: &Metric) -> bool {
    let of = metric.of.metric;
    let against = matches!(
        of.needs,
        Needs::Reference | Needs::ToolReference | Needs::StepsReference | Needs::ProbesReference
    );
    let error = of.kind == Kind::Error || *of == metric::TOOL_FORCE_ERROR;
    against && error && of.dimension == Dimension::None
}

/// Methods that a reference with this number of nodes is compared with, or the reason why there are none.
fn witnesses(reference: &Method, nodes: usize) -> Result<Vec<Method>, String> {
    let size = fineness(reference);
    let second = is_first_order(&reference.family).then(|| match elements(&reference.family) {
        Some(fem) => fem.element.second_order(),
        None => CellKind::Tet10.into(),
    });
    let of_second = |element: Element, size: Size| {
        let fem = Fem {
            element,
            dilation: Dilation::Standard,
            reduced: false,
            hourglass: None,
            size,
            jitter: None,
            adapt: None,
        };
        let id = element.name().to_string();
        let family = Family::Fem(fem);
        Method { series: id.clone(), id, family, mass: reference.mass, pod: None }
    };
    if let Size::File(file) = &size {
        let name = file.path.file_name().unwrap_or_default().to_string_lossy();
        return match second {
            // Second-order elements on the file's cells: nearly all of the distance is the error of the
            // first-order method.
            Some(element) if !has_nodes_alone(&reference.family) => Ok(vec![of_second(element, size)]),
            Some(_) => Err(format!("its nodes come from the file {name}, and no coarser nodes are known")),
            None => Err(format!(
                "its mesh is the file {name}, no coarser mesh is known, and no method here is of higher order: also \
                 solve on a finer mesh"
            )),
        };
    }
    let mut all = vec![coarser_version(reference, nodes)?];
    let size = fineness(&all[0]);
    if let Some(element) = second {
        // As many nodes as the reference has.
        let size = if let Size::Nodes(_) = size { Size::Nodes(nodes) } else { size };
        all.push(of_second(element, size));
    }
    Ok(all)
}

/// A method, which gave this number of nodes, with twice the spacing, or the reason why there is none; with
/// twice the error, if its mesh is refined until an error is reached. An external solver is replaced by its
/// elements.
pub(super) fn coarser_version(method: &Method, nodes: usize) -> Result<Method, String> {
    let mut same = method.clone();
    if let Family::Fem(Fem { adapt: Some(adapt), .. }) = &mut same.family {
        // The mesh at which the refinement starts says nothing of the last one.
        adapt.error *= 2.0;
        return Ok(same);
    }
    let size = coarser(fineness(method), nodes)?;
    if let Family::External(external) = &method.family {
        same.family = Family::Fem(external.elements.clone());
    }
    same.resize(&size);
    Ok(same)
}

/// Whether the size is a file of nodes, which has no cells.
fn has_nodes_alone(family: &Family) -> bool {
    matches!(family, Family::Efg(efg) if matches!(efg.cloud, Cloud::File { .. }))
}

fn elements(family: &Family) -> Option<&Fem> {
    match family {
        Family::Fem(fem) => Some(fem),
        Family::External(external) => Some(&external.elements),
        Family::Efg(_) => None,
    }
}

/// Whether the method's shape functions reproduce only linear polynomials, as far as is known.
fn is_first_order(family: &Family) -> bool {
    elements(family).is_none_or(|fem| fem.element.order() == 1)
}

/// Size setting of a method.
pub(super) fn fineness(method: &Method) -> Size {
    let of_cloud = |cloud: &Cloud| match cloud {
        Cloud::Mesh { size, .. } => size.clone(),
        Cloud::Uniform { nodes, .. } | Cloud::Graded { nodes, .. } | Cloud::Refined { nodes, .. } => {
            Size::Nodes(*nodes)
        }
        Cloud::File { file, .. } => Size::File(file.clone()),
    };
    match &method.family {
        Family::Efg(efg) => of_cloud(&efg.cloud),
        Family::Fem(fem) => fem.size.clone(),
        Family::External(external) => external.elements.size.clone(),
    }
}

/// Size of twice the spacing for a size that gave this number of nodes, or the reason why there is none.
fn coarser(size: Size, nodes: usize) -> Result<Size, String> {
    match size {
        Size::Nodes(_) | Size::Level(1) => Ok(Size::Nodes(nodes.div_ceil(COARSER))),
        Size::Level(level) => Ok(Size::Level(level - 1)),
        Size::Spacing(spacing) => Ok(Size::Spacing(2.0 * spacing)),
        Size::Cells { cells: [1, 1, 1], .. } => Err("its mesh has one cell and can't be coarser".into()),
        Size::Cells { cells, grading } => Ok(Size::Cells { cells: cells.map(|n| n.div_ceil(2)), grading }),
        Size::File(_) => Err("its nodes come from a file, and no coarser nodes are known".into()),
    }
}

/// Relative errors below this limit are attributed to rounding.
const ROUNDING: f64 = 1e-9;

/// Warning that the run has more nodes than its reference, whose error may then dominate.
pub(super) fn reference_coarser(reference: &records::Reference, outcome: &Outcome) -> Option<Warning> {
    let error = outcome.value(&metric::RELATIVE_RMS).filter(|error| *error > ROUNDING)?;
    let own = outcome.size.nodes;
    let known = reference.nodes;
    (known > 0 && own > known).then(|| {
        let message = format!(
            "with {own} nodes the run is finer than its reference, {}: the difference of {:.1} % may be the error of \
             the reference; take a finer reference (reference.size)",
            reference.name(),
            100.0 * error
        );
        Warning::new(&warning::REFERENCE_COARSER, own as f64 / known as f64, "reference", message)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ids and sizes of the witnesses of a method on a block.
    fn held_against(method: &str, nodes: usize) -> Result<Vec<(String, Size)>, String> {
        let text = format!(
            "title = \"A block\"\nbody = {{ shape = \"box\", size = [\"40 mm\", \"40 mm\", \"20 mm\"] }}\n\
             material = {{ law = \"linear\", young = \"20 kPa\", poisson = 0.3 }}\n\
             support = [{{ on = \"z-min\", fix = \"xyz\" }}]\nmethod = [{{ id = \"m\", {method} }}]\n"
        );
        let scene = cases::scene::parse(&text, "block.toml").unwrap_or_else(|bad| panic!("{bad:?}"));
        let all = witnesses(&scene.methods[0], nodes)?;
        Ok(all.iter().map(|method| (method.id.clone(), fineness(method))).collect())
    }

    #[test]
    fn second_order_is_held_against_itself_and_first_order_against_second_order_too() {
        let cells = |cells| Size::Cells { cells, grading: [1.0; 3] };
        let of = |element: &str, size: &str| {
            held_against(&format!("family = \"fem\", element = \"{element}\", size = {size}"), 100)
        };
        assert_eq!(of("hex20", "{ cells = [8, 8, 5] }"), Ok(vec![("m".into(), cells([4, 4, 3]))]));
        for (element, second) in [("tet4", "tet10"), ("hex8", "hex20")] {
            let expected = vec![("m".into(), cells([2, 2, 1])), (second.into(), cells([2, 2, 1]))];
            assert_eq!(of(element, "{ cells = [4, 4, 2] }"), Ok(expected), "{element}");
        }
        assert_eq!(of("tet10", "{ level = 3 }"), Ok(vec![("m".into(), Size::Level(2))]));
        assert_eq!(of("tet10", "{ level = 1 }"), Ok(vec![("m".into(), Size::Nodes(13))]));
        assert_eq!(of("tet10", "{ spacing = \"5 mm\" }"), Ok(vec![("m".into(), Size::Spacing(0.01))]));
        let both = vec![("m".into(), Size::Nodes(13)), ("tet10".into(), Size::Nodes(100))];
        assert_eq!(of("tet4", "{ nodes = 90 }"), Ok(both.clone()));
        let cloud = "family = \"efg\", nodes = 100, kernel = \"cubic-spline\", support_scale = 1.6, basis = \"linear\", \
                     integration = { rule = \"cell-smoothed\", points = 1 }, essential = \"penalty\"";
        assert_eq!(held_against(cloud, 100), Ok(both));
        assert!(of("hex20", "{ cells = [1, 1, 1] }").is_err());
    }
}
