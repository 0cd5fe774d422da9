//! Kernels for internal forces: their names, for plans and records, and what they have in common.

use lanes::LanePath;
use shape::Vector3;

/// Kernel for internal forces, chosen by table, dilation groups and laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// Tetrahedra with four nodes, eight at a time.
    Tet4,
    /// Tetrahedra with four nodes and nodal-mean dilation, eight at a time.
    Tet4NodalDilation,
    /// Trilinear hexahedra with eight Gauss points, eight elements at a time.
    Hex8,
    /// Trilinear hexahedra with one mean dilation per element, eight at a time.
    Hex8MeanDilation,
    /// Trilinear hexahedra with one point and hourglass control, eight elements at a time.
    Hex8OnePoint,
    /// Quadratic tetrahedra with four points, eight elements at a time.
    Tet10,
    /// Quadratic tetrahedra with one mean dilation per element, eight at a time.
    Tet10MeanDilation,
    /// Serendipity hexahedra with 27 or 8 points, eight elements at a time.
    Hex20,
    /// Serendipity hexahedra with one mean dilation per element, eight at a time.
    Hex20MeanDilation,
    /// Rows of any length, eight points at a time.
    Rows,
    /// One point after another on one thread, several times slower. Used for dilation groups other than those
    /// above, and for all groups if a law does not split into a part for shape change and a part for volume
    /// change (linear, St. Venant-Kirchhoff).
    Plain,
}

impl Kernel {
    /// All kernels.
    pub const ALL: [Kernel; 11] = [
        Kernel::Tet4,
        Kernel::Tet4NodalDilation,
        Kernel::Hex8,
        Kernel::Hex8MeanDilation,
        Kernel::Hex8OnePoint,
        Kernel::Tet10,
        Kernel::Tet10MeanDilation,
        Kernel::Hex20,
        Kernel::Hex20MeanDilation,
        Kernel::Rows,
        Kernel::Plain,
    ];

    /// Returns the name for records.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Tet4 => "tet4",
            Kernel::Tet4NodalDilation => "tet4 nodal dilation",
            Kernel::Hex8 => "hex8",
            Kernel::Hex8MeanDilation => "hex8 mean dilation",
            Kernel::Hex8OnePoint => "hex8 one point",
            Kernel::Tet10 => "tet10",
            Kernel::Tet10MeanDilation => "tet10 mean dilation",
            Kernel::Hex20 => "hex20",
            Kernel::Hex20MeanDilation => "hex20 mean dilation",
            Kernel::Rows => "rows",
            Kernel::Plain => "plain",
        }
    }

    /// Whether the kernel uses vector code and all threads.
    pub fn is_parallel(self) -> bool {
        self != Kernel::Plain
    }
}

/// Precision of the internal forces. Displacements, velocities, masses and the sums of nodal forces over
/// chunks of elements are double in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 16 digits.
    #[default]
    Double,
    /// 7 digits, with twice the lanes in half the memory.
    Single,
}

impl Precision {
    /// Strain of the differences of internal forces by which the critical step is estimated: large against
    /// the rounding of the forces, small against strains at which the stiffness changes.
    pub(crate) fn reach(self) -> f64 {
        match self {
            Precision::Double => 1e-6,
            Precision::Single => 3e-3,
        }
    }
}

/// Kernel and instruction set for the internal forces of a body; known before the first evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KernelInfo {
    /// The kernel.
    pub kernel: Kernel,
    /// Instruction set that the kernel runs on; `None` for the plain loop, which has no vector code.
    pub path: Option<LanePath>,
    /// Precision of the forces.
    pub precision: Precision,
}

impl KernelInfo {
    /// Returns the name for records, with the precision if it is single.
    pub fn name(self) -> String {
        match self.precision {
            Precision::Double => self.kernel.name().into(),
            Precision::Single => format!("single-precision {}", self.kernel.name()),
        }
    }
}

/// Lane kernel with the tables of one body.
pub(super) trait Engine: Send + Sync {
    /// The kernel's name.
    fn kernel(&self) -> Kernel;

    /// Computes internal forces, N. Returns false if `J` is not positive somewhere.
    fn forces(&mut self, path: LanePath, u: &[Vector3], f: &mut [Vector3]) -> bool;
}
