#!/usr/bin/env python3
"""Stands for snakemake: executes the only rule of a workflow by bash, in the folder of the workflow."""
import ast
import pathlib
import signal
import subprocess
import sys

words = sys.argv[1:]
snakefile, folder = (words[words.index(flag) + 1] for flag in ("--snakefile", "--directory"))
lines = pathlib.Path(snakefile).read_text().splitlines()
assert [line.split(":")[0].strip() for line in lines] == ["rule all", "output", "threads", "resources", "shell"], lines
shell = ast.literal_eval(lines[-1].strip().removeprefix("shell: ")).replace("{{", "{").replace("}}", "}")
# As Snakemake does, it waits for its job, which receives the same signal.
signal.signal(signal.SIGTERM, lambda *_: None)
job = subprocess.Popen(["bash", "-c", "set -euo pipefail; " + shell], cwd=folder)
if job.wait() != 0:
    sys.exit(1)
pathlib.Path(folder, "done").touch()
