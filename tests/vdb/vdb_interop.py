"""Writes .vdb files as users of python3-openvdb would, for vdb_interop_test.cpp and check_test.cpp.

usage: vdb_interop.py FOLDER
Each holds the ball about (1, 2, 3) mm with radius 6 mm, or something that is not a surface.
"""

import sys

import numpy
import pyopenvdb

folder = sys.argv[1]
CENTER = numpy.array([1.0, 2.0, 3.0])
RADIUS = 6.0


def ball(voxel=0.5, half_width=3.0):
    grid = pyopenvdb.createLevelSetSphere(RADIUS, tuple(CENTER), voxel, half_width)
    grid.name = "ball"
    grid["length_unit"] = "mm"
    return grid


def distances(make, name):
    """A dense array of distances on a slanted or stretched lattice."""
    matrix = make
    grid = pyopenvdb.FloatGrid(1e9)
    grid.name = name
    # Row vectors times the matrix, as in OpenVDB.
    shape = numpy.array([48, 48, 48])
    index = numpy.stack(numpy.meshgrid(*[numpy.arange(n) - n / 2 for n in shape], indexing="ij"), axis=-1)
    world = index @ matrix[:3, :3] + CENTER
    values = numpy.linalg.norm(world - CENTER, axis=-1) - RADIUS
    spacing = numpy.linalg.norm(matrix[:3, :3], axis=1).max()
    band = 3.0 * spacing
    grid = pyopenvdb.FloatGrid(band)
    grid.name = name
    grid.copyFromArray(numpy.clip(values, -band, band).astype(numpy.float32), tolerance=1e-7)
    placed = matrix.copy()
    placed[3, :3] = CENTER - (shape / 2) @ matrix[:3, :3]
    grid.transform = pyopenvdb.createLinearTransform(placed.tolist())
    grid.gridClass = pyopenvdb.GridClass.LEVEL_SET
    grid["length_unit"] = "mm"
    return grid


def write(name, *grids):
    pyopenvdb.write(folder + "/" + name + ".vdb", list(grids))


write("ball", ball())

half = ball()
half.saveFloatAsHalf = True
write("half", half)

plain = ball()
plain.gridClass = pyopenvdb.GridClass.UNKNOWN
write("no_class", plain)

no_unit = ball()
del no_unit["length_unit"]
write("no_unit", no_unit)

angle = numpy.radians(30.0)
turned = numpy.eye(4)
turned[:2, :2] = 0.5 * numpy.array([[numpy.cos(angle), numpy.sin(angle)], [-numpy.sin(angle), numpy.cos(angle)]])
turned[2, 2] = 0.5
write("turned", distances(turned, "turned"))
write("stretched", distances(numpy.diag([0.5, 0.5, 0.7, 1.0]), "stretched"))
write("mirrored", distances(numpy.diag([-0.5, 0.5, 0.5, 1.0]), "mirrored"))

fog = pyopenvdb.FloatGrid()
fog.name = "density"
fog.gridClass = pyopenvdb.GridClass.FOG_VOLUME
fog["length_unit"] = "mm"
side = 48
axis = 0.5 * (numpy.arange(side) - side / 2)
x, y, z = numpy.meshgrid(axis, axis, axis, indexing="ij")
# Reaches 0.5 at the ball's surface, over three voxels.
fog.copyFromArray(numpy.clip(0.5 + (RADIUS - numpy.sqrt(x * x + y * y + z * z)) / 1.5, 0.0, 1.0).astype(numpy.float32))
placed = numpy.eye(4)
placed[:3, :3] *= 0.5
placed[3, :3] = CENTER - 0.25 * side
fog.transform = pyopenvdb.createLinearTransform(placed.tolist())
write("fog", fog)

mask = pyopenvdb.BoolGrid()
mask.name = "mask"
mask["length_unit"] = "mm"
mask.copyFromArray(x * x + y * y + z * z < RADIUS * RADIUS)
mask.transform = fog.transform
write("mask", mask)

write("vectors", pyopenvdb.Vec3SGrid())

empty = pyopenvdb.FloatGrid(1.5)
empty.gridClass = pyopenvdb.GridClass.LEVEL_SET
empty.transform = pyopenvdb.createLinearTransform(0.5)
empty["length_unit"] = "mm"
write("empty", empty)

# Only the band, with the outside's background inside it: the result of a tool that copies active
# voxels only.
source = ball()
hollow = pyopenvdb.FloatGrid(source.background)
hollow.name = "ball"
hollow.gridClass = pyopenvdb.GridClass.LEVEL_SET
hollow.transform = source.transform
hollow["length_unit"] = "mm"
accessor = hollow.getAccessor()
for item in source.iterOnValues():
    accessor.setValueOn(item.min, item.value)
write("hollow", hollow)

# The same with a shell's two walls, and on a rotated lattice.
nested = hollow.deepCopy()
accessor = nested.getAccessor()
for item in pyopenvdb.createLevelSetSphere(2.5, tuple(CENTER), 0.5, 3.0).iterOnValues():
    if not accessor.isValueOn(item.min):
        accessor.setValueOn(item.min, -item.value)
write("nested", nested)
askew = distances(turned, "ball")
band = pyopenvdb.FloatGrid(askew.background)
band.name = "ball"
band.gridClass = pyopenvdb.GridClass.LEVEL_SET
band.transform = askew.transform
band["length_unit"] = "mm"
accessor = band.getAccessor()
for item in askew.iterOnValues():
    if abs(item.value) < askew.background:
        for x in range(item.min[0], item.max[0] + 1):
            for y in range(item.min[1], item.max[1] + 1):
                for z in range(item.min[2], item.max[2] + 1):
                    accessor.setValueOn((x, y, z), item.value)
write("hollow_turned", band)

# A patch of the band is missing.
torn = ball()
accessor = torn.getAccessor()
for item in source.iterOnValues():
    if item.min[0] > 10 and abs(item.min[1] - 4) < 3 and abs(item.min[2] - 6) < 3:
        accessor.setValueOff(item.min, source.background)
write("torn", torn)

# Values in voxels instead of millimeters.
voxels = ball()
voxels.mapAll(lambda value: value / 0.5)
voxels.background = 3.0
write("in_voxels", voxels)
