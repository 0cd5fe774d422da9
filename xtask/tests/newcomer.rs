//! The guide's first page with a time limit: from a fresh clone to a picture of an organ.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// Page that is followed.
const PAGE: &str = "docs/src/guide/own-organ.md";
/// Largest time on two cores, s, including the build.
const LIMIT: f64 = 600.0;
/// Files and folders that must exist at the end.
const MADE: [&str; 3] =
    ["kidney-results/report/report.html", "kidney-results/report/figures", "kidney-results/volumes"];

/// Clones the last commit, then runs every command of the page up to the first run, exactly as written there.
#[test]
#[ignore = "takes ten minutes, a whole build; cargo xtask nightly runs it"]
fn a_newcomer_has_a_picture_of_an_organ_in_ten_minutes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let folder = root.join("target/newcomer");
    if folder.exists() {
        std::fs::remove_dir_all(&folder).unwrap();
    }
    std::fs::create_dir_all(&folder).unwrap();
    let page = std::fs::read_to_string(root.join(PAGE)).unwrap();
    let commands = commands(&page);
    assert!(
        commands.len() >= 4 && commands.iter().any(|line| line.starts_with("cargo install")),
        "{commands:?}"
    );
    let (clone, installed) = (folder.join("tissuebench"), folder.join("installed"));
    let git = Command::new("git").args(["clone", "--quiet"]).arg(root).arg(&clone).status().unwrap();
    assert!(git.success());
    let path = std::env::var_os("PATH").unwrap_or_default();
    let with_installed = [installed.join("bin")].into_iter().chain(std::env::split_paths(&path));
    let with_installed = std::env::join_paths(with_installed).unwrap();
    let began = Instant::now();
    for command in commands {
        let start = Instant::now();
        let mut shell = Command::new("sh");
        shell.args(["-ec", command]).current_dir(&clone);
        shell
            .env("PATH", &with_installed)
            .env("CARGO_INSTALL_ROOT", &installed)
            .env_remove("CARGO_TARGET_DIR");
        assert!(shell.status().unwrap().success(), "{command}");
        println!("{:7.1} s  {command}", start.elapsed().as_secs_f64());
    }
    for made in MADE {
        assert!(clone.join(made).exists(), "{made} was not created");
    }
    let all = began.elapsed().as_secs_f64();
    assert!(all <= LIMIT, "{all:.1} s");
}

/// Returns the commands of a page's shell blocks up to the first run of a scene. A block below a comment is
/// left out, because it is not meant to be run as written.
fn commands(page: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let (mut inside, mut before) = (false, "");
    for line in page.lines() {
        match line {
            "```sh" => inside = !before.starts_with("<!--"),
            "```" => inside = false,
            command if inside => {
                found.push(command);
                if command.starts_with("tissuebench run") {
                    break;
                }
            }
            _ => {}
        }
        before = line;
    }
    found
}

#[test]
fn commands_end_with_the_first_run() {
    let page = "# A page\n```sh\ncargo install\n```\ntext\n<!-- exits 2 -->\n```sh\nwrong\n```\n\
                ```sh\ntissuebench init\ntissuebench run a\ntissuebench run b\n```\n";
    assert_eq!(commands(page), ["cargo install", "tissuebench init", "tissuebench run a"]);
}
