"""tissuebench: verification and benchmarks of soft-tissue solvers.

>>> import tissuebench as tb
>>> scene = tb.load("cases/scenes/kidney/kidney-fair.toml")
>>> run = scene.run("tet4-nodal", progress=tb.printed())
>>> run["tool-force"]

Numbers are SI. Errors are `SceneError` and `RunError`, with `file`, `line` and `key`.
"""

from ._engine import (
    Mesh,
    Problem,
    Results,
    Run,
    Scene,
    ShapeTable,
    Study,
    Table,
    Transposed,
    load,
    parse,
    read,
    schemes,
    transfer,
    verify,
)
from ._errors import Error, RunError, SceneError
from ._progress import printed

__all__ = [
    "Error",
    "Mesh",
    "Problem",
    "Results",
    "Run",
    "RunError",
    "Scene",
    "SceneError",
    "ShapeTable",
    "Study",
    "Table",
    "Transposed",
    "load",
    "parse",
    "printed",
    "read",
    "schemes",
    "transfer",
    "verify",
]
