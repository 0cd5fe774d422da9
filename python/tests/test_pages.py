"""The book's page on Python does what it says, and the types are those of the module."""

import importlib.util
import re
import subprocess
import sys

import pytest


def blocks(text: str) -> list[str]:
    return re.findall(r"```python\n(.*?)```", text, re.S)


def test_the_examples_of_the_page_run_in_order(root, tmp_path, monkeypatch):
    page = (root / "docs/src/guide/python.md").read_text()
    found = blocks(page)
    assert len(found) > 4
    for name, text in re.findall(r"```toml\n# (\S+\.toml)\n(.*?)```", page, re.S):
        (tmp_path / name).write_text(text)
    (tmp_path / "cases").symlink_to(root / "cases")
    monkeypatch.chdir(tmp_path)
    scope: dict = {}
    for block in found:
        if "matplotlib" in block:
            if importlib.util.find_spec("matplotlib") is None:
                continue
            monkeypatch.setenv("MPLBACKEND", "Agg")
        exec(compile(block, "python.md", "exec"), scope)


def test_stubs_are_what_the_module_has(root):
    pytest.importorskip("mypy")
    allowed = root / "python/tests/stubs-allowed.txt"
    check = [sys.executable, "-m", "mypy.stubtest", "tissuebench", "--allowlist", str(allowed)]
    done = subprocess.run(check, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
