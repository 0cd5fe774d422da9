//! Results other than errors: support forces, numbers of faces, points and volumes, and frequencies.

use catalogue::metric::{self, Address};
use records::Purpose;

use crate::history::curve;
use crate::select::{Run, Series, by_material, labels, series};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Column, Table};

/// The finest run of every method, with the label of its series, for each case that is not only a test of
/// exactness.
fn finest<'a>(runs: &[Run<'a>]) -> Vec<(Run<'a>, String)> {
    let mut out = Vec::new();
    for case in by_material(runs).filter(|case| case[0].is.purpose != Purpose::Patch) {
        let all: Vec<Series> = series(case);
        let names = labels(all.iter().map(|s| s.is()));
        out.extend(all.iter().map(|s| s.finest().clone()).zip(names));
    }
    out
}

/// Adds a row with `numbers` for every place of every run; places are numbered in the order of the scene.
fn of_places<const N: usize>(mut table: Table, runs: &[Run], numbers: [Address; N], scale: f64) -> Table {
    for (run, label) in finest(runs) {
        let at = |place: usize| numbers.map(|number| run.value(number.at(place)));
        let recorded = |found: &[Option<f64>; N]| found.iter().any(Option::is_some);
        for (place, found) in (1..).zip((0..).map(at).take_while(recorded)) {
            let mut row = vec![
                Cell::Text(&run.is.case),
                Cell::Text(&label),
                Cell::Count(run.is.nodes),
                Cell::Count(place),
            ];
            row.extend(found.map(|value| Cell::Digits(value.map(|v| v * scale), 4)));
            table.row(&row);
        }
    }
    table
}

/// Table of the force of every support.
pub(super) fn supports(runs: &[Run]) -> Table {
    let header = [
        ("case", Words),
        ("method", Words),
        ("nodes", Number),
        ("support", Number),
        ("x [N]", Number),
        ("y [N]", Number),
        ("z [N]", Number),
    ];
    let caption = "Force of each support on the body at the end, along the constrained axes, for the finest run of \
                   each method; supports are numbered as in the scene";
    of_places(
        Table::new("support-forces", "Forces of supports", caption, &header),
        runs,
        metric::REACTION.components(),
        1.0,
    )
}

/// Table of the force of every foundation.
pub(super) fn foundations(runs: &[Run]) -> Table {
    let header = [
        ("case", Words),
        ("method", Words),
        ("nodes", Number),
        ("foundation", Number),
        ("x [N]", Number),
        ("y [N]", Number),
        ("z [N]", Number),
    ];
    let caption = "Force of the springs and dampers of each foundation on the body at the end, for the finest run of \
                   each method; foundations are numbered as in the scene";
    let table = Table::new("foundation-forces", "Forces of springs and dampers", caption, &header);
    of_places(table, runs, metric::FOUNDATION_FORCE.components(), 1.0)
}

/// Table of the mean displacement of every requested face.
pub(super) fn means(runs: &[Run]) -> Table {
    let header = [
        ("case", Words),
        ("method", Words),
        ("nodes", Number),
        ("face", Number),
        ("x [mm]", Number),
        ("y [mm]", Number),
        ("z [mm]", Number),
    ];
    let caption = "Area-weighted mean displacement of the faces in output.means at the end, for the finest run of \
                   each method; faces are numbered as in the scene";
    of_places(
        Table::new("face-means", "Mean displacement of faces", caption, &header),
        runs,
        metric::MEAN.components(),
        1e3,
    )
}

/// Table of the displacement of every probe.
pub(super) fn probes(runs: &[Run]) -> Table {
    let header = [
        ("case", Words),
        ("method", Words),
        ("nodes", Number),
        ("point", Number),
        ("x [mm]", Number),
        ("y [mm]", Number),
        ("z [mm]", Number),
    ];
    let caption = "Displacement of the points in output.probes at the end, for the finest run of each method; points are \
                   numbered as in the scene";
    let table = Table::new("probes", "Displacement of points", caption, &header);
    of_places(table, runs, metric::PROBE.components(), 1e3)
}

/// Table of the moment of every support.
pub(super) fn support_moments(runs: &[Run]) -> Table {
    let caption = "Moment of the supports on the body about the point in output.moments_about at the end, for the finest \
                   run of each method; supports are numbered as in the scene";
    let table = Table::new("support-moments", "Moments of supports", caption, &moment_header("support"));
    of_places(table, runs, metric::REACTION_MOMENT.components(), 1e3)
}

/// Table of the moment on every tool.
pub(super) fn tool_moments(runs: &[Run]) -> Table {
    let caption = "Moment of the tissue on the tools about the point in output.moments_about at the end, for the finest \
                   run of each method; tools are numbered as in the scene";
    let table = Table::new("tool-moments", "Moments on tools", caption, &moment_header("tool"));
    of_places(table, runs, metric::TOOL_MOMENT.components(), 1e3)
}

fn moment_header(place: &'static str) -> [(&'static str, Column); 7] {
    [
        ("case", Words),
        ("method", Words),
        ("nodes", Number),
        (place, Number),
        ("x [N mm]", Number),
        ("y [N mm]", Number),
        ("z [N mm]", Number),
    ]
}

/// Table of the largest displacement of every probe in dynamics.
pub(super) fn peaks(runs: &[Run]) -> Table {
    let header = [
        ("case", Words),
        ("method", Words),
        ("nodes", Number),
        ("point", Number),
        ("largest [mm]", Number),
        ("at [ms]", Number),
    ];
    let caption = "Largest displacement of the points in output.probes in all recorded states, and the time of the \
                   first such state, for the finest run of each method; points are numbered as in the scene";
    let table = Table::new("peaks", "Largest displacement of points", caption, &header);
    of_places(table, runs, [metric::PROBE_PEAK.whole(), metric::PROBE_PEAK_TIME.whole()], 1e3)
}

/// Table of the stress of every probe.
pub(super) fn probe_stresses(runs: &[Run]) -> Table {
    let header = [
        ("case", Words),
        ("method", Words),
        ("nodes", Number),
        ("point", Number),
        ("xx [kPa]", Number),
        ("yy [kPa]", Number),
        ("zz [kPa]", Number),
        ("xy [kPa]", Number),
        ("yz [kPa]", Number),
        ("zx [kPa]", Number),
    ];
    let caption = "Recovered Cauchy stress of the points in output.probes at the end, for the finest run of each method; \
                   points are numbered as in the scene";
    let table = Table::new("probe-stresses", "Stress of points", caption, &header);
    of_places(table, runs, metric::PROBE_STRESS.tensor(), 1e-3)
}

/// Table of every requested stretch.
pub(super) fn stretches(runs: &[Run]) -> Table {
    let header =
        [("case", Words), ("method", Words), ("nodes", Number), ("point", Number), ("stretch [1]", Number)];
    let caption = "Ratio of deformed to undeformed length at the points and along the directions in output.stretches at \
                   the end, for the finest run of each method";
    let table = Table::new("stretches", "Stretches", caption, &header);
    of_places(table, runs, [metric::STRETCH.whole()], 1.0)
}

/// Table of every requested volume.
pub(super) fn volumes(runs: &[Run]) -> Table {
    let header =
        [("case", Words), ("method", Words), ("nodes", Number), ("surface", Number), ("volume [mL]", Number)];
    let caption = "Volume enclosed by the surfaces in output.volumes at the end, for the finest run of each method; \
                   surfaces are numbered as in the scene";
    let table = Table::new("enclosed-volumes", "Enclosed volumes", caption, &header);
    of_places(table, runs, [metric::ENCLOSED_VOLUME.whole()], 1e6)
}

/// Table of every requested strain energy.
pub(super) fn energies(runs: &[Run]) -> Table {
    let header =
        [("case", Words), ("method", Words), ("nodes", Number), ("region", Number), ("energy [mJ]", Number)];
    let caption = "Strain energy of the regions in output.energies at the end, for the finest run of each method; regions \
                   are numbered as in the scene's list";
    let table = Table::new("region-energies", "Strain energies of regions", caption, &header);
    of_places(table, runs, [metric::REGION_ENERGY.whole()], 1e3)
}

/// Table of the frequency of every mode.
pub(super) fn frequencies(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "frequencies",
        "Frequencies",
        "Frequencies of the lowest modes of vibration, for the finest run of each method, and their ratio to the \
         exact frequencies if known",
        &[
            ("case", Words),
            ("method", Words),
            ("nodes", Number),
            ("mode", Number),
            ("frequency [Hz]", Number),
            ("/ exact [1]", Number),
        ],
    );
    for (run, label) in finest(runs) {
        let ratios = curve(&run, &metric::MODE, &metric::OMEGA_RATIO);
        for (mode, frequency) in curve(&run, &metric::MODE, &metric::FREQUENCY) {
            let ratio = ratios.iter().find(|(other, _)| *other == mode).map(|(_, ratio)| *ratio);
            table.row(&[
                Cell::Text(&run.is.case),
                Cell::Text(&label),
                Cell::Count(run.is.nodes),
                Cell::Count(mode as u64),
                Cell::Digits(Some(frequency), 4),
                Cell::Digits(ratio, 4),
            ]);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::record;
    use crate::select::runs;
    use records::Family;

    #[test]
    fn places_are_numbered_and_the_finest_run_stands_for_its_method() {
        let of = |nodes: u64, quantity: &str, value: f64| {
            record(("block", "tet4", Family::Fem), nodes, (quantity, ""), value)
        };
        let records = [
            of(100, "reaction-z", 1.0),
            of(800, "reaction-z", 1.5),
            of(800, "reaction-x-2", -0.25),
            of(800, "mean-x", 1e-3),
            of(800, "mean-y", 0.0),
            of(800, "mean-z", -2e-3),
            of(800, "probe-x", 1e-3),
            of(800, "probe-stress-zx", 250.0),
            of(800, "stretch", 1.25),
            of(800, "enclosed-volume", 2e-6),
        ];
        let rows = |table: Table| -> Vec<String> { table.shown().iter().map(|row| row.join(" ")).collect() };
        assert_eq!(
            rows(supports(&runs(&records))),
            ["block tet4 800 1 — — 1.500", "block tet4 800 2 -0.2500 — —"]
        );
        assert_eq!(rows(means(&runs(&records))), ["block tet4 800 1 1.000 0 -2.000"]);
        assert_eq!(rows(probes(&runs(&records))), ["block tet4 800 1 1.000 — —"]);
        assert_eq!(rows(probe_stresses(&runs(&records))), ["block tet4 800 1 — — — — — 0.2500"]);
        assert_eq!(rows(stretches(&runs(&records))), ["block tet4 800 1 1.250"]);
        assert_eq!(rows(volumes(&runs(&records))), ["block tet4 800 1 2.000"]);
        let modes: Vec<_> = [("mode", 1.0), ("frequency", 12.5), ("omega-ratio", 1.01)]
            .into_iter()
            .map(|(quantity, value)| records::Record { mode: Some(1), ..of(100, quantity, value) })
            .collect();
        assert_eq!(rows(frequencies(&runs(&modes))), ["block tet4 100 1 12.50 1.010"]);
        assert!(supports(&runs(&modes)).is_empty());
    }
}
