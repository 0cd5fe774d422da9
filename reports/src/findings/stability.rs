//! Findings on the limits of methods along the axes of a study.

use records::text::{list, short};
use records::{Axis, AxisVerdict as Verdict, RunSet};

/// One sentence per axis: the methods that hold over the whole axis, the methods that fail, and the methods
/// that are wrong without a warning.
pub(super) fn stability(set: &RunSet) -> Vec<String> {
    set.axes.iter().filter(|axis| !axis.trials.is_empty()).map(sentence).collect()
}

fn sentence(axis: &Axis) -> String {
    let methods = axis.methods();
    let holds = |method: &&str| {
        let own = axis.trials.iter().filter(|t| t.method == **method);
        own.map(|t| axis.verdict(t)).all(|v| v == Verdict::Holds)
    };
    let steady: Vec<String> = methods.iter().filter(|m| holds(m)).map(|m| m.to_string()).collect();
    let broken: Vec<String> = methods.iter().filter_map(|m| breaks(axis, m)).collect();
    let mut text = format!("{}, {}: ", axis.case, axis.name);
    text += &match (steady.len(), methods.len()) {
        (all, of) if all == of => "every method holds at all values".to_string(),
        (0, _) => "no method holds at all values".to_string(),
        _ => format!("{} {} at all values", list(&steady), if steady.len() == 1 { "holds" } else { "hold" }),
    };
    if !broken.is_empty() {
        text += &format!("; wrong or refused: {}", broken.join(", "));
    }
    let silent: Vec<String> = methods.iter().filter(|m| axis.silent(m) > 0).map(|m| m.to_string()).collect();
    if !silent.is_empty() {
        text += &format!("; wrong without a warning: {}", list(&silent));
    }
    text + "."
}

/// `tet4 from 0.45 on` or `tet4 up to 0.1`, or both ranges.
fn breaks(axis: &Axis, method: &str) -> Option<String> {
    let at = |up: bool| axis.first(method, Verdict::Warned, up).map(short);
    match (at(false), at(true)) {
        (None, None) => None,
        (None, Some(up)) => Some(format!("{method} from {up} on")),
        (Some(down), None) => Some(format!("{method} up to {down}")),
        (Some(down), Some(up)) if down == up => Some(format!("{method} at {up}")),
        (Some(down), Some(up)) => Some(format!("{method} up to {down} and from {up} on")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use records::{Ended, Trial};

    #[test]
    fn a_sentence_says_what_holds_and_what_breaks() {
        let trial = |method: &str, value: f64, error: f64, warnings: &[&str]| Trial {
            method: method.into(),
            value,
            ended: Ended::Whole,
            error: Some(error),
            warnings: warnings.iter().map(|w| w.to_string()).collect(),
            reason: String::new(),
        };
        let axis = Axis {
            case: "bending".into(),
            name: "Poisson's ratio".into(),
            unit: String::new(),
            values: vec![0.3, 0.45],
            base: 0.3,
            judge: "l2".into(),
            wrong: 0.25,
            trials: vec![
                trial("tet4", 0.3, 0.2, &[]),
                trial("tet4", 0.45, 0.4, &["stress-jump"]),
                trial("hex8-mean", 0.3, 0.01, &[]),
                trial("hex8-mean", 0.45, 0.01, &[]),
                trial("worse", 0.3, 0.1, &[]),
                trial("worse", 0.45, 0.5, &[]),
            ],
        };
        assert_eq!(
            sentence(&axis),
            "bending, Poisson's ratio: hex8-mean holds at all values; wrong or refused: tet4 from 0.45 on, worse from 0.45 on; \
             wrong without a warning: worse."
        );
    }
}
