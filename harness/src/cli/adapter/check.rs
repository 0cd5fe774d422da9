//! `tissuebench adapter check`: compares a solver with known solutions. Its times are meaningful only if it
//! passes.

use cases::scene;
use catalogue::metric::{self, Metric};

use crate::adapter::{self, Found};
use crate::cli::text::digits;
use crate::error::Failure;
use crate::measure::Repeats;
use crate::outcome::Outcome;
use crate::run::{Group, RunOptions};

/// Bound of the relative error against an exact solution, for answers with all digits.
const EXACT: f64 = 1e-8;
/// Bound of the residual forces at free nodes over all forces, per unit in the last digit of the answer.
/// Elements are stiff: rounding of neighbouring displacements leaves large forces.
const BALANCE: f64 = 10.0;
/// Bound of the relative difference from this program's element.
const AGREEMENT: f64 = 1e-6;
/// Bound of the relative difference at large strain, because each solver chooses its own steps there.
const LARGE: f64 = 1e-5;

/// A test problem on a body of distorted cells, and its compared quantity.
struct Case {
    what: &'static str,
    /// Procedure and law required by the case, as words of `can`.
    needs: &'static [&'static str],
    scene: &'static str,
    /// The compared metric, and its bound.
    metric: &'static Metric,
    bound: f64,
    /// Factor of the tolerance for missing digits of the answer, in exact solutions and balances; 0 for none.
    by_digits: f64,
}

const LINEAR: &str = "material = { law = \"linear\", young = \"20 kPa\", poisson = 0.3 }\n";
const RIGID: &str = "support = [{ on = \"surface\", move = \"exact\" }]\n\
    reference = { exact = \"rigid\" }\n";
const PATCH: &str = "support = [{ on = \"surface\", move = \"exact\" }]\n\
    reference = { exact = \"affine\" }\n";
const LOADED: &str = "support = [{ on = \"z-min\", fix = \"xyz\" }, { on = \"z-max\", move = { x = \"0.05 mm\" } }]\n\
    load = [{ on = \"z-max\", pressure = \"0.4 kPa\" }, { body = [\"100 N/m^3\", \"0 N/m^3\", \"-500 N/m^3\"] }]\n\
    reference = { method = \"ours\" }\n";
const HELD: &str = "support = [{ on = \"z-min\", fix = \"xyz\" }]\n\
    load = [{ on = \"z-max\", pressure = \"2 kPa\", dead = true }, { on = \"x-max\", traction = [\"0.5 kPa\", \"0.2 kPa\", \"0 kPa\"] }]\n\
    procedure = { kind = \"static\", steps = 4, tolerance = 1e-10 }\nreference = { method = \"ours\" }\n";

const CASES: [Case; 6] = [
    Case {
        what: "rigid motion",
        needs: &["linear"],
        scene: RIGID,
        metric: &metric::RELATIVE_RMS,
        bound: EXACT,
        by_digits: 1.0,
    },
    Case {
        what: "linear patch",
        needs: &["linear"],
        scene: PATCH,
        metric: &metric::RELATIVE_RMS,
        bound: EXACT,
        by_digits: 1.0,
    },
    Case {
        what: "force balance",
        needs: &["linear"],
        scene: LOADED,
        metric: &metric::RESIDUAL,
        bound: EXACT,
        by_digits: BALANCE,
    },
    Case {
        what: "agreement with the built-in element",
        needs: &["linear"],
        scene: LOADED,
        metric: &metric::RELATIVE_RMS,
        bound: AGREEMENT,
        by_digits: 0.0,
    },
    Case {
        what: "neo-hookean at large strain",
        needs: &["static", "neo-hookean"],
        scene: HELD,
        metric: &metric::RELATIVE_RMS,
        bound: LARGE,
        by_digits: 0.0,
    },
    Case {
        what: "neo-hookean-isochoric at large strain",
        needs: &["static", "neo-hookean-isochoric"],
        scene: HELD,
        metric: &metric::RELATIVE_RMS,
        bound: LARGE,
        by_digits: 0.0,
    },
];

/// Runs all cases for all elements and returns the exit code.
pub(super) fn check(adapter: &Found) -> u8 {
    if let Err(reason) = adapter::ready(adapter) {
        eprintln!("tissuebench: {reason}");
        return 3;
    }
    let can =
        |case: &&Case| case.needs.iter().all(|word| adapter.manifest.can.iter().any(|known| known == word));
    let mut failed = 0;
    let mut asked = 0;
    for element in &adapter.manifest.elements {
        for case in CASES.iter().filter(can) {
            asked += 1;
            let (word, said) = match value(adapter, case, element) {
                Ok(value) => {
                    let bound = case.bound.max(case.by_digits * 0.1f64.powi(adapter.manifest.digits as i32));
                    // The comparison is false for NaN.
                    let holds = value <= bound;
                    (holds, format!("{} {}, at most {}", case.metric.name, digits(value), digits(bound)))
                }
                Err(failure) => (false, failure.to_string()),
            };
            failed += usize::from(!word);
            println!("{}  {element:<6} {:<38} {said}", if word { "passed" } else { "FAILED" }, case.what);
        }
    }
    println!("{}: {} of {asked} passed", adapter.manifest.name, asked - failed);
    adapter::note(adapter, asked > 0 && failed == 0);
    match (asked, failed) {
        (0, _) => 4,
        (_, 0) => 0,
        _ => 1,
    }
}

/// Runs one case and returns the compared value.
fn value(adapter: &Found, case: &Case, element: &str) -> Result<f64, Failure> {
    let outcome = run(adapter, case, element)?;
    let value = outcome.value(case.metric);
    match outcome.stalled {
        Some(failure) => Err(failure),
        None => value.ok_or_else(|| Failure::Run(format!("gives no {}", case.metric.name))),
    }
}

fn run(adapter: &Found, case: &Case, element: &str) -> Result<Outcome, Failure> {
    let name = &adapter.manifest.name;
    let law = case.needs.iter().find(|word| word.starts_with("neo"));
    let material = law.map_or(LINEAR.into(), |law| LINEAR.replace("\"linear\"", &format!("{law:?}")));
    let size = "size = { cells = [3, 2, 2] }, jitter = { fraction = 0.15, seed = 3 }";
    let text = format!(
        "title = {:?}\nbody = {{ shape = \"box\", size = [\"30 mm\", \"20 mm\", \"20 mm\"] }}\n{material}{}\
         method = [{{ id = \"ours\", family = \"fem\", element = {element:?}, {size} }},\
         {{ id = \"theirs\", family = \"external\", adapter = {name:?}, element = {element:?}, {size} }}]\n",
        case.what, case.scene
    );
    let errors = |errors: Vec<scene::SceneError>| {
        Failure::Run(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    };
    let scene = scene::parse(&text, "check.toml").map_err(errors)?;
    let group = Group::new(&scene, None, Repeats::ONCE)?;
    let scenario = group.scenario(scene.methods[1].clone(), 0);
    group.run(&scenario, RunOptions::default()).map_err(|unfinished| unfinished.failure)
}
