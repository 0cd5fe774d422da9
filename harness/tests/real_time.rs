//! Loops in real time: frames follow the converged path, late frames are counted, and a loop that can't go on
//! says where it ended.

mod common;

use common::{PRESSED, assert_fails, inside, objects, tissuebench, write};
use serde_json::Value;

/// [`PRESSED`] with one method and a loop.
fn scene(keys: &str) -> String {
    let text = PRESSED.replace("steps = 2", "steps = 8");
    format!("{text}\n[loop]\n{keys}\n")
}

fn played(text: &str, options: &[&str]) -> (u8, Vec<Value>, String) {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "loop.toml", text);
    let done = tissuebench(&[&["loop", &scene, "--method", "hex8", "--format", "json"], options].concat());
    (done.code as u8, objects(&done.stdout), done.stderr)
}

fn number(of: &Value, name: &str) -> f64 {
    of[name].as_f64().unwrap_or_else(|| panic!("no {name} in {of}"))
}

#[test]
fn frames_follow_the_path_at_every_rate() {
    let (code, rates, said) = played(&scene("duration = \"1 s\"\nrates = [16, 64]"), &[]);
    assert_eq!(code, 0, "{said}");
    assert_eq!(rates.iter().map(|of| of["rate"].as_u64().unwrap()).collect::<Vec<_>>(), [16, 64]);
    for of in &rates {
        assert_eq!(of["frames"], of["rate"]);
        // The state is uniform and the force nearly linear between the eight steps of the path.
        assert!(number(of, "force-error") < 2e-3 && number(of, "displacement-error") < 2e-3, "{of}");
        assert!(number(of, "median") > 0.0 && number(of, "median") <= number(of, "max"), "{of}");
        let late = number(of, "misses") / 1e3 * number(of, "frames");
        assert!((late - late.round()).abs() < 1e-9 && number(of, "longest-run") <= late + 1e-9, "{of}");
        assert!(number(of, "touch") <= number(of, "max"), "{of}");
    }
}

#[test]
fn errors_are_the_same_in_each_loop_and_on_any_number_of_threads() {
    let text = scene("duration = \"1 s\"\nrates = [32]");
    let of = |threads: &str| {
        let (code, rates, said) = played(&text, &["--threads", threads]);
        assert_eq!(code, 0, "{said}");
        [number(&rates[0], "force-error"), number(&rates[0], "displacement-error")].map(f64::to_bits)
    };
    assert_eq!(of("1"), of("1"));
    assert_eq!(of("1"), of("2"));
}

#[test]
fn a_budget_of_work_is_that_of_each_frame() {
    let text = common::written_out("vbd-ball.toml").replace("sweeps = 40", "sweeps = 3")
        + "\n[loop]\nrates = [25, 100]\n";
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["loop", &write(&dir, "loop.toml", &text), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let rates = objects(&done.stdout);
    assert_eq!(rates.iter().map(|of| of["frames"].as_u64().unwrap()).collect::<Vec<_>>(), [25, 100]);
    // Without mass a frame starts from the last: longer frames are farther from equilibrium.
    let errors: Vec<f64> = rates.iter().map(|of| number(of, "force-error")).collect();
    assert!(errors[0] > errors[1] && errors[1] > 0.0, "{errors:?}");
}

#[test]
fn a_loop_that_ends_early_has_no_errors_and_says_so() {
    let text = scene("duration = \"100 s\"\nrates = [100]\nwithin = \"50 ms\"");
    let (code, rates, said) = played(&text, &[]);
    assert_eq!(code, 0, "{said}");
    let done = rates[0]["frames"].as_u64().unwrap();
    assert!((1..10_000).contains(&done) && rates[0]["force-error"].is_null(), "{}", rates[0]);
    let ended =
        format!("at 100 frames per second the loop ended after {done} of 10000 frames: 0.05 s have passed");
    assert!(said.contains(&ended), "{said}");
}

#[test]
fn records_have_a_phase_for_each_rate() {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "loop.toml", &scene("duration = \"1 s\"\nrates = [10, 20]"));
    let out = inside(&dir, "out");
    let done = tissuebench(&["run", &path, "--method", "hex8", "--once", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let records = records::read_run(std::path::Path::new(&out)).unwrap().records;
    for phase in ["loop-10", "loop-20"] {
        for statistic in ["median", "max", "frames", "misses", "longest-run", "touch"] {
            let has = |r: &records::Record| r.phase == phase && r.statistic == statistic;
            assert!(records.iter().any(has), "no {statistic} of {phase}");
        }
    }
    for quantity in ["loop-force-error", "loop-probe-error"] {
        let count = records.iter().filter(|r| r.quantity == quantity && r.statistic == "value").count();
        assert_eq!(count, 2, "{quantity}");
    }
    assert!(std::path::Path::new(&out).join("report/tables/real-time.csv").exists());
}

#[test]
fn loops_that_make_no_sense_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    for (keys, key, problem) in [
        ("rates = [30]", "loop.duration", "is missing"),
        ("duration = \"1 s\"\nrates = []", "loop.rates", "is empty"),
        ("duration = \"1 s\"\nrates = [30, 0]", "loop.rates[1]", "is zero"),
        ("duration = \"1 s\"\nrates = [30, 30]", "loop.rates[1]", "is not above the rate before it"),
        ("duration = \"-1 s\"\nrates = [30]", "loop.duration", "is not positive"),
        ("duration = \"1000000 s\"\nrates = [1000]", "loop.rates[0]", "gives 1000000000 frames"),
        ("duration = \"1 s\"\nrates = [30]\nwithin = \"0 s\"", "loop.within", "is not positive"),
    ] {
        let path = write(&dir, "bad.toml", &scene(keys));
        let done = tissuebench(&["loop", &path]);
        assert_fails(&done, 2, &format!("key '{key}': "));
        assert!(done.stderr.contains(problem), "{}", done.stderr);
    }
    let linear = common::BLOCK.to_string() + "[loop]\nduration = \"1 s\"\nrates = [30]\n";
    let done = tissuebench(&["loop", &write(&dir, "linear.toml", &linear)]);
    assert_fails(&done, 2, "key 'loop': is not available in a linear procedure");
    let done = tissuebench(&["loop", &write(&dir, "none.toml", common::BLOCK)]);
    assert_fails(&done, 2, "key 'loop': is missing");
}
