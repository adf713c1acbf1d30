"""Material grids as python3-openvdb sees and writes them, for scene_map_test.cpp.

usage: material_grid_oracle.py read FILE GRID        prints name, class, unit, voxel, and some voxels
       material_grid_oracle.py write FOLDER          fog volumes as users write them
"""

import sys

import numpy
import pyopenvdb


def read(path, name):
    grid = pyopenvdb.read(path, name)
    assert grid.gridClass == pyopenvdb.GridClass.FOG_VOLUME, grid.gridClass
    assert grid["unit"] == "N/m" and grid["length_unit"] == "mm" and grid["layer"] == "skin"
    accessor = grid.getConstAccessor()
    low, high = grid.evalActiveVoxelBoundingBox()
    print(grid.activeVoxelCount(), *low, *high)
    print(*grid.transform.indexToWorld((0, 0, 0)), *grid.transform.indexToWorld((1, 1, 1)))
    for ijk in [(0, 0, 0), (1, 0, 0), (0, 2, 0), (3, 2, 1)]:
        value, active = accessor.probeValue(ijk)
        print(repr(value), int(active))


def ramp():
    """200 + 10 x N/m at the voxels' places, x in mm, voxels of 2 mm."""
    values = numpy.zeros((11, 9, 7), numpy.float32)
    values += 200 + 10 * 2 * numpy.arange(11, dtype=numpy.float32)[:, None, None]
    grid = pyopenvdb.FloatGrid(0.0)
    grid.copyFromArray(values)
    grid.transform = pyopenvdb.createLinearTransform(voxelSize=2.0)
    grid.gridClass = pyopenvdb.GridClass.FOG_VOLUME
    grid.name = "skin/stiffness"
    grid["unit"] = "N/m"
    grid["length_unit"] = "mm"
    return grid


def write(folder):
    def save(name, grid):
        pyopenvdb.write(folder + "/" + name + ".vdb", grids=[grid])

    save("ramp", ramp())
    grid = ramp()
    grid["unit"] = "N/mm"
    save("newtons_per_mm", grid)
    grid = ramp()
    del grid["unit"]
    save("no_unit", grid)
    grid = ramp()
    grid["unit"] = "Pa"
    save("pascal", grid)
    grid = ramp()
    del grid["length_unit"]
    save("no_length", grid)
    save("level_set", pyopenvdb.createLevelSetSphere(6.0, (0.0, 0.0, 0.0), 0.5, 3.0))
    grid = ramp()
    grid.getAccessor().setValueOn((3, 3, 3), -5.0)
    save("negative", grid)
    grid = ramp()
    grid.getAccessor().setValueOn((3, 3, 3), float("nan"))
    save("nan", grid)
    empty = ramp()
    empty.clear()
    save("empty", empty)
    double = pyopenvdb.BoolGrid(False)
    double.name = "skin/stiffness"
    double.fill((0, 0, 0), (3, 3, 3), True)
    save("bools", double)


if sys.argv[1] == "read":
    read(*sys.argv[2:])
else:
    write(sys.argv[2])
