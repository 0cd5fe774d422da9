"""FElupe: linear and neo-Hookean solids of one material, Newton's method with PARDISO, or SciPy's sparse LU."""
import json
import sys
import time
from pathlib import Path

import felupe
import numpy as np

try:
    from pypardiso import spsolve

    SOLVER = "PARDISO"
except ImportError:
    from scipy.sparse.linalg import spsolve

    SOLVER = "SciPy"

problem, answer = map(Path, sys.argv[1:3])
KINDS = {
    "tet4": ("tetra", felupe.RegionTetra),
    "tet10": ("tetra10", felupe.RegionQuadraticTetra),
    "hex8": ("hexahedron", felupe.RegionHexahedron),
    "hex20": ("hexahedron20", felupe.RegionQuadraticHexahedron),
}


def law(m):
    if m["law"] == "neo-hookean":
        return felupe.NeoHookeCompressible(mu=m["mu"], lmbda=m["lambda"])
    if m["law"] == "neo-hookean-isochoric":
        return felupe.NeoHooke(mu=m["mu"], bulk=m["bulk"])
    return felupe.LinearElastic(E=m["young"], nu=m["poisson"])


def solve(text, load):
    """Displacement of the nodes at the end of each load step, and the iterations of all."""
    kind, region = KINDS[text["element"]]
    mesh = felupe.Mesh(load("nodes"), load("cells"), cell_type=kind)
    u = felupe.Field(region(mesh), dim=3)
    field = felupe.FieldContainer([u])
    solid = felupe.SolidBody(law(text["materials"][0]), field)
    force, fixed = load("force").ravel(), load("fixed")
    held = (3 * fixed[:, 0] + fixed[:, 1]).astype(int)
    free = np.setdiff1d(np.arange(u.values.size), held)
    steps, found, iterations = max(text["procedure"]["steps"], 1), [], 0
    for step in range(1, steps + 1):
        f, target = force * step / steps, fixed[:, 2] * step / steps
        for trial in range(text["procedure"]["iterations"] + 1):
            values = u.values.ravel()
            residual = f - solid.assemble.vector(field).toarray().ravel()
            scale = max(np.linalg.norm(f), np.linalg.norm(residual - f)) or 1.0
            still = np.allclose(values[held], target, rtol=1e-12, atol=0)
            if still and np.linalg.norm(residual[free]) <= text["procedure"]["tolerance"] * scale:
                break
            if trial == text["procedure"]["iterations"]:
                if text["procedure"]["kind"] == "linear":
                    break
                return found, iterations, (step - 1) / steps
            K = solid.assemble.matrix(field).tocsr()
            move = np.zeros_like(values)
            move[held] = target - values[held]
            move[free] = spsolve(K[free][:, free], (residual - K @ move)[free])
            u.values[:] += move.reshape(-1, 3)
            iterations += 1
        found.append(u.values.copy())
    return found, iterations, None


start = time.perf_counter()
text = json.loads((problem / "problem.json").read_text())
result = {"status": "ok", "problem": text["id"], "version": f"FElupe {felupe.__version__}, {SOLVER}"}
if len(text["materials"]) > 1:
    result |= {"status": "refused", "message": "this adapter supports one material only"}
else:
    found, iterations, reached = solve(text, lambda name: np.load(problem / f"{name}.npy"))
    result |= {"counts": {"iterations": iterations}, "phases": {"solve": time.perf_counter() - start}}
    if reached is not None:
        result |= {"status": "stalled", "message": f"no equilibrium beyond {reached} of the load"}
    elif len(found) > 1:
        np.save(answer / "displacement.npy", np.stack(found))
    else:
        np.save(answer / "displacement.npy", found[0])
(answer / "result.json").write_text(json.dumps(result))
