//! Records for tests.

use records::Record;

pub(crate) trait Blank {
    /// A record of a value of a run without a size.
    fn blank() -> Self;

    /// Sets the id of the run from the properties that distinguish runs in tests.
    fn of_its_run(self) -> Self;
}

impl Blank for Record {
    fn blank() -> Record {
        Record { poisson: 0.495, unit: "m".into(), statistic: "value".into(), ..Record::default() }
    }

    fn of_its_run(mut self) -> Record {
        let who = (
            &self.case,
            &self.method,
            &self.variant,
            self.settings(),
            self.poisson.to_bits(),
            self.level,
            self.nodes,
            self.seed,
        );
        self.run = format!("{who:?}");
        self
    }
}
