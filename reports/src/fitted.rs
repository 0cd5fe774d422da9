//! A fit in lines of text.

use records::text::significant;
use records::{Fit, FitConstant};

use crate::quantity;

/// The fit in lines of text.
pub fn fitted_text(fit: &Fit) -> String {
    let Fit { case, method, data, points, rms, r2, chi2, runs, iterations, .. } = fit;
    let label = quantity::label_of_name(&fit.of);
    let scale = catalogue::metric::find(&fit.of).map_or(1.0, quantity::scale);
    let chi2 = chi2.map_or(String::new(), |chi2| format!(", chi2 = {}", significant(chi2, 3)));
    let mut text = format!(
        "{case} {method}, {label} of {} points of {data}: RMS residual {}, R2 = {r2:.6}{chi2}; {iterations} iterations, {runs} runs\n",
        points.len(),
        significant(rms * scale, 3),
    );
    for FitConstant { key, unit, start, value, interval, on_bound, .. } in &fit.constants {
        let number = |value: f64| significant(value, 5);
        let confidence = match interval {
            Some([low, high]) => format!("[{}, {}]", number(*low), number(*high)),
            None if *on_bound => "on its bound".into(),
            None => "not determined".into(),
        };
        let line =
            format!("  {key:24} {} {unit} {confidence}, from {} {unit}", number(*value), number(*start));
        text += line.replace("  [", " [").trim_end();
        text.push('\n');
    }
    for (i, row) in fit.correlation.iter().enumerate() {
        for (j, correlation) in row.iter().enumerate().skip(i + 1) {
            let (one, other) = (&fit.constants[i].key, &fit.constants[j].key);
            text += &format!("  correlation of {one} and {other}: {correlation:.4}\n");
        }
    }
    for warning in &fit.warnings {
        text += &format!("  warning: {warning}\n");
    }
    text
}
