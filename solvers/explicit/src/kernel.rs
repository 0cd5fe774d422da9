//! Names of the kernels for internal forces, for plans and records.

use lanes::LanePath;

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
    /// Rows of any length, eight points at a time.
    Rows,
    /// One point after another on one thread, several times slower. Used for dilation groups other than those
    /// above, and for all groups if a law does not split into a part for shape change and a part for volume
    /// change (linear, St. Venant-Kirchhoff).
    Plain,
}

impl Kernel {
    /// All kernels.
    pub const ALL: [Kernel; 6] = [
        Kernel::Tet4,
        Kernel::Tet4NodalDilation,
        Kernel::Hex8,
        Kernel::Hex8MeanDilation,
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
            Kernel::Rows => "rows",
            Kernel::Plain => "plain",
        }
    }

    /// Whether the kernel uses vector code and all threads.
    pub fn is_parallel(self) -> bool {
        self != Kernel::Plain
    }
}

/// Kernel and instruction set for the internal forces of a body; known before the first evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KernelInfo {
    /// The kernel.
    pub kernel: Kernel,
    /// Instruction set that the kernel runs on; `None` for the plain loop, which has no vector code.
    pub path: Option<LanePath>,
}
