//! Outputs whose path is that of an input: by the same name, by a link, or by another name of the file.

use std::fs;

use crate::world::{World, fifo};

/// Input file, command with OUT in place of the output, and file extension that the output needs.
const OVERWRITES: [(&str, &str, &str); 12] = [
    ("organ.obj", "mesh make organ.obj --nodes 100 --out OUT", ".msh"),
    ("body.msh", "mesh convert body.msh OUT", ".msh"),
    ("deck.inp", "mesh convert whole.inp OUT", ".inp"),
    ("block.toml", "reference block.toml --points body.msh --unit m --out OUT", ""),
    ("body.msh", "reference block.toml --points body.msh --unit m --out OUT", ""),
    ("record.json", "reference block.toml --points body.msh --unit m --from record.json --out OUT", ""),
    ("study.toml", "verify study.toml --out out --junit OUT", ""),
    ("block.toml", "verify study.toml --out out --events OUT", ""),
    ("body.msh", "verify files.toml --out out --events OUT", ""),
    ("body.msh", "verify files.toml --out out --junit OUT", ""),
    ("HISTORY", "history show --figure OUT", ""),
    ("organ.obj", "init --file organ.obj --yes --force --out OUT", ""),
];

#[test]
fn no_output_replaces_an_input() {
    let world = World::new();
    let study = fs::read_to_string(world.path("study.toml")).unwrap();
    world.write("files.toml", &study.replace("block.toml", "file.toml"));
    let history = world.only("history", ".toml");
    for (input, command, ending) in OVERWRITES {
        let input = if input == "HISTORY" { &history } else { input };
        let before = fs::read(world.path(input)).unwrap();
        for link in ["itself", "symbolic link", "hard link"] {
            let out = match link {
                "itself" => input.to_string(),
                _ => format!("link{ending}"),
            };
            if !out.ends_with(ending) {
                continue;
            }
            match link {
                "symbolic link" => std::os::unix::fs::symlink(world.path(input), world.path(&out)).unwrap(),
                "hard link" => fs::hard_link(world.path(input), world.path(&out)).unwrap(),
                _ => {}
            }
            let args: Vec<&str> =
                command.split(' ').map(|word| if word == "OUT" { &out } else { word }).collect();
            let done = world.tissuebench(&args);
            assert!(
                fs::read(world.path(input)).unwrap() == before,
                "{input} is destroyed by {args:?}, {link}"
            );
            assert_eq!(done.code, 2, "{args:?}, {link}: {}", done.stderr);
            assert!(done.stderr.contains("is the input file"), "{args:?}, {link}: {}", done.stderr);
            let _ = fs::remove_file(world.path("link"))
                .or_else(|_| fs::remove_file(world.path(&format!("link{ending}"))));
        }
    }
}

/// An input lies in an output folder at the path of an output.
#[test]
fn no_folder_of_outputs_costs_an_input() {
    let world = World::new();
    let scene = fs::read_to_string(world.path("file.toml")).unwrap();
    for (input, args) in [
        ("series/tet4/body-0001.vtu", "fields SCENE --out series"),
        ("exported/mesh.vtu", "export SCENE --method tet4 --out exported"),
        ("ours/volumes/tet4/body-0001.vtu", "run SCENE --once --out ours"),
    ] {
        world.runs(&["mesh", "convert", "body.msh", "copy.vtu"], 0);
        fs::create_dir_all(world.path(input).parent().unwrap()).unwrap();
        fs::rename(world.path("copy.vtu"), world.path(input)).unwrap();
        world.write("inside.toml", &scene.replace("body.msh", input));
        let before = fs::read(world.path(input)).unwrap();
        let args = args.replace("SCENE", "inside.toml");
        let done = world.tissuebench(&args.split(' ').collect::<Vec<_>>());
        assert!(fs::read(world.path(input)).is_ok_and(|now| now == before), "{input} is destroyed by {args}");
        assert!(
            done.code != 0 && done.stderr.contains("is the input file"),
            "{args}: {} {}",
            done.code,
            done.stderr
        );
    }
    for args in ["merge kept kept", "adapter run tissuebench problem problem"] {
        let done = world.runs(&args.split(' ').collect::<Vec<_>>(), 2);
        assert!(done.stderr.contains("folder"), "{args}: {}", done.stderr);
    }
}

/// The program does not write through a link in a folder of results.
#[test]
fn links_in_a_folder_of_results_are_not_followed() {
    let world = World::new();
    world.write("precious", "mine");
    for name in
        [".lock", ".writing", "records.csv", "records.csv.partial", "incomplete.json", "report/report.html"]
    {
        let path = world.path(&format!("results/{name}"));
        let _ = fs::remove_file(&path);
        std::os::unix::fs::symlink(world.path("precious"), &path).unwrap();
        world.tissuebench(&["run", "block.toml", "--once", "--out", "results"]);
        assert_eq!(fs::read_to_string(world.path("precious")).unwrap(), "mine", "{name}");
        let _ = fs::remove_file(&path);
    }
}

#[test]
fn a_pipe_that_nobody_reads_takes_no_output() {
    let world = World::new();
    fifo(&world.path("pipe"));
    for args in [
        "verify study.toml --out out --events pipe",
        "verify study.toml --out out --junit pipe",
        "reference block.toml --points body.msh --unit m --out pipe",
        "history show --figure pipe",
        "init --file organ.obj --yes --force --out pipe",
        "run block.toml --out pipe",
        "baseline results --accepted pipe --accept",
    ] {
        let done = world.tissuebench(&args.split(' ').collect::<Vec<_>>());
        assert!(done.code != 0 && !done.stderr.is_empty(), "{args}: {}", done.code);
    }
}
