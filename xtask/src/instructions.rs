//! Instruction counts of kernels by valgrind, which reveal a slower kernel without a clock, even on a busy
//! machine.
//!
//! A kernel runs once and three times; half of the difference is one run, exact except for hashing and the
//! allocator.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};

/// Ratio of found to accepted instructions above which a kernel counts as slower.
const MORE: f64 = 1.02;

/// The accepted counts of every machine.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Accepted {
    machine: Vec<Machine>,
}

/// Counts with the compiler and the processor, on which they depend.
#[derive(Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
struct Machine {
    rustc: String,
    /// Processor, whose caches determine the blocks of matrix products.
    processor: String,
    /// Vector instruction set.
    path: String,
    kernels: BTreeMap<String, u64>,
}

/// Counts the instructions of each kernel and compares them with tests/baseline/instructions.toml, or accepts
/// them. Returns 0 if no kernel is slower, otherwise 1.
pub(crate) fn instructions(root: &Path, accept: bool) -> Result<u8> {
    if Command::new("valgrind").arg("--version").output().is_err() {
        let why = "valgrind is not installed, so no instructions are counted";
        return crate::skips::skipped(root, "valgrind", why);
    }
    eprintln!("xtask: building the kernels; a minute after tissuebench is built");
    let build =
        ["build", "--release", "--locked", "--package", "tissuebench-integration", "--example", "kernels"];
    let code = crate::cargo::cargo(&build, &[])?;
    if code != 0 {
        return Ok(code);
    }
    let program = root.join("target/release/examples/kernels");
    let mut lines =
        valgrind(&program, &["--tool=none"], &[])?.0.lines().map(String::from).collect::<Vec<_>>();
    ensure!(lines.len() > 1, "{} printed no names of kernels", program.display());
    let names = lines.split_off(1);
    let version = Command::new("rustc").arg("--version").output().context("could not start rustc")?;
    let found = Machine {
        rustc: String::from_utf8_lossy(&version.stdout).trim().into(),
        processor: processor(),
        path: lines.remove(0),
        kernels: names
            .into_iter()
            .map(|name| Ok((name.clone(), (count(&program, &name, 3)? - count(&program, &name, 1)?) / 2)))
            .collect::<Result<_>>()?,
    };
    let file = root.join("tests/baseline/instructions.toml");
    let text =
        std::fs::read_to_string(&file).with_context(|| format!("could not read {}", file.display()))?;
    let mut all: Accepted = toml::from_str(&text).with_context(|| format!("in {}", file.display()))?;
    let known = all.machine.iter().position(|machine| machine.is_like(&found));
    if accept {
        println!("accepted {} kernels in {}", found.kernels.len(), file.display());
        match known {
            Some(k) => all.machine[k] = found,
            None => all.machine.push(found),
        }
        let head = "# Instructions of one run of each kernel: cargo xtask instructions --accept\n";
        std::fs::write(&file, format!("{head}{}", toml::to_string(&all)?))?;
        return Ok(0);
    }
    let Some(accepted) = known.map(|k| &all.machine[k]) else {
        let Machine { rustc, processor, path, .. } = &found;
        println!("not compared: no counts are accepted with {rustc} on {processor}, {path}");
        return Ok(0);
    };
    let (lines, slower) = compare(&accepted.kernels, &found.kernels);
    print!("{lines}");
    Ok(u8::from(slower > 0))
}

impl Machine {
    fn is_like(&self, other: &Machine) -> bool {
        let key = |machine: &Machine| {
            let Machine { rustc, processor, path, .. } = machine;
            [rustc, processor, path].map(String::clone)
        };
        key(self) == key(other)
    }
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        text.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(": "));
    model.map_or("unknown", |(_, name)| name).into()
}

/// Returns a line for each kernel, and the number of kernels that are slower or missing on one side.
fn compare(accepted: &BTreeMap<String, u64>, found: &BTreeMap<String, u64>) -> (String, usize) {
    let (mut lines, mut failed) = (String::new(), 0);
    for (name, count) in found {
        let Some(before) = accepted.get(name) else {
            failed += 1;
            lines += &format!("NEW     {name}: {count} instructions; accept it with --accept\n");
            continue;
        };
        let ratio = *count as f64 / *before as f64;
        let word = match ratio {
            _ if ratio > MORE => "SLOWER",
            _ if ratio < 1.0 / MORE => "faster",
            _ => "same",
        };
        failed += usize::from(word == "SLOWER");
        lines += &format!("{word:7} {name}: {count} instructions, {:+.2} %\n", 100.0 * (ratio - 1.0));
    }
    for name in accepted.keys().filter(|name| !found.contains_key(*name)) {
        failed += 1;
        lines += &format!("LOST    {name}\n");
    }
    (lines, failed)
}

fn count(program: &Path, name: &str, times: usize) -> Result<u64> {
    let tool = ["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"];
    let said = valgrind(program, &tool, &[name, &times.to_string()])?.1;
    let refs =
        said.lines().find_map(|line| line.split_once("I   refs:").or_else(|| line.split_once("I refs:")));
    let Some((_, number)) = refs else { bail!("valgrind gave no count for {name}:\n{said}") };
    number.trim().replace(',', "").parse().with_context(|| format!("valgrind counted '{number}'"))
}

/// Returns the output of the program under valgrind, on one thread, and the output of valgrind.
fn valgrind(program: &Path, tool: &[&str], args: &[&str]) -> Result<(String, String)> {
    let mut command = Command::new("valgrind");
    command.args(tool).arg(program).args(args).env("RAYON_NUM_THREADS", "1");
    let output = command.output().context("could not start valgrind")?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    ensure!(output.status.success(), "{} {args:?} fails under valgrind:\n{said}", program.display());
    Ok((String::from_utf8_lossy(&output.stdout).into_owned(), said))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slower_kernel_a_new_one_and_a_lost_one_fail() {
        let of = |pairs: &[(&str, u64)]| pairs.iter().map(|(n, c)| (n.to_string(), *c)).collect();
        let accepted = of(&[("a", 1000), ("b", 1000), ("c", 1000)]);
        assert_eq!(compare(&accepted, &of(&[("a", 1020), ("b", 990), ("c", 500)])).1, 0);
        let (lines, failed) = compare(&accepted, &of(&[("a", 1021), ("b", 1000), ("d", 1)]));
        assert_eq!(failed, 3, "{lines}");
        assert!(lines.contains("SLOWER  a: 1021 instructions, +2.10 %"), "{lines}");
        assert!(lines.contains("NEW     d") && lines.contains("LOST    c"), "{lines}");
    }
}
