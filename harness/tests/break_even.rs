//! The choice between a factor and iterations for linear problems, against measured times.
//!
//! The table is measured anew by
//! `cargo test --release -p tissuebench-harness --test break_even -- --ignored`.

use std::fmt::Write as _;
use std::path::PathBuf;

use cases::scene::{self, Scene};
use tissuebench_harness::outcome::StageName;
use tissuebench_harness::run::{Group, Repeats, RunOptions};

/// Largest ratio of the time of the chosen solver to that of the other.
const LOSS: f64 = 1.3;

/// Bodies, methods, Poisson's ratios and sizes of the table.
const CASES: [(&str, &str, f64, &[&str]); 33] = [
    ("cube", "tet4", 0.3, &["8", "10", "13", "18", "31"]),
    ("cube", "tet4", 0.49, &["10", "18"]),
    ("cube", "tet4", 0.4999, &["10", "17", "24"]),
    ("cube", "tet4-nodal", 0.3, &["9", "16"]),
    ("cube", "tet4-nodal", 0.495, &["9", "16", "22"]),
    ("cube", "tet4-nodal", 0.4999, &["9", "13", "19", "25"]),
    ("cube", "tet10", 0.3, &["4", "6", "10", "15"]),
    ("cube", "tet10", 0.49, &["6", "10"]),
    ("cube", "tet10-mean", 0.4999, &["5", "8", "11"]),
    ("cube", "hex8", 0.3, &["9", "15", "24"]),
    ("cube", "hex8-mean", 0.45, &["10", "17"]),
    ("cube", "hex8-mean", 0.495, &["10", "17"]),
    ("cube", "hex8-mean", 0.4999, &["10", "17", "25", "32"]),
    ("cube", "hex20", 0.3, &["5", "10"]),
    ("cube", "hex20-reduced", 0.49, &["6", "11"]),
    ("cube", "wedge6", 0.3, &["10", "16"]),
    ("cube", "wedge15", 0.3, &["5", "9"]),
    ("cube", "efg-smoothed", 0.3, &["9", "12", "15"]),
    ("cube", "efg-smoothed", 0.45, &["9", "12"]),
    ("kidney", "tet4", 0.3, &["3", "4"]),
    ("kidney", "tet4-nodal", 0.495, &["3", "4"]),
    ("kidney", "tet4-nodal", 0.4999, &["3", "4"]),
    ("kidney", "tet10", 0.3, &["2", "3"]),
    ("kidney", "tet10-mean", 0.4999, &["2", "3"]),
    ("kidney", "hex8-mean", 0.495, &["3", "4"]),
    ("kidney", "hex8-mean", 0.4999, &["3", "4"]),
    ("beam", "tet10", 0.3, &["2", "4"]),
    ("beam", "hex8-mean", 0.495, &["4", "7"]),
    ("beam", "hex8-mean", 0.4999, &["4", "7"]),
    ("beam", "tet4-nodal", 0.4999, &["4", "7"]),
    ("plate", "hex8-mean", 0.495, &["8", "12"]),
    ("plate", "tet4", 0.3, &["10", "24"]),
    ("plate", "hex20", 0.3, &["6", "12"]),
];

fn table() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../benches/break-even.csv")
}

/// Scene of a case. A size is the number of cells along the shortest or an equal side, or a level.
fn scene(shape: &str, method: &str, poisson: f64, size: &str, solver: &str) -> Scene {
    let (body, support) = match shape {
        "kidney" => (r#"{ shape = "kidney" }"#, r#"where = "y >= 30 mm""#),
        "beam" => (r#"{ shape = "box", size = ["10 mm", "10 mm", "100 mm"] }"#, r#"on = "z-min""#),
        "plate" => (r#"{ shape = "box", size = ["80 mm", "80 mm", "10 mm"] }"#, r#"on = "x-min""#),
        _ => (r#"{ shape = "box", size = ["40 mm", "40 mm", "40 mm"] }"#, r#"on = "z-min""#),
    };
    let cells: usize = size.parse().expect("a number");
    let size = match shape {
        "kidney" => format!("level = {cells}"),
        "beam" => format!("cells = [{cells}, {cells}, {}]", 10 * cells),
        "plate" => format!("cells = [{}, {}, {}]", 2 * cells, 2 * cells, cells.div_ceil(4)),
        _ => format!("cells = [{cells}, {cells}, {cells}]"),
    };
    let methods = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../cases/methods.toml");
    let text = format!(
        r#"
title = "Time of a linear solver"
purpose = "smooth"
methods_from = "{}"
body = {body}
material = {{ law = "linear", young = "20 kPa", poisson = {poisson} }}
support = [{{ {support}, fix = "xyz" }}]
load = [{{ body = ["0 N/m^3", "0 N/m^3", "-100 N/m^3"] }}]
procedure = {{ kind = "linear", linear_solver = "{solver}" }}
method = [{{ use = "{method}", size = {{ {size} }} }}]
"#,
        methods.display()
    );
    scene::parse(&text, "case.toml").unwrap_or_else(|errors| panic!("{text}\n{errors:?}"))
}

#[test]
#[ignore = "measures the table: some minutes"]
fn measure() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no other test runs");
    let mut csv = String::from("shape,method,poisson,size,unknowns,factor_s,iterations_s,auto_s\n");
    for (shape, method, poisson, sizes) in CASES {
        for size in sizes {
            let mut unknowns = 0;
            // Infinite if the iterations do not converge.
            let seconds = ["direct", "amg", "auto"].map(|solver| {
                let scene = scene(shape, method, poisson, size, solver);
                let group = Group::new(&scene, None, Repeats::ONCE).unwrap();
                let scenario = group.scenario(scene.methods[0].clone(), 0);
                let once = || {
                    let Ok(outcome) = group.run(&scenario, RunOptions::default()) else {
                        return f64::INFINITY;
                    };
                    unknowns = outcome.size.dofs;
                    let of_solver = outcome.phases.iter().filter(|p| ["factor", "solve"].contains(&p.phase));
                    of_solver.filter_map(|phase| phase.cpu_median()).sum::<f64>()
                };
                std::iter::repeat_with(once).take(3).fold(f64::INFINITY, f64::min)
            });
            let [factor, iterations, auto] = seconds;
            writeln!(
                csv,
                "{shape},{method},{poisson},{size},{unknowns},{factor:.4},{iterations:.4},{auto:.4}"
            )
            .unwrap();
            print!("{}", csv.lines().last().map(|line| format!("{line}\n")).unwrap_or_default());
        }
    }
    std::fs::write(table(), csv).unwrap();
}

#[test]
fn auto_takes_a_solver_that_is_nearly_as_fast_as_the_other() {
    let csv = std::fs::read_to_string(table()).unwrap();
    let mut lost = Vec::new();
    for line in csv.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [shape, method, poisson, size, _, factor, iterations, auto] = fields[..] else {
            panic!("{line}")
        };
        let number = |text: &str| text.parse::<f64>().unwrap_or_else(|_| panic!("{line}"));
        let scene = scene(shape, method, number(poisson), size, "auto");
        let group = Group::new(&scene, None, Repeats::ONCE).unwrap();
        let (plan, _) = group.plan(&group.scenario(scene.methods[0].clone(), 0)).unwrap();
        let stage = plan.stages().iter().find(|stage| stage.stage == StageName::Factorisation).unwrap();
        let iterates = stage.why.starts_with("multigrid levels");
        let (taken, other) = if iterates { (iterations, factor) } else { (factor, iterations) };
        // Iterations that would take too long are given up after a few, for a factor.
        let taken = number(taken).min(if iterates { number(auto) } else { f64::INFINITY });
        if taken > LOSS * number(other) {
            lost.push(format!("{line}: {}", stage.why));
        }
    }
    assert!(lost.is_empty(), "{}", lost.join("\n"));
    assert!(csv.lines().count() > 30);
}
