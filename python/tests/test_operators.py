"""Meshes, shape tables, transfer schemes, and solvers of one's own judged."""

import numpy as np
import pytest
import tissuebench as tb
from conftest import BLOCK


def test_a_mesh_goes_to_a_file_and_back(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]) * 1e-3
    cells = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])
    cells[1] = [1, 4, 2, 3]
    mesh = tb.Mesh(points, cells)
    assert mesh.element == "tet4" and mesh.region_names == ["body"] and list(mesh.regions) == [0, 0]
    for name in ["a.msh", "a.inp", "a.vtu"]:
        mesh.write(tmp_path / name)
        back = tb.Mesh.read(tmp_path / name)
        assert np.allclose(back.points, points, rtol=1e-15, atol=0) and np.array_equal(back.cells, cells)
    for version in ["2.2", "4.1"]:
        mesh.write(tmp_path / "b.msh", version=version)
        assert (tmp_path / "b.msh").read_text().startswith(f"$MeshFormat\n{version} 0 8\n")
        assert np.array_equal(tb.Mesh.read(tmp_path / "b.msh").cells, cells)
    with pytest.raises(tb.SceneError, match="version: '4.0'; give 2.2 or 4.1"):
        mesh.write(tmp_path / "c.msh", version="4.0")
    with pytest.raises(tb.SceneError, match="c.inp: version applies to Gmsh's format only; write a .msh file"):
        mesh.write(tmp_path / "c.inp", version="4.1")
    read = tb.Mesh.read(tmp_path / "b.msh")
    (tmp_path / "link.msh").hardlink_to(tmp_path / "b.msh")
    before = (tmp_path / "b.msh").read_bytes()
    for name in ["b.msh", "link.msh"]:
        with pytest.raises(tb.SceneError, match="is the input file of the mesh"):
            read.write(tmp_path / name)
    assert (tmp_path / "b.msh").read_bytes() == before
    assert not (tmp_path / "c.msh").exists() and not (tmp_path / "c.inp").exists()
    with pytest.raises(tb.SceneError, match="names node 9"):
        tb.Mesh(points, [[0, 1, 2, 9]])
    with pytest.raises(tb.SceneError, match="row 0 names node 0.9"):
        tb.Mesh(points, cells + 0.9)
    with pytest.raises(tb.SceneError, match="names node -1"):
        tb.Mesh(points, [[0, 1, 2, -1]])
    with pytest.raises(tb.SceneError, match="inverted"):
        tb.Mesh(points, [[0, 2, 1, 3]])
    with pytest.raises(tb.SceneError, match="5 nodes each"):
        tb.Mesh(points, [[0, 1, 2, 3, 4]])
    with pytest.raises(tb.SceneError, match="unit"):
        tb.Mesh.read(tmp_path / "a.msh", unit="inch")
    with pytest.raises(tb.SceneError) as none:
        tb.Mesh.read(tmp_path / "none.msh")
    assert str(none.value).count("none.msh") == 1


@pytest.mark.parametrize("method", ["tet4", "hex8", "hex20", "efg"])
def test_a_table_reproduces_linear_fields(block, method):
    problem = block.problem(method)
    inside = np.random.default_rng(1).uniform([1e-3] * 3, [39e-3, 39e-3, 19e-3], (20, 3))
    inside[:, :2] -= problem.nodes[:, :2].min(axis=0) * -1
    table = problem.table(inside, gradients=True)
    assert table.shape == (20, len(problem.nodes)) and table.outside == 0
    slope = np.array([[0.1, 0.2, 0.0], [0.0, -0.1, 0.3], [0.2, 0.0, 0.1]])
    u = problem.nodes @ slope.T
    assert np.allclose(table @ u, inside @ slope.T, atol=1e-9 * np.abs(u).max())
    assert np.allclose(table.gradients(u), slope, atol=1e-8)
    assert np.allclose(table @ np.ones(len(problem.nodes)), 1.0, atol=1e-12)


def test_a_table_is_a_sparse_matrix_with_a_transpose(block):
    problem = block.problem("hex8")
    table = problem.quadrature
    data, indices, indptr = table.csr
    dense = np.zeros(table.shape)
    for row in range(table.shape[0]):
        dense[row, indices[indptr[row] : indptr[row + 1]]] = data[indptr[row] : indptr[row + 1]]
    rng = np.random.default_rng(2)
    for columns in [1, 2, 3, 5]:
        u, f = rng.normal(size=(table.shape[1], columns)), rng.normal(size=(table.shape[0], columns))
        assert np.allclose(table @ u, dense @ u) and np.allclose(table.T @ f, dense.T @ f)
    flat = rng.normal(size=table.shape[1])
    assert np.allclose(table.values(flat), dense @ flat)
    assert table.T.shape == table.shape[::-1]
    assert np.isclose(table.weights.sum(), 40e-3 * 40e-3 * 20e-3)
    with pytest.raises(tb.SceneError, match=r"\[3, 3\]"):
        table @ np.zeros((3, 3))


def test_transfer_schemes_are_operators(block):
    nodes = np.stack(np.meshgrid(*[np.linspace(0, 1e-2, 4)] * 3, indexing="ij"), -1).reshape(-1, 3)
    targets = np.random.default_rng(3).uniform(2e-3, 8e-3, (10, 3))
    for scheme in set(tb.schemes()) - {"barycentric"}:
        table = tb.transfer(scheme, nodes, targets)
        assert (table @ nodes).shape == (10, 3)
    near = tb.transfer("inverse-distance", nodes, targets, neighbours=1)
    distance = np.linalg.norm(targets[:, None] - nodes[None], axis=2)
    assert np.array_equal(near @ nodes, nodes[distance.argmin(axis=1)])
    with pytest.raises(tb.SceneError, match="inverse-distance"):
        tb.transfer("inverse-distanc", nodes, targets)
    with pytest.raises(tb.SceneError, match="neighbour"):
        tb.transfer("inverse-distance", nodes, targets, neighbors=3)
    mesh = block.problem("tet4").mesh
    inside = mesh.points[mesh.cells].mean(axis=1)
    table = tb.transfer("barycentric", mesh.points, inside, mesh=mesh)
    assert np.allclose(table @ mesh.points, inside) and table.outside == 0


def assembled(problem, young, poisson):
    """Stiffness of linear elasticity, dense, from the quadrature alone."""
    table = problem.quadrature
    count = table.shape[1]
    # Gradients of all shape functions at all points: those of one unit vector at a time.
    b = np.stack([table.gradients(np.eye(count)[:, [node]] * [1.0, 0, 0])[:, 0, :] for node in range(count)], 1)
    mu, lam = young / (2 + 2 * poisson), young * poisson / (1 + poisson) / (1 - 2 * poisson)
    w = table.weights
    k = lam * np.einsum("q,qai,qbj->aibj", w, b, b) + mu * np.einsum("q,qaj,qbi->aibj", w, b, b)
    k += mu * np.einsum("q,qak,qbk,ij->aibj", w, b, b, np.eye(3))
    return k.reshape(3 * count, 3 * count)


def test_a_solver_of_ones_own_is_judged_in_three_lines(block):
    problem = block.problem("hex8")
    fixed, values = problem.fixed
    k, f = assembled(problem, 20e3, 0.45), problem.force.ravel()
    u = np.zeros(k.shape[0])
    u[fixed] = values
    free = np.setdiff1d(np.arange(len(u)), fixed)
    u[free] = np.linalg.solve(k[np.ix_(free, free)], f[free] - k[np.ix_(free, fixed)] @ values)
    # The three lines.
    judged = problem.compare(u.reshape(-1, 3), solver="numpy", seconds=0.5)
    ours = block.run("hex8")
    assert judged["rms"] == pytest.approx(ours["rms"], rel=1e-8)
    for name in ["rms-x", "relative-rms", "max-error", "max-z", "strain-energy"]:
        assert judged[name] == pytest.approx(ours[name], rel=1e-8), name
    assert judged["residual"] < 1e-8 and judged.seconds == 0.5
    assert set(judged.records["family"]) == {"external"} and set(judged.records["adapter"]) == {"numpy"}
    results = block.run_all(["tet4"], once=True)
    results.add(judged)
    assert len(results) == 2
    with pytest.raises(tb.SceneError, match="the results already have a run of hex8 by numpy"):
        results.add(judged)
    other = tb.parse(BLOCK.replace("1 kPa", "2 kPa"), "block.toml").run("hex8")
    with pytest.raises(tb.SceneError, match="another scene with the name block"):
        results.add(other)
    assert len(results) == 2


def test_a_displacement_of_our_own_has_our_own_errors(block):
    for method in ["tet4", "hex20"]:
        run = block.run(method, states=True)
        again = block.problem(method).compare(run.displacement)
        for name in ["rms", "max-error", "peak-error"]:
            assert again[name] == run[name], name


@pytest.mark.parametrize(
    "u, says",
    [
        (np.zeros((3, 3)), "3 nodes; the problem has 75"),
        (np.zeros((75, 2)), "give \\(n, 3\\)"),
        (np.zeros((2, 75, 3)), "2 displacement fields"),
        (np.full((75, 3), np.nan), "node 0 is not finite"),
        (np.zeros(75), "shape"),
        (np.full((75, 3), 1e-3), "differs by 1e-3 m along [xyz] from the 0e0 m"),
    ],
)
def test_what_is_no_displacement_is_refused(block, u, says):
    with pytest.raises(tb.SceneError, match=says):
        block.problem("hex8").compare(u)


def test_what_no_folder_of_results_can_hold_is_refused(block):
    u, problem = block.run("hex8", states=True).displacement, block.problem("hex8")
    with pytest.raises(tb.Error, match="finite"):
        problem.compare(u * 1e300)
    for seconds in [np.nan, np.inf, -1.0]:
        with pytest.raises(tb.SceneError, match="seconds: "):
            problem.compare(u, seconds=seconds)
    for solver in ["", "x" * 65, "a\x1b[31m"]:
        with pytest.raises(tb.SceneError, match="solver: "):
            problem.compare(u, solver=solver)


def test_contact_forces_of_a_displacement_are_those_of_the_scene(root):
    scene = tb.parse(PLATE, "plate.toml")
    run = scene.run("hex8", states=True)
    problem = scene.problem("hex8")
    assert problem.steps == 2 and problem.tools[0]["closure"] == pytest.approx(2e-3)
    by_steps = problem.compare(run.displacements[-2:])
    at_end = problem.compare(run.displacement)
    assert run["tool-force"] > 0
    for judged in [by_steps, at_end]:
        assert judged["tool-force"] == pytest.approx(run["tool-force"], rel=1e-9)
        assert judged["tool-force-error"] == pytest.approx(run["tool-force-error"], rel=1e-6)
        assert judged["strain-energy"] == pytest.approx(run["strain-energy"], rel=1e-9)
    given = problem.compare(run.displacement, tool_forces=[2.0])
    assert given["tool-force"] == 2.0
    nodal = np.zeros((1, len(problem.nodes), 3))
    nodal[0, 0] = [0.1, 0.2, -1.5]
    assert problem.compare(run.displacement, tool_forces=nodal)["tool-force"] == 1.5
    with pytest.raises(tb.SceneError, match="2 tool forces given"):
        problem.compare(run.displacement, tool_forces=[1.0, 2.0])


PLATE = """
title = "A block under a plate"
body = { shape = "box", size = ["20 mm", "20 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.3 }
support = [{ on = "z-min", fix = "xyz" }]
tool = [{ name = "plate", shape = "plate", at = ["0 mm", "0 mm", "20 mm"], along = [0, 0, -1], drive = { closure = "2 mm" }, penalty = "0.5 MPa/mm" }]
procedure = { kind = "static", steps = 2 }
reference = { method = "hex20", size = { cells = [3, 3, 3] } }
method = [
    { id = "hex8", family = "fem", element = "hex8", size = { cells = [4, 4, 4] } },
    { id = "hex20", family = "fem", element = "hex20", size = { cells = [2, 2, 2] } },
]
"""
