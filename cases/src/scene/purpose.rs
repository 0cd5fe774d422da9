//! What a scene is for: reports judge it by this, never by its name.

use super::words::words;

words! {
    /// What a scene is for.
    pub enum Purpose {
        /// A test of exactness: the solution lies in the space of every method, so that run times, locking and orders mean nothing.
        Patch = "patch",
        /// A smooth solution: errors fall with the order that theory promises. Used unless given.
        Smooth = "smooth",
        /// A solution that is not smooth (a jump of the load, a wave front, a corner): theory promises no order.
        Rough = "rough",
        /// A reading of the published case that `published` names: its results are compared with the published ones. No order is
        /// promised.
        Published = "published",
    }
}

words! {
    /// Published comparisons whose numbers the report holds.
    pub enum Publication {
        /// Saghaei Nooshabadi et al., Scientia Iranica B 23(1) (2016) 295-300: a kidney in a grasper, elements and clouds.
        Saghaei2016 = "saghaei-2016",
    }
}
