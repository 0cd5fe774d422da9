"""What the tests have in common: the repository's scenes, a small one of their own, and the command."""

import os
import subprocess
from pathlib import Path

import pytest
import tissuebench as tb

ROOT = Path(__file__).resolve().parents[2]

BLOCK = """
title = "A soft block under pressure"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.45 }
support = [{ on = "z-min", fix = "xyz" }]
load = [{ on = "z-max", pressure = "1 kPa" }]
output = { probes = [["0 mm", "0 mm", "20 mm"]] }
reference = { method = "hex20", size = { cells = [6, 6, 3] } }
method = [
    { id = "tet4", family = "fem", element = "tet4", size = { level = 1 } },
    { id = "hex8", family = "fem", element = "hex8", size = { cells = [4, 4, 2] } },
    { id = "hex20", family = "fem", element = "hex20", size = { level = 1 } },
    { id = "efg", family = "efg", nodes = 150, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "gauss", points = 4 }, essential = "penalty" },
]
"""


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    """With CI=true, a test left out for want of a package fails unless .ci/skips names the package."""
    report = (yield).get_result()
    if report.skipped and os.environ.get("CI") == "true":
        lines = (ROOT / ".ci/skips").read_text().splitlines()
        why = str(report.longrepr[2]) if isinstance(report.longrepr, tuple) else str(report.longrepr)
        if not any(f"'{line.partition(':')[0]}'" in why for line in lines if not line.startswith("#")):
            report.outcome, report.longrepr = "failed", f"CI=true, and .ci/skips does not name it: {why}"


@pytest.fixture
def root() -> Path:
    return ROOT


@pytest.fixture
def block() -> tb.Scene:
    return tb.parse(BLOCK, "block.toml")


@pytest.fixture
def command():
    """Runs the command `tissuebench`, where it is built: `TISSUEBENCH` or `target/release/tissuebench`."""
    program = Path(os.environ.get("TISSUEBENCH", ROOT / "target/release/tissuebench"))
    if not program.exists():
        pytest.skip(f"no command at {program}")

    def run(*args: str) -> str:
        done = subprocess.run([program, *args], cwd=ROOT, capture_output=True, text=True, check=True)
        return done.stdout

    return run
