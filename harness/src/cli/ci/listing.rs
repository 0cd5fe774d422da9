//! Lists the runs of a study without running them.

use crate::study::Planned;

/// Returns one line per run: its case and its name.
pub(crate) fn names(planned: &[Planned]) -> String {
    planned.iter().map(|run| format!("{} {}\n", run.case, run.name)).collect()
}

/// Returns one line per run with its estimated cost, and the sum of the times.
pub(crate) fn forecast(planned: &[Planned]) -> String {
    let rows: Vec<[String; 4]> = planned.iter().map(row).collect();
    let head = ["about", "nodes", "seconds", "memory"].map(String::from);
    let width = |column: usize| rows.iter().chain([&head]).map(|row| row[column].chars().count()).max();
    let widths: [usize; 4] = std::array::from_fn(|column| width(column).unwrap_or(0));
    let line = |[run, nodes, seconds, memory]: &[String; 4]| {
        let [a, b, c, d] = widths;
        format!("{run:a$}  {nodes:>b$}  {seconds:>c$}  {memory:>d$}\n")
    };
    let body: String = rows.iter().map(line).collect();
    let sum: f64 = planned.iter().map(|run| run.takes.seconds).sum();
    format!("{}{body}{} runs, about {}\n", line(&head), planned.len(), seconds(sum))
}

fn row(run: &Planned) -> [String; 4] {
    let memory = format!("{:.0} MB", (run.takes.bytes / 1e6).max(1.0));
    let nodes = format!("{:.0}", run.takes.nodes);
    [format!("{} {}", run.case, run.name), nodes, seconds(run.takes.seconds), memory]
}

/// Formats a time with one digit: the estimate is accurate to within a factor of three.
fn seconds(seconds: f64) -> String {
    // Rounded through text: a product of 6 and 0.1 has more than one digit.
    let rounded: f64 = format!("{:.0e}", seconds.max(1e-3)).parse().unwrap_or(seconds);
    format!("{rounded} s")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_have_one_digit() {
        assert_eq!(
            [0.0, 0.0123, 0.61, 3.4, 678.0].map(seconds),
            ["0.001 s", "0.01 s", "0.6 s", "3 s", "700 s"]
        );
    }
}
