//! `tissuebench init`: writes a scene of an organ under a tool, from options, answers and defaults.

mod args;
mod filled;
mod meshes;
mod organ;
mod questions;
mod scene_text;
mod tool;

use std::io::{BufReader, IsTerminal};
use std::path::{Path, PathBuf};

use cases::scene::{self, Place, Region, Scene, SceneError};
use catalogue::Dimension;
use geometry::Mesh;
use geometry::surface::Treatment;

pub use args::InitArgs;

use super::args::{LengthUnit, length, length_unit};
use super::errors::input;
use super::mesh::info::guess;
use super::text::row;
use crate::discretise::place;
use crate::error::Failure;
use args::{Method, Side, Strain, choice, word};
use filled::Filled;
use meshes::Meshes;
use organ::Organ;
use questions::Questions;
use scene_text::{Drive, Hold, Size, Wanted};
use tool::Tool;

/// Default of the constrained fraction of the height.
const HELD: f64 = 0.2;
/// Default displacement of the plate over the body's height.
const CLOSURE: f64 = 0.05;
/// Node counts of each method's sizes relative to its finest size, and factors on the requested node count.
/// The first entry that gives valid meshes is used.
const FINENESS: [([f64; 3], f64); 7] = [
    ([0.25, 0.5, 1.0], 1.0),
    ([0.4, 0.6, 1.0], 1.0),
    ([0.6, 0.8, 1.0], 1.0),
    ([0.5, 0.7, 1.0], 1.5),
    ([0.6, 0.8, 1.0], 2.0),
    ([0.6, 0.8, 1.0], 3.0),
    ([0.6, 0.8, 1.0], 5.0),
];
/// Largest gap between a mesh and the end of the body at the plate, over the height.
const SHORT: f64 = 0.05;
/// Increment of the constrained height if it does not reach all pieces of a mesh, and its largest value, both
/// over the height.
const MORE: f64 = 0.05;
const MOST: f64 = 0.5;
/// Bounds of the node count. With fewer nodes, an organ cannot be meshed at a quarter of them; with more,
/// runs take hours.
const NODES: [f64; 2] = [100.0, 200_000.0];

/// Writes the scene and prints the defaults used.
pub fn init(args: &InitArgs) -> Result<(), Failure> {
    let terminal = !args.yes && std::io::stdin().is_terminal();
    let answers = terminal.then(|| Box::new(BufReader::new(std::io::stdin())) as _);
    let mut ask = Questions { answers, taken: Vec::new() };
    let file = args.file.as_deref().map(Path::to_string_lossy);
    let read = |text: &str| match Path::new(text) {
        path if path.is_file() => Ok(path.to_path_buf()),
        path if path.exists() => {
            Err("is not a file; give a surface (STL, OBJ, PLY, OFF, .vtp, .mesh) or a mesh file".into())
        }
        _ => {
            Err("there is no such file; give a surface (STL, OBJ, PLY, OFF, .vtp, .mesh) or a mesh file"
                .into())
        }
    };
    let file: PathBuf = ask.value("file", file.as_deref(), "Surface or mesh file of the organ", "", read)?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| Path::new(file.file_name().unwrap_or_default()).with_extension("toml"));
    free(&out, &file, args.force)?;
    let (organ, unit) = sized(&file, args, &mut ask)?;
    let (wanted, meshes) = wanted(args, &mut ask, &file, &out, &organ, unit)?;
    let text = scene_text::text(&wanted);
    let name = out.display().to_string();
    let found = parsed(&wanted, &out)?;
    let held = &found.supports[0].place;
    if let Place::Where(region) = held {
        holds(region, &organ, &wanted)?;
    }
    if let Some((mesh, pieces)) = meshes.unheld(held)? {
        let problem = format!(
            "does not constrain the mesh of {mesh}, which has {pieces} pieces: constrain more of the body, or give more --nodes"
        );
        return Err(input(format!("--hold '{}': {problem}", place::words(held))));
    }
    disk::write(&out, &text).map_err(|bad| input(format!("{name}: can't be written: {bad}")))?;
    println!(
        "{name}: {} under {} from the {}, {} runs",
        file.display(),
        wanted.tool.words(),
        word(wanted.side),
        found.methods.len()
    );
    let width = ask.taken.iter().map(|[option, value, _]| option.len() + value.len()).max().unwrap_or(0) + 3;
    for (at, [option, value, question]) in ask.taken.iter().enumerate() {
        let given = format!("{option} \"{value}\"");
        row(if at == 0 { "defaults" } else { "" }, &format!("{given:width$}  {question}"));
    }
    if wanted.parts != FINENESS[0].0 {
        row("sizes", "finer than usual, so that every mesh reaches the plate and the constrained part");
    }
    for (at, line) in mesh_files::summary(&model_of(&file)).iter().enumerate() {
        row(if at == 0 { "left out" } else { "" }, line);
    }
    let results = out.with_extension("");
    row("next", &format!("tissuebench run {name} --out {}-results", results.display()));
    Ok(())
}

/// Returns the parts of a mesh file's model that the scene leaves out.
fn model_of(file: &Path) -> Vec<mesh_files::LeftOut> {
    let found = mesh_files::left_out(file).into_iter();
    found.filter(|part| part.kind != mesh_files::Kind::Values).collect()
}

/// Refuses to overwrite the organ's file, or an existing scene unless `force` is set.
fn free(out: &Path, file: &Path, force: bool) -> Result<(), Failure> {
    disk::input(file);
    disk::spare(out).map_err(|bad| input(format!("--out '{}': {bad}", out.display())))?;
    if out.is_dir() {
        return Err(input(format!("--out '{}': is a folder; name a file in it", out.display())));
    }
    if out.exists() && !force {
        let name = out.display();
        return Err(input(format!(
            "{name}: exists; replace the file with --force, or name another file with --out"
        )));
    }
    Ok(())
}

/// Reads the body in the given unit, or in the unit that gives the length of an organ.
fn sized(file: &Path, args: &InitArgs, ask: &mut Questions) -> Result<(Organ, LengthUnit), Failure> {
    let known = |text: &str| length_unit(text).map_err(|known| format!("is not {known}"));
    let treatment = treatment(args)?;
    let mut first = LengthUnit { name: "mm", metres: 1e-3 };
    if let (Treatment::Wrap { .. }, Some(unit)) = (treatment, &args.unit) {
        // A wrap in another unit than the size would be of other triangles.
        first = known(unit).map_err(|bad| input(format!("--unit '{unit}' {bad}")))?;
    }
    let read = |unit| Organ::read(file, unit, treatment);
    let organ = read(first)?;
    let fits = guess(organ.largest_extent(), first).unwrap_or(first.name);
    let unit: LengthUnit = ask.value("unit", args.unit.as_deref(), "Length unit of the file", fits, known)?;
    let same = unit.name == first.name;
    Ok((if same { organ } else { read(unit)? }, unit))
}

/// Returns what is done with the surface.
fn treatment(args: &InitArgs) -> Result<Treatment, Failure> {
    match &args.wrap {
        Some(text) => {
            let size = length(text).map_err(|bad| input(format!("--wrap '{text}': {bad}")))?;
            Ok(Treatment::Wrap { size })
        }
        None if args.repair => Ok(Treatment::Repair),
        None => Ok(Treatment::AsGiven),
    }
}

/// Returns the key of the scene's body for what is done with the surface.
fn treatment_key(args: &InitArgs) -> String {
    match &args.wrap {
        Some(text) => format!("\nwrap = {}", scene_text::quoted(text)),
        None if args.repair => "\nrepair = true".into(),
        None => String::new(),
    }
}

/// Returns the values of the scene, from options, answers or fits to its meshes, and these meshes.
fn wanted(
    args: &InitArgs,
    ask: &mut Questions,
    file: &Path,
    out: &Path,
    organ: &Organ,
    unit: LengthUnit,
) -> Result<(Wanted, Meshes), Failure> {
    let question = "Range of strains: small or large";
    let strain = ask.value("strain", args.strain.as_deref(), question, "large", choice::<Strain>)?;
    let (young, young_value) =
        ask.value("young", args.young.as_deref(), "Young's modulus", "20 kPa", |text| {
            quantity(Dimension::Pressure, text).map(|value| (text.to_string(), value))
        })?;
    let poisson = ask.value("poisson", args.poisson.as_deref(), "Poisson's ratio", "0.45", ratio)?;
    let question = "Methods: tet4, tet4-nodal, tet10 and efg";
    let methods = ask.value("methods", args.methods.as_deref(), question, "tet4,tet10,efg", methods)?;
    let described = |metres: f64| scene_text::length(metres, unit, organ.largest_extent());
    let size = match &args.spacing {
        Some(text) => spacing(text, organ, &described)?,
        None => ask.value("nodes", args.nodes.as_deref(), "Nodes of the finest size", "1000", nodes)?,
    };
    let tool = tool(args, strain)?;
    let tool_path = match &tool {
        Tool::File(file) => path_from(out, file)?,
        _ => String::new(),
    };
    let filled = Filled::new(organ);
    let sides = filled.sides(HELD);
    let mut wanted = Wanted {
        title: String::new(),
        path: path_from(out, file)?,
        treatment: treatment_key(args),
        unit,
        strain,
        young,
        young_value,
        poisson,
        hold: Hold::Where(String::new()),
        side: sides[0],
        friction: friction(args, strain)?,
        across: tool.across(sides[0], organ),
        tool,
        tool_path,
        bounds: organ.bounds,
        drive: Drive::Closure(CLOSURE * organ.smallest_extent()),
        gap: gap(args, strain)?,
        methods,
        size,
        parts: FINENESS[0].0,
        probes: organ.bounds,
    };
    let pressed = |wanted: &mut Wanted, side| {
        wanted.title = title(file, &wanted.tool, side);
        (wanted.side, wanted.size, wanted.across) = (side, size, wanted.tool.across(side, organ));
        fine_enough(wanted, organ, filled.held(wanted.tool.held_from(side, organ), HELD), out)
    };
    let fits = |side: &&Side| args.press_from.is_none() && pressed(&mut wanted, **side).is_ok();
    let best = word(*sides.iter().find(fits).unwrap_or(&sides[0]));
    let question = "Side from which the tool presses: top, bottom, left, right, front or back";
    let side = ask.value("press-from", args.press_from.as_deref(), question, &best, choice::<Side>)?;
    let (meshes, default) = pressed(&mut wanted, side)?;
    let question = "Constrained part: comparisons of x, y and z, or a surface of the mesh file";
    wanted.hold = ask.value("hold", args.hold.as_deref(), question, &default, |text| held(text, organ))?;
    let height = organ.extent(side.axis());
    let short = meshes.shortest(organ.bounds, side);
    wanted.drive = driven(args, ask, strain, &described((CLOSURE * height).max(2.0 * short)))?;
    if let Drive::Closure(by) = wanted.drive
        && by >= height
    {
        let height = described(height);
        return Err(input(format!("--closure '{}': the body is only {height} high", described(by))));
    }
    wanted.probes = [organ.near(side, &meshes), organ.middle(&meshes)];
    Ok((wanted, meshes))
}

/// Returns the initial distance of the tool, m.
fn gap(args: &InitArgs, strain: Strain) -> Result<f64, Failure> {
    match (&args.gap, strain) {
        (None, _) => Ok(0.0),
        (Some(text), Strain::Large) => {
            quantity(Dimension::Length, text).map_err(|bad| input(format!("--gap '{text}': {bad}")))
        }
        (Some(text), Strain::Small) => {
            Err(input(format!("--gap '{text}': small strain has no tool; give --strain large")))
        }
    }
}

/// Returns the tool.
fn tool(args: &InitArgs, strain: Strain) -> Result<Tool, Failure> {
    match (&args.tool, strain) {
        (None, _) => Ok(Tool::Plate),
        (Some(text), Strain::Large) => {
            Tool::parse(text).map_err(|bad| input(format!("--tool '{text}': {bad}")))
        }
        (Some(text), Strain::Small) => {
            Err(input(format!("--tool '{text}': small strain has no tool; give --strain large")))
        }
    }
}

/// Returns the coefficient of friction.
fn friction(args: &InitArgs, strain: Strain) -> Result<Option<f64>, Failure> {
    let Some(text) = &args.friction else { return Ok(None) };
    if strain == Strain::Small {
        let problem = "small strain has no tool; give --strain large";
        return Err(input(format!("--friction '{text}': {problem}")));
    }
    let value = text.parse().ok().filter(|value: &f64| *value > 0.0 && value.is_finite());
    let bad = || input(format!("--friction '{text}': a coefficient above zero, such as 0.3"));
    value.map(Some).ok_or_else(bad)
}

/// Returns comparisons for a fraction of the height at the end opposite to the plate.
fn held_end(organ: &Organ, side: Side, part: f64, described: &dyn Fn(f64) -> String) -> String {
    let (than, opposite) = if side.sign() > 0.0 { ("<=", 0) } else { (">=", 1) };
    let end = organ.bounds[opposite][side.axis()] + side.sign() * part * organ.extent(side.axis());
    format!("{} {than} {}", ["x", "y", "z"][side.axis()], described(end))
}

/// Refines sizes until every mesh reaches the plate and all its pieces reach the constrained part, which
/// starts at `part` of the height. Stores sizes and constrained part in `wanted`. Returns the meshes and the
/// comparisons of the constrained part.
fn fine_enough(
    wanted: &mut Wanted,
    organ: &Organ,
    part: f64,
    out: &Path,
) -> Result<(Meshes, String), Failure> {
    let (size, side, height) = (wanted.size, wanted.side, organ.extent(wanted.side.axis()));
    let unit = wanted.unit;
    let described = |metres: f64| scene_text::length(metres, unit, organ.largest_extent());
    let reaches = |name: &str, mesh: &Mesh| match meshes::short(mesh, organ.bounds, side) {
        short if short > SHORT * height => {
            let short = described(short);
            Err(input(format!("the mesh of {name} ends {short} from the contact point of the tool")))
        }
        _ => Ok(()),
    };
    let held_from = wanted.tool.held_from(side, organ);
    wanted.hold = Hold::Where(held_end(organ, held_from, part, &described));
    let mut why = String::new();
    for (parts, finer) in FINENESS {
        (wanted.parts, wanted.size) = (parts, size.times(finer));
        let meshes = match Meshes::new(&parsed(wanted, out)?, reaches) {
            Ok(meshes) => meshes,
            Err(bad) => {
                why = bad.to_string();
                continue;
            }
        };
        let more = (0..).map(|k| part + f64::from(k) * MORE);
        for held in more.take_while(|held| *held <= MOST.max(part)) {
            let comparisons = held_end(organ, held_from, held, &described);
            wanted.hold = Hold::Where(comparisons.clone());
            match meshes.unheld(&parsed(wanted, out)?.supports[0].place)? {
                None => return Ok((meshes, comparisons)),
                Some((name, pieces)) => {
                    why = format!(
                        "the mesh of {name} has {pieces} pieces, and some do not reach the constrained part"
                    )
                }
            }
        }
    }
    let problem = format!(
        "no mesh of up to {} is suitable: {why}; give a finer size, or another --press-from",
        size.described()
    );
    Err(input(problem))
}

/// Parses the text of the scene.
fn parsed(wanted: &Wanted, out: &Path) -> Result<Scene, Failure> {
    scene::parse(&scene_text::text(wanted), &out.display().to_string()).map_err(|errors| refused(&errors))
}

fn title(file: &Path, tool: &Tool, side: Side) -> String {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    format!("{name}, pressed by {} from the {}", tool.words(), word(side))
}

/// Returns the file's path for the scene: relative if the file is in the scene's folder or below.
fn path_from(out: &Path, file: &Path) -> Result<String, Failure> {
    let real = |path: &Path| path.canonicalize().map_err(|bad| input(format!("{}: {bad}", path.display())));
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (folder, file) = (real(folder)?, real(file)?);
    let path = file.strip_prefix(&folder).unwrap_or(&file);
    let text = path.to_str();
    text.map(String::from)
        .ok_or_else(|| input(format!("--file '{}': the name of the file is not valid text", file.display())))
}

/// Parses a positive quantity and returns its value in SI units.
fn quantity(dimension: Dimension, text: &str) -> Result<f64, String> {
    let value = dimension.read(text).map_err(|bad| bad.to_string())?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(format!("a {} above zero", dimension.name()))
    }
}

fn ratio(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (0.0..0.5).contains(value));
    value.ok_or_else(|| "a number from 0 to below 0.5, such as 0.45".into())
}

fn nodes(text: &str) -> Result<Size, String> {
    let [least, most] = NODES;
    let value = text.parse().ok().filter(|value: &u32| (least..=most).contains(&f64::from(*value)));
    value.map(|value| Size::Nodes(value.into())).ok_or_else(|| format!("a number from {least} to {most}"))
}

fn spacing(text: &str, organ: &Organ, described: &dyn Fn(f64) -> String) -> Result<Size, Failure> {
    let refuse = |bad: String| input(format!("--spacing '{text}': {bad}"));
    let value = length(text).map_err(refuse)?;
    // The coarsest mesh has edges 1.6 times as long, and needs two of them across.
    let most = organ.smallest_extent() / 4.0;
    if value > most {
        let most = described(most);
        return Err(refuse(format!(
            "is too large for the body; at most {most}, a quarter of its smallest extent"
        )));
    }
    Ok(Size::Spacing(value))
}

fn methods(text: &str) -> Result<Vec<Method>, String> {
    let mut found = Vec::new();
    for name in text.split(',') {
        let method = choice(name).map_err(|bad| format!("'{}' {bad}", name.trim()))?;
        if !found.contains(&method) {
            found.push(method);
        }
    }
    Ok(found)
}

/// Parses comparisons, or a named surface of the file.
fn held(text: &str, organ: &Organ) -> Result<Hold, String> {
    if text.contains(['<', '>', '=']) {
        return Ok(Hold::Where(text.into()));
    }
    if organ.names.iter().any(|name| name == text) {
        return Ok(Hold::On(text.into()));
    }
    let names = match organ.names.as_slice() {
        [] => "the file names no surface".into(),
        names => format!("the file names {}", names.join(", ")),
    };
    Err(format!("{names}; or write comparisons such as \"z < 3 mm\""))
}

/// Returns the displacement or the load of the plate.
fn driven(args: &InitArgs, ask: &mut Questions, strain: Strain, way: &str) -> Result<Drive, Failure> {
    if let Some(text) = &args.load {
        let dimension = match strain {
            Strain::Large => Dimension::Force,
            Strain::Small => Dimension::Pressure,
        };
        quantity(dimension, text).map_err(|bad| input(format!("--load '{text}': {bad}")))?;
        return Ok(Drive::Load(text.clone()));
    }
    let question = "Displacement of the tool into the body";
    let read = |text: &str| quantity(Dimension::Length, text).map(Drive::Closure);
    ask.value("closure", args.closure.as_deref(), question, way, read)
}

/// Refuses comparisons that select nothing, everything, or the point touched by the plate.
fn holds(region: &Region, organ: &Organ, wanted: &Wanted) -> Result<(), Failure> {
    let tolerance = Region::TOLERANCE * (organ.bounds[1] - organ.bounds[0]).norm();
    let inside = |p: &geometry::Point3| region.contains([p.x, p.y, p.z], tolerance);
    let count = organ.surface.points().iter().filter(|p| inside(p)).count();
    let refuse = |bad: &str| Err(input(format!("--hold '{}': {bad}", region.text)));
    if count == 0 {
        let [low, high] = organ.bounds.map(|p| [0, 1, 2].map(|axis| format!("{:.4}", p[axis])).join(", "));
        return refuse(&format!(
            "no corner of the surface lies there; the body is from ({low}) to ({high}) m"
        ));
    }
    if count == organ.surface.points().len() {
        return refuse("constrains the whole body; constrain a part of the body");
    }
    if wanted.tool != Tool::Jaws && inside(&organ.first_touched(wanted.side)) {
        let (tool, side) = (wanted.tool.words(), word(wanted.side));
        return refuse(&format!(
            "constrains the point that {tool} from the {side} touches first; constrain another part, or give \
             another side with --press-from"
        ));
    }
    Ok(())
}

/// Returns the errors of the scene, each at the option that caused it.
fn refused(errors: &[SceneError]) -> Failure {
    let options = [
        ("support[0]", "--hold"),
        ("material.young", "--young"),
        ("material.poisson", "--poisson"),
        ("body.path", "--file"),
        ("body.wrap", "--wrap"),
        ("tool", "--tool, --closure, --load or --gap"),
        ("load", "--load"),
    ];
    let lines = errors.iter().map(|error| {
        let option = options.iter().find(|(key, _)| error.key.starts_with(key));
        let option = option.map_or(error.key.as_str(), |(_, option)| option);
        let found = error.found.as_ref().map_or(String::new(), |found| format!(" '{found}'"));
        let help = error.help.as_ref().map_or(String::new(), |help| format!("; {help}"));
        format!("{option}{found}: {}{help}", error.problem)
    });
    input(lines.collect::<Vec<_>>().join("\n"))
}
