"""The engine. Numbers are SI: metres, newtons, pascals, seconds."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Path = str | PathLike[str]
Floats = NDArray[np.float64]
Event = dict[str, Any]
"""An event with its name under `event`: `begin` (`runs`), `start`, `step` (`load`, `iterations`, `tool-forces`), `done` or
`failed` (`reason`); each of a run has `case`, `method` and `run`."""

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
    """Records, one number a row. polars, pyarrow, pandas and duckdb take it over without a copy: `polars.DataFrame(table)`."""

    @property
    def columns(self) -> list[str]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, name: str, /) -> Any:
        """A column: numbers as an array of its own, absent ones as nan; texts as a list."""

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...
    def __arrow_c_schema__(self) -> object: ...

@final
class Mesh:
    """Tetrahedra or hexahedra; the nodes of a cell in VTK's order."""

    def __new__(cls, points: ArrayLike, cells: ArrayLike) -> Mesh:
        """From whole numbers of nodes; a cell that is inverted or flat is refused."""

    @staticmethod
    def read(path: Path, unit: str = "mm") -> Mesh: ...
    def write(self, path: Path, unit: str = "mm", version: str | None = None) -> None:
        """Writes .msh, .inp, .vtu or the boundary as .stl, by the name; `version` of a .msh is "2.2" (unless given) or "4.1"."""

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
    """Shape functions at points, as an operator: `table @ u` are the values there, `table.T @ f` nodal forces."""

    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def points(self) -> Floats: ...
    @property
    def weights(self) -> Floats | None: ...
    @property
    def outside(self) -> int | None:
        """How many of the points lie outside, where that is known."""

    @property
    def T(self) -> Transposed: ...
    @property
    def csr(self) -> tuple[Floats, NDArray[np.uint32], NDArray[np.int64]]:
        """`(data, indices, indptr)` as `scipy.sparse.csr_matrix` takes them."""

    def values(self, u: ArrayLike) -> Floats: ...
    def gradients(self, u: ArrayLike) -> Floats:
        """`du_i / dX_j`, (points, 3, 3), where the table has gradients."""

    def __matmul__(self, u: ArrayLike, /) -> Floats: ...

@final
class Transposed:
    @property
    def shape(self) -> tuple[int, int]: ...
    def __matmul__(self, forces: ArrayLike, /) -> Floats: ...

@final
class Run:
    """One finished run."""

    @property
    def case(self) -> str: ...
    @property
    def method(self) -> str: ...
    @property
    def status(self) -> str:
        """`ok`, or how it ended early."""

    @property
    def failure(self) -> Exception | None:
        """Why it ended early, where it did."""

    @property
    def nodes(self) -> int: ...
    @property
    def dofs(self) -> int: ...
    @property
    def seconds(self) -> float | None:
        """Median seconds of a pass."""

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
        """Displacement at the scene's probes, (probes, 3)."""

    @property
    def mesh(self) -> Mesh:
        """The undeformed body, where `states` were asked for; so the others below."""

    @property
    def times(self) -> Floats: ...
    @property
    def displacements(self) -> Floats:
        """(states, points, 3)."""

    @property
    def displacement(self) -> Floats:
        """(points, 3), at the last state."""

@final
class Results:
    """Runs of one scene."""

    @property
    def runs(self) -> list[Run]: ...
    @property
    def failures(self) -> list[tuple[str, Exception]]: ...
    def __getitem__(self, method: str, /) -> Run:
        """A method's run; its failure is raised."""

    def __len__(self) -> int: ...
    @property
    def records(self) -> Table: ...
    def add(self, run: Run) -> None:
        """Adds a run of the same scene; one that is there already is refused."""

    def write(self, out: Path) -> None:
        """Writes a folder of results with its report."""

@final
class Problem:
    """A method's problem for a solver of one's own."""

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
        """Load steps of the scene."""

    @property
    def fixed(self) -> tuple[NDArray[np.int64], Floats]:
        """Prescribed components by `3 node + axis`, and their values."""

    @property
    def force(self) -> Floats:
        """Consistent nodal forces of all loads, (nodes, 3)."""

    @property
    def tools(self) -> list[Tool]: ...
    @property
    def quadrature(self) -> ShapeTable: ...
    def table(self, points: ArrayLike, *, gradients: bool = False) -> ShapeTable:
        """The shape functions at points of the body."""

    def compare(
        self,
        u: ArrayLike,
        *,
        tool_forces: ArrayLike | None = None,
        seconds: float | None = None,
        solver: str = "own",
    ) -> Run:
        """Compares a displacement, (nodes, 3) at the end or (steps, nodes, 3), with the scene's reference.

        `tool_forces` are the forces of the tools along their ways, (tools,), or nodal forces that they exert on the body,
        (tools, nodes, 3); by the scene's contact law where they are not given. A displacement that misses what supports prescribe by more
        than 1 % of the largest is refused.
        """

@final
class Scene:
    """A scene that has been checked."""

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
        """Runs one method. `states` keeps the displacement, `frames` runs the scene's loop of frames, `once` repeats no timing."""

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
    """Reads a scene from text; `file` names it in messages, and paths in it are relative to its folder."""

def read(results: Path) -> Table:
    """The records in a folder of results."""

def schemes() -> list[str]: ...
def transfer(
    scheme: str, nodes: ArrayLike, targets: ArrayLike, *, mesh: Mesh | None = None, **parameters: float | bool
) -> ShapeTable:
    """The table of a transfer scheme, by its name and parameters as in scenes."""

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
