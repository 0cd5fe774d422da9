//! A folder with one valid file of each kind, in which the program runs under limits of time and memory.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Time after which a command counts as hanging.
const LIMIT: Duration = Duration::from_secs(10);
/// Memory that the program may allocate besides [`product_buffers`], KiB: 1 GiB.
const MEMORY: usize = 1 << 20;

const SCENE: &str = r#"title = "A block"
BODY
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ where = "z <= 0.1 mm", fix = "xyz" }]
load = [{ body = ["0 N/m^3", "0 N/m^3", "-1000 N/m^3"] }]
"#;
const BOX: &str = r#"body = { shape = "box", size = ["4 mm", "4 mm", "4 mm"] }"#;
const TET4: &str = r#"id = "tet4", family = "fem", element = "tet4""#;
const ORGAN: &str = "v 0 0 0\nv 8 0 0\nv 0 8 0\nv 0 0 8\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// Exit code and output of a finished command.
pub struct Done {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

pub struct World {
    dir: TempDir,
}

impl World {
    pub fn new() -> World {
        let world = World { dir: tempfile::tempdir().unwrap() };
        let boxed = SCENE.replace("BODY", BOX);
        let method = |more: &str| format!("method = [{{ {TET4}, {more} }}]\n");
        let own = method("size = { cells = [2, 2, 2] }");
        world.write("block.toml", &format!("{boxed}{own}"));
        world.write(
            "study.toml",
            "title = \"S\"\n[[run]]\nscene = \"block.toml\"\nmethods = [\"tet4\"]\nquick = true\n",
        );
        world.write(
            "shared.toml",
            &format!("methods_from = \"methods.toml\"\n{boxed}[[method]]\nuse = \"tet4\"\n"),
        );
        world.write("methods.toml", &own);
        world.write("organ.obj", ORGAN);
        world.runs(&["export", "block.toml", "--method", "tet4", "--out", "problem"], 0);
        std::fs::copy(world.path("problem/mesh.inp"), world.path("deck.inp")).unwrap();
        world.runs(&["mesh", "convert", "deck.inp", "body.msh"], 0);
        let of_file = SCENE.replace("BODY", "body = { shape = \"file\", path = \"body.msh\", unit = \"m\" }");
        world.write("file.toml", &format!("{of_file}{}", method("size = { level = 1 }")));
        world.write("whole.inp", "*INCLUDE, INPUT=deck.inp\n");
        let cloud = r#"method = [{ id = "efg", family = "efg", cloud = { file = "CLOUD", unit = "m" }, size = { cells = [2, 2, 2] }, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "cell-smoothed" }, essential = "penalty" }]"#;
        for (scene, file) in [("points.toml", "points.csv"), ("array.toml", "problem/nodes.npy")] {
            world.write(scene, &format!("{boxed}{}\n", cloud.replace("CLOUD", file)));
        }
        world.write("points.csv", "x, y, z\n0, 0, 0\n0.004, 0, 0\n0, 0.004, 0\n0, 0, 0.004\n");
        world.runs(
            &["reference", "block.toml", "--points", "body.msh", "--unit", "m", "--out", "record.json"],
            0,
        );
        world.write("recorded.toml", &format!("{boxed}{own}reference = {{ record = \"record.json\" }}\n"));
        world.runs(&["run", "block.toml", "--once", "--out", "results"], 0);
        world.runs(&["verify", "study.toml", "-q", "--out", "kept"], 0);
        world.runs(&["baseline", "results", "--accepted", "baseline", "--accept"], 0);
        world.runs(&["history", "add", "results", "--to", "history"], 0);
        world.write("claims.toml", "");
        world
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    /// Path of the only file with this extension in a folder.
    pub fn only(&self, folder: &str, ending: &str) -> String {
        let names = std::fs::read_dir(self.path(folder)).unwrap().map(|e| e.unwrap().file_name());
        let found = names.map(|name| name.into_string().unwrap()).find(|name| name.ends_with(ending));
        format!("{folder}/{}", found.unwrap_or_else(|| panic!("no {ending} in {folder}")))
    }

    pub fn runs(&self, args: &[&str], code: i32) -> Done {
        let done = self.tissuebench(args);
        assert_eq!(done.code, code, "{args:?}: {}", done.stderr);
        done
    }

    /// Runs the program in the folder. It must end by itself within the limits.
    pub fn tissuebench(&self, args: &[&str]) -> Done {
        let mut command = Command::new("sh");
        command.args([
            "-c",
            &format!("ulimit -d {}; exec \"$0\" \"$@\"", MEMORY + product_buffers()),
            env!("CARGO_BIN_EXE_tissuebench"),
        ]);
        command.args(args).current_dir(self.dir.path()).stdin(Stdio::null());
        command.env("TMPDIR", self.path("tmp")).env("TISSUEBENCH_DATA", self.path("data"));
        std::fs::create_dir_all(self.path("tmp")).unwrap();
        let out = |name: &str| std::fs::File::create(self.path(name)).unwrap();
        let mut child = command.stdout(out(".stdout")).stderr(out(".stderr")).spawn().unwrap();
        let began = Instant::now();
        let status = loop {
            match child.try_wait().unwrap() {
                Some(status) => break status,
                None if began.elapsed() > LIMIT => {
                    child.kill().unwrap();
                    panic!("{args:?} hangs");
                }
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        };
        let text =
            |name: &str| String::from_utf8_lossy(&std::fs::read(self.path(name)).unwrap()).into_owned();
        let done =
            Done { code: status.code().unwrap_or(-1), stdout: text(".stdout"), stderr: text(".stderr") };
        assert!(done.code >= 0, "{args:?}: {status}: {}", done.stderr);
        assert!(!done.stderr.contains("panicked"), "{args:?}: {}", done.stderr);
        done
    }
}

/// Returns the address space that dense products reserve, KiB: twice the largest cache on every thread, which
/// is 1.2 GB on two cores with 300 MB of cache.
fn product_buffers() -> usize {
    let size = |index: usize| {
        let path = format!("/sys/devices/system/cpu/cpu0/cache/index{index}/size");
        std::fs::read_to_string(path).ok()?.trim().strip_suffix('K')?.parse().ok()
    };
    let largest: usize = (0..4).filter_map(size).max().unwrap_or(0);
    2 * largest * std::thread::available_parallelism().map_or(1, usize::from)
}

pub fn fifo(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}
