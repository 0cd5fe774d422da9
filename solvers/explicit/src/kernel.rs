//! Which kernel evaluates the internal forces, for plans and records.

use lanes::LanePath;

/// The kernels, chosen by table, dilation groups and laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// Tetrahedra of four nodes, eight at a time.
    Tet4,
    /// The same with nodal-mean dilation.
    Tet4NodalDilation,
    /// Trilinear hexahedra with eight Gauss points, eight elements at a time.
    Hex8,
    /// The same with one mean dilation per element.
    Hex8MeanDilation,
    /// Rows of any length, eight points at a time.
    Rows,
    /// One point after another on one thread: several times slower. It serves dilation groups other than those above, and
    /// all groups where a law is no sum of a part in the change of shape and one in that of volume (linear,
    /// St. Venant-Kirchhoff).
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

    /// Name for the record.
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

    /// Whether it runs in lanes and on all threads.
    pub fn is_parallel(self) -> bool {
        self != Kernel::Plain
    }
}

/// What evaluates the internal forces of a body; known before the first evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KernelInfo {
    /// The kernel.
    pub kernel: Kernel,
    /// Instructions of its lanes; none in the plain loop.
    pub path: Option<LanePath>,
}
