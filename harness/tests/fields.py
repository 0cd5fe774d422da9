"""Opens a series of tissuebench with VTK and meshio and compares what they read: python fields.py SERIES.pvd"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshio
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

series = Path(sys.argv[1])
entries = ElementTree.parse(series).getroot().findall("Collection/DataSet")
assert entries, "an empty series"
times = [float(entry.get("timestep")) for entry in entries]
assert times == sorted(times), times
for entry in entries:
    path = series.parent / entry.get("file")
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    time = grid.GetFieldData().GetArray("TimeValue").GetValue(0)
    assert time == float(entry.get("timestep")), (path, time)
    mesh = meshio.read(path)
    assert len(mesh.points) == grid.GetNumberOfPoints() > 0
    points, cells = grid.GetPointData(), grid.GetCellData()
    moved = vtk_to_numpy(points.GetArray("displacement"))
    assert moved.shape == (len(mesh.points), 3)
    assert numpy.array_equal(moved, mesh.point_data["displacement"])
    if entry.get("name") == "tools":
        assert cells.GetArray("body") is not None
        continue
    stress = vtk_to_numpy(cells.GetArray("stress"))
    assert stress.shape == (grid.GetNumberOfCells(), 6)
    pressure = vtk_to_numpy(cells.GetArray("pressure"))
    assert numpy.allclose(pressure, -stress[:, :3].sum(axis=1) / 3, atol=1e-9 * abs(stress).max())
    assert numpy.array_equal(pressure, numpy.concatenate(mesh.cell_data["pressure"]))
    assert (vtk_to_numpy(cells.GetArray("det_f")) > 0).all()
    assert (vtk_to_numpy(cells.GetArray("von_mises")) >= 0).all()
