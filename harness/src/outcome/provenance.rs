//! Provenance of the results: the program, fixed when it was built, and the state of the machine when a run
//! begins.

use records::{FORMAT, Machine, Program, Provenance, SceneHash};

/// BLAKE3 hash of a scene's text, in hexadecimal digits.
pub fn hash(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// Description of the program as it was built.
pub fn program() -> Program {
    Program {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: env!("TISSUEBENCH_COMMIT").into(),
        dirty: env!("TISSUEBENCH_DIRTY") == "true",
        rustc: env!("TISSUEBENCH_RUSTC").into(),
        target: env!("TISSUEBENCH_TARGET").into(),
        features: env!("TISSUEBENCH_FEATURES").into(),
        profile: if cfg!(debug_assertions) { "dev".into() } else { "release".into() },
    }
}

/// Largest load per processor of a quiet machine.
const QUIET: f64 = 0.2;

/// Description of the machine at this moment. Before the first run, its load comes from other programs.
pub fn machine() -> Machine {
    let load = load();
    let processors = std::thread::available_parallelism().map_or(1, |n| n.get()) as f64;
    Machine {
        cpu: cpu(),
        model: model(),
        clock: clock(),
        instructions: instructions(),
        threads: rayon::current_num_threads() as u32,
        load,
        quiet: load.map(|load| load <= QUIET * processors),
        at_once: 1,
    }
}

/// Provenance of a study or a single run; the caller adds the name of its file. `scenes` are pairs of case
/// name and [`Scene::text`](cases::scene::Scene::text).
pub fn provenance(machine: Machine, scenes: &[(String, String)]) -> Provenance {
    let of = |(case, text): &(String, String)| SceneHash {
        case: case.clone(),
        blake3: hash(text),
        title: title(text),
    };
    let mut hashes: Vec<SceneHash> = scenes.iter().map(of).collect();
    hashes.sort_by(|a, b| a.case.cmp(&b.case));
    hashes.dedup();
    Provenance { format: FORMAT, program: program(), machine, scenes: hashes, ..Provenance::default() }
}

/// Title of a scene; empty if it has none.
fn title(text: &str) -> String {
    let table: Option<toml::Table> = toml::from_str(text).ok();
    table.and_then(|t| Some(t.get("title")?.as_str()?.to_string())).unwrap_or_default()
}

/// Average number of processes that ran or waited to run in the last minute; `None` if the system does not
/// report it.
fn load() -> Option<f64> {
    std::fs::read_to_string("/proc/loadavg").ok()?.split_whitespace().next()?.parse().ok()
}

fn cpu() -> String {
    cpuinfo("model name").unwrap_or_else(|| std::env::consts::ARCH.to_string())
}

/// Family, model and stepping of the processor, as far as they are known.
fn model() -> String {
    let known = [("family", "cpu family"), ("model", "model"), ("stepping", "stepping")];
    let each = known.iter().filter_map(|(word, field)| Some(format!("{word} {}", cpuinfo(field)?)));
    each.collect::<Vec<_>>().join(", ")
}

/// Current clock frequency of the first processor, GHz.
fn clock() -> Option<f64> {
    Some(cpuinfo("cpu MHz")?.parse::<f64>().ok()? / 1e3)
}

/// Kind of the processor, as far as it determines the last bits of a result: the instruction sets, and the
/// cache sizes, by which matrix products are blocked. Virtual machines hide the model's name, so the family
/// and model number are included.
pub fn processor() -> String {
    let of = |field| cpuinfo(field).unwrap_or_else(|| "unknown".into());
    let cache = |index| {
        std::fs::read_to_string(format!("/sys/devices/system/cpu/cpu0/cache/index{index}/size"))
            .map_or("unknown".into(), |size| size.trim().to_string())
    };
    let caches = [0, 2, 3].map(cache).join("/");
    format!(
        "{}, family {}, model {}, caches {caches}, {}",
        cpu(),
        of("cpu family"),
        of("model"),
        instructions()
    )
}

fn cpuinfo(field: &str) -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    text.lines().find_map(|line| {
        let (name, value) = line.split_once(':')?;
        (name.trim() == field).then(|| value.trim().to_string())
    })
}

/// Instruction sets among which the linear algebra chooses at run time. They change the last bits of a
/// result.
fn instructions() -> String {
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
