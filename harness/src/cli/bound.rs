//! `tissuebench bound`: strict bounds of a scene's results, and which of its methods can be right.

use std::time::Instant;

use cases::scene::{self, Dilation, Element, Family, Fem, Reference, Scene, Size};
use catalogue::metric;
use clap::Args;
use geometry::CellKind;
use serde_json::{Value, json};

use super::args::{Format, SceneArgs, length};
use super::scenes::{affordable_methods, open};
use super::text::{aligned, digits};
use crate::discretise::place;
use crate::error::Failure;
use crate::measure::Repeats;
use crate::outcome::Outcome;
use crate::run::bounds::{Bounded, Bounds, Bracket, MOST_CELLS, bounds, cell_count, exact_energy};
use crate::run::{Group, RunOptions, case_name};
use crate::scenario::uncut;

/// Arguments of `bound`.
#[derive(Args)]
pub struct BoundArgs {
    /// The scene
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Edge length of the tetrahedra of the bounds, such as "3 mm"; unless given, the finest mesh of the
    /// methods that the bounds can use
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub size: Option<f64>,
    /// Approximate number of nodes of the tetrahedra, instead of --size
    #[arg(long, value_name = "N", conflicts_with = "size", value_parser = clap::value_parser!(u32).range(8..=100_000))]
    pub nodes: Option<u32>,
    /// Run even if the estimate exceeds twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
    /// Output format on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
}

/// An answer that the bounds judge.
struct Answer {
    /// Id of the method, or "exact".
    name: String,
    is_reference: bool,
    /// Number of nodes; 0 for an exact solution.
    nodes: u64,
    /// Value of each bounded result, in SI units, as far as the method gives it.
    values: Vec<Option<f64>>,
}

/// Prints bounds and verdicts and returns the exit code.
pub(super) fn bound(args: &BoundArgs) -> u8 {
    let mut asked = args.scene.clone();
    asked.set.push("output.bounds=true".parse().expect("a key with its value"));
    let (mut scene, chosen) = match open(&asked) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    if let Err(code) = affordable_methods(&scene, &chosen, args.force) {
        return code;
    }
    // The scene is checked for bounds, and its runs need none of their own.
    scene.output.bounds = false;
    match judged(&scene, &chosen, args) {
        Ok(code) => code,
        Err(failure) => {
            eprintln!("{failure}");
            failure.exit_code()
        }
    }
}

fn judged(scene: &Scene, chosen: &[usize], args: &BoundArgs) -> Result<u8, Failure> {
    let group = Group::unreferenced(scene, Repeats::ONCE)?;
    let method = meshed(&group, scene, chosen, args)?;
    let scenario = group.scenario(method, 0);
    let (discretisation, setup) = (scenario.discretise()?, scenario.setup()?);
    uncut(scene, discretisation.mesh()).map_err(|failure| scenario.locate(failure))?;
    let begin = Instant::now();
    let bounds = bounds(&discretisation, &setup).map_err(|failure| scenario.locate(failure))?;
    let seconds = begin.elapsed().as_secs_f64();
    if args.format == Format::Table {
        print!("{}", described(&case_name(scene), &bounds, seconds, scene));
    }
    let mut answers = Vec::new();
    if let Some(energy) = exact_energy(&discretisation, &setup)? {
        let energy = |(of, _): &(Bounded, Bracket)| (*of == Bounded::Energy).then_some(energy);
        let values = bounds.results.iter().map(energy).collect();
        answers.push(Answer { name: "exact".into(), is_reference: true, nodes: 0, values });
    }
    let mut code = 0;
    for (method, is_reference) in runs(scene, chosen) {
        match group.run(&group.scenario(method.clone(), 0), RunOptions::default()) {
            Ok(outcome) => answers.push(Answer::of(&outcome, &bounds, is_reference)),
            Err(unfinished) => {
                eprintln!("{} (method '{}')", unfinished.failure, method.id);
                code = code.max(unfinished.failure.exit_code());
            }
        }
    }
    match args.format {
        Format::Table => print!("\n{}\n", aligned(&verdicts(&answers, &bounds, scene))),
        Format::Json => println!("{}", object(&case_name(scene), &bounds, seconds, &answers, scene)),
    }
    let refuted =
        |answer: &&Answer| answer.is_reference && answer.excess(&bounds).iter().any(|excess| *excess != 0.0);
    if let Some(reference) = answers.iter().find(refuted) {
        eprintln!("the reference of the scene, {}, lies outside the bounds: it is wrong", reference.name);
        code = code.max(1);
    }
    Ok(code)
}

/// Methods to run, the reference first, if it is one, at its own size.
fn runs(scene: &Scene, chosen: &[usize]) -> Vec<(scene::Method, bool)> {
    let reference = match &scene.reference {
        Some(Reference::Method { id, size, .. }) => scene.method(id).cloned().map(|mut method| {
            size.iter().for_each(|size| method.resize(size));
            (method, true)
        }),
        _ => None,
    };
    let others = chosen.iter().map(|&index| (scene.methods[index].clone(), false));
    let same = |(method, _): &(scene::Method, bool)| {
        reference.as_ref().is_none_or(|(reference, _)| reference != method)
    };
    let others: Vec<_> = others.filter(same).collect();
    reference.into_iter().chain(others).collect()
}

/// The method whose mesh gives the bounds.
fn meshed(
    group: &Group,
    scene: &Scene,
    chosen: &[usize],
    args: &BoundArgs,
) -> Result<scene::Method, Failure> {
    let size = args.size.map(Size::Spacing).or(args.nodes.map(|nodes| Size::Nodes(nodes as usize)));
    if let Some(size) = size {
        let (element, dilation) = (Element::from(CellKind::Tet4), Dilation::Standard);
        let family = Family::Fem(Fem {
            element,
            dilation,
            reduced: false,
            hourglass: None,
            size,
            jitter: None,
            adapt: None,
        });
        return Ok(scene::Method {
            id: "bounds".into(),
            series: "bounds".into(),
            family,
            mass: None,
            pod: None,
        });
    }
    let mut best: Option<(bool, usize, &scene::Method)> = None;
    for &index in chosen {
        let method = &scene.methods[index];
        let cells = cell_count(&group.scenario(method.clone(), 0).discretise()?);
        let fits = cells <= MOST_CELLS;
        // Of the meshes that are not too large the finest, otherwise the coarsest.
        let better = best.is_none_or(|(known_fits, known, _)| match (fits, known_fits) {
            (true, true) => cells > known,
            (false, false) => cells < known,
            (fits, _) => fits,
        });
        if better {
            best = Some((fits, cells, method));
        }
    }
    best.map(|(_, _, method)| method.clone()).ok_or_else(|| Failure::Input("no method is chosen".into()))
}

impl Answer {
    fn of(outcome: &Outcome, bounds: &Bounds, is_reference: bool) -> Answer {
        let value = |(of, _): &(Bounded, Bracket)| match *of {
            Bounded::Energy => outcome.value(&metric::STRAIN_ENERGY),
            Bounded::Force { support, along } => {
                outcome.supports.get(support).map(|of| of.resultant.force.dot(&along))
            }
            Bounded::Displacement => None,
            Bounded::Mean { index, axis } => outcome.means.get(index).map(|mean| mean.u[axis]),
        };
        Answer {
            name: outcome.identity.method.clone(),
            is_reference,
            nodes: outcome.size.nodes,
            values: bounds.results.iter().map(value).collect(),
        }
    }

    /// Distance of each value from its bounds, relative; 0 between them and for a value that is not known.
    fn excess(&self, bounds: &Bounds) -> Vec<f64> {
        let each = self.values.iter().zip(&bounds.results);
        each.map(|(value, (_, bracket))| value.map_or(0.0, |value| bracket.excess(value))).collect()
    }

    fn title(&self) -> String {
        if self.is_reference { format!("{} (reference)", self.name) } else { self.name.clone() }
    }
}

/// Name, unit and factor from SI to this unit of a result.
fn named(of: &Bounded, scene: &Scene) -> (String, &'static str, f64) {
    match of {
        Bounded::Energy => ("strain energy".into(), "mJ", 1e3),
        Bounded::Force { support, along } => {
            let name = place::words(&scene.supports[*support].place);
            let [x, y, z] = [along.x, along.y, along.z].map(digits);
            (format!("force on {name} along ({x}, {y}, {z})"), "N", 1.0)
        }
        Bounded::Displacement => ("mean of the loaded faces along the load".into(), "mm", 1e3),
        Bounded::Mean { index, axis } => {
            let name = place::words(&scene.output.means[*index]);
            (format!("mean of {name} along {}", ["x", "y", "z"][*axis]), "mm", 1e3)
        }
    }
}

fn described(case: &str, bounds: &Bounds, seconds: f64, scene: &Scene) -> String {
    let Bounds { results, vertices, cells, dofs } = bounds;
    let head = ["bounds", "lower", "upper", "unit", "half-width [%]"].map(String::from).to_vec();
    let row = |(of, bracket): &(Bounded, Bracket)| {
        let (name, unit, scale) = named(of, scene);
        let [lower, upper] = [bracket.lower, bracket.upper].map(|value| precise(scale * value));
        vec![name, lower, upper, unit.into(), digits(100.0 * bracket.half_width())]
    };
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(results.iter().map(row)).collect();
    let single = results.iter().any(|(of, _)| matches!(of, Bounded::Force { .. } | Bounded::Displacement));
    let note =
        if single { "" } else { "No force has bounds of its own: not one motion or load alone does work.\n" };
    format!(
        "{case}: {vertices} vertices, {cells} tetrahedra; {} unknowns of displacement, {} of stress; {} s\n\n{}\n{note}",
        dofs[0],
        dofs[1],
        digits(seconds),
        aligned(&rows)
    )
}

/// Formats a bound with six significant digits.
fn precise(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if (1e-2..1e6).contains(&v) => {
            let before = v.log10().floor() as i32 + 1;
            format!("{value:.*}", usize::try_from(6 - before).unwrap_or(0))
        }
        _ => format!("{value:.5e}"),
    }
}

fn verdict(excess: f64) -> String {
    match excess {
        0.0 => "yes".into(),
        above if above > 0.0 => format!("no: {} % above", digits(100.0 * above)),
        below => format!("no: {} % below", digits(-100.0 * below)),
    }
}

/// Rows of all values that a method gives, with their verdicts.
fn verdicts(answers: &[Answer], bounds: &Bounds, scene: &Scene) -> Vec<Vec<String>> {
    let head = ["method", "nodes", "result", "value", "unit", "can be true"].map(String::from).to_vec();
    let rows = answers.iter().flat_map(|answer| {
        answer.values.iter().zip(&bounds.results).filter_map(|(value, (of, bracket))| {
            let value = (*value)?;
            let (name, unit, scale) = named(of, scene);
            let nodes = if answer.nodes > 0 { answer.nodes.to_string() } else { "-".into() };
            let verdict = verdict(bracket.excess(value));
            Some(vec![answer.title(), nodes, name, precise(scale * value), unit.into(), verdict])
        })
    });
    std::iter::once(head).chain(rows).collect()
}

/// The bounds and verdicts in SI units, for scripts.
fn object(case: &str, bounds: &Bounds, seconds: f64, answers: &[Answer], scene: &Scene) -> Value {
    let names: Vec<String> = bounds.results.iter().map(|(of, _)| named(of, scene).0).collect();
    let results: Vec<Value> = bounds
        .results
        .iter()
        .zip(&names)
        .map(|((of, bracket), name)| {
            let unit = match of {
                Bounded::Energy => "J",
                Bounded::Force { .. } => "N",
                Bounded::Displacement | Bounded::Mean { .. } => "m",
            };
            let Bracket { lower, upper } = bracket;
            json!({ "result": name, "unit": unit, "lower": lower, "upper": upper, "half_width": bracket.half_width() })
        })
        .collect();
    let answers: Vec<Value> = answers
        .iter()
        .map(|answer| {
            let excess = answer.excess(bounds);
            json!({
                "method": answer.name,
                "is_reference": answer.is_reference,
                "nodes": answer.nodes,
                "values": answer.values,
                "excess": excess,
                "can_be_true": excess.iter().all(|excess| *excess == 0.0),
            })
        })
        .collect();
    json!({
        "scene": case,
        "vertices": bounds.vertices,
        "tetrahedra": bounds.cells,
        "dofs": bounds.dofs,
        "seconds": seconds,
        "bounds": results,
        "answers": answers,
    })
}
