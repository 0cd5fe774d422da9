"""What goes wrong, with the place in the file."""

from __future__ import annotations


class Error(Exception):
    """Something could not be done. What is not known of its place is None."""

    file: str | None
    line: int | None
    column: int | None
    key: str | None
    found: str | None
    problem: str
    help: str | None

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        key: str | None = None,
        found: str | None = None,
        problem: str | None = None,
        help: str | None = None,
    ) -> None:
        super().__init__(message)
        self._errors: list[Error] = []
        self.file, self.line, self.column, self.key = file, line, column, key
        self.found, self.problem, self.help = found, problem or message, help


    @property
    def errors(self) -> list[Error]:
        """Everything that is wrong, each with its place; the first of them is this error itself, where it is the only one."""
        return self._errors or [self]


class SceneError(Error, ValueError):
    """Input that makes no sense: exit code 2 of the command."""


class RunError(Error, RuntimeError):
    """Sound input that could not be run, or files that could not be written: exit code 3 or 5 of the command."""
