#!/usr/bin/env python3
"""Stands for hq: `hq submit`, `hq job info IDS` with JSON as HyperQueue prints it, `hq job cancel IDS`."""
import json
import os
import subprocess
import sys

import places

words = sys.argv[1:]
if words[0] == "run":
    state, log, folder, *command = words[1:]
    place = places.take(state, "canceled|")
    places.put(state, "running|")
    out = open(log, "w")
    job = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, start_new_session=True)
    while job.poll() is None and not places.is_cancelled(state):
        try:
            job.wait(0.02)
        except subprocess.TimeoutExpired:
            pass
    cancelled = job.poll() is None
    places.kill_below(os.getpid())
    code = job.wait()
    failed = f"failed|Error: Program terminated with exit code {code}" if code > 0 else "failed|Error: killed by a signal"
    places.put(state, "canceled|" if cancelled else "finished|" if code == 0 else failed)
elif words[:2] == ["job", "cancel"]:
    places.cancel(words[2].split(","))
else:
    assert words[0] == "--output-mode=json", words
    if words[1] == "submit":
        at = words.index("--")
        options = dict(word[2:].split("=", 1) for word in words[2:at])
        assert options["stderr"] == "none" and options["directives"] == "off", options
        number = places.next_number()
        state = os.path.join(places.here, f"{number}.state")
        places.put(state, "waiting|")
        subprocess.Popen(
            [os.path.abspath(__file__), "run", state, options["stdout"], options["cwd"], *words[at + 1 :]],
            start_new_session=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        print(json.dumps({"id": number}, indent=2))
    else:
        assert words[1:3] == ["job", "info"], words
        found = []
        for job in words[3].split(","):
            state, error = open(os.path.join(places.here, f"{job}.state")).read().split("|", 1)
            task = {"id": 0, "state": state} | ({"error": error} if error else {})
            found.append({"info": {"id": int(job), "name": "job", "task_count": 1}, "max_fails": None, "tasks": [task]})
        print(json.dumps(found, indent=2))
