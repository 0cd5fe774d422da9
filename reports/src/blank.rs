//! Records that tests fill in.

use records::Record;

pub(crate) trait Blank {
    /// A value of a run of no size.
    fn blank() -> Self;

    /// Sets the id of its run from the settings that tell runs of tests apart.
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
