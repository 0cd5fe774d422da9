//! Samples of the uncertain inputs of a scene: each is the scene with other values of its varied keys.

use catalogue::Problem;
use catalogue::metric::Needs;

use super::altered::altered;
use super::demands;
use super::document::unnumbered;
use super::error::{ErrorKind, SceneError};
use super::reference::Reference;
use super::report::Report;
use super::scene::Scene;
use super::vary::Vary;

/// Name of the samples where runs are named by the setting in which they differ.
const SAMPLE: &str = "sample";
/// Requests for output that a sample does not need, with the metrics that need them.
const LEFT_OUT: [(&str, &[Needs]); 7] = [
    (
        "output.estimate",
        &[
            Needs::Estimate,
            Needs::ToolEstimate,
            Needs::PointEstimate,
            Needs::SupportEstimate,
            Needs::ModeEstimate,
        ],
    ),
    ("output.error_of", &[Needs::Trace]),
    ("output.transfer", &[Needs::Transfer]),
    ("output.beside", &[Needs::Transfer]),
    ("output.pictures", &[]),
    ("output.repeated", &[]),
    ("loop", &[]),
];

impl Scene {
    /// The scene with the values of its uncertain keys in the sample `index`, which counts from 0, and with
    /// the named methods (all if `methods` is empty). Requests for output that no metric of the samples needs
    /// are left out, and so is a reference that has to be solved.
    ///
    /// # Errors
    ///
    /// The scene has no uncertain inputs, or not with these values. The error names the sample and the key.
    pub fn at_sample(&self, methods: &[String], index: u32) -> Result<Scene, Vec<SceneError>> {
        let Some(vary) = &self.vary else {
            let help = "give the scene [vary] samples = 60, of = [\"tool-force\"] and [vary.keys]";
            return Err(vec![self.error(ErrorKind::Invalid, "vary", "is missing", Some(help))]);
        };
        let values = vary.values(index);
        let written: Vec<String> = vary.keys.iter().zip(&values).map(|(key, v)| key.written(*v)).collect();
        let set = vary.keys.iter().zip(&written).map(|(key, text)| (key.key.as_str(), Some(text.as_str())));
        let left_out = left_out(self, |needs| vary.needs_any(needs), vary.needs_reference());
        let driver = format!("{} at sample {}", self.file(), index + 1);
        let settings: Vec<_> = left_out.into_iter().chain(set).collect();
        let mut sample = altered(self, methods, &settings, &driver)
            .map_err(|errors| vec![self.refused_sample(vary, index, &values, &errors)])?;
        sample.varied = Some((SAMPLE.into(), f64::from(index + 1)));
        sample.sample = Some(index);
        sample.vary = Some(vary.clone());
        Ok(sample)
    }

    /// Error of a sample whose values the scene refuses, at the varied key that is at fault.
    fn refused_sample(&self, vary: &Vary, index: u32, values: &[f64], errors: &[SceneError]) -> SceneError {
        let at_fault = |error: &SceneError| {
            vary.keys.iter().position(|key| unnumbered(&error.key) == unnumbered(&key.key))
        };
        let key = errors.iter().find_map(at_fault);
        let named = |at: usize| format!("{} = {}", vary.keys[at].key, vary.keys[at].shown(values[at]));
        let all = || (0..values.len()).map(named).collect::<Vec<_>>().join(", ");
        let what = key.map_or_else(all, named);
        let first = errors.first();
        let mut why = first.map_or(String::new(), |error| format!("{} {}", error.key, error.problem));
        if let Some(help) = first.and_then(|error| error.help.as_ref()) {
            why += &format!(" ({help})");
        }
        let place = key.map_or("vary.keys".into(), |at| format!("vary.keys.{}", vary.keys[at].key));
        let problem = format!("gives sample {} of {} the value {what}: {why}", index + 1, vary.samples);
        let help = "leave such values out: within = [low, high] cuts a normal or lognormal distribution off";
        self.error(ErrorKind::Invalid, &place, &problem, Some(help))
    }
}

/// Requests for output that runs with other values do not need, as keys without a value.
pub(super) fn left_out(
    scene: &Scene,
    needed: impl Fn(&[Needs]) -> bool,
    compared: bool,
) -> Vec<(&'static str, Option<&'static str>)> {
    let solved = matches!(scene.reference, Some(Reference::Method { .. } | Reference::Record(_)));
    let reference = (solved && !compared).then_some("reference");
    let left_out = LEFT_OUT.into_iter().filter(|(key, needs)| scene.has(key) && !needed(needs));
    left_out.map(|(key, _)| key).chain(reference).map(|key| (key, None)).collect()
}

/// Checks that the scene has the varied keys and metrics, and takes the median of each key.
///
/// # Errors
///
/// All keys that the scene does not have or refuses, and all metrics that its runs do not give.
pub(crate) fn driven(scene: &Scene) -> Result<(), Vec<SceneError>> {
    let Some(vary) = &scene.vary else { return Ok(()) };
    let report = Report::new(&scene.origin);
    let at = report.at("vary");
    for (i, address) in vary.of.iter().enumerate() {
        demands::varied(*address, scene, &at.at(&format!("of[{i}]")));
    }
    for varied in &vary.keys {
        let key = format!("keys.{}", varied.key);
        if !scene.has_any(&varied.key) {
            let help = "write the key in the scene, with the value that the run of the scene itself takes";
            at.add(&key, Problem::new("is no key of this scene").help(help));
            continue;
        }
        let median = varied.distribution.quantile(0.5);
        let text = varied.written(median);
        let driver = format!("{} at the median of {}", scene.file(), varied.key);
        if let Err(errors) = altered(scene, &[], &[(varied.key.as_str(), Some(text.as_str()))], &driver) {
            let why =
                errors.first().map_or(String::new(), |error| format!("{} {}", error.key, error.problem));
            let problem = format!("has the median {}, which the scene refuses: {why}", varied.shown(median));
            let help = errors.first().and_then(|error| error.help.clone()).unwrap_or_default();
            at.add(&key, Problem::new(problem).help(help));
        }
    }
    let errors = report.finish();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}
