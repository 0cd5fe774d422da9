//! Definitions of the metrics.

use super::definition::{Kind, Metric, Needs, Shape};
use crate::dimension::Dimension;

/// Declares each metric as a separate static and lists them all.
macro_rules! metrics {
    (@shape) => { Shape::Scalar };
    (@shape $shape:ident) => { Shape::$shape };
    ($($id:ident: $name:literal, $label:literal, $dimension:ident, $kind:ident $(($of:expr))?, $needs:ident $(, $shape:ident)?,
        $meaning:literal;)*) => {
        $(
            #[doc = concat!("`", $name, "`: ", $meaning, ".")]
            pub static $id: Metric = Metric {
                name: $name,
                label: $label,
                dimension: Dimension::$dimension,
                kind: Kind::$kind $(($of))?,
                needs: Needs::$needs,
                shape: metrics!(@shape $($shape)?),
                meaning: $meaning,
            };
        )*
        /// Every metric, in the order of lists.
        pub static METRICS: &[&Metric] = &[$(&$id),*];
    };
}

metrics! {
    // Errors of displacement, stress and energy.
    RMS: "rms", "RMS error", Length, Error, Reference, Vector,
        "root mean square error of the displacement; for a transfer, of the transferred displacement, which \
         includes the errors of the method and of the transfer";
    MAX_ERROR: "max-error", "largest error", Length, Error, Reference,
        "largest error of the displacement";
    RELATIVE_MAX: "relative-max", "relative largest error", None, Error, Reference,
        "largest error of the displacement divided by the largest exact displacement";
    RELATIVE_RMS: "relative-rms", "relative RMS error", None, Error, Reference,
        "root mean square error of the displacement divided by the root mean square of the reference \
         displacement";
    PEAK_ERROR: "peak-error", "relative error of the peak", None, Error, Reference,
        "error of the largest displacement, wherever it occurs, divided by the largest displacement of the \
         reference";
    L2: "l2", "relative L2 error", None, Error, Reference,
        "relative L2 error of the displacement";
    ENERGY: "energy", "relative energy error", None, Error, Reference,
        "relative error of the method's own stress in the energy norm";
    STRESS: "stress", "relative stress error", None, Error, Reference,
        "relative L2 error of the stress recovered from the method's own points";
    PRESSURE: "pressure", "relative pressure error", None, Error, Reference,
        "relative L2 error of the pressure recovered from the method's own points";
    PROBE_ERROR: "probe-error", "relative error at probes", None, Error, Probes,
        "largest relative error at the probes";
    HISTORY_ERROR: "history-error", "relative error over time", None, Error, Exact,
        "largest error at the probes in all recorded states, divided by the largest exact displacement at \
         the probes";
    TIP: "tip", "ratio of computed to exact", None, Value, Probes,
        "ratio of computed to exact displacement at the first probe";
    // Estimated errors.
    DISPLACEMENT_ESTIMATE: "displacement-error-estimate", "estimated displacement error", None, Value, Estimate,
        "estimated root mean square error of the displacement, divided by the root mean square of the predicted \
         displacement";
    DISPLACEMENT_SATURATION: "displacement-error-saturation", "saturation of the displacement", None, Value, Estimate,
        "change of the predicted displacement from a coarser mesh, divided by the change of the run's";
    PROBE_ESTIMATE: "probe-error-estimate", "estimated error of a point", None, Place, PointEstimate,
        "estimated error of the displacement of a point of output.probes, relative to the predicted displacement";
    PROBE_SATURATION: "probe-error-saturation", "saturation of a point", None, Place, PointEstimate,
        "change of the predicted displacement of a point from a coarser mesh, divided by the change of the run's";
    TOOL_FORCE_ESTIMATE: "tool-force-error-estimate", "estimated force error", None, Tool, ToolEstimate,
        "estimated error of the tool's force, relative to the predicted force";
    TOOL_FORCE_SATURATION: "tool-force-error-saturation", "saturation of the force", None, Tool, ToolEstimate,
        "change of the predicted tool force from a coarser mesh, divided by the change of the run's";
    TOOL_FORCE_PREDICTED: "tool-force-predicted", "predicted tool force", Force, Tool, ToolEstimate,
        "force of the tool that more shape functions predict, on two meshes if there is a coarser one";
    REACTION_ESTIMATE: "reaction-error-estimate", "estimated error of a support force", None, Place, SupportEstimate,
        "estimated error of a support's force, relative to the largest predicted force of a support";
    REACTION_SATURATION: "reaction-error-saturation", "saturation of a support force", None, Place, SupportEstimate,
        "change of the predicted force of a support from a coarser mesh, divided by the change of the run's";
    STRAIN_ENERGY_ESTIMATE: "strain-energy-error-estimate", "estimated energy error", None, Value, Estimate,
        "estimated error of the strain energy, relative to the predicted energy";
    STRAIN_ENERGY_SATURATION: "strain-energy-error-saturation", "saturation of the energy", None, Value, Estimate,
        "change of the predicted strain energy from a coarser mesh, divided by the change of the run's";
    ERROR_VOLUME: "error-volume", "volume that causes the error", None, Value, Trace,
        "volume of the cells that cause half of the error of the number of output.error_of, divided by the volume of the \
         body";
    MESHES: "meshes", "solved meshes", None, Count, Run,
        "meshes that a refinement has solved, until its number was accurate";
    REMAINING_ERROR: "remaining-error", "remaining error", None, Value, Run,
        "estimated error of the number that a mesh is refined for, on the last mesh, relative to the predicted number";
    STRAIN_ENERGY_PREDICTED: "strain-energy-predicted", "predicted strain energy", Energy, Value, Estimate,
        "strain energy that more shape functions predict, on two meshes if there is a coarser one";
    FREQUENCY_ESTIMATE: "frequency-error-estimate", "estimated error of a frequency", None, Place, ModeEstimate,
        "estimated error of the frequency of a mode, relative to the predicted frequency; none of a rigid motion";
    FREQUENCY_SATURATION: "frequency-error-saturation", "saturation of a frequency", None, Place, ModeEstimate,
        "change of the predicted frequency of a mode from a coarser mesh, divided by the change of the run's";
    FREQUENCY_PREDICTED: "frequency-predicted", "predicted frequency", Frequency, Place, ModeEstimate,
        "frequency of a mode that more shape functions predict, on two meshes if there is a coarser one";
    // Strict bounds.
    STRAIN_ENERGY_LOWER: "strain-energy-lower", "lower bound of the strain energy", Energy, Value, Bounds,
        "number that the strain energy of the exact solution is never below";
    STRAIN_ENERGY_UPPER: "strain-energy-upper", "upper bound of the strain energy", Energy, Value, Bounds,
        "number that the strain energy of the exact solution is never above";
    SUPPORT_FORCE_LOWER: "support-force-lower", "lower bound of a support force", Force, Value, Bounds,
        "number that the exact force of the only moving support along its motion is never below";
    SUPPORT_FORCE_UPPER: "support-force-upper", "upper bound of a support force", Force, Value, Bounds,
        "number that the exact force of the only moving support along its motion is never above";
    LOAD_DISPLACEMENT_LOWER: "load-displacement-lower", "lower bound of a mean displacement", Length, Value, Bounds,
        "number that the exact mean displacement of the loaded faces along the only load, a uniform one, is never below";
    LOAD_DISPLACEMENT_UPPER: "load-displacement-upper", "upper bound of a mean displacement", Length, Value, Bounds,
        "number that the exact mean displacement of the loaded faces along the only load, a uniform one, is never above";
    MEAN_LOWER: "mean-lower", "lower bound of a mean displacement", Length, Place, MeanBounds, Components,
        "number that the exact mean displacement of a face listed in output.means is never below";
    MEAN_UPPER: "mean-upper", "upper bound of a mean displacement", Length, Place, MeanBounds, Components,
        "number that the exact mean displacement of a face listed in output.means is never above";
    BOUNDS_HALF_WIDTH: "bounds-half-width", "half-width of the bounds", None, Value, Bounds,
        "half the distance between the bounds of the strain energy, divided by their mean";
    BOUNDS_EXCESS: "bounds-excess", "strain energy outside its bounds", None, Value, Bounds,
        "distance of the run's strain energy from the nearer of its bounds, divided by this bound, positive above and \
         negative below; 0 between them";
    // Parts of an error, and distances from a secondary reference.
    INTEGRATION_RMS: "integration-rms", "integration error", Length, Error, Reference, Vector,
        "root mean square difference from the same method with the study's integration rule";
    DISCRETISATION_RMS: "discretisation-rms", "discretisation error", Length, Error, Reference, Vector,
        "root mean square error of the method with the study's integration rule";
    BESIDE_RMS: "beside-rms", "RMS difference from the secondary reference", Length, Value, Reference, Vector,
        "root mean square difference from the secondary reference (output.beside)";
    // Transfers to other points.
    TRANSFER_RMS: "transfer-rms", "RMS change made by a transfer", Length, Error, Transfer,
        "root mean square difference between the transferred displacement and the displacement by the \
         method's own shape functions, which excludes the error of the method; in a check, the worst of all \
         schemes";
    LINEAR_RMS: "linear-rms", "RMS error of a linear field", Length, Error, Transfer,
        "root mean square error of a transferred linear field of 10 % strain";
    TRANSFER_ONLY_RMS: "transfer-only-rms", "RMS error of the reference's field after transfer", Length, Error, Transfer, Vector,
        "root mean square error of the reference's own field, transferred from the cloud's nodes";
    BESIDE_TRANSFER_RMS: "beside-transfer-rms", "RMS error of the secondary reference's field after transfer", Length, Error, Transfer, Vector,
        "root mean square error of the secondary reference's own field, transferred from the cloud's nodes";
    OUTSIDE: "outside", "targets outside the nodes' hull", None, Count, Transfer,
        "targets of a transfer outside the convex hull of the nodes or outside the mesh";
    // Orders of convergence.
    ORDER_L2: "order-l2", "order of the L2 error", None, Order(&L2), Levels,
        "observed order of the L2 error";
    ORDER_ENERGY: "order-energy", "order of the energy error", None, Order(&ENERGY), Levels,
        "observed order of the energy error";
    ORDER_PRESSURE: "order-pressure", "order of the pressure error", None, Order(&PRESSURE), Levels,
        "observed order of the pressure error";
    ORDER_FREQUENCY_ERROR: "order-frequency-error", "order of the frequency error", None, Order(&FREQUENCY_ERROR), Levels,
        "observed order of the frequency error";
    // Many clouds.
    CARRIED_SHARE: "carried-share", "fraction of clouds that reached the full load", None, Value, Seeds,
        "fraction of the clouds of a study's seeds that gave results and reached the full load, 0 to 1";
    // Vibrations.
    FREQUENCY_RATIO: "frequency-ratio", "ratio of computed to exact frequency", None, Value, ModesReference,
        "ratio of computed to exact frequency, the worst of the modes nearest to the exact modes of this \
         frequency";
    FREQUENCY_ERROR: "frequency-error", "relative frequency error", None, Error, ModesReference,
        "absolute difference between frequency-ratio and 1";
    MODE_OVERLAP: "mode-overlap", "mode overlap", None, Value, ModesReference,
        "smallest squared cosine between a mode of frequency-ratio and the space of the exact modes";
    SPECTRUM_ERROR: "spectrum-error", "relative error of the spectrum", None, Error, ModesReference,
        "largest relative error of the reported frequencies, compared one by one in ascending order";
    SLOW_MODES: "slow-modes", "spurious slow modes", None, Count, ModesReference,
        "modes with a frequency below 0.9 of the lowest exact frequency";
    RIGID_MODES: "rigid-modes", "rigid modes", None, Count, Modes,
        "modes with a frequency below a thousandth of that of a shear wave across the body";
    MASSLESS: "massless", "massless motions", None, Count, Modes,
        "motions that have stiffness but no mass";
    MODE: "mode", "mode", None, Count, Modes,
        "number of a mode, from 1, by ascending frequency";
    OMEGA: "omega", "angular frequency", AngularFrequency, Value, Modes,
        "angular frequency of a mode";
    FREQUENCY: "frequency", "frequency", Frequency, Value, Modes,
        "frequency of a mode, its angular frequency divided by 2 pi";
    OMEGA_RATIO: "omega-ratio", "ratio of computed to exact angular frequency", None, Value, ModesReference,
        "ratio of the angular frequency of a mode to the exact angular frequency with the same number";
    // Tools and contact.
    CLOSURE: "closure", "tool displacement", Length, Tool, Tool,
        "displacement of the tool along its direction";
    TOOL_FORCE: "tool-force", "tool force", Force, Tool, Tool,
        "force of the tool along its direction";
    CONTACT_POINTS: "contact-points", "points in contact", None, Tool, Tool,
        "surface points in contact with the tool";
    TOOL_FORCE_ERROR: "tool-force-error", "relative force error", None, Tool, ToolReference,
        "relative error of the tool's force against the reference method, at the same load fraction";
    // ANCHOR: contact_radius_error
    CONTACT_RADIUS_ERROR: "contact-radius-error", "relative error of the contact's radius", None, Error, ExactContact,
        "relative error of the contact radius, sqrt(A / A exact) - 1, with the area A of the points in \
         contact, whose edge is known to half a cell's width";
    // ANCHOR_END: contact_radius_error
    PENETRATION: "penetration", "deepest penetration", Length, Value, Tool,
        "deepest penetration of a tool";
    LIMIT_CLOSURE: "limit-closure", "tool displacement at the limit", Length, Tool, Tool,
        "displacement of the tool at the last stable step before the body first lost stability";
    LIMIT_TOOL_FORCE: "limit-tool-force", "tool force at the limit", Force, Tool, Tool,
        "force of the tool at the last stable step before the body first lost stability";
    // Supports and faces.
    REACTION: "reaction", "support force", Force, Place, Support, Components,
        "force of a support on the body, at the end; the forces of all supports, loads and tools are in equilibrium";
    FOUNDATION_FORCE: "foundation-force", "force of springs and dampers", Force, Place, Foundation, Components,
        "force of the springs and dampers of a foundation on the body, at the end";
    MEAN: "mean", "mean displacement", Length, Place, Mean, Components,
        "area-weighted mean displacement of a face listed in output.means, at the end";
    TOOL_MOMENT: "tool-moment", "moment on a tool", Moment, Tool, ToolMoment, Components,
        "moment of the tissue on a tool about output.moments_about, at the end";
    REACTION_MOMENT: "reaction-moment", "moment of a support", Moment, Place, SupportMoment, Components,
        "moment of a support on the body about output.moments_about, at the end";
    // Points and volumes.
    PROBE: "probe", "displacement of a point", Length, Place, Point, Vector,
        "displacement of a point of output.probes, at the end";
    POSITION: "position", "position of a point", Length, Place, Point, Components,
        "deformed position of a point of output.probes, at the end";
    PROBE_STRESS: "probe-stress", "stress of a point", Pressure, Place, Point, Tensor,
        "recovered Cauchy stress of a point of output.probes, at the end; none for viscoelastic tissue";
    PROBE_PEAK: "probe-peak", "largest displacement of a point", Length, Place, Motion,
        "largest displacement of a point of output.probes in all recorded states";
    PROBE_PEAK_TIME: "probe-peak-time", "time of the largest displacement of a point", Time, Place, Motion,
        "time of the first recorded state with the largest displacement of a point of output.probes";
    STRETCH: "stretch", "stretch of a point", None, Place, Stretch,
        "ratio of deformed to undeformed length along the direction and at the point of an entry of \
         output.stretches, at the end";
    ENCLOSED_VOLUME: "enclosed-volume", "enclosed volume", Volume, Place, Enclosed,
        "volume enclosed by a surface of output.volumes, at the end";
    REGION_ENERGY: "region-energy", "strain energy of a region", Energy, Place, RegionEnergy,
        "strain energy of a region in output.energies, at the end; none for viscoelastic tissue";
    // Load steps, Newton's method, relaxation.
    LOAD_CARRIED: "load-carried", "applied load fraction", None, Value, Steps,
        "fraction of the load that was reached, 0 to 1";
    LIMIT_LOAD: "limit-load", "load fraction at the limit", None, Value, Steps,
        "fraction of the load at the last stable step before the body first lost stability";
    LOAD_STEPS: "load-steps", "recorded states", None, Count, Steps,
        "load steps or recorded states";
    SMALLEST_J: "smallest-j", "smallest volume ratio", None, Value, Steps,
        "smallest volume ratio J of all quadrature points";
    STRAIN_ENERGY_ERROR: "strain-energy-error", "relative energy error", None, Error, StepsReference,
        "relative error of the strain energy against the reference method, at the same load fraction";
    PROBE_DIFFERENCE: "probe-difference", "largest difference at probes", Length, Error, ProbesReference,
        "largest distance from the reference method's displacement at the probes, at the same load fraction";
    PROBE_BAND: "probe-band", "uncertainty of the reference at probes", Length, Value, ProbesReference,
        "largest distance between the solutions that a stored reference is made of, at the probes";
    NEWTON_ITERATIONS: "newton-iterations", "Newton iterations", None, Count, Newton,
        "number of linear systems solved by Newton's method in all steps";
    CUT_BACKS: "cut-backs", "cut-back steps", None, Count, Newton,
        "number of steps that failed and were repeated with a shorter length";
    TRAINING_DISTANCE: "training-distance", "distance from the training", None, Value, Reduced,
        "largest distance of a step's displacement, in the modes of the reduced model, from the nearest state of the \
         training, divided by the largest displacement of the run";
    SAMPLED_CELLS: "sampled-cells", "part of the cells with forces", None, Value, Reduced,
        "part of the cells in which a reduced model evaluates forces";
    SAMPLING_ERROR: "sampling-error", "error of the sampled forces", None, Error, Reduced,
        "difference of the forces on the modes by the sampled cells from those by all cells, in all states of the \
         training, relative to the latter";
    RELAXATION_STEPS: "relaxation-steps", "relaxation steps", None, Count, Steps,
        "pseudo-time steps of dynamic relaxation";
    RELAXATION_ERROR: "relaxation-error", "relaxation error", None, Error, Steps,
        "estimated relative error of the displacement at which dynamic relaxation stopped";
    RELAXATION_RESIDUAL: "relaxation-residual", "relaxation residual", None, Error, Steps,
        "relative residual at which dynamic relaxation stopped";
    REPEATED_ERROR: "repeated-error", "relative error of a repeated frame", None, Error, Run,
        "largest difference at the probes between a frame of the repeated loading and the direct solution, \
         divided by the largest displacement at the probes";
    LOOP_FORCE_ERROR: "loop-force-error", "force error in a loop", None, Place, ToolLoop,
        "difference of a tool's force in a frame of the loop from the reference's path, or from the run's own without a \
         reference that has one, over the largest force of this path; 99 % of the frames are below it, for each rate of \
         the loop";
    LOOP_PROBE_ERROR: "loop-probe-error", "displacement error in a loop", None, Place, PointLoop,
        "the same for the displacement of the points of output.probes, the worst of them";
    // Dynamics.
    TIME: "time", "time", Time, Cost, Run,
        "duration of a phase; for a recorded state in dynamics, the time of the model";
    TIME_STEPS: "time-steps", "time steps", None, Count, Dynamics,
        "number of time steps";
    TIME_REACHED: "time-reached", "time reached", Time, Value, Dynamics,
        "time up to which the motion was computed";
    SWEEPS: "sweeps", "sweeps", None, Count, Frames,
        "number of sweeps over the body in all time steps";
    SWEEP_RESIDUAL: "sweep-residual", "relative residual after the sweeps", None, Error, Frames,
        "largest out-of-balance force that the sweeps of the last time step left, divided by the largest force";
    CRITICAL_STEP: "critical-step", "critical time step", Time, Value, Explicit,
        "smallest estimated critical time step; for vibrations, 2 / omega of the highest mode";
    STEP_ERROR: "step-error", "error of a time step", Length, Error, Dynamics,
        "largest estimated error of the displacement in one implicit time step";
    FORCE_ROUNDING: "force-rounding", "relative rounding of internal forces", None, Error, Explicit,
        "largest difference of the internal forces in single precision from those in double precision in all \
         recorded states, divided by the largest force";
    ENERGY_DRIFT: "energy-drift", "relative energy drift", None, Error, Dynamics,
        "largest error of the energy balance divided by its largest term; with implicit steps, this error is \
         the energy dissipated by the scheme";
    MAX_OVER_TIME: "max-over-time", "largest displacement over time", Length, Value, Dynamics,
        "largest displacement in all recorded states, at the points at which max is evaluated";
    TIME_OF_MAX: "time-of-max", "time of the largest displacement", Time, Value, Dynamics,
        "time of the recorded state with the largest displacement";
    PERIOD: "period", "period", Time, Value, Motion,
        "mean period of the first probe, between upward crossings of the middle of its recorded displacement range";
    DAMPING_RATIO: "damping-ratio", "damping ratio", None, Value, Motion,
        "damping of the first probe's vibration as a part of critical damping, from the logarithmic decrement of \
         the second half of its swings; with damping only";
    MASS: "mass", "mass", Mass, Value, Dynamics,
        "mass of the body";
    TOOL_MASS: "tool-mass", "tool mass", Mass, Value, Explicit,
        "mass given to tools that are driven by a force; 0 without one";
    KINETIC_ENERGY: "kinetic-energy", "kinetic energy", Energy, Value, Dynamics,
        "kinetic energy of the body and of tools that are driven by a force";
    INTERNAL_WORK: "internal-work", "internal work", Energy, Value, Dynamics,
        "work done on relaxing tissue by its stresses";
    EXTERNAL_WORK: "external-work", "external work", Energy, Value, Explicit,
        "work of loads, prescribed displacements and tools";
    WORK_ON_BODY: "work-on-body", "work on the body", Energy, Value, Dynamics,
        "work of loads, prescribed displacements and contact on the body";
    CONTACT_ENERGY: "contact-energy", "contact energy", Energy, Value, Explicit,
        "energy stored in the contact penalty";
    FRICTION_DISSIPATION: "friction-dissipation", "friction dissipation", Energy, Value, Explicit,
        "energy dissipated by friction";
    DAMPING_DISSIPATION: "damping-dissipation", "damping dissipation", Energy, Value, Dynamics,
        "energy dissipated by damping";
    SCHEME_DISSIPATION: "scheme-dissipation", "numerical dissipation", Energy, Value, Dynamics,
        "energy dissipated by the implicit time-stepping scheme";
    // Any run.
    MAX: "max", "largest displacement", Length, Value, Run, Vector,
        "largest displacement at the end";
    STRAIN_ENERGY: "strain-energy", "strain energy", Energy, Value, Run,
        "strain energy";
    HOURGLASS_ENERGY: "hourglass-energy", "part of hourglass energy", None, Value, Run,
        "largest energy of hourglass control divided by the largest strain energy, which includes it, of all \
         load steps or recorded states";
    LOAD: "load", "load", Force, Value, Run, Components,
        "sum of all nodal loads";
    VOLUME: "volume", "volume", Volume, Value, Run,
        "sum of the weights of all quadrature points";
    VOLUME_ERROR: "volume-error", "relative volume error", None, Error, Run,
        "relative difference between the integrated volume and the body's";
    RESIDUAL: "residual", "relative residual", None, Error, Run,
        "relative residual of the linear solve, of the last static step, or of the worst reported mode";
    FACTOR_NONZEROS: "factor-nonzeros", "nonzeros of the factor", None, Count, Run,
        "stored entries of the matrix factor, or of the matrices of all levels of a multigrid solver";
    LINEAR_ITERATIONS: "linear-iterations", "iterations of the linear solver", None, Count, Run,
        "iterations of the multigrid-preconditioned solver: conjugate gradients, or the solver for systems \
         with pressures";
    OPERATOR_COMPLEXITY: "operator-complexity", "operator complexity", None, Value, Run,
        "matrix entries of all levels of a multigrid solver divided by the entries of the finest level";
    STRESS_JUMP: "stress-jump", "jump of the stress", None, Value, Run,
        "distance between a method's own stress and the smooth stress recovered from it, divided by the norm \
         of both; the error can be a fraction of this value or several times as large";
    SMALLEST_FINE_J: "smallest-fine-j", "smallest J between points", None, Value, Steps,
        "smallest J at the points of a finer quadrature than the method's own, at the end";
    NITSCHE_FACTOR_NEEDED: "nitsche-factor-needed", "needed factor of Nitsche's method", None, Value, Run,
        "estimated factor below which Nitsche's form is not definite, for the quadrature rules and materials \
         of the run";
    SUPPORT_GAP: "support-gap", "gap at supports", Length, Error, Run,
        "root mean square difference between the displacement and the values prescribed at weakly imposed \
         supports";
    SILENT_WRONG: "silent-wrong", "wrong without a warning", None, Count, Axis,
        "runs of one method along an axis of a study that are wrong but have neither a warning nor another status";
    WARNINGS: "warnings", "warnings", None, Count, Run,
        "warnings of the run";
    TARGETS_OUTSIDE: "targets-outside", "targets outside the mesh", None, Count, Run,
        "comparison points outside the mesh, at which the nearest element is extrapolated";
    CONSTRAINTS_ELIMINATED: "constraints-eliminated", "eliminated constraints", None, Count, Run,
        "rows of essential conditions that were eliminated";
    CONSTRAINTS_DROPPED: "constraints-dropped", "redundant constraints", None, Count, Run,
        "rows of eliminated essential conditions that depend linearly on the others";
    FINITE_ELEMENT_NODES: "finite-element-nodes", "finite-element nodes", None, Count, Run,
        "nodes of finite elements coupled to a cloud";
    NEIGHBOURS_MIN: "neighbours-min", "fewest neighbours", None, Count, Run,
        "smallest number of nodes whose supports contain a quadrature point";
    NEIGHBOURS_MEAN: "neighbours-mean", "mean neighbours", None, Value, Run,
        "mean number of nodes whose supports contain a quadrature point";
    NEIGHBOURS_MAX: "neighbours-max", "most neighbours", None, Count, Run,
        "largest number of nodes whose supports contain a quadrature point";
    CONDITION_MEDIAN: "condition-median", "median condition", None, Value, Run,
        "median condition estimate of the moment matrices";
    CONDITION_MAX: "condition-max", "largest condition", None, Value, Run,
        "largest condition estimate of a moment matrix";
    FALLBACKS: "fallbacks", "fallbacks", None, Count, Run,
        "points at which the approximation used a fallback";
    FALLBACKS_ENLARGED: "fallbacks-enlarged", "enlarged supports", None, Count, Run,
        "points at which the support was enlarged";
    FALLBACKS_REGULARISED: "fallbacks-regularised", "regularised moments", None, Count, Run,
        "points at which the moment matrix was regularised";
    FALLBACKS_REDUCED: "fallbacks-reduced", "reduced bases", None, Count, Run,
        "points at which the basis was reduced";
    // Costs.
    MEMORY: "memory", "memory", Bytes, Cost, Run,
        "peak memory allocated in the run, excluding its input";
    CPU_TIME: "cpu-time", "CPU time", Time, Cost, Run,
        "CPU time of a phase, of all threads of the process";
    TIME_PREPARE: "time-prepare", "time to prepare", Time, Phase("prepare"), Run,
        "seconds for search and shape functions";
    TIME_ASSEMBLE: "time-assemble", "time to assemble", Time, Phase("assemble"), Run,
        "seconds to assemble";
    TIME_FACTOR: "time-factor", "time to factor", Time, Phase("factor"), Run,
        "seconds to factor";
    TIME_SOLVE: "time-solve", "time to solve", Time, Phase("solve"), Run,
        "seconds to solve";
    TIME_TRANSFER: "time-transfer", "time to transfer", Time, Phase("transfer"), Transfer,
        "seconds to apply the transfer";
    TIME_TOTAL: "time-total", "total time", Time, Phase("total"), Run,
        "seconds for all phases except reading files";
}
