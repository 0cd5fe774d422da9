//! Expected times of a study's runs: the stored time if there is one, otherwise an estimate scaled by the
//! stored times.

use std::collections::BTreeMap;
use std::path::Path;

use super::args::VerifyArgs;
use super::plan::StudyPlan;
use super::store::{Cost, Machines, Store};
use super::tasks::Task;
use crate::scenario::{estimate, of_reference};

/// Expected times of the tasks of a plan, all repeats included.
pub(super) struct Foreseen {
    /// Times by task, s.
    seconds: Vec<f64>,
    /// Whether each task's time is a stored measurement.
    known: Vec<bool>,
    /// Measured peak memory of each task, bytes.
    bytes: Vec<Option<f64>>,
    /// Number of measured runs and median ratio of measured to estimated time, by scene; and the median over
    /// all scenes.
    of_scene: BTreeMap<usize, (usize, f64)>,
    of_all: f64,
}

impl StudyPlan {
    /// Expected times of the tasks, from the times stored in the folder `--times`.
    pub(super) fn foreseen(&self, args: &VerifyArgs) -> Foreseen {
        self.foreseen_from(args, args.times.as_deref(), Machines::This)
    }

    /// Expected times of the tasks, from the times that these machines stored in a folder.
    pub(super) fn foreseen_from(&self, args: &VerifyArgs, folder: Option<&Path>, from: Machines) -> Foreseen {
        let estimated: Vec<f64> = self.tasks.iter().map(|task| self.estimated(task, args)).collect();
        let stored =
            folder.map(|folder| Store::of(&VerifyArgs { out: folder.into(), ..VerifyArgs::of(folder) }));
        let cost = |index: usize| stored.as_ref()?.cost(&self.key(index, args), from);
        let costs: Vec<Option<Cost>> = (0..self.tasks.len()).map(cost).collect();
        let known: Vec<Option<f64>> = costs.iter().map(|cost| Some(cost.as_ref()?.seconds)).collect();
        let ratios = || {
            let pairs = known.iter().zip(&estimated).zip(&self.tasks);
            pairs.filter_map(|((known, estimated), task)| Some((task.scene, (*known)? / estimated)))
        };
        let mut by_scene: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        ratios().for_each(|(scene, ratio)| by_scene.entry(scene).or_default().push(ratio));
        let of_scene =
            by_scene.into_iter().map(|(scene, ratios)| (scene, (ratios.len(), median(ratios)))).collect();
        let of_all = median(ratios().map(|(_, ratio)| ratio).collect());
        let bytes = costs.iter().map(|cost| cost.as_ref()?.bytes).collect();
        let mut foreseen = Foreseen { seconds: Vec::new(), known: Vec::new(), bytes, of_scene, of_all };
        let tasks = self.tasks.iter().zip(known.iter().zip(estimated));
        foreseen.seconds = tasks
            .map(|(task, (known, estimated))| {
                known.unwrap_or_else(|| estimated * foreseen.factor(task.scene))
            })
            .collect();
        foreseen.known = known.iter().map(Option::is_some).collect();
        foreseen
    }

    /// Estimated time of a task with its repeats, s.
    fn estimated(&self, task: &Task, args: &VerifyArgs) -> f64 {
        let repeats = self.repeats(task, args);
        let once = estimate(&self.scenes[task.scene].2, &task.method.family).seconds;
        // Short runs are repeated for their times.
        once * (1.0 + repeats.seconds / once).min(repeats.most as f64)
    }

    /// Expected time to solve the reference of a scene and to estimate its own error, s; 0 if the reference
    /// is not solved.
    pub(super) fn reference_seconds(&self, scene: usize, foreseen: &Foreseen) -> f64 {
        let once = of_reference(&self.scenes[scene].2).map_or(0.0, |reference| reference.seconds);
        WITH_WITNESS * once * foreseen.factor(scene)
    }
}

/// Cost ratio of a reference with its coarser mesh to the reference alone.
const WITH_WITNESS: f64 = 1.125;

impl Foreseen {
    /// Expected time of a task, s.
    pub(super) fn of(&self, task: usize) -> f64 {
        self.seconds[task]
    }

    /// Measured peak memory of a task, bytes.
    pub(super) fn bytes(&self, task: usize) -> Option<f64> {
        self.bytes[task]
    }

    /// Whether a task's time is a stored measurement.
    pub(super) fn is_stored(&self, task: usize) -> bool {
        self.known[task]
    }

    /// Ratio of measured to estimated time of a scene. The ratio of all scenes counts like one more run of
    /// this scene, so that a single run does not decide.
    pub(super) fn factor(&self, scene: usize) -> f64 {
        let (count, of_scene) = self.of_scene.get(&scene).copied().unwrap_or((0, 1.0));
        let runs = count as f64;
        ((runs * of_scene.ln() + self.of_all.ln()) / (runs + 1.0)).exp()
    }
}

/// Median; 1 for an empty list.
fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    match numbers.len() {
        0 => 1.0,
        n if n % 2 == 1 => numbers[n / 2],
        n => 0.5 * (numbers[n / 2 - 1] + numbers[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::median;

    #[test]
    fn the_median_of_nothing_leaves_estimates_as_they_are() {
        assert_eq!(
            [vec![], vec![4.0], vec![9.0, 1.0], vec![3.0, 1.0, 2.0]].map(median),
            [1.0, 4.0, 5.0, 2.0]
        );
    }
}
