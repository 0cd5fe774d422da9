"""Records as Arrow: polars and pandas take them over, without a copy where they keep them alike."""

import csv

import numpy as np
import pytest
import tissuebench as tb


@pytest.fixture
def large(block, tmp_path):
    """A folder with 100,000 records or more: those of a run again and again, each time of another run."""
    out = tmp_path / "out"
    results = block.run_all(["tet4"], once=True)
    results.write(out)
    with open(out / "records.csv") as file:
        rows = list(csv.DictReader(file))
    with open(out / "records.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        for copy in range(-(-100_000 // len(rows))):
            writer.writerows({**row, "run": f"{row['run']}-{copy}"} for row in rows)
    return tb.read(out)


def test_columns_are_those_of_the_file(block, tmp_path):
    results = block.run_all(["tet4"], once=True)
    results.write(tmp_path / "out")
    with open(tmp_path / "out/records.csv") as file:
        header = next(csv.reader(file))
    # The rest is the program and the machine, the same in all rows.
    columns = results.records.columns
    assert columns == header[: len(columns)] and header[len(columns)] == "commit"


def test_columns_are_numpy_arrays(block):
    records = block.run("tet4").records
    values = records["value"]
    assert values.dtype == np.float64 and values.shape == (len(records),)
    assert set(records["method"]) == {"tet4"} and set(records["family"]) == {"fem"}
    assert np.isnan(records["support_scale"]).all() and records["nodes"].dtype == np.uint64
    with pytest.raises(KeyError):
        records["nonsense"]


def test_100000_records_reach_polars_without_a_copy(large):
    pa = pytest.importorskip("pyarrow")
    pl = pytest.importorskip("polars")
    assert len(large) >= 100_000
    # pyarrow holds the buffers as they were exported.
    arrow = pa.table(large)
    frame = pl.DataFrame(large)
    assert frame.shape == (len(large), len(large.columns))
    for name in ["value", "nodes", "level", "poisson", "spacing"]:
        ours = arrow[name].chunk(0).buffers()[1].address
        theirs = frame[name].to_numpy(allow_copy=False)
        assert theirs.__array_interface__["data"][0] == ours, name
    # Texts: polars keeps views, and gives its own buffers back. The second one has the views.
    newest = pl.CompatLevel.newest()
    for name in ["run", "case", "quantity"]:
        ours = arrow[name].chunk(0).buffers()[1].address
        assert frame[name].to_arrow(compat_level=newest).buffers()[1].address == ours, name
    assert frame["value"].sum() == pytest.approx(large["value"].sum())


def test_pandas_reads_a_table(block):
    pa = pytest.importorskip("pyarrow")
    pytest.importorskip("pandas")
    run = block.run("tet4")
    frame = pa.table(run.records).to_pandas()
    rms = frame[(frame["quantity"] == "rms") & (frame["statistic"] == "value")].set_index("component")["value"]
    assert dict(rms) == {"": run["rms"], "x": run["rms-x"], "y": run["rms-y"], "z": run["rms-z"]}
