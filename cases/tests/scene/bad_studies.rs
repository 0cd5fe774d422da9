use tissuebench_cases::scene::parse_study;

use crate::marked_line;

const CASES: &[(&str, &str, &[&str])] = &[
    ("title = \"t\" #<", "run", &["is missing", "[[run]]"]),
    ("title = \"t\"\n[[run]]\nscene = \"no.toml\" #<", "run[0].scene", &["'no.toml' can't be found"]),
    ("title = \"t\"\n[[runs]] #<\nscene = \"scenes/first.toml\"", "runs", &["did you mean 'run'?"]),
    ("title = \"t\"\n[[run]] #<\nlevels = [1]", "run[0].scene", &["is missing"]),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nlevels = [1, 2, 1] #<",
        "run[0].levels[2]",
        &["is given already"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nlevels = [0] #<",
        "run[0].levels[0]",
        &["not a valid level"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\npoisson = [0.5] #<",
        "run[0].poisson[0]",
        &["0.4999"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\npoisson = [\"0.3\"] #<",
        "run[0].poisson[0]",
        &["without quotes"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nnodes = [3] #<",
        "run[0].nodes[0]",
        &["4 nodes or more"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nseeds = 1 #<",
        "run[0].seeds",
        &["is out of range", "50 is"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nseeds = 5 #<",
        "run[0].seeds",
        &["are not of every method", "name such methods"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nlevels = [1]\nnodes = [83] #<",
        "run[0].nodes",
        &["can't be combined with levels"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nkernels = [\"cubic\"] #<",
        "run[0].kernels[0]",
        &["'cubic' is not known"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nsupport_scales = [1.2, 0.5] #<",
        "run[0].support_scales[1]",
        &["not a valid support scale", "1.2 to 3"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nmethods = [\"tet10\"]\nsupport_scales = [1.2] #<",
        "run[0].support_scales",
        &["has no method to vary"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nmethods = [\"tet10\"]\nessentials = [\"penalty\"] #<",
        "run[0].essentials",
        &["has no method to vary"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/kidney/kidney-fair.toml\"\nessentials = [\"penalty\", \"nitsche\"] #<",
        "run[0].essentials[1]",
        &[
            "is available for linear procedures and modes, not for kind = \"static\"",
            "take \"penalty\" or \"coupling\"",
        ],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/beam/pure-bending.toml\"\nessentials = [\"coupling\"] #<",
        "run[0].essentials[0]",
        &["does not go with every method", "linear basis"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nessentials = [{ method = \"coupling\", factor = 4 }] #<",
        "run[0].essentials[0].factor",
        &["nitsche and penalty only"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nsplit = { rule = \"gauss\", points = 0 } #<",
        "run[0].split.points",
        &["is zero"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/contact/punch.toml\"\nsplit = { rule = \"gauss\", points = 14 } #<",
        "run[0].split",
        &["is not of every method", "another one"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nmethods = [\"tet11\"] #<",
        "run[0].methods",
        &["'tet11' is not a method", "did you mean 'tet10'?"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\nmethods = [\"tet10\"]\nnodes = [83] #<",
        "run[0].nodes",
        &["has no method to vary"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\n[[run.check]]\nmetric = \"order-l2\" #<\nat_least = 1.85",
        "run[0].check[0].metric",
        &["needs a [reference]"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/patch/compression.toml\"\n[[run.check]]\nmetric = \"order-l2\" #<\nat_least = 1.85",
        "run[0].check[0].metric",
        &["needs several levels", "levels = [1, 2, 3]"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\n[[run.check]]\nmetric = \"max\"\nmethod = \"hex\" #<\nat_most = \"1 m\"",
        "run[0].check[0].method",
        &["'hex' is not a method"],
    ),
    (
        "title = \"t\"\n[[run]]\nscene = \"scenes/first.toml\"\n[[run.check]]\nmetric = \"carried-share\" #<\nat_least = 0.9",
        "run[0].check[0].metric",
        &["needs many clouds", "seeds = 50"],
    ),
    (
        "title = \"t\"\nall_of = \"scenes/beam\" #<\n[[run]]\nscene = \"scenes/first.toml\"",
        "all_of",
        &["contains a scene without a run", "torsion.toml", "[[left_out]]"],
    ),
    (
        "title = \"t\"\nall_of = \"scenes/beams\" #<\n[[run]]\nscene = \"scenes/first.toml\"",
        "all_of",
        &["has no scenes", "relative to the study's"],
    ),
    (
        "title = \"t\"\n[[left_out]] #<\nscene = \"scenes/first.toml\"\nreason = \"why\"\n[[run]]\nscene = \"scenes/first.toml\"",
        "left_out",
        &["applies to all_of only"],
    ),
    (
        "title = \"t\"\nall_of = \"scenes\"\n[[left_out]]\nscene = \"scenes/first.toml\" #<\nreason = \"why\"\n[[run]]\nscene = \"scenes/first.toml\"",
        "left_out[0].scene",
        &["is in a run"],
    ),
    (
        "title = \"t\"\nall_of = \"scenes\"\n[[left_out]]\nscene = \"scenes/last.toml\" #<\nreason = \"why\"\n[[run]]\nscene = \"scenes/first.toml\"",
        "left_out[0].scene",
        &["can't be found"],
    ),
    (
        "title = \"t\"\nall_of = \"scenes\"\n[[left_out]]\nscene = \"scenes/cloud-cost.toml\"\nreason = \" \" #<\n[[run]]\nscene = \"scenes/first.toml\"",
        "left_out[0].reason",
        &["is empty"],
    ),
];

#[test]
fn every_mistake_of_a_study_is_named() {
    let file = format!("{}/study.toml", env!("CARGO_MANIFEST_DIR"));
    for (text, key, fragments) in CASES {
        let line = marked_line(text);
        let errors = parse_study(text, &file).expect_err(text);
        let fits = errors.iter().any(|error| {
            let said = error.to_string();
            error.key == *key && error.line == line && fragments.iter().all(|f| said.contains(f))
        });
        assert!(fits, "{text}\nwants line {line}, key {key}, {fragments:?}, got {errors:#?}");
    }
}
