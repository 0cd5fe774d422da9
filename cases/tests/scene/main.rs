//! Scene and study files through the public interface: accepted files, refused files with their messages, no
//! panics.

mod bad;
mod expressions;
mod fuzz;
mod good;
mod limits;
mod project;
mod shared;
mod tissue;

/// A scene with every part that runs today, and some parts that are not available yet.
pub const SCENE: &str = r#"title = "A block"
source = "made up for the tests"
[body]
shape = "box"
min = ["-20 mm", "-2 cm", "0 mm"]
max = ["20 mm", "20 mm", "0.02 m"]
[material]
law = "linear"
young = "20 kPa"
poisson = 0.45
density = "1000 kg/m^3"
[[region]]
name = "core"
where = "x >= -5 mm and x <= 5 mm"
material = { law = "linear", young = "0.04 N/mm^2", poisson = 0.3 }
[[support]]
where = "z == 0 mm"
fix = "xyz"
[[support]]
on = ["x-min", "x-max"]
move = { x = "exact", z = { unit = "mm", of = "-x^2" } }
[[load]]
on = "z-max"
pressure = { unit = "Pa", of = "z^2" }
[[load]]
on = "y-max"
traction = ["0 Pa", "1 kPa", { unit = "kPa", of = "x" }]
[[load]]
body = ["0 N/m^3", "0 N/m^3", "-9810 N/m^3"]
[procedure]
kind = "linear"
steps = 10
[[method]]
id = "tet4"
family = "fem"
element = "tet4"
dilation = "nodal-mean"
size = { cells = [4, 4, 2], grading = [1, 1, 2] }
jitter = { fraction = 0.2, seed = 7 }
[[method]]
id = "efg-83"
family = "efg"
nodes = 83
kernel = { name = "gaussian", alpha = 0.4 }
support_scale = 1.6
basis = "linear"
integration = { rule = "gauss", points = 4 }
essential = { method = "nitsche", factor = 10 }
background = { spacing = "5 mm" }
[[method]]
id = "efg-mesh"
family = "efg"
size = { level = 2 }
kernel = "cubic-spline"
neighbours = 15
factor = 1.2
basis = "linear"
integration = { rule = "cell-smoothed" }
essential = "multipliers"
[output]
probes = [["0 mm", "0 mm", "5 mm"]]
transfer = { to = "probes", scheme = "inverse-distance", neighbours = 4, power = 2 }
[reference]
exact = "pure-bending"
curvature = "0.5 /m"
[[check]]
metric = "rms-x"
method = ["tet4", "efg-83"]
at_most = "0.1 mm"
[[check]]
metric = "l2"
method = "efg-mesh"
known_band = [1e-4, 1e-2]
reason = "inconsistent integration"
"#;

/// The scene with `from` replaced by `to`; panics if `from` is not there exactly once.
pub fn edited(from: &str, to: &str) -> String {
    assert_eq!(SCENE.matches(from).count(), 1, "'{from}' must occur once");
    SCENE.replace(from, to)
}
