"""The wheel is of the same source as the command."""

import importlib.metadata

import pytest


@pytest.fixture
def toml():
    return pytest.importorskip("tomllib")


def test_the_version_is_that_of_the_workspace(root, toml):
    workspace = toml.loads((root / "Cargo.toml").read_text())["workspace"]["package"]
    assert importlib.metadata.version("tissuebench") == workspace["version"]


def test_dependencies_are_locked_as_those_of_the_command(root, toml):
    """Another version of one could give other bits."""

    def versions(path):
        found = {}
        for package in toml.loads(path.read_text())["package"]:
            found.setdefault(package["name"], set()).add(package["version"])
        return found

    command, module = versions(root / "Cargo.lock"), versions(root / "python/Cargo.lock")
    # Python's own dependencies may need further versions beside.
    other = {name: found for name, found in module.items() if name in command and not found & command[name]}
    assert not other, f"{other}: cargo update --manifest-path python/Cargo.toml NAME --precise VERSION"
