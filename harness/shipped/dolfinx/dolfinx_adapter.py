"""DOLFINx: linear elasticity by conjugate gradients with PETSc's algebraic multigrid, the rigid motions as its near null space."""
import json
import sys
import time
from pathlib import Path

import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

problem, answer = map(Path, sys.argv[1:3])
# Cell, degree, degree of integration as ours has it, and where theirs has VTK's corners.
KINDS = {
    "tet4": ("tetrahedron", 1, 1, (0, 1, 2, 3)),
    "tet10": ("tetrahedron", 2, 2, (0, 1, 2, 3)),
    "hex8": ("hexahedron", 1, 3, (0, 1, 3, 2, 4, 5, 7, 6)),
}
# Residual over that at the start, of the equations and not of the preconditioned ones.
OPTIONS = """-ksp_type cg -ksp_rtol 1e-8 -ksp_norm_type unpreconditioned -pc_type gamg -mg_levels_ksp_type chebyshev \
-mg_levels_pc_type jacobi -mg_levels_esteig_ksp_type cg -mg_levels_ksp_chebyshev_esteig_steps 20"""


def order(points, scale):
    """Rows sorted by position, of points that are apart by more than `scale`."""
    return np.lexsort(np.rint(points / scale).T)


def rigid(x):
    """The six rigid motions at points, one row each."""
    moves = np.zeros((6, len(x), 3))
    for a, b in ((0, 1), (1, 2), (2, 0)):
        moves[a, :, a], moves[3 + a, :, a], moves[3 + a, :, b] = 1, -x[:, b], x[:, a]
    return np.linalg.qr(moves.reshape(6, -1).T)[0].T


def solve(text, load):
    if not hasattr(fem, "VectorFunctionSpace"):
        return {"status": "refused", "message": "this adapter supports DOLFINx 0.5 to 0.7 only"}, None
    nodes, cells, regions, fixed = map(load, ("nodes", "cells", "regions", "fixed"))
    cell, degree, points, corners = KINDS[text["element"]]
    used, numbers = np.unique(cells[:, : len(corners)], return_inverse=True)
    numbers, linear = numbers.reshape(len(cells), -1)[:, list(corners)], ufl.VectorElement("Lagrange", cell, 1)
    body = mesh.create_mesh(MPI.COMM_SELF, numbers.astype(np.int64), nodes[used], ufl.Mesh(linear))
    V, constants = fem.VectorFunctionSpace(body, ("Lagrange", degree)), fem.FunctionSpace(body, ("DG", 0))
    x = V.tabulate_dof_coordinates()
    # A shift that puts no position of a regular mesh between two of those that positions are rounded to.
    origin, scale = nodes.min(axis=0) - 0.2371e-6 * np.ptp(nodes), 1e-6 * np.ptp(nodes)
    node_of, ours = np.empty(len(nodes), dtype=int), order(nodes - origin, scale)
    node_of[order(x - origin, scale)] = ours
    if np.abs(x - nodes[node_of]).max() > scale:
        return {"status": "refused", "message": "this adapter does not pass curved edges to DOLFINx"}, None
    times.append(time.process_time())
    lam, mu, found = fem.Function(constants), fem.Function(constants), fem.Function(V)
    region = regions[np.asarray(body.topology.original_cell_index)]
    for values, key in ((lam, "lambda"), (mu, "mu")):
        values.x.array[:] = np.array([m[key] for m in text["materials"]])[region]
    u, v = ufl.TrialFunction(V), ufl.TestFunction(V)
    stress = lam * ufl.tr(ufl.sym(ufl.grad(u))) * ufl.Identity(3) + 2 * mu * ufl.sym(ufl.grad(u))
    form = fem.form(ufl.inner(stress, ufl.sym(ufl.grad(v))) * ufl.dx(metadata={"quadrature_degree": points}))
    place = np.argsort(node_of).astype(np.int32)
    rows = 3 * place[fixed[:, 0].astype(int)] + fixed[:, 1].astype(np.int32)
    K = petsc.assemble_matrix(form)
    K.assemble()
    values, b = found.x.array, load("force")[node_of].ravel()
    values[rows] = fixed[:, 2]
    right, start = K.createVecLeft(), K.createVecRight()
    right.array[:], start.array[:] = b, values
    K.zeroRowsColumns(rows, 1.0, start, right)
    K.setNearNullSpace(PETSc.NullSpace().create(vectors=[PETSc.Vec().createWithArray(m) for m in rigid(x)]))
    times.append(time.process_time())
    PETSc.Options().insertString(OPTIONS)
    solver = PETSc.KSP().create(K.comm)
    solver.setOperators(K)
    solver.setFromOptions()
    solver.setInitialGuessNonzero(True)
    solver.solve(right, start)
    if (reason := solver.getConvergedReason()) <= 0:
        return {"status": "failed", "message": f"conjugate gradients did not converge (PETSc reason {reason})"}, None
    moved = np.empty(nodes.shape)
    moved[node_of] = start.array.reshape(-1, 3)
    return {"status": "ok", "counts": {"iterations": solver.getIterationNumber()}}, moved


# Seconds of processors: those of a mesh, and of finding our nodes in it, are no part of a comparison of solvers.
times = [time.process_time()]
text = json.loads((problem / "problem.json").read_text())
result, u = solve(text, lambda name: np.load(problem / f"{name}.npy"))
times.append(time.process_time())
if u is not None:
    np.save(answer / "displacement.npy", u)
phases = {name: times[at + 1] - times[at] for at, name in enumerate(("mesh", "assemble", "solve")[: len(times) - 1])}
(answer / "result.json").write_text(json.dumps(result | {"problem": text["id"], "phases": phases}))
