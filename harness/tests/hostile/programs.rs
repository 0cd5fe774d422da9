//! Third-party programs, and third-party texts that are printed to a terminal.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::world::World;

const EXTERNAL: &str = r#"title = "A block"
body = { shape = "box", size = ["4 mm", "4 mm", "4 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "z-min", fix = "xyz" }]
load = [{ on = "z-max", pressure = "1 kPa" }]
method = [{ id = "theirs", family = "external", adapter = "ADAPTER", element = "tet4", size = { cells = [2, 2, 2] }SETTINGS }]
"#;

fn scene(adapter: &str, settings: &str) -> String {
    EXTERNAL.replace("ADAPTER", adapter).replace("SETTINGS", settings)
}

fn manifest(name: &str, run: &str, more: &str) -> String {
    format!(
        "name = \"{name}\"\ntitle = \"T\"\nrun = {run}\ncan = [\"linear\"]\nelements = [\"tet4\"]\n{more}"
    )
}

/// Temporary folders of the program.
fn work(world: &World) -> Vec<std::path::PathBuf> {
    let entries = fs::read_dir(world.path("tmp")).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| path.to_string_lossy().contains("tissuebench-")).collect()
}

#[test]
fn folders_of_calls_are_private_and_gone_after_a_signal() {
    let world = World::new();
    world.write("adapters/sleeper/adapter.toml", &manifest("sleeper", "[\"sleep\", \"600\"]", ""));
    world.write("sleeps.toml", &scene("sleeper", ""));
    world.write(
        "sleep.toml",
        "title = \"S\"\n[[run]]\nscene = \"sleeps.toml\"\nmethods = [\"theirs\"]\nquick = true\n",
    );
    for args in ["run sleeps.toml", "fields sleeps.toml --out f", "verify sleep.toml --isolate --out s"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tissuebench"));
        command.args(args.split(' ')).current_dir(world.path("")).env("TMPDIR", world.path("tmp"));
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let began = Instant::now();
        let wait = |held: &mut dyn FnMut() -> bool| {
            while !held() {
                assert!(began.elapsed() < Duration::from_secs(20), "{args}");
                std::thread::sleep(Duration::from_millis(5));
            }
        };
        wait(&mut || !work(&world).is_empty());
        let mode = fs::metadata(&work(&world)[0]).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o700, "{args}");
        std::thread::sleep(Duration::from_millis(200));
        assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
        let mut code = None;
        wait(&mut || {
            code = child.try_wait().unwrap();
            code.is_some()
        });
        assert_eq!(code.unwrap().code(), Some(5), "{args}");
        assert!(work(&world).is_empty(), "{args} leaves {:?}", work(&world));
    }
}

#[test]
fn a_list_of_adapters_runs_nothing_and_their_folder_is_named() {
    let world = World::new();
    let touch = r#"["sh", "-c", "touch TOUCHED; echo 1"]"#
        .replace("TOUCHED", world.path("touched").to_str().unwrap());
    let needs = format!("version = {touch}\n[install]\npython = [\"numpy\"]\n");
    let run = touch.replace("]", ", \"{python}\"]");
    world.write("adapters/evil/adapter.toml", &manifest("evil", &run, &needs));
    world.write("csv.py", "open('touched', 'w')");
    let listed = world.runs(&["adapter", "list"], 0);
    assert!(
        listed.stdout.contains("evil: T") && listed.stdout.contains("adapters/evil"),
        "{}",
        listed.stdout
    );
    assert!(!world.path("touched").exists(), "a list has run a program");
    let listed = world.runs(&["adapter", "list", "--no-local-adapters"], 0);
    assert!(!listed.stdout.contains("evil"), "{}", listed.stdout);
    fs::remove_file(world.path("csv.py")).unwrap();
    world.write("evil.toml", &scene("evil", ""));
    let refused = world.runs(&["run", "evil.toml", "--no-local-adapters"], 2);
    assert!(refused.stderr.contains("no adapter 'evil'"), "{}", refused.stderr);
    world.write("adapters/evil/adapter.toml", &manifest("evil", &touch, ""));
    let run = world.tissuebench(&["run", "evil.toml"]);
    assert!(
        run.stderr.contains("using adapter 'evil' from /") && world.path("touched").exists(),
        "{}",
        run.stderr
    );
}

#[test]
fn answers_that_are_no_files_and_versions_without_end_cost_their_run_alone() {
    let world = World::new();
    let ok = r#"echo '{\"status\": \"ok\"}' > $0/result.json"#;
    for (what, script, says) in [
        ("result", "mkfifo $0/result.json".to_string(), "result.json: is a pipe"),
        ("endless", "ln -s /dev/zero $0/result.json".into(), "result.json: is a device"),
        ("array", format!("{ok}; mkfifo $0/displacement.npy"), "displacement.npy: can't be read: is a pipe"),
        (
            "large",
            format!("{ok}; truncate -s 64G $0/displacement.npy"),
            "displacement.npy: can't be read: has more than",
        ),
    ] {
        let run = format!("[\"sh\", \"-c\", \"{script}\", \"{{answer}}\"]");
        world.write(&format!("adapters/{what}/adapter.toml"), &manifest(what, &run, "version = [\"yes\"]\n"));
        world.write("scene.toml", &scene(what, ""));
        let done = world.tissuebench(&["run", "scene.toml"]);
        assert!(done.code == 3 && done.stderr.contains(says), "{what}: {} {}", done.code, done.stderr);
    }
}

#[test]
fn no_name_leads_out_of_its_folder() {
    let world = World::new();
    let sound = fs::read_to_string(world.path("block.toml")).unwrap();
    for id in [".", "..", "...", &"a".repeat(65), "a/b", ""] {
        world.write("named.toml", &sound.replace("id = \"tet4\"", &format!("id = {id:?}")));
        let done = world.runs(&["fields", "named.toml", "--out", "named"], 2);
        assert!(done.stderr.contains("is not a valid id"), "{id}: {}", done.stderr);
    }
    world.write("named.toml", &sound.replace("id = \"tet4\"", &format!("id = {:?}", "a".repeat(64))));
    world.runs(&["fields", "named.toml", "--out", "named"], 0);
}

#[test]
fn terminals_get_text_and_nothing_else() {
    let world = World::new();
    let evil = "\u{1b}[2Jx\u{202e}\u{7}\u{9b}\r";
    let escaped = r"\u001b[2Jx\u202e\u0007\u009b\r";
    let sound = fs::read_to_string(world.path("block.toml")).unwrap();
    world.write(
        "evil.toml",
        &sound.replace("A block", escaped).replace("law = \"linear\"", &format!("law = \"{escaped}\"")),
    );
    world.write("title.toml", &sound.replace("A block", escaped));
    world.write(
        "check.toml",
        &format!("{sound}[[check]]\nmetric = \"max\"\nat_most = 0\nreason = \"{escaped}\"\n"),
    );
    world.write(&format!("{evil}.toml"), &sound);
    fs::copy(world.path("body.msh"), world.path(&format!("{evil}.msh"))).unwrap();
    let study = fs::read_to_string(world.path("study.toml")).unwrap();
    world.write("evil-study.toml", &study.replace("block", escaped));
    world.write(&format!("adapters/{evil}/adapter.toml"), "name = 3");
    let script = "[\"sh\", \"-c\", \"printf '\\\\033[2J\\\\007' >&2; exit 1\"]";
    world.write("adapters/loud/adapter.toml", &manifest("loud", script, ""));
    world.write("loud.toml", &scene("loud", ""));
    let named = [format!("{evil}.toml"), format!("{evil}.msh"), format!("--{evil}")];
    let commands: [&[&str]; 13] = [
        &["run", "evil.toml"],
        &["run", "title.toml", "--format", "json", "--once"],
        &["run", "check.toml", "--once"],
        &["run", &named[0], "--once"],
        &["run", &named[0], "--once", "--format", "json"],
        &["plan", &named[0]],
        &["mesh", "info", &named[1]],
        &["mesh", "info", &named[1], "--format", "json"],
        &["verify", "evil-study.toml", "--out", "e", "--events", "-"],
        &["verify", "evil-study.toml", "--out", "e", "--list"],
        &["adapter", "list"],
        &["run", "loud.toml"],
        &["run", &named[2]],
    ];
    for args in commands {
        let done = world.tissuebench(args);
        for text in [&done.stdout, &done.stderr] {
            let bad = text.chars().find(|c| (c.is_control() && !"\n\t".contains(*c)) || *c == '\u{202e}');
            assert_eq!(bad, None, "{args:?}: {text:?}");
        }
        assert!(!done.stdout.is_empty() || !done.stderr.is_empty(), "{args:?}");
    }
}
