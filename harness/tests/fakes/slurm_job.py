#!/usr/bin/env python3
"""Stands for the daemon of one job: waits for room, runs the script, warns its shell, kills what is left."""
import os
import signal
import subprocess
import sys
import time

import places

state, script, log, folder, minutes, notice = sys.argv[1:]
# A minute of a job takes four seconds here.
limit = 4 * float(minutes)
place = places.take(state, "CANCELLED|None")
places.put(state, "RUNNING|None")
out = open(log, "w")
job = subprocess.Popen(
    ["sh", script], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=out, start_new_session=True
)
began, warned, end = time.time(), False, None
while job.poll() is None and not end:
    took = time.time() - began
    if not warned and took > max(limit - float(notice), limit / 2):
        warned = True
        os.kill(job.pid, signal.SIGTERM)
    if places.is_cancelled(state):
        end = "CANCELLED|None"
    elif took > limit:
        end = "TIMEOUT|TimeLimit"
    time.sleep(0.02)
places.kill_below(os.getpid())
code = job.wait()
failed = f"FAILED|{'NonZeroExitCode' if code > 0 else 'RaisedSignal'}"
places.put(state, end or ("COMPLETED|None" if code == 0 else failed))
