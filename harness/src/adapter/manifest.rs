//! `adapter.toml`: the description of an adapter.

use std::path::Path;

use catalogue::suggest;
use geometry::CellKind;
use material::LAWS;
use serde::Deserialize;

/// Words that `can` accepts besides the names of material laws.
const WORDS: [&str; 3] = ["linear", "static", "tools"];
const READS: [&str; 2] = ["mesh.inp", "mesh.vtu"];
/// Longest name of an adapter, in characters; the name is also that of a folder.
const LONGEST_NAME: usize = 64;
/// Significant digits of a displacement written in full.
const ALL_DIGITS: u32 = 15;

/// An adapter as described in its file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    /// Name of the adapter in scenes, and of its folder.
    pub(crate) name: String,
    /// Name of the solver, in one line.
    pub(crate) title: String,
    /// The program with its arguments. `{problem}` and `{answer}` stand for folders, `{python}` for the
    /// adapter's own Python or `python3`, and `{tissuebench}` for this program. An argument that names a file
    /// of the adapter's folder stands for that file's path.
    pub(crate) run: Vec<String>,
    /// Command that prints the version of the solver.
    #[serde(default)]
    pub(crate) version: Vec<String>,
    /// Supported procedures and laws, by their names in scenes, and "tools".
    pub(crate) can: Vec<String>,
    /// Supported elements, by their names in scenes.
    pub(crate) elements: Vec<String>,
    /// Significant digits of the solver's answer; text files have few.
    #[serde(default = "all_digits")]
    pub(crate) digits: u32,
    /// Mechanism that passes the number of threads to the solver.
    #[serde(default)]
    pub(crate) threads: Threads,
    /// Mesh files (mesh.inp, mesh.vtu) to be written for the adapter in addition to the arrays.
    #[serde(default)]
    pub(crate) reads: Vec<String>,
    /// The adapter's requirements.
    #[serde(default)]
    pub(crate) install: Install,
}

/// Mechanism that passes the number of threads to a solver.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Threads {
    /// Environment variable that receives the number.
    pub(crate) env: Option<String>,
}

/// Requirements of an adapter.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Install {
    /// Python packages, installed in a virtual environment of the adapter.
    #[serde(default)]
    pub(crate) python: Vec<String>,
    /// Optional Python packages that make the solver faster; skipped on machines for which they do not exist.
    #[serde(default)]
    pub(crate) faster: Vec<String>,
    /// Programs that must be in the `PATH`.
    #[serde(default)]
    pub(crate) programs: Vec<String>,
    /// Instructions for users on how to install these programs.
    #[serde(default)]
    pub(crate) say: String,
}

fn all_digits() -> u32 {
    ALL_DIGITS
}

impl Manifest {
    /// Parses a manifest; `file` is the name used in messages.
    pub(crate) fn parse(text: &str, file: &Path) -> Result<Manifest, String> {
        let manifest: Manifest = toml::from_str(text)
            .map_err(|bad| format!("{}: {}", file.display(), bad.to_string().trim_end()))?;
        manifest.check().map_err(|bad| format!("{}: {bad}", file.display()))?;
        Ok(manifest)
    }

    fn check(&self) -> Result<(), String> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
        if self.name.is_empty() || self.name.len() > LONGEST_NAME || !self.name.chars().all(plain) {
            let help = format!("use up to {LONGEST_NAME} letters, digits, '-' and '_'");
            return Err(format!("name '{}' is not valid; {help}", self.name));
        }
        if self.run.is_empty() {
            return Err("run is empty; give a program with its arguments".into());
        }
        let laws: Vec<&str> = LAWS.iter().map(|law| law.name).collect();
        let can: Vec<&str> = WORDS.into_iter().chain(laws).collect();
        for (key, given, known) in [
            ("can", &self.can, &can[..]),
            ("elements", &self.elements, &CellKind::ALL.map(CellKind::name)),
            ("reads", &self.reads, &READS),
        ] {
            if let Some(word) = given.iter().find(|word| !known.contains(&word.as_str())) {
                return Err(format!("{key}: '{word}' is not known; {}", suggest(word, known)));
            }
        }
        match (1..=ALL_DIGITS).contains(&self.digits) {
            true => Ok(()),
            false => Err(format!("digits = {} is out of range; give 1 to {ALL_DIGITS}", self.digits)),
        }
    }

    /// Returns why the adapter cannot solve a problem with this element and these features (words of `can`,
    /// each with its description); `None` if it can.
    pub(crate) fn refusal(&self, element: &str, asked: &[(&str, String)]) -> Option<String> {
        if !self.elements.iter().any(|known| known == element) {
            return Some(format!("does not support element {element}, only {}", self.elements.join(", ")));
        }
        let missing = asked.iter().find(|(word, _)| !self.can.iter().any(|known| known == word));
        missing.map(|(_, what)| format!("does not support {what}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOUND: &str = "name = \"mine\"\ntitle = \"Mine\"\nrun = [\"mine\", \"{problem}\", \"{answer}\"]\n\
                         can = [\"linear\", \"static\"]\nelements = [\"tet4\"]\n";

    fn parse(text: &str) -> Result<Manifest, String> {
        Manifest::parse(text, Path::new("mine/adapter.toml"))
    }

    #[test]
    fn a_file_is_read_or_refused_with_what_is_wrong() {
        let sound = parse(SOUND).unwrap();
        assert_eq!((sound.digits, sound.threads.env, sound.reads.len()), (15, None, 0));
        for (from, to, says) in [
            ("\"static\"", "\"statics\"", "can: 'statics' is not known"),
            ("\"tet4\"", "\"tet5\"", "elements: 'tet5' is not known"),
            ("\"mine\"\ntitle", "\"my own\"\ntitle", "name 'my own' is not valid"),
            ("title = \"Mine\"\n", "", "missing field `title`"),
            ("title", "titel", "line 2"),
            ("run = [\"mine\", \"{problem}\", \"{answer}\"]", "run = []", "run is empty"),
            ("can", "digits = 0\ncan", "digits = 0"),
        ] {
            let bad = parse(&SOUND.replacen(from, to, 1)).unwrap_err();
            assert!(bad.contains(says) && bad.starts_with("mine/adapter.toml: "), "{says}: {bad}");
        }
    }

    #[test]
    fn what_it_does_not_take_is_named() {
        let sound = parse(SOUND).unwrap();
        let asked = [("linear", "the linear law".to_string()), ("tools", "rigid tools".to_string())];
        assert_eq!(sound.refusal("tet4", &asked[..1]), None);
        assert_eq!(sound.refusal("tet4", &asked).as_deref(), Some("does not support rigid tools"));
        assert_eq!(
            sound.refusal("hex8", &asked).as_deref(),
            Some("does not support element hex8, only tet4")
        );
    }
}
