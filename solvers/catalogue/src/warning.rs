//! Warnings about the results of a run. A run with warnings has all its numbers and its status; its reader,
//! or a check, decides whether the numbers are right.

use crate::Dimension;

/// Kind of warning, with the dimension of the value that is recorded with it.
#[derive(Debug, PartialEq)]
pub struct Warning {
    /// Code that names the warning in files and tables, such as `few-digits`.
    pub code: &'static str,
    /// Dimension of the recorded value.
    pub dimension: Dimension,
    /// Meaning of the warning and, after a semicolon or colon, the meaning of the recorded value.
    pub meaning: &'static str,
}

impl Warning {
    /// Returns the SI unit of the value; `1` for a bare number.
    pub fn unit(&self) -> &'static str {
        self.dimension.si_unit()
    }
}

/// Declares each warning as a separate static and lists them all.
macro_rules! warnings {
    ($($id:ident: $code:literal, $dimension:ident, $meaning:literal;)*) => {
        $(
            #[doc = concat!("`", $code, "`: ", $meaning, ".")]
            pub static $id: Warning =
                Warning { code: $code, dimension: Dimension::$dimension, meaning: $meaning };
        )*
        /// Every warning, in the order of lists.
        pub static WARNINGS: &[&Warning] = &[$(&$id),*];
    };
}

warnings! {
    NOTHING_MOVES: "nothing-moves", None,
        "no load, no tool and no moved support: every displacement is 0";
    EXACT_MISFIT: "exact-misfit", None,
        "the exact solution has other displacements or tractions on the surface than the scene prescribes; the largest root mean \
         square difference on a surface over the largest value on any";
    PROBE_OUTSIDE: "probe-outside", Length,
        "a probe lies outside the mesh and has the values of the mesh's nearest point; the distance";
    REGION_CUT: "region-cut", None,
        "the border of a region runs through cells, each of which is of the material at its centre; the share of such cells";
    REGIONS_BLENDED: "regions-blended", None,
        "shape functions of a cloud reach across the border of two materials and smooth the jump of the strain there; the \
         stiffer's modulus over the softer's";
    FEW_POINTS: "few-points", None,
        "a cloud has too few integration points to see all its motions; points per node";
    PATCH_TEST: "patch-test", None,
        "the integration of a cloud does not see constant stress in balance; the error that makes in the gradient of a linear \
         field";
    SUPPORT_GIVES: "support-gives", None,
        "a support held weakly gives way; the root mean square gap there over the largest displacement";
    SUPPORT_LEAKS: "support-leaks", None,
        "a support held weakly gives way by much for a flat body or one that is hard to compress; the root of the energy lost by \
         that over the strain energy";
    NITSCHE_FACTOR: "nitsche-factor", None,
        "the factor of Nitsche's method is barely large enough for a definite form; the factor over the one needed";
    FEW_CONTACT_POINTS: "few-contact-points", None,
        "fewer than three contact points carry the force of a tool, which depends on where they are; how many carry it";
    FOLDED: "folded", None,
        "the body is turned inside out between the integration points; the smallest J at the points of a finer quadrature";
    LARGE_STRAIN: "large-strain", None,
        "a law of small strain strains by more than 10 %, where a law of large strain gives other numbers; the largest principal \
         strain at the integration points";
    LARGE_ROTATION: "large-rotation", None,
        "a law of small strain, or the linear procedure, turns by more than 0.2 rad, which it takes for a strain; the largest rotation \
         at the integration points, rad";
    DEAD_PRESSURE: "dead-pressure", None,
        "a pressure keeps the direction and the area of the undeformed faces, which turn by more than 10 degrees or change their area \
         by more than 10 %; the largest change of a face's directed area over its area";
    NODES_DIFFER: "nodes-differ", None,
        "a mesh has more than 10 % more or fewer nodes than the scene asks for, as sizes of cells come in steps; nodes got over asked";
    VOLUME_DIFFERS: "volume-differs", None,
        "a mesh made inside a surface has 5 % less or more volume than that encloses, as parts thinner than its cells are left out; volume \
         got over enclosed";
    LEFT_OUT: "left-out", None,
        "the file of the mesh has parts that are not read, such as the model of a deck or arrays that may number regions; how many of \
         them join or carry parts of the body";
    PIECES_APART: "pieces-apart", None,
        "the body is in pieces without a node in common, which do not feel each other, also where their faces coincide; how many there \
         are";
    DEEP_PENETRATION: "deep-penetration", None,
        "a tool sinks into the surface by more than 5 % of the way that the tools close, as the penalty is too small; the penetration \
         over that way";
    TOOL_UNTOUCHED: "tool-untouched", None,
        "a tool of a static path touches nothing at the end, where its force is 0; no number";
    TOOL_INSIDE: "tool-inside", Length,
        "a tool stands in the body before anything moves, so that the first step has all of that to press out; how deep";
    STEP_ERROR: "step-error", None,
        "time steps are too long: the estimated error of one step over the largest displacement";
    REFERENCE_COARSER: "reference-coarser", None,
        "a run has more nodes than the reference that it is compared with, whose error its own may be; nodes over those of the reference";
    MACHINE_BUSY: "machine-busy", None,
        "other programs had the processors while runs were timed; the largest ratio of a run's time to its seconds of the processors";
    ADAPTER_UNCHECKED: "adapter-unchecked", None,
        "a solver outside this program has not passed `tissuebench adapter check` as it is now; no number";
    STABILITY_LOST: "stability-lost", None,
        "the body loses its stability on a path that goes on: beyond that there are several equilibria, of which the mesh chooses one; \
         the part of the load at the last stable step";
    ZERO_ENERGY_MODES: "zero-energy-modes", None,
        "modes of vibration strain the body without energy, which its supports do not leave free: the frequency of 0 is the \
         method's own; how many";
    FEW_CELLS: "few-cells", None,
        "fewer than three cells lie across what bends or is pressed, along its displacement, quadratic ones counted twice; how many, \
         the median by strain energy";
    FEW_DIGITS: "few-digits", None,
        "the matrix is so near to a singular one that rounding takes most digits of a linear solution; how many are certain";
    STRESS_JUMP: "stress-jump", None,
        "the stress is far from smooth: its distance from the stress recovered from it over the norm of both; no error by itself";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_warning_has_a_code_of_its_own() {
        for (i, warning) in WARNINGS.iter().enumerate() {
            assert!(WARNINGS[..i].iter().all(|other| other.code != warning.code), "{} twice", warning.code);
            assert!(warning.meaning.contains(['.', ';', ':']), "{}", warning.code);
        }
    }
}
