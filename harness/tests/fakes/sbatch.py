#!/usr/bin/env python3
"""Stands for sbatch: `sbatch --parsable SCRIPT`. The state of a job is a file next to this program."""
import os
import shlex
import subprocess
import sys

import places

here = os.path.dirname(os.path.abspath(__file__))
flag, script = sys.argv[1:]
assert flag == "--parsable", flag
options = {}
for line in open(script):
    if line.startswith("#SBATCH "):
        (word,) = shlex.split(line[8:])
        key, _, value = word[2:].partition("=")
        options[key] = value
if options.get("partition", "short") != "short":
    sys.exit("sbatch: error: invalid partition specified: " + options["partition"])
assert options["signal"].startswith("B:TERM@"), "without B: the signal reaches job steps only"
notice = options["signal"].split("@")[1]
number = places.next_number()
state = os.path.join(here, f"{number}.state")
places.put(state, "PENDING|Resources")
subprocess.Popen(
    [os.path.join(here, "fake-slurm-job"), state, script, options["output"].replace("%%", "%"), options["chdir"],
     options["time"], notice],
    start_new_session=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
)
print(f"{number};cluster")
