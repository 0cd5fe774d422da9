"""Errors with their place in the file."""

from __future__ import annotations


class Error(Exception):
    """Base class of all errors. Unknown parts of the place are None."""

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
        """All errors of the file, each with its place; a list of this error if there is only one."""
        return self._errors or [self]


class SceneError(Error, ValueError):
    """Invalid input: exit code 2 of the command."""


class RunError(Error, RuntimeError):
    """Valid input that could not be run, or files that could not be written: exit code 3 or 5 of the command."""
