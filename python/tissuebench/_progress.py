"""Progress as one line of text."""

from __future__ import annotations

import sys
from typing import Any, TextIO


def printed(file: TextIO | None = None):
    """Returns a `progress` function that updates one line: `3 of 9  kidney-fair tet10  40 % of the load`."""
    out = file or sys.stderr
    state: dict[str, Any] = {"runs": 0, "done": 0, "now": "", "width": 0}

    def show(more: str = "") -> None:
        line = f"{state['done']} of {state['runs']}  {state['now']}{more}"
        out.write("\r" + line.ljust(state["width"]))
        out.flush()
        state["width"] = len(line)

    def progress(event: dict[str, Any]) -> None:
        kind = event["event"]
        if kind == "begin":
            state["runs"] = event["runs"]
        elif kind == "start":
            state["now"] = f"{event['case']} {event['method']}"
            show()
        elif kind == "step":
            show(f"  {100 * event['load']:.0f} % of the load")
        elif kind in ("done", "failed"):
            state["done"] += 1
            show()
            if state["done"] == state["runs"]:
                out.write("\n")

    return progress
