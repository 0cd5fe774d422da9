//! Where the numbers come from: source, compiler, processor, threads.

use std::process::Command;

use reports::{Provenance, SceneHash};

/// BLAKE3 of a scene's text, in hexadecimal digits.
pub fn hash(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// Reads what this process can know of its own making. `scenes` are (case name, file text).
pub fn provenance(scenes: &[(String, String)], seed: u64) -> Provenance {
    let mut hashes: Vec<SceneHash> =
        scenes.iter().map(|(case, text)| SceneHash { case: case.clone(), blake3: hash(text) }).collect();
    hashes.sort_by(|a, b| a.case.cmp(&b.case));
    hashes.dedup();
    Provenance {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: commit(),
        rustc: env!("TISSUEBENCH_RUSTC").into(),
        cpu: cpu(),
        threads: rayon::current_num_threads() as u32,
        seed,
        features: features(),
        profile: if cfg!(debug_assertions) { "dev".into() } else { "release".into() },
        scenes: hashes,
    }
}

/// The commit of the source tree this binary was built in, if that tree still exists and is a git checkout.
fn commit() -> String {
    let git = |args: &[&str]| {
        let out = Command::new("git").args(["-C", env!("CARGO_MANIFEST_DIR")]).args(args).output().ok()?;
        out.status.success().then(|| String::from_utf8_lossy(&out.stdout).trim().to_string())
    };
    match git(&["rev-parse", "HEAD"]) {
        Some(hash) => match git(&["status", "--porcelain", "--untracked-files=no"]) {
            Some(changes) if changes.is_empty() => hash,
            _ => format!("{hash}+"),
        },
        None => "unknown".into(),
    }
}

fn cpu() -> String {
    std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            text.lines().find_map(|line| {
                line.strip_prefix("model name")?.split_once(": ").map(|(_, name)| name.to_string())
            })
        })
        .unwrap_or_else(|| std::env::consts::ARCH.to_string())
}

/// Instruction sets that the linear algebra chooses between at run time: they change the last bits of a result.
fn features() -> String {
    #[cfg(target_arch = "x86_64")]
    {
        let found = [
            ("avx2", std::arch::is_x86_feature_detected!("avx2")),
            ("fma", std::arch::is_x86_feature_detected!("fma")),
            ("avx512f", std::arch::is_x86_feature_detected!("avx512f")),
        ];
        found.iter().filter(|(_, on)| *on).map(|(name, _)| *name).collect::<Vec<_>>().join(",")
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        std::env::consts::ARCH.to_string()
    }
}
