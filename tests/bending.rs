//! Pure bending from its scene file through the harness: errors and orders of every kind of method against
//! stored tables, and conditions that must hold independently of these tables.

#[path = "common/one_percent.rs"]
mod one_percent;

use std::fmt::Write as _;
use std::path::Path;

use cases::scene::parse_study;
use catalogue::metric;
use harness::study::{StudyPlan, VerifyArgs, check};
use records::Record;

use one_percent::within_one_percent;

const METHODS: [&str; 8] =
    ["tet4", "tet4-nodal", "tet10", "hex8", "hex8-mean", "hex20", "efg-gauss", "efg-projected"];
const RATIOS: [f64; 2] = [0.3, 0.495];
const QUANTITIES: [&str; 6] = ["rms-x", "rms-y", "rms-z", "rms", "l2", "energy"];

/// Runs the methods at levels 1 and 2.
fn bending() -> Vec<Record> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/scenes/beam/pure-bending.toml");
    let text = format!(
        "title = \"Bending\"\n[[run]]\nscene = '{}'\nmethods = {METHODS:?}\nlevels = [1, 2]\npoisson = {RATIOS:?}\n",
        scene.display()
    );
    let dir = tempfile::tempdir().unwrap();
    let plan = StudyPlan::new(parse_study(&text, "study.toml").unwrap()).unwrap();
    let args = VerifyArgs { out: dir.path().into(), ..VerifyArgs::of(Path::new("study.toml")) };
    let finished = plan.execute(&args);
    assert!(finished.set.failures.is_empty(), "{:?}", finished.set.failures);
    assert_eq!(finished.ran, METHODS.len() * 2 * RATIOS.len());
    finished.set.records
}

fn run(records: &[Record], method: &str, poisson: f64, level: u32) -> Vec<Record> {
    let own = |r: &&Record| r.method == method && r.poisson == poisson && r.level == level;
    records.iter().filter(own).cloned().collect()
}

/// Formats a number for a table. Numbers below 1e-9 are rounding, which differs between machines.
fn number(value: f64) -> String {
    if value.abs() < 1e-9 { "exact".into() } else { format!("{value:.4e}") }
}

fn errors(records: &[Record]) -> String {
    let mut text = format!("method nu nodes {}\n", QUANTITIES.join(" "));
    for method in METHODS {
        for poisson in RATIOS {
            let run = run(records, method, poisson, 1);
            write!(text, "{method} {poisson} {}", run[0].nodes).unwrap();
            for quantity in QUANTITIES {
                write!(text, " {}", number(check::value(metric::find(quantity).unwrap(), &run).unwrap()))
                    .unwrap();
            }
            text.push('\n');
        }
    }
    text
}

fn order(records: &[Record], method: &str, poisson: f64, quantity: &str) -> f64 {
    let levels = [1, 2].map(|level| run(records, method, poisson, level));
    let order = metric::find(&format!("order-{quantity}")).unwrap();
    check::of_many(order, &levels.each_ref().map(Vec::as_slice)).unwrap()
}

/// Whether a method reproduces the quadratic solution. Its error is then rounding and has no order.
fn is_exact(method: &str) -> bool {
    ["tet10", "hex20"].contains(&method)
}

fn orders(records: &[Record]) -> String {
    let mut text = String::from("method nu l2 energy\n");
    for method in METHODS.into_iter().filter(|m| !is_exact(m)) {
        for poisson in RATIOS {
            let [l2, energy] = ["l2", "energy"].map(|q| order(records, method, poisson, q));
            writeln!(text, "{method} {poisson} {l2:.4} {energy:.4}").unwrap();
        }
    }
    text
}

#[test]
fn errors_and_orders_of_pure_bending() {
    let records = bending();
    let l2 = metric::L2.whole();
    let l2 = |method, poisson, level| check::value(l2, &run(&records, method, poisson, level)).unwrap();
    for poisson in RATIOS {
        for method in METHODS {
            if is_exact(method) {
                assert!(l2(method, poisson, 1) < 1e-9 && l2(method, poisson, 2) < 1e-9, "{method}");
            } else {
                assert!(l2(method, poisson, 2) < l2(method, poisson, 1), "{method} nu={poisson}");
            }
        }
    }
    // Linear tetrahedra lock near 1/2; one dilation per node or per cell prevents this.
    assert!(l2("tet4", 0.495, 2) > 3.0 * l2("tet4", 0.3, 2));
    assert!(l2("tet4", 0.495, 2) > 3.0 * l2("tet4-nodal", 0.495, 2));
    assert!(l2("hex8", 0.495, 2) > 3.0 * l2("hex8-mean", 0.495, 2));
    within_one_percent(|| {
        insta::assert_snapshot!("errors", errors(&records));
        insta::assert_snapshot!("orders", orders(&records));
    });
}
