"""NGSolve: linear and neo-Hookean solids by its H1 elements, Newton's method on the energy with its sparse Cholesky factors."""
import json
import sys
import time
from pathlib import Path

import netgen.meshing as nm
import ngsolve as ng
import numpy as np

problem, answer = map(Path, sys.argv[1:3])
TET_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
# Corners, and points of integration as ours.
KINDS = {"tet4": (4, ng.TET, 1), "tet10": (4, ng.TET, 2), "hex8": (8, ng.HEX, 3)}


def energy(law, of, u):
    """Strain energy over the volume; `of` has a constant of each material."""
    mu, H = of("mu"), ng.Grad(u)
    if law == "linear":
        e = ng.Sym(H)
        return mu * ng.InnerProduct(e, e) + of("lambda") / 2 * ng.Trace(e) ** 2
    J, I1 = ng.Det(ng.Id(3) + H), 3 + 2 * ng.Trace(H) + ng.InnerProduct(H, H)
    if law == "neo-hookean":
        return mu / 2 * (I1 - 3) - mu * ng.log(J) + of("lambda") / 2 * ng.log(J) ** 2
    return mu / 2 * (I1 * J ** (-2 / 3) - 3) + of("bulk") / 2 * (J - 1) ** 2


def meshed(nodes, cells, regions, corners):
    """The mesh of the corners, our nodes in the order of its vertices and edges, and the ends of the edges."""
    used, numbers = np.unique(cells[:, :corners], return_inverse=True)
    numbers, mesh = numbers.reshape(-1, corners), nm.Mesh(dim=3)
    points = [mesh.Add(nm.MeshPoint(nm.Pnt(*map(float, nodes[node])))) for node in used]
    for region in range(regions.max() + 1):
        mesh.SetMaterial(region + 1, f"r{region}")
    for row, region in zip(numbers, regions):
        mesh.Add(nm.Element3D(int(region) + 1, [points[node] for node in row]))
    mesh = ng.Mesh(mesh)
    if cells.shape[1] != 10:
        return mesh, used, np.empty((0, 2), int)
    middle = {}
    for at, pair in enumerate(TET_EDGES):
        middle.update(zip(map(tuple, np.sort(numbers[:, pair], axis=1)), cells[:, 4 + at]))
    ends = np.array([sorted(v.nr for v in edge.vertices) for edge in mesh.edges])
    return mesh, np.append(used, [middle[tuple(edge)] for edge in ends]), ends


def solve(text, load):
    """Status, and displacement of the nodes at the end of each load step with all iterations."""
    nodes, cells, regions, fixed, force = map(load, ("nodes", "cells", "regions", "fixed", "force"))
    (corners, kind, degree), procedure = KINDS[text["element"]], text["procedure"]
    mesh, order, ends = meshed(nodes, cells, regions, corners)
    edges = len(nodes) - len(ends)
    if np.abs(nodes[order[edges:]] - nodes[order[ends]].mean(axis=1)).max(initial=0) > 1e-9 * np.ptp(nodes):
        return {"status": "refused", "message": "this adapter does not pass curved edges to NGSolve"}, []
    space = ng.VectorH1(mesh, order=2 if len(ends) else 1)
    form, rule = ng.BilinearForm(space), {kind: ng.IntegrationRule(kind, degree)}
    of = lambda name: mesh.MaterialCF({f"r{at}": m[name] for at, m in enumerate(text["materials"])})
    form += ng.Variation(energy(text["materials"][0]["law"], of, space.TrialFunction()) * ng.dx(intrules=rule))
    # The function of an edge is minus half the product of those of its ends: minus an eighth in the middle.
    goal, held, force = np.zeros(nodes.shape), np.zeros(nodes.shape, bool), force[order]
    node, axis = fixed[:, :2].astype(int).T
    goal[node, axis], held[node, axis] = fixed[:, 2], True
    goal, held = goal[order], held[order].T.ravel()
    goal[edges:] = -8 * (goal[edges:] - goal[ends].mean(axis=1))
    np.add.at(force, ends, force[edges:, None] / 2)
    force[edges:] /= -8
    goal, force, free = goal.T.ravel(), force.T.ravel(), ng.BitArray([not h for h in held.tolist()])
    u, inner, move = (ng.GridFunction(space).vec for _ in range(3))
    x, r, d = (vector.FV().NumPy() for vector in (u, inner, move))
    steps, found, result = max(procedure["steps"], 1), [], {"status": "ok", "counts": {"iterations": 0}}
    for part in np.arange(1, steps + 1) / steps:
        for trial in range(procedure["iterations"] + 1):
            form.Apply(u, inner)
            scale = max(part * np.linalg.norm(force), np.linalg.norm(r))
            r[:] = part * force - r
            there = np.allclose(x[held], part * goal[held], rtol=1e-12, atol=0)
            done = np.linalg.norm(r[~held]) <= procedure["tolerance"] * scale or (trial and procedure["kind"] == "linear")
            if there and done:
                break
            if trial == procedure["iterations"] or not np.isfinite(r).all():
                return {"status": "stalled", "message": f"no equilibrium at {part} of the load"}, []
            form.AssembleLinearization(u)
            d[:] = np.where(held, part * goal - x, 0)
            inner.data -= form.mat * move
            u.data += move + form.mat.Inverse(free, inverse="sparsecholesky") * inner
            result["counts"]["iterations"] += 1
        values = x.reshape(3, -1).T
        found.append(np.empty(nodes.shape))
        found[-1][order] = np.vstack([values[:edges], values[ends].mean(axis=1) - values[edges:] / 8])
    return result, found


start, text = time.perf_counter(), json.loads((problem / "problem.json").read_text())
with ng.TaskManager():
    result, found = solve(text, lambda name: np.load(problem / f"{name}.npy"))
if found:
    np.save(answer / "displacement.npy", np.stack(found) if len(found) > 1 else found[0])
result |= {"problem": text["id"], "phases": {"solve": time.perf_counter() - start}}
(answer / "result.json").write_text(json.dumps(result))
