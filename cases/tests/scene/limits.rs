//! Files larger than any sensible use: each is refused at once, with the key, the number and the limit.

use tissuebench_cases::scene::{parse, parse_study};

use crate::{SCENE, edited};

fn first(result: Result<impl Sized, Vec<tissuebench_cases::scene::SceneError>>) -> String {
    result.err().map(|errors| errors[0].to_string()).unwrap_or_default()
}

#[test]
fn a_scene_has_a_size() {
    let long = format!("{SCENE}\n{}", "# more\n".repeat(700_000));
    assert!(first(parse(&long, "long.toml")).contains("long.toml:1: is 49"), "{}", first(parse(&long, "l")));
    let probes = "[\"0 mm\", \"0 mm\", \"5 mm\"], ".repeat(10_001);
    let many = first(parse(&edited("[\"0 mm\", \"0 mm\", \"5 mm\"]", &probes), "many.toml"));
    assert!(
        many.contains("output.probes") && many.contains("has 10001 entries; give 10000 or less"),
        "{many}"
    );
    let grid = format!("[{}]", ["[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]"; 30].join(", "));
    let values = format!("a = [{}]", [grid.as_str(); 700].join(", "));
    let many = first(parse(&values, "many.toml"));
    assert!(many.contains("one value too many; a file has at most 200000"), "{many}");
}

fn study(table: &str) -> String {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/study.toml");
    first(parse_study(&format!("title = \"t\"\n[[run]]\n{table}"), file))
}

#[test]
fn a_study_has_a_number_of_runs_and_of_scenes() {
    let scene = "scene = \"scenes/kidney/kidney-clouds.toml\"\nmethods = [\"gauss-1\"]\n";
    let list = |count: u32| (4..4 + count).map(|n| n.to_string()).collect::<Vec<_>>().join(", ");
    assert_eq!(study(&format!("{scene}nodes = [{}]\nseeds = 100", list(1000))), "");
    let runs = study(&format!("{scene}nodes = [{}]\nseeds = 100", list(1001)));
    assert!(
        runs.contains("run[0]") && runs.contains("gives 100100 runs") && runs.contains("100000"),
        "{runs}"
    );
    let axis = |count: u32| {
        let values = list(count);
        let set = "set = { \"material.poisson\" = \"{x / 100000}\" }";
        let beam = "scene = \"scenes/beam/pure-bending.toml\"\nmethods = [\"tet4\"]";
        study(&format!("{beam}\n[run.axis]\nname = \"nu\"\nvalues = [{values}]\njudge = \"l2\"\n{set}"))
    };
    assert_eq!(axis(5000), "");
    let scenes = axis(5001);
    assert!(scenes.contains("run[0].axis.values") && scenes.contains("gives 5001 scenes"), "{scenes}");
}
