#!/usr/bin/env python3
"""Stands for the daemon of one job: waits for room, runs the script, warns its shell, kills what is left."""
import ctypes
import fcntl
import os
import signal
import subprocess
import sys
import time

state, script, log, folder, minutes, notice = sys.argv[1:]
here = os.path.dirname(state)
# A minute of a job takes four seconds here.
limit = float(os.environ.get("FAKE_MINUTE", "4")) * float(minutes)
ctypes.CDLL(None).prctl(36, 1)  # adopts orphaned processes


def put(text):
    open(state + ".new", "w").write(text)
    os.rename(state + ".new", state)


def is_cancelled():
    return os.path.exists(state.replace(".state", ".cancel"))


def room():
    """Takes one of the places, or returns None."""
    for place in range(int(os.environ.get("FAKE_ROOM", "64"))):
        file = open(os.path.join(here, f"place-{place}"), "w")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return file
        except OSError:
            file.close()
    return None


while not (place := room()):
    if is_cancelled():
        put("CANCELLED|None")
        sys.exit()
    time.sleep(0.02)
if is_cancelled():
    put("CANCELLED|None")
    sys.exit()
put("RUNNING|None")
out = open(log, "w")
job = subprocess.Popen(["sh", script], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=out, start_new_session=True)
began, warned, end = time.time(), False, None
while job.poll() is None:
    took = time.time() - began
    if is_cancelled():
        end = "CANCELLED|None"
        break
    if not warned and took > limit - float(notice):
        warned = True
        os.kill(job.pid, signal.SIGTERM)
    if took > limit:
        end = "TIMEOUT|TimeLimit"
        break
    time.sleep(0.02)


def below(root):
    pids = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            pids.setdefault(int(open(f"/proc/{name}/stat").read().rsplit(")", 1)[1].split()[1]), []).append(int(name))
        except OSError:
            pass
    found = list(pids.get(root, []))
    for pid in found:
        found.extend(pids.get(pid, []))
    return found


for pid in below(os.getpid()):
    try:
        os.kill(pid, signal.SIGKILL)
    except OSError:
        pass
code = job.wait()
put(end or ("COMPLETED|None" if code == 0 else f"FAILED|{'NonZeroExitCode' if code > 0 else 'RaisedSignal'}"))
