//! Warnings about the results of a run. A run with warnings has all its numbers and its status; its reader,
//! or a check, decides whether the numbers are right.

use crate::dimension::Dimension;

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
        "the scene has no load, no tool and no moving support, so every displacement is 0; no value";
    LOOP_ENDED: "loop-ended", None,
        "a loop in real time ended before the whole loading had passed; value: the number of its frames";
    NO_ESTIMATE: "no-estimate", None,
        "the error of a run cannot be estimated; no value";
    ROUGH_ESTIMATE: "rough-estimate", None,
        "no equilibrium with more shape functions was found near that of a run, so that its error is estimated from \
         the linearised problem; value: the estimated error of the displacement";
    SINGLE_ESTIMATE: "single-estimate", None,
        "no coarser mesh confirms the estimated errors of a run; no value";
    LEVELS_DISAGREE: "levels-disagree", None,
        "the prediction of a run's error still changes from mesh to mesh; value: the change divided by that of the \
         run";
    NOT_ACCURATE: "not-accurate", None,
        "the refinement of a mesh ended before its number was accurate; value: the remaining error, relative to the \
         predicted number";
    UNTRACED: "untraced", None,
        "the error of the number of output.error_of cannot be traced to cells; no value";
    OUTSIDE_BOUNDS: "outside-bounds", None,
        "the strain energy of a run lies outside the strict bounds of the exact energy; value: the distance from \
         the nearer bound divided by this bound";
    EXACT_MISFIT: "exact-misfit", None,
        "the exact solution has other displacements or tractions on the surface than the scene prescribes; \
         value: the largest root mean square difference on a surface divided by the largest value on any \
         surface";
    PROBE_OUTSIDE: "probe-outside", Length,
        "a probe lies outside the mesh and takes the values at the nearest point of the mesh; value: the \
         distance to this point";
    REGION_CUT: "region-cut", None,
        "the border of a region runs through cells, and each of these cells has the material at its centre; \
         value: the fraction of such cells";
    REGIONS_BLENDED: "regions-blended", None,
        "shape functions of a cloud extend across the border of two materials and smooth the strain jump \
         there; value: the ratio of the stiffer modulus to the softer";
    FEW_POINTS: "few-points", None,
        "a cloud has too few integration points to resist every nodal motion; value: the number of \
         integration points per node";
    POINT_FORCE: "point-force", None,
        "a force acts at a point of a cloud that smooths its gradients by one point on each face, and the displacement \
         there can be 20 times too large; value: the number of such points";
    PATCH_TEST: "patch-test", None,
        "the integration of a cloud fails the patch test, so constant stress is not in equilibrium; value: \
         the resulting relative error in the gradient of a linear field";
    SUPPORT_GIVES: "support-gives", None,
        "the displacement at a weakly imposed support differs from the prescribed displacement; value: the \
         root mean square difference divided by the largest displacement";
    SUPPORT_LEAKS: "support-leaks", None,
        "the displacement at a weakly imposed support differs from the prescribed displacement by much for a \
         flat or nearly incompressible body, so the stress may be wrong; value: the square root of the ratio \
         of the energy of the difference to the strain energy";
    NITSCHE_FACTOR: "nitsche-factor", None,
        "the factor of Nitsche's method is barely large enough for a definite form; value: the ratio of the \
         factor to the smallest sufficient factor";
    SPURIOUS_MOTION: "spurious-motion", None,
        "parameters of a cloud with a lumped mass oscillate almost without displacement; value: the largest \
         kinetic energy that the displacement does not have, divided by the largest kinetic energy";
    FEW_CONTACT_POINTS: "few-contact-points", None,
        "fewer than three contact points carry the force of a tool, so the force depends on their positions; \
         value: the number of points that carry the force";
    FOLDED: "folded", None,
        "the body is inverted between the integration points; value: the smallest J at the points of a finer quadrature";
    LARGE_STRAIN: "large-strain", None,
        "a material with a small-strain law is strained by more than 10 %, at which a large-strain law gives \
         other results; value: the largest principal strain at the integration points";
    LARGE_ROTATION: "large-rotation", None,
        "a material with a small-strain law, or in the linear procedure, rotates by more than 0.2 rad, and \
         the rotation is taken for strain; value: the largest rotation at the integration points, rad";
    DEAD_PRESSURE: "dead-pressure", None,
        "a pressure keeps the direction and the area of the undeformed faces, but the faces rotate by more \
         than 10 degrees or change their area by more than 10 %; value: the largest change of a face's area \
         vector divided by its area";
    NODES_DIFFER: "nodes-differ", None,
        "the number of nodes of a mesh differs by more than 10 % from the requested number, because cell \
         sizes come in steps; value: the ratio of actual to requested nodes";
    VOLUME_DIFFERS: "volume-differs", None,
        "the volume of a mesh made inside a surface differs by more than 5 % from the enclosed volume, \
         because parts thinner than the cells are left out; value: the ratio of mesh volume to enclosed \
         volume";
    SURFACE_TREATED: "surface-treated", Length,
        "the surface of the body's file has faults that are repaired, or it is wrapped; value: the largest distance \
         between the wrap and the triangles of the file, 0 of a repair";
    LEFT_OUT: "left-out", None,
        "the mesh file has parts that are not read, such as the model of a deck or arrays that may number \
         regions; value: the number of these parts that join or support parts of the body";
    PIECES_APART: "pieces-apart", None,
        "the body consists of pieces without a common node, which do not interact even if their faces \
         coincide; value: the number of pieces";
    DEEP_PENETRATION: "deep-penetration", None,
        "a tool penetrates the surface by more than 5 % of the distance that the tools close, because the \
         penalty is too small; value: the ratio of penetration to this distance";
    TOOL_UNTOUCHED: "tool-untouched", None,
        "a tool touches nothing at the end of a static path, so its force is 0; no value";
    TOOL_INSIDE: "tool-inside", Length,
        "a tool overlaps the undeformed body, so the first step has to remove the whole overlap; value: the \
         depth of the overlap";
    TOOL_CUT: "tool-cut", None,
        "a plane of symmetry cuts a tool, so its force is a part of that on the whole body, which the stored \
         reference has; value: this part";
    STEP_ERROR: "step-error", None,
        "time steps are too long; value: the estimated error of one step divided by the largest displacement";
    REFERENCE_COARSER: "reference-coarser", None,
        "a run has more nodes than its reference, so the reported error may be that of the reference; value: \
         the ratio of the run's nodes to the reference's nodes";
    REFERENCE_ROUGH: "reference-rough", None,
        "the reference has not the accuracy that the scene asks for; value: its own error, 0 if unknown";
    MACHINE_BUSY: "machine-busy", None,
        "other programs used the processors while runs were timed; value: the largest ratio of wall-clock time to CPU time of a run";
    ADAPTER_UNCHECKED: "adapter-unchecked", None,
        "an external solver has not passed `tissuebench adapter check` in its present state; no value";
    STABILITY_LOST: "stability-lost", None,
        "the body loses stability before the end of the load path, and the mesh decides which of several \
         equilibria the run follows from there; value: the load fraction at the last stable step";
    ZERO_ENERGY_MODES: "zero-energy-modes", None,
        "vibration modes have less than half the frequency that their shape has with finer integration and a consistent mass, often \
         zero, which is an artefact of the method; value: the number of such modes";
    FEW_CELLS: "few-cells", None,
        "the body has fewer than three cells, or four linear tetrahedra, across a section that bends or is compressed, \
         counted along the displacement and twice if quadratic; value: the number of cells across, median by strain energy";
    HOURGLASSING: "hourglassing", None,
        "means over nodes ignore strain that alternates from cell to cell, which makes the body too soft; value: the energy of this strain \
         divided by the strain energy";
    HOURGLASS_CONTROL: "hourglass-control", None,
        "much of the strain energy is that of hourglass control, an artificial stiffness; value: this energy divided by the strain energy";
    GAP_BRIDGED: "gap-bridged", None,
        "a transfer scheme takes displacements from nodes across a slit or another gap of the body; value: the largest difference from \
         the cloud's own displacement there, divided by the largest displacement";
    FEW_DIGITS: "few-digits", None,
        "the matrix is nearly singular, so rounding leaves few correct digits in a linear solution; value: \
         the number of correct digits";
    STRESS_JUMP: "stress-jump", None,
        "the stress is far from smooth; value: the distance between the stress and the smooth stress \
         recovered from it, divided by the norm of both, which is not an error";
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
