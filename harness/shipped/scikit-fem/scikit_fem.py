"""scikit-fem: linear elasticity with its P1, P2 and Q1 elements, solved by PARDISO, or SciPy's sparse LU."""
import json
import sys
import time
from pathlib import Path

import numpy as np
import skfem
from skfem.helpers import ddot, div, sym_grad

try:
    from pypardiso import spsolve

    SOLVER = "PARDISO"
except ImportError:
    from scipy.sparse.linalg import spsolve

    SOLVER = "SciPy"

problem, answer = map(Path, sys.argv[1:3])
# Element, order of integration as ours has it, and where VTK's corners of a hexahedron are among theirs.
KINDS = {
    "tet4": (skfem.MeshTet, skfem.ElementTetP1, 1, range(4)),
    "tet10": (skfem.MeshTet, skfem.ElementTetP2, 2, range(4)),
    "hex8": (skfem.MeshHex, skfem.ElementHex1, 3, (0, 3, 4, 1, 7, 2, 5, 6)),
}
TET_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))


@skfem.BilinearForm
def stiffness(u, v, w):
    return w["lam"] * div(u) * div(v) + 2 * w["mu"] * ddot(sym_grad(u), sym_grad(v))


def solve(text, load):
    nodes, cells, regions = load("nodes"), load("cells"), load("regions")
    kind, element, order, corners = KINDS[text["element"]]
    used, numbers = np.unique(cells[:, : len(corners)], return_inverse=True)
    numbers = numbers.reshape(len(cells), -1)
    mesh = kind(nodes[used].T.copy(), numbers[:, list(corners)].T.copy(), sort_t=len(corners) == 4)
    node_of = used  # our node of each point of theirs
    if text["element"] == "tet10":
        middle = {}
        for at, (a, b) in enumerate(TET_EDGES):
            ends = np.sort(numbers[:, (a, b)], axis=1)
            middle.update(zip(map(tuple, ends), cells[:, 4 + at]))
        node_of = np.append(used, [middle[tuple(sorted(edge))] for edge in mesh.edges.T])
        mesh = skfem.MeshTet2(nodes[node_of].T.copy(), mesh.t.copy())
    basis = skfem.Basis(mesh, skfem.ElementVector(element()), intorder=order)
    # Rows of vertices, and of edges behind them, are their degrees of freedom along x, y, z.
    dofs = np.hstack([basis.nodal_dofs] + ([basis.edge_dofs] if text["element"] == "tet10" else []))
    at_node = np.empty((len(nodes), 3), dtype=int)
    at_node[node_of] = dofs.T
    moduli = {
        name: np.array([m[key] for m in text["materials"]])[regions][:, None] + np.zeros(basis.dx.shape)
        for name, key in (("lam", "lambda"), ("mu", "mu"))
    }
    K = stiffness.assemble(basis, **moduli)
    times.append(time.perf_counter())
    f, u = np.zeros(basis.N), np.zeros(basis.N)
    f[at_node] = load("force")
    fixed = load("fixed")
    held = at_node[fixed[:, 0].astype(int), fixed[:, 1].astype(int)]
    u[held] = fixed[:, 2]
    return skfem.solve(*skfem.condense(K, f, x=u, D=held), solver=spsolve)[at_node]


times = [time.perf_counter()]
text = json.loads((problem / "problem.json").read_text())
u = solve(text, lambda name: np.load(problem / f"{name}.npy"))
times.append(time.perf_counter())
np.save(answer / "displacement.npy", u)
phases = {name: times[at + 1] - times[at] for at, name in enumerate(("assemble", "solve"))}
version = f"scikit-fem {skfem.__version__}, {SOLVER}"
result = {"status": "ok", "problem": text["id"], "version": version, "phases": phases}
(answer / "result.json").write_text(json.dumps(result))
