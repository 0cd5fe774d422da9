//! The runs that a study would make.

use crate::study::Planned;

/// One line for each run: its case and its name.
pub(in crate::cli) fn names(planned: &[Planned]) -> String {
    planned.iter().map(|run| format!("{} {}\n", run.case, run.name)).collect()
}

/// The same with nodes and with the seconds that a pass took before, and the sum of them.
pub(in crate::cli) fn forecast(planned: &[Planned]) -> String {
    let rows: Vec<[String; 3]> = planned.iter().map(row).collect();
    let head = ["run", "nodes", "seconds before"].map(String::from);
    let width = |column: usize| rows.iter().chain([&head]).map(|row| row[column].chars().count()).max();
    let widths: [usize; 3] = std::array::from_fn(|column| width(column).unwrap_or(0));
    let line = |[run, nodes, seconds]: &[String; 3]| {
        let [a, b, c] = widths;
        format!("{run:a$}  {nodes:>b$}  {seconds:>c$}\n")
    };
    let known: Vec<f64> = planned.iter().filter_map(|run| run.seconds).collect();
    let sum = match known.len() {
        0 => "no earlier results say how long they take".into(),
        count => format!("one pass over {count} of them took {:.1} s", known.iter().sum::<f64>()),
    };
    let body: String = rows.iter().map(line).collect();
    format!("{}{body}{} runs; {sum}\n", line(&head), planned.len())
}

fn row(run: &Planned) -> [String; 3] {
    let or_none = |text: Option<String>| text.unwrap_or_else(|| "-".into());
    let nodes = or_none(run.nodes.map(|nodes| format!("{nodes:.0}")));
    [format!("{} {}", run.case, run.name), nodes, or_none(run.seconds.map(|s| format!("{s:.4}")))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_is_summed() {
        let run =
            |name: &str, nodes, seconds| Planned { case: "block".into(), name: name.into(), nodes, seconds };
        let planned = [run("tet4", Some(405.0), Some(0.25)), run("efg level 2", None, None)];
        assert_eq!(names(&planned), "block tet4\nblock efg level 2\n");
        let expected = "run                nodes  seconds before\nblock tet4           405          0.2500\n\
                        block efg level 2      -               -\n2 runs; one pass over 1 of them took 0.2 s\n";
        assert_eq!(forecast(&planned), expected);
        assert!(forecast(&planned[1..]).ends_with("1 runs; no earlier results say how long they take\n"));
    }
}
