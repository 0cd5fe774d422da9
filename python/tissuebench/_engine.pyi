"""The compiled module. All numbers are in SI units: metres, newtons, pascals, seconds."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Path = str | PathLike[str]
Floats = NDArray[np.float64]
Event = dict[str, Any]
"""A progress event. The name is stored under `event`: `begin` (`runs`), `start`, `step` (`load`, `iterations`, `tool-forces`), `done` or
`failed` (`reason`). All events of a run have `case`, `method` and `run`."""

class Tool(TypedDict):
    name: str
    along: tuple[float, float, float]
    closure: float | None

class Check(TypedDict):
    case: str
    method: str
    metric: str
    value: float | None
    bound: str
    status: str
    reason: str

@final
class Table:
    """Records with one number per row. polars, pyarrow, pandas and duckdb read the table without a copy: `polars.DataFrame(table)`."""

    @property
    def columns(self) -> list[str]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, name: str, /) -> Any:
        """Returns a column: numbers as a new array with nan for missing values, texts as a list."""

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...
    def __arrow_c_schema__(self) -> object: ...

@final
class Mesh:
    """A mesh of tetrahedra or hexahedra, with the nodes of a cell in VTK's order."""

    def __new__(cls, points: ArrayLike, cells: ArrayLike) -> Mesh:
        """Creates a mesh from points (n, 3) and cells of node numbers; inverted or flat cells are refused."""

    @staticmethod
    def read(path: Path, unit: str = "mm") -> Mesh: ...
    def write(self, path: Path, unit: str = "mm", version: str | None = None) -> None:
        """Writes .msh, .inp, .vtu, or the boundary as .stl, according to the file name; `version` of a .msh is "2.2" (default) or "4.1"."""

    @property
    def points(self) -> Floats: ...
    @property
    def cells(self) -> NDArray[np.uint32]: ...
    @property
    def element(self) -> str | None: ...
    @property
    def regions(self) -> NDArray[np.uint16]: ...
    @property
    def region_names(self) -> list[str]: ...

@final
class ShapeTable:
    """Shape functions at points, as an operator: `table @ u` gives values at the points, and `table.T @ f` gives nodal forces."""

    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def points(self) -> Floats: ...
    @property
    def weights(self) -> Floats | None: ...
    @property
    def outside(self) -> int | None:
        """Number of points outside the nodes' hull or the mesh; None if unknown."""

    @property
    def T(self) -> Transposed: ...
    @property
    def csr(self) -> tuple[Floats, NDArray[np.uint32], NDArray[np.int64]]:
        """`(data, indices, indptr)` in the format of `scipy.sparse.csr_matrix`."""

    def values(self, u: ArrayLike) -> Floats: ...
    def gradients(self, u: ArrayLike) -> Floats:
        """Returns `du_i / dX_j`, (points, 3, 3), if the table has gradients."""

    def __matmul__(self, u: ArrayLike, /) -> Floats: ...

@final
class Transposed:
    @property
    def shape(self) -> tuple[int, int]: ...
    def __matmul__(self, forces: ArrayLike, /) -> Floats: ...

@final
class Run:
    """A finished run."""

    @property
    def case(self) -> str: ...
    @property
    def method(self) -> str: ...
    @property
    def status(self) -> str:
        """`ok`, or the kind of early end."""

    @property
    def failure(self) -> Exception | None:
        """Reason of an early end, or None."""

    @property
    def nodes(self) -> int: ...
    @property
    def dofs(self) -> int: ...
    @property
    def seconds(self) -> float | None:
        """Median time of a pass, s."""

    @property
    def metrics(self) -> dict[str, float]: ...
    def __getitem__(self, name: str, /) -> float: ...
    def __contains__(self, name: str, /) -> bool: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def records(self) -> Table: ...
    @property
    def probes(self) -> Floats:
        """Displacement at the scene's probes, m, (probes, 3)."""

    @property
    def mesh(self) -> Mesh:
        """The undeformed body. This property and the properties below need a run with `states=True`."""

    @property
    def times(self) -> Floats: ...
    @property
    def displacements(self) -> Floats:
        """Displacement of the points of the mesh at each state, m, (states, points, 3)."""

    @property
    def displacement(self) -> Floats:
        """Displacement of the points of the mesh at the last state, m, (points, 3)."""

@final
class Results:
    """Runs of one scene."""

    @property
    def runs(self) -> list[Run]: ...
    @property
    def failures(self) -> list[tuple[str, Exception]]: ...
    def __getitem__(self, method: str, /) -> Run:
        """Returns the run of a method, or raises the failure of the method."""

    def __len__(self) -> int: ...
    @property
    def records(self) -> Table: ...
    def add(self, run: Run) -> None:
        """Adds a run of the same scene; a run that already exists is refused."""

    def write(self, out: Path) -> None:
        """Writes a folder of results with its report."""

@final
class Problem:
    """The problem of a method, for a solver of the user."""

    @property
    def method(self) -> str: ...
    @property
    def nodes(self) -> Floats: ...
    @property
    def cells(self) -> NDArray[np.uint32]: ...
    @property
    def mesh(self) -> Mesh: ...
    @property
    def interpolates(self) -> bool:
        """Whether nodal parameters are displacements, as on a mesh."""

    @property
    def steps(self) -> int:
        """Number of load steps of the scene."""

    @property
    def fixed(self) -> tuple[NDArray[np.int64], Floats]:
        """Prescribed components by their number `3 node + axis`, and their values, m."""

    @property
    def force(self) -> Floats:
        """Consistent nodal forces of all loads, N, (nodes, 3)."""

    @property
    def tools(self) -> list[Tool]: ...
    @property
    def quadrature(self) -> ShapeTable: ...
    def table(self, points: ArrayLike, *, gradients: bool = False) -> ShapeTable:
        """Returns the shape functions at points of the body."""

    def compare(
        self,
        u: ArrayLike,
        *,
        tool_forces: ArrayLike | None = None,
        seconds: float | None = None,
        solver: str = "own",
    ) -> Run:
        """Compares a displacement (m), (nodes, 3) at the end or (steps, nodes, 3), with the scene's reference.

        `tool_forces` (N) are the forces of the tools along their directions, (tools,), or their nodal forces on the body,
        (tools, nodes, 3); by default the forces follow from the scene's contact law. A displacement that differs from a prescribed
        displacement by more than 1 % of the largest displacement is refused.
        """

@final
class Scene:
    """A checked scene."""

    @property
    def file(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def methods(self) -> list[str]: ...
    def run(
        self,
        method: str,
        *,
        once: bool = True,
        states: bool = False,
        frames: bool = False,
        progress: Callable[[Event], object] | None = None,
    ) -> Run:
        """Runs one method. `states` keeps the displacement, `frames` runs the scene's loop of frames, and `once` times a single run."""

    def run_all(
        self,
        methods: Sequence[str] | None = None,
        *,
        once: bool = False,
        states: bool = False,
        frames: bool = True,
        progress: Callable[[Event], object] | None = None,
    ) -> Results: ...
    def problem(self, method: str) -> Problem: ...

@final
class Study:
    """A finished study."""

    @property
    def ok(self) -> bool: ...
    @property
    def records(self) -> Table: ...
    @property
    def checks(self) -> list[Check]: ...
    @property
    def failures(self) -> list[tuple[str, str, str]]:
        """`(case, method, reason)`."""

    def __len__(self) -> int: ...

def load(path: Path) -> Scene: ...
def parse(text: str, file: Path = "scene.toml") -> Scene:
    """Reads a scene from text; `file` is its name in messages, and paths in the scene are relative to the folder of `file`."""

def read(results: Path) -> Table:
    """Reads the records in a folder of results."""

def schemes() -> list[str]: ...
def transfer(
    scheme: str, nodes: ArrayLike, targets: ArrayLike, *, mesh: Mesh | None = None, **parameters: float | bool
) -> ShapeTable:
    """Builds the table of a transfer scheme, with the name and the parameters used in scenes."""

def verify(
    study: Path,
    *,
    out: Path = "results",
    quick: bool = False,
    cases: Sequence[str] = (),
    methods: Sequence[str] = (),
    tags: Sequence[str] = (),
    leave_out: Sequence[str] = (),
    resume: bool = False,
    jobs: int = 1,
    force: bool = False,
    progress: Callable[[Event], object] | None = None,
) -> Study: ...
