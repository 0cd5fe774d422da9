//! Uncertainty of results from the samples of uncertain inputs: statistics, shares of the inputs, bands.

use catalogue::metric;
use records::text::significant;
use records::{Input, Output, RunSet, Sample, Samples};
use uncertainty::{Distribution, Source, Statistics, quantiles, statistics};

use crate::history::between;

/// Ratio of the numerical error to the spread by the inputs up to which a mesh is fine enough.
pub const FINE_ENOUGH: f64 = 0.1;
/// Ratio below which a coarser mesh would do: half of the error is a fifth of what is allowed.
const COARSER_WOULD_DO: f64 = 0.02;

/// Whether so few samples miss a result that a polynomial in the inputs stands for them: up to a twentieth.
fn few_missing(missing: usize, samples: usize) -> bool {
    20 * missing <= samples
}

/// Uncertainty of one metric of one method.
pub struct Uncertain<'a> {
    /// The samples.
    pub of: &'a Samples,
    /// The metric.
    pub output: &'a Output,
    /// Number of samples with a result.
    pub results: usize,
    /// Number of samples without one.
    pub missing: usize,
    /// Statistics; `None` for fewer than two results.
    pub statistics: Option<Statistics>,
    /// 5 %, 50 % and 95 % quantiles along the history: `(x, quantiles)`.
    pub(crate) band: Vec<(f64, [f64; 3])>,
}

/// Uncertainty of every metric of the set's samples.
pub fn uncertain(set: &RunSet) -> Vec<Uncertain<'_>> {
    set.samples.iter().flat_map(|of| (0..of.outputs.len()).map(move |at| Uncertain::new(of, at))).collect()
}

/// Distribution in words, with the unit.
pub(crate) fn words(input: &Input) -> String {
    let of = |value: &f64| format!("{value} {}", input.unit).trim_end().to_string();
    let cut = |within: &Option<[f64; 2]>| {
        within.map_or(String::new(), |[low, high]| format!(", from {} to {}", of(&low), of(&high)))
    };
    match &input.distribution {
        Distribution::Uniform { low, high } => format!("uniform from {} to {}", of(low), of(high)),
        Distribution::Normal { mean, sd, within } => {
            format!("normal, {} +- {}{}", of(mean), of(sd), cut(within))
        }
        Distribution::Lognormal { mean, sd, within } => {
            format!("lognormal, {} +- {}{}", of(mean), of(sd), cut(within))
        }
        Distribution::List { values } => {
            format!("one of {}", values.iter().map(of).collect::<Vec<_>>().join(", "))
        }
    }
}

impl<'a> Uncertain<'a> {
    fn new(of: &'a Samples, at: usize) -> Uncertain<'a> {
        let whole = |s: &&Sample| s.failure.is_empty();
        let found =
            || of.samples.iter().filter(whole).filter_map(|s| Some((s, (*s.results.results.get(at)?)?)));
        let values: Vec<Vec<f64>> = found().map(|(sample, _)| sample.values.clone()).collect();
        let results: Vec<f64> = found().map(|(_, result)| result).collect();
        let missing = of.samples.len() - results.len();
        // A polynomial would be extrapolated to the values at which many runs failed.
        let inputs: Vec<Distribution> = match few_missing(missing, of.samples.len()) {
            true => of.inputs.iter().map(|input| input.distribution.clone()).collect(),
            false => Vec::new(),
        };
        let curves: Vec<&[(f64, f64)]> =
            found().map(|(sample, _)| sample.results.curves.get(at).map_or(&[][..], Vec::as_slice)).collect();
        Uncertain {
            of,
            output: &of.outputs[at],
            results: results.len(),
            missing,
            statistics: statistics(&inputs, &values, &results),
            band: band(&inputs, &values, &curves),
        }
    }

    /// Unit of the metric.
    pub(crate) fn unit(&self) -> &'static str {
        metric::find(&self.output.name).map_or("", |of| of.metric.unit())
    }

    /// Name of the metric with its unit.
    pub(crate) fn label(&self) -> String {
        metric::find(&self.output.name)
            .map_or_else(|| self.output.name.clone(), |of| format!("{} [{}]", of.label(), self.unit()))
    }

    /// Ratio of the numerical error to the standard deviation by the inputs.
    pub fn numerical_share(&self) -> Option<f64> {
        let sd = self.statistics.as_ref()?.sd.value;
        self.output.numerical.filter(|_| sd > 0.0).map(|numerical| numerical / sd)
    }

    /// Uncertainty by numerical error and inputs together, `sqrt(u_num^2 + u_input^2)`.
    pub(crate) fn combined(&self) -> Option<f64> {
        Some(self.output.numerical?.hypot(self.statistics.as_ref()?.sd.value))
    }

    /// The advice on the size of the runs.
    pub(crate) fn advice(&self) -> &'static str {
        match self.numerical_share() {
            None => "unknown: give [output] estimate = true",
            Some(share) if share > FINE_ENOUGH => "finer: above a tenth of the inputs",
            Some(share) if share > COARSER_WOULD_DO => "as is: up to a tenth of the inputs",
            Some(_) => "as is; coarser might do",
        }
    }

    /// Origin of the statistics in words.
    pub(crate) fn source(&self) -> String {
        match self.statistics.as_ref().map(|of| of.source) {
            Some(Source::Chaos(degree)) => format!("chaos of degree {degree}"),
            Some(Source::Samples) => "samples".into(),
            None => "none".into(),
        }
    }

    /// The uncertainty in lines of text.
    pub fn text(&self) -> String {
        let Samples { case, method, inputs, .. } = self.of;
        let made = self.results + self.missing;
        let mut text = format!("{case} {method}, {}: {} of {made} samples", self.label(), self.results);
        let Some(of) = &self.statistics else { return text + "; too few for statistics\n" };
        let q2 = of.q2.map_or(String::new(), |q2| format!(", Q2 = {q2:.5}"));
        text += &format!(", by {}{q2}\n", self.source());
        let near = |e: &uncertainty::Estimate| {
            let [value, low, high] = [e.value, e.low, e.high].map(|v| significant(v, 4));
            format!("{value} [{low}, {high}]")
        };
        for (name, e) in ["mean", "standard deviation", "5 %", "median", "95 %"]
            .iter()
            .zip([&of.mean, &of.sd].into_iter().chain(&of.quantiles))
        {
            text += &format!("  {name:20} {}\n", near(e));
        }
        if let (Some(numerical), Some(share)) = (self.output.numerical, self.numerical_share()) {
            let (numerical, share) = (significant(numerical, 3), significant(100.0 * share, 2));
            text += &format!(
                "  {:20} {numerical}, {share} % of the standard deviation; mesh: {}\n",
                "numerical error",
                self.advice()
            );
        }
        for (input, index) in inputs.iter().zip(&of.indices) {
            let per_cent = |e: &uncertainty::Estimate| {
                let [value, low, high] = [e.value, e.low, e.high].map(|v| format!("{:.1}", 100.0 * v));
                format!("{value} % [{low}, {high}]")
            };
            text += &format!(
                "  {:24} alone {}, with interactions {}\n",
                input.key,
                per_cent(&index.first),
                per_cent(&index.total)
            );
        }
        if of.indices.is_empty() {
            let why = match few_missing(self.missing, made) {
                true => "no polynomial of degree 3 fits; more samples may help",
                false => "more than a twentieth of the samples have no result",
            };
            text += &format!("  no shares of the inputs: {why}\n");
        }
        text
    }
}

/// Quantiles along curves, at the places of the first curve if all have the same, and else at as many places
/// up to the end of the shortest.
fn band(inputs: &[Distribution], values: &[Vec<f64>], curves: &[&[(f64, f64)]]) -> Vec<(f64, [f64; 3])> {
    let Some(first) = curves.first().filter(|first| first.len() > 1) else { return Vec::new() };
    let end = |curve: &[(f64, f64)]| curve.last().map_or(0.0, |p| p.0);
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
    let same = |curve: &&[(f64, f64)]| {
        curve.len() == first.len() && curve.iter().zip(*first).all(|(a, b)| near(a.0, b.0))
    };
    let places: Vec<f64> = match curves.iter().all(same) {
        true => first.iter().map(|p| p.0).collect(),
        false => {
            let shortest = curves.iter().map(|curve| end(curve)).fold(f64::INFINITY, f64::min);
            let last = first.len() - 1;
            (0..=last).map(|k| shortest * k as f64 / last as f64).collect()
        }
    };
    let at = |&x: &f64| {
        let results: Option<Vec<f64>> = curves.iter().map(|curve| between(curve, x)).collect();
        Some((x, quantiles(inputs, values, &results?)?))
    };
    places.iter().filter_map(at).collect()
}
