//! Small programs in place of those of job systems. They keep the rules on which executors depend: Slurm
//! signals the shell of a job's script and no other process, and forgets nothing that ended.

#![allow(dead_code)] // each test file uses its share

use std::ffi::OsString;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// Environment variable with the number of jobs at once.
pub const ROOM: &str = "FAKE_ROOM";

/// Search path with a folder in front.
pub fn path(programs: &Path) -> OsString {
    let others = std::env::var_os("PATH").unwrap();
    let folders = std::iter::once(programs.to_path_buf()).chain(std::env::split_paths(&others));
    std::env::join_paths(folders).unwrap()
}

/// Writes the programs of Slurm and returns their folder.
pub fn slurm(dir: &TempDir) -> PathBuf {
    programs(
        dir,
        &[
            ("sbatch", include_str!("sbatch.py")),
            ("squeue", include_str!("squeue.py")),
            ("scancel", include_str!("scancel.py")),
            ("fake-slurm-job", include_str!("slurm_job.py")),
            ("places.py", include_str!("places.py")),
        ],
    )
}

/// Writes the program of HyperQueue and returns its folder.
pub fn hyperqueue(dir: &TempDir) -> PathBuf {
    programs(dir, &[("hq", include_str!("hq.py")), ("places.py", include_str!("places.py"))])
}

/// Writes the program of Snakemake and returns its folder.
pub fn snakemake(dir: &TempDir) -> PathBuf {
    programs(dir, &[("snakemake", include_str!("snakemake.py"))])
}

fn programs(dir: &TempDir, programs: &[(&str, &str)]) -> PathBuf {
    let folder = dir.path().join("bin");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in programs {
        let file = folder.join(name);
        std::fs::write(&file, text).unwrap();
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    folder
}
