//! `tissuebench init`: a scene of an organ under a plate, from options, answers and defaults.

mod args;
mod organ;
mod questions;
mod scene_text;

use std::io::{BufReader, IsTerminal};
use std::path::{Path, PathBuf};

use cases::scene::{self, Place, Region, SceneError};
use catalogue::Dimension;

pub use args::InitArgs;

use super::args::{LengthUnit, length, length_unit};
use super::mesh_files::{input, row};
use super::mesh_info::guess;
use crate::Failure;
use args::{Method, Side, Strain, choice, word};
use organ::Organ;
use questions::Questions;
use scene_text::{Drive, Hold, Size, Wanted};

/// Part of the body that is held unless something else is said.
const HELD: f64 = 0.2;
/// Part of the height by which the plate presses unless something else is said.
const CLOSURE: f64 = 0.05;
/// Fewer nodes than this make no mesh of an organ at a quarter of them; more are a matter of hours.
const NODES: [f64; 2] = [100.0, 200_000.0];

/// Writes the scene and says which defaults it took.
pub fn init(args: &InitArgs) -> Result<(), Failure> {
    let terminal = !args.yes && std::io::stdin().is_terminal();
    let answers = terminal.then(|| Box::new(BufReader::new(std::io::stdin())) as _);
    let mut ask = Questions { answers, taken: Vec::new() };
    let file = args.file.as_deref().map(Path::to_string_lossy);
    let read = |text: &str| match Path::new(text) {
        path if path.is_file() => Ok(path.to_path_buf()),
        path if path.exists() => Err("is no file; give a surface (STL, OBJ, PLY) or a mesh file".into()),
        _ => Err("there is no such file; give a surface (STL, OBJ, PLY) or a mesh file".into()),
    };
    let file: PathBuf = ask.value("file", file.as_deref(), "Surface or mesh file of the organ", "", read)?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| Path::new(file.file_name().unwrap_or_default()).with_extension("toml"));
    free(&out, &file, args.force)?;
    let (organ, unit) = sized(&file, args, &mut ask)?;
    let wanted = wanted(args, &mut ask, &file, &out, &organ, unit)?;
    let text = scene_text::text(&wanted);
    let name = out.display().to_string();
    let found = scene::parse(&text, &name).map_err(|errors| refused(&errors))?;
    if let Some(Place::Where(region)) = found.supports.first().map(|support| &support.place) {
        holds(region, &organ, wanted.side)?;
    }
    disk::write(&out, &text).map_err(|bad| input(format!("{name}: can't be written: {bad}")))?;
    println!(
        "{name}: {} under a plate from the {}, {} runs",
        file.display(),
        word(wanted.side),
        found.methods.len()
    );
    let width = ask.taken.iter().map(|[option, value, _]| option.len() + value.len()).max().unwrap_or(0) + 3;
    for (at, [option, value, question]) in ask.taken.iter().enumerate() {
        let given = format!("{option} \"{value}\"");
        row(if at == 0 { "defaults" } else { "" }, &format!("{given:width$}  {question}"));
    }
    let results = out.with_extension("");
    row("next", &format!("tissuebench run {name} --out {}-results", results.display()));
    Ok(())
}

/// Refuses to write over a file: a scene unless that is forced, the organ always.
fn free(out: &Path, file: &Path, force: bool) -> Result<(), Failure> {
    disk::input(file);
    disk::spare(out).map_err(|bad| input(format!("--out '{}': {bad}", out.display())))?;
    if out.is_dir() {
        return Err(input(format!("--out '{}': is a folder; name a file in it", out.display())));
    }
    if out.exists() && !force {
        let name = out.display();
        return Err(input(format!("{name}: exists; --force replaces it, --out names another")));
    }
    Ok(())
}

/// The body in the unit given, or in the one in which it is as long as organs are.
fn sized(file: &Path, args: &InitArgs, ask: &mut Questions) -> Result<(Organ, LengthUnit), Failure> {
    let millimetre = LengthUnit { name: "mm", metres: 1e-3 };
    let read = |unit| Organ::read(file, unit);
    let organ = read(millimetre)?;
    let fits = guess(organ.largest_extent(), millimetre).unwrap_or(millimetre.name);
    let known = |text: &str| length_unit(text).map_err(|known| format!("is not {known}"));
    let unit: LengthUnit = ask.value("unit", args.unit.as_deref(), "Length unit of the file", fits, known)?;
    let same = unit.name == millimetre.name;
    Ok((if same { organ } else { read(unit)? }, unit))
}

fn wanted(
    args: &InitArgs,
    ask: &mut Questions,
    file: &Path,
    out: &Path,
    organ: &Organ,
    unit: LengthUnit,
) -> Result<Wanted, Failure> {
    let question = "How large strains become: small or large";
    let strain = ask.value("strain", args.strain.as_deref(), question, "large", choice::<Strain>)?;
    let (young, young_value) =
        ask.value("young", args.young.as_deref(), "Young's modulus", "20 kPa", |text| {
            quantity(Dimension::Pressure, text).map(|value| (text.to_string(), value))
        })?;
    let poisson = ask.value("poisson", args.poisson.as_deref(), "Poisson's ratio", "0.45", ratio)?;
    let question = "Side from which the plate presses: top, bottom, left, right, front or back";
    let side = ask.value("press-from", args.press_from.as_deref(), question, "top", choice::<Side>)?;
    let described = |metres: f64| scene_text::length(metres, unit, organ.largest_extent());
    let (than, opposite) = if side.sign() > 0.0 { ("<=", 0) } else { (">=", 1) };
    let end = organ.bounds[opposite][side.axis()] + side.sign() * HELD * organ.extent(side.axis());
    let default = format!("{} {than} {}", ["x", "y", "z"][side.axis()], described(end));
    let question = "What is held: comparisons of x, y and z, or a surface of the mesh file";
    let hold = ask.value("hold", args.hold.as_deref(), question, &default, |text| held(text, organ))?;
    let drive = driven(args, ask, strain, &described(CLOSURE * organ.extent(side.axis())))?;
    if let Drive::Closure(by) = drive
        && by >= organ.extent(side.axis())
    {
        let height = described(organ.extent(side.axis()));
        return Err(input(format!("--closure '{}': the body is only {height} high", described(by))));
    }
    let gap = match (&args.gap, strain) {
        (None, _) => 0.0,
        (Some(text), Strain::Large) => {
            quantity(Dimension::Length, text).map_err(|bad| input(format!("--gap '{text}': {bad}")))?
        }
        (Some(text), Strain::Small) => {
            return Err(input(format!(
                "--gap '{text}': there is no plate at small strain; --strain large has one"
            )));
        }
    };
    let question = "Methods, of tet4, tet4-nodal, tet10 and efg";
    let methods = ask.value("methods", args.methods.as_deref(), question, "tet4,tet10,efg", methods)?;
    let size = match &args.spacing {
        Some(text) => spacing(text, organ, &described)?,
        None => ask.value("nodes", args.nodes.as_deref(), "Nodes of the finest size", "1000", nodes)?,
    };
    Ok(Wanted {
        title: title(file, side),
        path: path_from(out, file)?,
        unit,
        strain,
        young,
        young_value,
        poisson,
        hold,
        side,
        bounds: organ.bounds,
        drive,
        gap,
        methods,
        size,
        probes: [organ.near(side), organ.middle()],
    })
}

fn title(file: &Path, side: Side) -> String {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    format!("{name}, pressed by a plate from the {}", word(side))
}

/// The file as a scene names it: relative where it lies in the scene's folder or below.
fn path_from(out: &Path, file: &Path) -> Result<String, Failure> {
    let real = |path: &Path| path.canonicalize().map_err(|bad| input(format!("{}: {bad}", path.display())));
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (folder, file) = (real(folder)?, real(file)?);
    let path = file.strip_prefix(&folder).unwrap_or(&file);
    let text = path.to_str();
    text.map(String::from).ok_or_else(|| input(format!("--file '{}': its name is no text", file.display())))
}

/// A quantity above zero in SI units.
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

/// Comparisons, or a surface that the file names.
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

/// The way or the load of the plate.
fn driven(args: &InitArgs, ask: &mut Questions, strain: Strain, way: &str) -> Result<Drive, Failure> {
    if let Some(text) = &args.load {
        let dimension = match strain {
            Strain::Large => Dimension::Force,
            Strain::Small => Dimension::Pressure,
        };
        quantity(dimension, text).map_err(|bad| input(format!("--load '{text}': {bad}")))?;
        return Ok(Drive::Load(text.clone()));
    }
    let question = "How far the plate presses into the body";
    let read = |text: &str| quantity(Dimension::Length, text).map(Drive::Closure);
    ask.value("closure", args.closure.as_deref(), question, way, read)
}

/// Refuses comparisons that hold nothing, everything, or what is pressed.
fn holds(region: &Region, organ: &Organ, side: Side) -> Result<(), Failure> {
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
        return refuse("holds the whole body; hold a part of it");
    }
    if inside(&organ.first_touched(side)) {
        let side = word(side);
        return refuse(&format!(
            "holds what the plate from the {side} touches first; hold another part, or --press-from another side"
        ));
    }
    Ok(())
}

/// What is wrong with the scene, by the option that says it.
fn refused(errors: &[SceneError]) -> Failure {
    let options = [
        ("support[0]", "--hold"),
        ("material.young", "--young"),
        ("material.poisson", "--poisson"),
        ("body.path", "--file"),
        ("tool", "--closure, --load or --gap"),
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
