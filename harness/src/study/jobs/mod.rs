//! Studies whose runs are executed as jobs of another system (`--on`): the runs are bundled by cost, each
//! bundle is a job, and all jobs store their results in the folder of the study.

pub(crate) mod bundle;
pub(crate) mod drive;
mod pack;
pub(crate) mod queue;
pub(crate) mod status;
pub(crate) mod worker;
