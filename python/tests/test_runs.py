"""Scenes and studies: the same numbers as by the command, progress, Ctrl-C, errors with their place."""

import json
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import tissuebench as tb

KIDNEY = "cases/scenes/kidney/kidney-fair.toml"


def test_the_example_of_the_readme_gives_the_jaw_force_of_the_command_bit_for_bit(root, command):
    example = re.search(r'python -c "(import tissuebench[^\n]*)"\n', (root / "README.md").read_text())
    assert example, "the README has an example"
    method = re.search(r"run\('([a-z0-9-]+)'\)\['tool-force'\]", example[1])
    assert method, example[1]
    printed = subprocess.run([sys.executable, "-c", example[1]], cwd=root, capture_output=True, text=True, check=True)
    answer = json.loads(command("run", KIDNEY, "--method", method[1], "--once", "--format", "json"))
    by_command = answer["metrics"]["tool-force"]["value"]
    assert float(printed.stdout).hex() == float(by_command).hex()


def test_a_run_has_metrics_probes_and_the_displacement(block):
    run = block.run("hex8", states=True)
    assert run.status == "ok" and run.failure is None and run.nodes == 75
    assert run["rms"] == run.metrics["rms"] > 0
    assert "max-z" in run and "nonsense" not in run
    with pytest.raises(KeyError):
        run["nonsense"]
    u = run.displacement
    assert u.shape == run.mesh.points.shape == (75, 3)
    assert np.array_equal(run.displacements[-1], u) and list(run.times) == [1.0]
    assert np.abs(u[:, 2]).max() == run["max-z"] or run["max-z"] > 0
    top = np.flatnonzero((run.mesh.points == [0.0, 0.0, 0.02]).all(axis=1))
    if len(top) == 1:
        assert np.allclose(run.probes[0], u[top[0]], rtol=1e-12)
    assert run.seconds > 0


def test_runs_of_a_scene_are_a_folder_of_results(block, tmp_path):
    results = block.run_all(["tet4", "hex8"], once=True)
    assert len(results) == 2 and results.failures == []
    assert results["tet4"]["rms"] > results["hex8"]["rms"]
    results.write(tmp_path / "out")
    assert (tmp_path / "out/report/report.html").exists()
    assert len(tb.read(tmp_path / "out")) == len(results.records)


def test_progress_is_reported_in_order(block):
    events = []
    block.run_all(["tet4", "efg"], once=True, progress=events.append)
    kinds = [event["event"] for event in events if event["event"] != "step"]
    assert kinds == ["begin", "start", "done", "start", "done"]
    assert events[0]["runs"] == 2 and events[1]["method"] == "tet4"


def test_printed_progress_is_a_line(block):
    import io

    out = io.StringIO()
    block.run_all(["tet4"], once=True, progress=tb.printed(out))
    assert out.getvalue().rstrip().endswith("1 of 1  block tet4")


def test_an_exception_of_progress_ends_the_run(block):
    def progress(event):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        block.run("tet4", progress=progress)


def test_ctrl_c_ends_a_long_run_at_once(root):
    code = f"""
import sys, time
import tissuebench as tb
def progress(event):
    if event["event"] == "start":
        print("started", flush=True)
try:
    tb.load({KIDNEY!r}).run("hex20", progress=progress)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    program = subprocess.Popen([sys.executable, "-c", code], cwd=root, stdout=subprocess.PIPE, text=True)
    assert program.stdout.readline() == "started\n"
    time.sleep(0.3)
    began = time.monotonic()
    program.send_signal(signal.SIGINT)
    assert program.stdout.readline() == "interrupted\n"
    assert time.monotonic() - began < 5
    assert program.wait(60) == 0


def test_errors_have_file_line_and_key(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text('title = "x"\nbody = { shape = "box", size = ["1 mm", "1 mm", "1 mm"] }\nmaterial = { law = "liner" }\n')
    with pytest.raises(tb.SceneError) as caught:
        tb.load(path)
    error = caught.value
    assert (error.file, error.line, error.key) == (str(path), 3, "material.law")
    assert error.found == "liner" and "linear" in error.help
    assert isinstance(error, tb.Error) and isinstance(error, ValueError)
    with pytest.raises(tb.SceneError, match="no such file"):
        tb.load(tmp_path / "none.toml")


def test_an_unknown_method_is_named(block):
    with pytest.raises(tb.SceneError, match="no method 'tet5'; known methods are tet4, hex8, hex20, efg"):
        block.run("tet5")


def test_what_cannot_run_is_a_run_error(block):
    scene = tb.parse(
        """
title = "Free"
body = { shape = "box", size = ["1 mm", "1 mm", "1 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
load = [{ on = "z-max", pressure = "1 kPa" }]
method = [{ id = "tet4", family = "fem", element = "tet4", size = { cells = [1, 1, 1] } }]
"""
    )
    with pytest.raises(tb.RunError) as caught:
        scene.run("tet4")
    assert caught.value.key is not None
    assert len(scene.run_all().failures) == 1


def test_all_mistakes_of_a_scene_are_on_the_exception():
    text = 'title = "x"\nbody = { shape = "box", size = ["1 mm", "1 mm", "0 mm"] }\nmaterial = { law = "liner" }\n'
    with pytest.raises(tb.SceneError) as caught:
        tb.parse(text, "bad.toml")
    errors = caught.value.errors
    assert len(errors) > 1 and {"material.law"} < {error.key for error in errors}
    assert all(isinstance(error, tb.SceneError) and str(error) in str(caught.value) for error in errors)
    assert (errors[0].line, errors[0].key) == (caught.value.line, caught.value.key) and errors[0].errors == [errors[0]]


def test_the_reference_of_a_scene_is_solved_once():
    scene, before = tb.parse(PLATE, "plate.toml"), []

    def steps_before_the_start(event):
        if event["event"] in ("begin", "start", "step"):
            before.append(event["event"])

    # Two steps of the reference, and two of the coarser one by which its own error is estimated.
    for steps in (4, 0):
        before.clear()
        run = scene.run("hex8", states=True, progress=steps_before_the_start)
        assert before[: steps + 2] == ["begin"] + steps * ["step"] + ["start"], before
    assert scene.problem("hex8").compare(run.displacement)["rms"] == pytest.approx(run["rms"], rel=1e-9)


PLATE = """
title = "A block under a plate"
body = { shape = "box", size = ["20 mm", "20 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.3 }
support = [{ on = "z-min", fix = "xyz" }]
tool = [{ name = "plate", shape = "plate", at = ["0 mm", "0 mm", "20 mm"], along = [0, 0, -1], drive = { closure = "2 mm" }, penalty = "0.5 MPa/mm" }]
procedure = { kind = "static", steps = 2 }
reference = { method = "hex20", size = { cells = [2, 2, 2] } }
method = [
    { id = "hex8", family = "fem", element = "hex8", size = { cells = [2, 2, 2] } },
    { id = "hex20", family = "fem", element = "hex20", size = { cells = [1, 1, 1] } },
]
"""


FORKED = """
import os, sys
import numpy as np
import tissuebench as tb
exec(open(sys.argv[1]).read())
def work(scene):
    errors = []
    for use in [lambda: scene.run("tet4"), lambda: scene.problem("tet4"), lambda: tb.transfer("nearest", np.zeros((1, 3)), np.zeros((1, 3)))]:
        try:
            use()
        except tb.RunError as error:
            errors.append(str(error))
    return errors
scene = tb.parse(BLOCK, "block.toml")
scene.run("tet4")
child = os.fork()
if child == 0:
    errors = work(scene)
    os._exit(0 if len(errors) == 3 and all("forked" in error and "spawn" in error for error in errors) else 1)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), work(scene))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="nothing forks")
def test_a_forked_child_raises_and_its_parent_goes_on(tmp_path):
    from conftest import BLOCK

    given = tmp_path / "block.py"
    given.write_text(f"BLOCK = {BLOCK!r}")
    done = subprocess.run([sys.executable, "-c", FORKED, given], capture_output=True, text=True, timeout=60)
    assert done.stdout == "0 []\n", done.stderr


def test_ctrl_c_ends_a_transfer_within_a_second():
    code = """
import numpy as np
import tissuebench as tb
points = np.random.default_rng(1).uniform(size=(6000, 3))
print("started", flush=True)
try:
    tb.transfer("thin-plate", points, points)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    program = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert program.stdout.readline() == "started\n"
    time.sleep(0.3)
    began = time.monotonic()
    program.send_signal(signal.SIGINT)
    assert program.stdout.readline() == "interrupted\n"
    assert time.monotonic() - began < 1
    program.kill()


STUDY = """
title = "Two patch tests"
[[run]]
scene = "patch-displacement.toml"
methods = ["tet4", "hex8"]
"""


@pytest.fixture
def study(root, tmp_path):
    patch = (root / "cases/scenes/patch/patch-displacement.toml").read_text()
    methods = (root / "cases/methods.toml").as_posix()
    (tmp_path / "patch-displacement.toml").write_text(patch.replace("../../methods.toml", methods))
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path / "study.toml"


def test_a_study_runs_and_resumes(study, tmp_path):
    events = []
    found = tb.verify(study, out=tmp_path / "out", progress=events.append)
    assert found.ok and len(found) > 0 and found.failures == []
    assert {check["status"] for check in found.checks} == {"pass"}
    assert [e["event"] for e in events if e["event"] != "step"][0] == "begin"
    assert len(found.records) == len(tb.read(tmp_path / "out"))
    events.clear()
    tb.verify(study, out=tmp_path / "out", resume=True, progress=events.append)
    assert all(event["stored"] for event in events if event["event"] == "done")


def test_a_study_without_runs_is_refused(study, tmp_path):
    with pytest.raises(tb.SceneError, match="no run matches the selection"):
        tb.verify(study, out=tmp_path / "out", methods=["nonsense"])
