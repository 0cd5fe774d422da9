use tissuebench_cases::scene::{ErrorKind, parse};

use crate::bad_methods::METHODS;
use crate::{edited, marked_line};

/// Replaced text in the sound scene, its replacement (the line of the error ends in `#<`), the key of the
/// error, and parts of the message.
pub type Bad = (&'static str, &'static str, &'static str, &'static [&'static str]);

const UNITS: &[Bad] = &[
    (
        "young = \"20 kPa\"",
        "young = 20 #<",
        "material.young",
        &["'20' has no unit", "write \"20 kPa\"", "a pressure needs a unit: kPa, Pa, MPa, GPa, N/mm^2"],
    ),
    ("young = \"20 kPa\"", "young = \"20\" #<", "material.young", &["'20' has no unit", "write \"20 kPa\""]),
    ("young = \"20 kPa\"", "young = 2.5e4 #<", "material.young", &["'2.5e4' has no unit", "\"2.5e4 kPa\""]),
    (
        "young = \"20 kPa\"",
        "young = \"20 mm\" #<",
        "material.young",
        &["'20 mm' is a length, where a pressure belongs", "kPa"],
    ),
    ("young = \"20 kPa\"", "young = \"20 KPa\" #<", "material.young", &["'KPa'", "did you mean 'kPa'?"]),
    ("young = \"20 kPa\"", "young = \"20 kpa\" #<", "material.young", &["'kpa'", "did you mean 'kPa'?"]),
    ("young = \"20 kPa\"", "young = \"20 kPa^2\" #<", "material.young", &["wrong dimension for a pressure"]),
    ("young = \"20 kPa\"", "young = \"20 kPa^99\" #<", "material.young", &["kPa^99", "not known"]),
    (
        "young = \"20 kPa\"",
        "young = \"soft\" #<",
        "material.young",
        &["'soft'", "begin with a finite number"],
    ),
    ("young = \"20 kPa\"", "young = \"nan kPa\" #<", "material.young", &["'nan kPa'", "finite number"]),
    ("young = \"20 kPa\"", "young = \"inf Pa\" #<", "material.young", &["'inf Pa'", "finite number"]),
    ("young = \"20 kPa\"", "young = \"1e400 Pa\" #<", "material.young", &["not a finite number"]),
    (
        "young = \"20 kPa\"",
        "young = \"\" #<",
        "material.young",
        &["finite number", "a pressure needs a unit"],
    ),
    ("young = \"20 kPa\"", "young = true #<", "material.young", &["'true' is a truth value", "a pressure"]),
    (
        "density = \"1000 kg/m^3\"",
        "density = \"1000 kg/m^2\" #<",
        "material.density",
        &["wrong dimension", "kg/m^3"],
    ),
    ("\"-9810 N/m^3\"]", "-9810] #<", "load[2].body[2]", &["'-9810' has no unit", "\"-9810 N/m^3\""]),
    ("\"0 mm\", \"5 mm\"]]", "\"0 mm\", 5]] #<", "output.probes[0][2]", &["'5' has no unit", "\"5 mm\""]),
    (
        "unit = \"Pa\", of",
        "unit = \"mm\", #<\n of",
        "load[0].pressure.unit",
        &["a length, where a pressure belongs"],
    ),
    ("unit = \"Pa\", of", "unit = \"5 Pa\", #<\n of", "load[0].pressure.unit", &["a quantity, not a unit"]),
    ("at_most = \"0.1 mm\"", "at_most = 0.1 #<", "check[0].at_most", &["'0.1' has no unit", "\"0.1 mm\""]),
    (
        "at_most = \"0.1 mm\"",
        "at_most = \"0.1 Pa\" #<",
        "check[0].at_most",
        &["a pressure, where a length belongs"],
    ),
    ("[1e-4, 1e-2]", "[1e-4, \"1 mm\"] #<", "check[1].known_band", &["a length, where a number belongs"]),
    ("curvature = \"0.5 /m\"", "curvature = 0.5 #<", "reference.curvature", &["has no unit", "\"0.5 /m\""]),
    (
        "curvature = \"0.5 /m\"",
        "curvature = \"0.5 m\" #<",
        "reference.curvature",
        &["a length, where a curvature"],
    ),
];

const KEYS: &[Bad] = &[
    (
        "young = \"20 kPa\"",
        "yuong = \"20 kPa\" #<",
        "material.yuong",
        &["not a known key", "did you mean 'young'?"],
    ),
    ("title = \"A block\"", "titel = \"A block\" #<", "titel", &["not a known key", "did you mean 'title'?"]),
    ("[procedure]", "[proccedure] #<", "proccedure", &["not a known key", "did you mean 'procedure'?"]),
    ("element = \"tet4\"", "elements = \"tet4\" #<", "method[0].elements", &["did you mean 'element'?"]),
    (
        "support_scale = 1.6",
        "dilation = 1.6 #<",
        "method[1].dilation",
        &["'1.6' is a number", "\"nodal-mean\""],
    ),
    ("seed = 7 }", "sed = 7 } #<", "method[0].jitter.sed", &["did you mean 'seed'?"]),
    ("[material]\n", "[material]\nyoung = 1\nyoung = 2 #<\n", "", &["not valid TOML", "duplicate key"]),
    ("[material]\n", "[material #<\n", "", &["not valid TOML"]),
    ("poisson = 0.45", "poisson = 0,45 #<", "", &["not valid TOML at column", "write a decimal point: 0.45"]),
    (
        "law = \"linear\", young = \"0.04 N/mm^2\", poisson = 0.3 }",
        "law = \"linear\", young = \"0.04 N/mm^2\", poisson = 0,3 } #<",
        "",
        &["write a decimal point: 0.3"],
    ),
    ("young = \"20 kPa\"", "young = 20 kPa #<", "", &["not valid TOML"]),
    ("young = \"20 kPa\"", "young = \"20 kPa #<", "", &["not valid TOML"]),
    ("[material]\nlaw = \"linear\"", "[material] #<", "material.law", &["is missing", "linear", "ogden"]),
    ("law = \"linear\"\nyoung", "law = \"lineer\" #<\nyoung", "material.law", &["did you mean 'linear'?"]),
    (
        "[material]\nlaw = \"linear\"\nyoung = \"20 kPa\"",
        "[material] #<\nlaw = \"linear\"",
        "material.young",
        &["is missing", "a pressure with its unit"],
    ),
    ("shape = \"box\"", "shape = \"boks\" #<", "body.shape", &["'boks' is not known", "did you mean 'box'?"]),
    (
        "poisson = 0.45",
        "poisson = \"0.45\" #<",
        "material.poisson",
        &["'0.45' is text", "a number without quotes"],
    ),
    ("poisson = 0.45", "poisson = nan #<", "material.poisson", &["'nan' is not a finite number"]),
    ("poisson = 0.45", "poisson = -inf #<", "material.poisson", &["not a finite number"]),
    ("poisson = 0.45", "poisson = 2026-01-01 #<", "material.poisson", &["is a date"]),
    ("kind = \"linear\"", "kind = \"statik\" #<", "procedure.kind", &["did you mean 'static'?"]),
    (
        "kernel = \"cubic-spline\"\nneighbours = 15\nfactor = 1.2\nbasis = \"linear\"",
        "kernel = \"cubic-spline\" #<\nbasis = \"maximum-entropy\"",
        "method[2].kernel",
        &["can't be combined with basis = \"maximum-entropy\""],
    ),
    (
        "kernel = \"cubic-spline\"\nneighbours = 15\nfactor = 1.2\nbasis = \"linear\"",
        "basis = \"maximum-entropy\"\ngamma = 20 #<",
        "method[2].gamma",
        &["is not a valid locality", "0.8 to 4"],
    ),
    (
        "kernel = \"cubic-spline\"",
        "kernel = \"cubic\" #<",
        "method[2].kernel",
        &["not known", "cubic-spline"],
    ),
    (
        "basis = \"linear\"\nintegration = { rule = \"gauss\"",
        "basis = \"cubic\" #<\nintegration = { rule = \"gauss\"",
        "method[1].basis",
        &["not known", "linear, quadratic"],
    ),
    (
        "rule = \"gauss\", points",
        "rule = \"gaus\", #<\npoints",
        "method[1].integration.rule",
        &["did you mean 'gauss'?"],
    ),
    (
        "essential = \"multipliers\"",
        "essential = \"multiplier\" #<",
        "method[2].essential",
        &["did you mean 'multipliers'?"],
    ),
    (
        "essential = \"multipliers\"",
        "essential = { method = \"multipliers\", rows = \"points\" } #<",
        "method[2].essential.rows",
        &["applies to elimination only", "leave it out"],
    ),
    (
        "essential = \"multipliers\"",
        "essential = { method = \"elimination\", factor = 4 } #<",
        "method[2].essential.factor",
        &["applies to nitsche and penalty only"],
    ),
    (
        "essential = \"multipliers\"",
        "essential = { method = \"coupling\", factor = 4 } #<",
        "method[2].essential.factor",
        &["applies to nitsche and penalty only"],
    ),
    (
        "basis = \"linear\"\nintegration = { rule = \"cell-smoothed\" }\nessential = \"multipliers\"",
        "basis = \"quadratic\" #<\nintegration = { rule = \"cell-smoothed\", order = 2 }\nessential = \"coupling\"",
        "method[2].basis",
        &["'quadratic' can't be combined with essential = \"coupling\"", "take basis = \"linear\""],
    ),
    (
        "kernel = \"cubic-spline\"\nneighbours = 15\nfactor = 1.2\nbasis = \"linear\"\n\
         integration = { rule = \"cell-smoothed\" }\nessential = \"multipliers\"",
        "basis = \"maximum-entropy\" #<\nintegration = { rule = \"cell-smoothed\" }\nessential = \"coupling\"",
        "method[2].basis",
        &["'maximum-entropy' can't be combined with essential = \"coupling\""],
    ),
    (
        "size = { level = 2 }\nkernel = \"cubic-spline\"\nneighbours = 15\nfactor = 1.2\nbasis = \"linear\"\n\
         integration = { rule = \"cell-smoothed\" }\nessential = \"multipliers\"",
        "nodes = 83\ncloud = { refine = { by = \"gradient-error\" } } #<\nkernel = \"cubic-spline\"\nsupport_scale = 1.6\n\
         basis = \"linear\"\nintegration = { rule = \"cell-smoothed\" }\nessential = \"coupling\"",
        "method[2].cloud.refine",
        &["can't be combined with essential = \"coupling\"", "\"elimination\""],
    ),
    (
        "scheme = \"inverse-distance\",",
        "scheme = \"inverse distance\", #<\n",
        "output.transfer.scheme",
        &["did you mean 'inverse-distance'?"],
    ),
    ("cells = [4, 4, 2]", "cells = [4, 4] #<\n", "method[0].size.cells", &["has 2 entries, not 3"]),
    ("cells = [4, 4, 2]", "cells = [4, 4, -2] #<\n", "method[0].size.cells[2]", &["'-2' is negative"]),
    ("nodes = 83", "nodes = 83.5 #<", "method[1].nodes", &["'83.5' is a number", "a whole number"]),
    ("nodes = 83", "nodes = 99999999999 #<", "method[1].nodes", &["larger than 4294967295"]),
    ("nodes = 83", "nodes = 99999999999999999999 #<", "method[1].nodes", &["too large"]),
    ("[procedure]", "[[procedure]] #<", "procedure", &["is a list, where a table"]),
    ("metric = \"rms-x\"", "metric = 3 #<", "check[0].metric", &["'3' is a number", "text in quotes"]),
];

const CONDITIONS: &[Bad] = &[
    (
        "traction = [\"0 Pa\", \"1 kPa\", { unit = \"kPa\", of = \"x\" }]",
        "traction = \"1 kPa\" #<",
        "load[1].traction",
        &[
            "'1 kPa' is text, where \"exact\" or a list of 3 such as [\"0 kPa\", \"0 kPa\", \"1 kPa\"] or a table",
            "for one along the inner normal take pressure = \"1 kPa\"",
        ],
    ),
    (
        "move = { x = \"exact\", z = { unit = \"mm\", of = \"-x^2\" } }",
        "move = \"6 mm\" #<",
        "support[1].move",
        &[
            "'6 mm' is text, where \"exact\" or a list of 3 such as [\"0 mm\", \"0 mm\", \"1 mm\"] or a table { x, y, z }",
        ],
    ),
    (
        "fix = \"xyz\"",
        "fix = \"z\"\nmove = [\"0 mm\", \"0 mm\", \"1 mm\"] #<",
        "support[0].move[2]",
        &["moves an axis that 'fix' constrains"],
    ),
    ("\"z == 0 mm\"", "\"z = 0 mm\" #<", "support[0].where", &["'==' compares"]),
    ("\"z == 0 mm\"", "\"z == 0\" #<", "support[0].where", &["'z == 0' has no unit", "\"0 mm\""]),
    ("\"z == 0 mm\"", "\"z == 1 Pa\" #<", "support[0].where", &["a pressure, where a length belongs"]),
    ("\"z == 0 mm\"", "\"r == 0 mm\" #<", "support[0].where", &["doesn't begin with x, y or z"]),
    ("\"z == 0 mm\"", "\"z == 0 mm and\" #<", "support[0].where", &["an empty comparison"]),
    ("\"z == 0 mm\"", "\"z == 0 mm or x == 0 mm\" #<", "support[0].where", &["compares twice"]),
    ("\"z == 0 mm\"", "\"0 mm < z < 1 mm\" #<", "support[0].where", &["doesn't begin with x, y or z"]),
    ("\"z == 0 mm\"", "\"top\" #<", "support[0].where", &["'top' has no comparison", "joined by 'and'"]),
    ("\"z == 0 mm\"", "\"z <> 0 mm\" #<", "support[0].where", &["'<>'", "not known"]),
    (
        "where = \"z == 0 mm\"",
        "on = \"zmin\" #<",
        "support[0].on",
        &["'zmin' is not a surface of a box", "did you mean 'z-min'?"],
    ),
    ("where = \"z == 0 mm\"", "on = [] #<", "support[0].on", &["names nothing"]),
    (
        "where = \"z == 0 mm\"",
        "on = \"z-min\"\nwhere = \"z == 0 mm\" #<",
        "support[0].where",
        &["can't be combined with 'on'", "not both"],
    ),
    (
        "[[support]]\nwhere = \"z == 0 mm\"",
        "[[support]] #<",
        "support[0].where",
        &["is missing", "give a region"],
    ),
    ("fix = \"xyz\"", "fix = \"xw\" #<", "support[0].fix", &["'xw' is not a list of axes"]),
    (
        "fix = \"xyz\"",
        "fix = \"xyz\"\nmove = \"exact\" #<",
        "support[0].move",
        &["moves axes that 'fix' constrains"],
    ),
    (
        "fix = \"xyz\"",
        "fix = \"xyz\"\nmove.z = \"1 mm\" #<",
        "support[0].move.z",
        &["moves an axis that 'fix' constrains"],
    ),
    (
        "fix = \"xyz\"",
        "move = \"exactly\" #<",
        "support[0].move",
        &["'exactly' is not known", "did you mean 'exact'?"],
    ),
    (
        "[[support]]\nwhere = \"z == 0 mm\"\nfix = \"xyz\"",
        "[[support]] #<\nwhere = \"z == 0 mm\"",
        "support[0].fix",
        &["is missing", "write fix = \"xyz\""],
    ),
    (
        "of = \"z^2\"",
        "of = \"z^^2\" #<\n",
        "load[0].pressure.of",
        &["'z^^2'", "missing before '^' at character 3"],
    ),
    ("of = \"z^2\"", "of = \"z^2 + r\" #<\n", "load[0].pressure.of", &["'r' is not known at character 7"]),
    ("of = \"z^2\"", "of = \"(z^2\" #<\n", "load[0].pressure.of", &["a ')' is missing at character 5"]),
    ("of = \"z^2\"", "of = \"z^2)\" #<\n", "load[0].pressure.of", &["a ')' closes nothing at character 4"]),
    (
        "of = \"z^2\"",
        "of = \"2z\" #<\n",
        "load[0].pressure.of",
        &["an operator is missing before 'z'", "2*x"],
    ),
    ("of = \"z^2\"", "of = \"z**2\" #<\n", "load[0].pressure.of", &["missing before '*' at character 3"]),
    (
        "of = \"z^2\"",
        "of = \"x^2 y\" #<\n",
        "load[0].pressure.of",
        &["an operator is missing before 'y' at character 5"],
    ),
    ("of = \"z^2\"", "of = \"sin x\" #<\n", "load[0].pressure.of", &["in parentheses"]),
    ("of = \"z^2\"", "of = \"sine(x)\" #<\n", "load[0].pressure.of", &["did you mean 'sin'?"]),
    ("of = \"z^2\"", "of = \"max(x)\" #<\n", "load[0].pressure.of", &["an argument is missing"]),
    ("of = \"z^2\"", "of = \"1/0\" #<\n", "load[0].pressure.of", &["'1/0' is not finite"]),
    ("of = \"z^2\"", "of = \"\" #<\n", "load[0].pressure.of", &["empty expression"]),
    (
        "of = \"z^2\"",
        "of = \"z\u{b2}\" #<\n",
        "load[0].pressure.of",
        &["'\u{b2}' has no meaning at character 2"],
    ),
    ("of = \"z^2\"", "of = 3 #<\n", "load[0].pressure.of", &["'3' is a number", "an expression in quotes"]),
    (
        "[[load]]\nbody = [\"0 N/m^3\", \"0 N/m^3\", \"-9810 N/m^3\"]",
        "[[load]] #<\non = \"z-max\"",
        "load[2]",
        &["is missing", "traction, pressure and body"],
    ),
    (
        "[[load]]\non = \"z-max\"\n",
        "[[load]] #<\non = \"z-max\"\ntraction = \"exact\"\n",
        "load[0]",
        &["several kinds of load", "one of traction, pressure and body"],
    ),
    ("[[load]]\nbody", "[[load]]\non = \"z-max\" #<\nbody", "load[2].on", &["acts everywhere"]),
];

const OUTPUT: &[Bad] = &[
    ("[[\"0 mm\", \"0 mm\", \"5 mm\"]]", "[] #<", "output.probes", &["is empty"]),
    ("neighbours = 4, power = 2", "neighbours = 0 #<\n", "output.transfer.neighbours", &["is zero"]),
    (
        "neighbours = 4, power = 2",
        "support_scale = 2 #<\n",
        "output.transfer.support_scale",
        &["takes no support_scale"],
    ),
    (
        "scheme = \"inverse-distance\", neighbours = 4, power = 2",
        "scheme = \"cubic\", shape = 2 #<\n",
        "output.transfer.shape",
        &["cubic takes no shape"],
    ),
    (
        "scheme = \"inverse-distance\", neighbours = 4, power = 2",
        "scheme = \"multiquadric\", shape = 0 #<\n",
        "output.transfer.shape",
        &["zero"],
    ),
    (
        "scheme = \"inverse-distance\", neighbours = 4, power = 2",
        "scheme = \"natural-neighbour\", polynomial = false #<\n",
        "output.transfer.polynomial",
        &["natural-neighbour takes no polynomial"],
    ),
    (
        "to = \"probes\"",
        "to = \"reference-nodes\" #<\n",
        "output.transfer.to",
        &["'reference-nodes' has no nodes to go to"],
    ),
    (
        "\"pure-bending\"",
        "\"pure-bendng\" #<",
        "reference.exact",
        &["'pure-bendng' is not known", "did you mean 'pure-bending'?"],
    ),
    (
        "curvature = \"0.5 /m\"",
        "curvatur = \"0.5 /m\" #<",
        "reference.curvatur",
        &["did you mean 'curvature'?"],
    ),
    (
        "[reference]\nexact = \"pure-bending\"\ncurvature = \"0.5 /m\"",
        "[reference] #<\nexact = \"pure-bending\"",
        "reference.curvature",
        &["is missing", "curvature of the axis"],
    ),
    ("[reference]\nexact", "[reference] #<\nmethod = \"tet4\"\nexact", "reference", &["not one reference"]),
    (
        "exact = \"pure-bending\"\ncurvature = \"0.5 /m\"",
        "method = \"tet4\"\ncurvature = \"0.5 /m\" #<",
        "reference.curvature",
        &["not a known key"],
    ),
    (
        "metric = \"rms-x\"",
        "metric = \"rms_x\" #<",
        "check[0].metric",
        &["'rms_x' is not a known metric", "did you mean 'rms-x'?"],
    ),
    ("metric = \"l2\"", "metric = \"order-l2\" #<", "check[1].metric", &["needs several levels"]),
    (
        "[\"tet4\", \"efg-83\"]",
        "[\"tet4\", \"efg-84\"] #<",
        "check[0].method",
        &["'efg-84' is not a method", "did you mean 'efg-83'?"],
    ),
    (
        "[[check]]\nmetric = \"rms-x\"\nmethod = [\"tet4\", \"efg-83\"]\nat_most = \"0.1 mm\"",
        "[[check]] #<\nmetric = \"rms-x\"",
        "check[0]",
        &["at_most, at_least or known_band"],
    ),
    (
        "at_most = \"0.1 mm\"",
        "at_least = \"1 mm\"\nat_most = \"0.1 mm\" #<",
        "check[0].at_most",
        &["leaves no value"],
    ),
    ("[1e-4, 1e-2]", "[1e-2, 1e-4] #<", "check[1].known_band", &["is not a valid band"]),
    (
        "known_band = [1e-4, 1e-2]",
        "at_most = 1\nknown_band = [1e-4, 1e-2] #<",
        "check[1].known_band",
        &["can't be combined with a bound"],
    ),
    (
        "at_most = \"0.1 mm\"",
        "at_most = \"0.1 mm\"\nreason = \"why\" #<",
        "check[0].reason",
        &["applies to known_band only"],
    ),
];

#[test]
fn every_mistake_is_named_with_its_line_its_key_and_the_fix() {
    let mut wrong = Vec::new();
    let lists = [UNITS, KEYS, CONDITIONS, METHODS, OUTPUT];
    for (from, to, key, fragments) in lists.into_iter().flatten() {
        let text = edited(from, to);
        let line = marked_line(&text);
        let errors = match parse(&text, "cases/bad.toml") {
            Ok(_) => {
                wrong.push(format!("'{to}' was taken"));
                continue;
            }
            Err(errors) => errors,
        };
        let said: Vec<String> = errors.iter().map(ToString::to_string).collect();
        let start = format!("cases/bad.toml:{line}: ");
        let fits = errors.iter().zip(&said).any(|(error, text)| {
            error.key == *key
                && error.kind == ErrorKind::Invalid
                && text.starts_with(&start)
                && fragments.iter().all(|fragment| text.contains(fragment))
        });
        if !fits {
            wrong.push(format!(
                "'{to}' wants '{start}key {key}' with {fragments:?}, got\n  {}",
                said.join("\n  ")
            ));
        }
    }
    assert!(wrong.is_empty(), "{} findings:\n{}", wrong.len(), wrong.join("\n"));
    let count: usize = lists.iter().map(|list| list.len()).sum();
    assert!(count >= 120, "{count} bad inputs");
}
