"""CalculiX: writes a deck, runs ccx, reads the displacement in its .dat file (7 digits).

Python's own library is enough. settings: type = "C3D8I" (any element of as many nodes), solver = "ITERATIVE CHOLESKY".
"""
import array, ast, json, struct, subprocess, sys, time
from pathlib import Path

problem, answer = map(Path, sys.argv[1:3])
TYPES = {"tet4": "C3D4", "tet10": "C3D10", "hex8": "C3D8", "hex20": "C3D20"}
text = json.loads((problem / "problem.json").read_text())
result = {"status": "ok", "problem": text["id"], "phases": {}, "counts": {}}


def read(name):
    """Rows of an array."""
    with open(problem / name, "rb") as file:
        head = ast.literal_eval(file.read(struct.unpack("<8xH", file.read(10))[0]).decode())
        values = array.array({"<f8": "d", "<i8": "q"}[head["descr"]], file.read())
    return list(zip(*[iter(values)] * (head["shape"] + (1,))[1]))


def write(name, rows):
    head = "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 3), }" % len(rows)
    head += " " * (63 - (10 + len(head)) % 64) + "\n"
    flat = array.array("d", (value for row in rows for value in row))
    (answer / name).write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + flat.tobytes())


def number(value):
    return "%.12e" % value  # CalculiX reads at most 20 characters


def deck():
    nodes, cells, regions = read("nodes.npy"), read("cells.npy"), read("regions.npy")
    procedure, settings = text["procedure"], text["settings"]
    kind = settings.get("type", TYPES[text["element"]])
    yield "*NODE, NSET=ALL"
    for node, x in enumerate(nodes):
        yield ", ".join([str(node + 1), *map(number, x)])
    for region, material in enumerate(text["materials"]):
        yield f"*ELEMENT, TYPE={kind}, ELSET=R{region}"
        for cell, row in enumerate(cells):
            if regions[cell][0] == region:
                row = [str(node + 1) for node in (cell, *row)]
                yield ",\n".join(", ".join(row[at : at + 10]) for at in range(0, len(row), 10))
        yield f"*MATERIAL, NAME=M{region}"
        if material["law"] == "linear":
            yield "*ELASTIC\n" + ", ".join(map(number, (material["young"], material["poisson"])))
        else:
            constants = material["constants"]
            yield "*HYPERELASTIC, NEO HOOKE\n" + ", ".join(map(number, (constants["c10"], constants["d1"])))
        yield f"*SOLID SECTION, ELSET=R{region}, MATERIAL=M{region}"
    large = procedure["kind"] == "static" and any(m["law"] != "linear" for m in text["materials"])
    yield "*STEP, INC=10000" + (", NLGEOM" if large else "")
    yield "*STATIC" + (f", SOLVER={settings['solver']}" if "solver" in settings else "")
    if large:
        step = number(1 / procedure["steps"])
        yield f"{step}, 1., 1.e-6, {step}"
        yield f"*CONTROLS, PARAMETERS=FIELD\n{number(procedure['tolerance'])}, 1.e-8"
    yield "*BOUNDARY"
    for node, axis, value in read("fixed.npy"):
        yield f"{int(node) + 1}, {int(axis) + 1}, {int(axis) + 1}, {number(value)}"
    yield "*CLOAD"
    for node, force in enumerate(read("force.npy")):
        for axis, value in enumerate(force):
            if value:
                yield f"{node + 1}, {axis + 1}, {number(value)}"
    yield "*NODE PRINT, NSET=ALL, FREQUENCY=10000\nU\n*END STEP\n"


def displacement():
    rows = []
    for line in (answer / "job.dat").read_text().splitlines():
        if "displacements" in line:
            rows = []  # of the last increment
        elif len(words := line.split()) == 4:
            rows.append([float(word) for word in words[1:]])
    return rows


times = [time.perf_counter()]
(answer / "job.inp").write_text("\n".join(deck()))
times.append(time.perf_counter())
run = subprocess.run(["ccx", "-i", "job"], cwd=answer, capture_output=True, text=True)
times.append(time.perf_counter())
result["counts"]["iterations"] = run.stdout.count("\n iteration ") or 1
errors = [line.strip() for line in run.stdout.splitlines() if "*ERROR" in line]
if run.returncode or errors:
    stalled = "too many cutbacks" in run.stdout or "increment size smaller" in run.stdout
    result |= {"status": "stalled" if stalled else "failed", "message": (errors or [f"ccx: {run.returncode}"])[0]}
else:
    write("displacement.npy", displacement())
times.append(time.perf_counter())
result["phases"] = {name: times[at + 1] - times[at] for at, name in enumerate(("write", "solve", "read"))}
(answer / "result.json").write_text(json.dumps(result))
