//! Neighbours, conditioning and fallbacks of the meshfree methods.

use catalogue::metric;

use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, whole};

/// Table of the moment matrices' neighbours, conditioning and fallbacks.
pub(super) fn conditioning(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "conditioning",
        "Neighbours and conditioning",
        "Neighbours per integration point, condition number of the moment matrix (shifted and scaled basis), and \
         numbers of points that needed a fallback: a larger support, a regularised moment matrix, or a lower order",
        &[
            ("case", Words),
            ("method", Words),
            ("kernel", Words),
            ("basis", Words),
            ("support scale [1]", Words),
            ("integration", Words),
            ("nodes", Number),
            ("neighbours min", Number),
            ("neighbours mean", Number),
            ("neighbours max", Number),
            ("condition median [1]", Number),
            ("condition max [1]", Number),
            ("points enlarged", Number),
            ("points regularised", Number),
            ("points reduced", Number),
        ],
    );
    for run in runs {
        if run
            .value(&metric::NEIGHBOURS_MEAN)
            .or(run.value(&metric::CONDITION_MAX))
            .or(run.value(&metric::CONDITION_MEDIAN))
            .is_none()
        {
            continue;
        }
        let words = |value: &'_ Option<String>| value.clone().unwrap_or_else(|| "—".into());
        let scale = run.is.support_scale.map_or("—".into(), |scale| scale.to_string());
        let (basis, integration) = (words(&run.is.basis), words(&run.is.integration));
        // Poisson's ratio has no influence here, so all ratios share one row.
        table.row_once(&[
            Cell::Text(&run.is.case),
            Cell::Text(run.name()),
            Cell::Text(&run.is.variant),
            Cell::Text(&basis),
            Cell::Text(&scale),
            Cell::Text(&integration),
            Cell::Count(run.is.nodes),
            whole(run.value(&metric::NEIGHBOURS_MIN)),
            Cell::Digits(run.value(&metric::NEIGHBOURS_MEAN), 4),
            whole(run.value(&metric::NEIGHBOURS_MAX)),
            Cell::Digits(run.value(&metric::CONDITION_MEDIAN), 3),
            Cell::Digits(run.value(&metric::CONDITION_MAX), 3),
            whole(run.value(&metric::FALLBACKS_ENLARGED)),
            whole(run.value(&metric::FALLBACKS_REGULARISED)),
            whole(run.value(&metric::FALLBACKS_REDUCED)),
        ]);
    }
    table
}
