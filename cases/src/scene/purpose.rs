//! The purpose of a scene. Reports judge a scene by its purpose, never by its name.

use super::words::words;

words! {
    /// Purpose of a scene.
    pub enum Purpose {
        /// A test of exactness: every method can represent the solution, so run times, locking and orders
        /// mean nothing.
        Patch = "patch",
        /// A smooth solution: errors fall with the theoretical order. The default.
        Smooth = "smooth",
        /// A solution that is not smooth (a jump of the load, a wave front, a corner): theory predicts no
        /// order.
        Rough = "rough",
        /// A model of the published case that `published` names: its results are compared with the published
        /// ones. No order is predicted.
        Published = "published",
    }
}

words! {
    /// Published comparisons whose numbers the report contains.
    pub enum Publication {
        /// Saghaei Nooshabadi et al., Scientia Iranica B 23(1) (2016) 295-300: a kidney in a grasper,
        /// elements and clouds.
        Saghaei2016 = "saghaei-2016",
    }
}
