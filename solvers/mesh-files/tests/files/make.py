"""Makes the mesh files beside this script with Gmsh and meshio: two boxes of 1 x 1 x 1 and 1 x 1 x 1, side by side.

    pip install gmsh meshio vtk && python make.py
"""
import gmsh
import meshio
import vtk


# Missing in meshio 5.3.5.
meshio._mesh.topological_dimension.setdefault("wedge15", 3)
SOLIDS = ("tetra", "tetra10", "hexahedron", "hexahedron20", "wedge", "wedge15")


def model(kind):
    gmsh.clear()
    gmsh.model.add(kind)
    occ = gmsh.model.occ
    left, right = occ.addBox(0, 0, 0, 1, 1, 1), occ.addBox(1, 0, 0, 1, 1, 1)
    occ.fragment([(3, left)], [(3, right)])
    occ.synchronize()
    for curve in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(curve[1], 3)
    for surface in gmsh.model.getEntities(2):
        gmsh.model.mesh.setTransfiniteSurface(surface[1])
        # The surfaces below and above wedges are triangles. Mixed boxes have hexahedra on the left.
        x, _, z = occ.getCenterOfMass(*surface)
        on_left = x < 1 - 1e-6
        if kind.startswith("hex") or not kind.startswith("tet") and (abs(z - 0.5) < 1e-6 or kind.startswith("mixed") and on_left):
            gmsh.model.mesh.setRecombine(*surface)
    if not kind.startswith("tet"):
        for volume in gmsh.model.getEntities(3):
            gmsh.model.mesh.setTransfiniteVolume(volume[1])

    def at(dimension, x):
        found = gmsh.model.getEntities(dimension)
        return [tag for _, tag in found if abs(occ.getCenterOfMass(dimension, tag)[0] - x) < 1e-6]

    gmsh.model.addPhysicalGroup(3, at(3, 0.5), 11, "left half")
    gmsh.model.addPhysicalGroup(3, at(3, 1.5), 12, "right")
    gmsh.model.addPhysicalGroup(2, at(2, 0.0), 21, "held")
    gmsh.model.addPhysicalGroup(2, at(2, 2.0), 22, "pressed")
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    gmsh.model.mesh.generate(3)
    if kind in ("tet10", "hex20", "wedge15", "mixed2"):
        gmsh.model.mesh.setOrder(2)


def vtus(kind):
    """Every encoding that VTK writes, of a grid that meshio made."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(f"{kind}-meshio-text.vtu")
    reader.Update()
    for name, mode, encode, pack, big, wide in [
        ("text", "Ascii", 0, None, 0, 0),
        ("base64", "Binary", 0, None, 0, 0),
        ("base64-zlib-64", "Binary", 0, "ZLib", 0, 1),
        ("raw", "Appended", 0, None, 0, 1),
        ("raw-big", "Appended", 0, None, 1, 0),
        ("raw-zlib", "Appended", 0, "ZLib", 0, 0),
        ("raw-lz4", "Appended", 0, "LZ4", 0, 1),
        ("raw-zlib-big", "Appended", 0, "ZLib", 1, 1),
        ("appended-base64-lz4", "Appended", 1, "LZ4", 0, 0),
    ]:
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetInputData(reader.GetOutput())
        writer.SetFileName(f"{kind}-vtk-{name}.vtu")
        getattr(writer, f"SetDataModeTo{mode}")()
        writer.SetEncodeAppendedData(encode)
        getattr(writer, f"SetCompressorTypeTo{pack or 'None'}")()
        (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
        (writer.SetHeaderTypeToUInt64 if wide else writer.SetHeaderTypeToUInt32)()
        # Several blocks of the smallest size.
        writer.SetBlockSize(8 * 64)
        writer.Write()


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
for kind in ("tet4", "tet10", "hex8", "hex20", "wedge6", "wedge15", "mixed1", "mixed2"):
    model(kind)
    for version in (2.2, 4.0, 4.1):
        # Gmsh writes 4.0 in text only; meshio writes it in binary.
        for binary in (0, 1) if version != 4.0 else (0,):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            gmsh.write(f"{kind}-{version}-{'binary' if binary else 'text'}.msh")
    gmsh.option.setNumber("Mesh.SaveGroupsOfElements", 1)
    gmsh.write(f"{kind}-gmsh.inp")
    mesh = meshio.read(f"{kind}-4.1-binary.msh")
    mesh.point_data = {}
    meshio.gmsh.write(f"{kind}-4.0-binary.msh", mesh, fmt_version="4.0", binary=True)
    solid = [block for block in mesh.cells if block.type in SOLIDS]
    plain = meshio.Mesh(mesh.points, [(b.type, b.data) for b in solid])
    plain.write(f"{kind}-meshio.inp")
    kinds = SOLIDS + ("triangle", "triangle6", "quad", "quad8")
    kept = [at for at, block in enumerate(mesh.cells) if block.type in kinds]
    groups = {"gmsh:physical": [mesh.cell_data["gmsh:physical"][at] for at in kept]}
    whole = meshio.Mesh(mesh.points, [(mesh.cells[at].type, mesh.cells[at].data) for at in kept], cell_data=groups)
    meshio.vtu.write(f"{kind}-meshio-text.vtu", whole, binary=False)
    meshio.vtu.write(f"{kind}-meshio-zlib.vtu", whole, binary=True, compression="zlib")
    for version in ("4.2", "5.1"):
        for binary in (False, True):
            name = f"{kind}-vtk-{version}-{'binary' if binary else 'text'}.vtk"
            meshio.vtk.write(name, whole, fmt_version=version, binary=binary)
    if kind in ("tet10", "hex8"):
        vtus(kind)
gmsh.finalize()
