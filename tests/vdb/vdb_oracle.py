"""Reads a .vdb with python3-openvdb and prints what it found, for vdb_io_test.cpp.

usage: vdb_oracle.py FILE GRID I,J,K...
First lines "key value" of the metadata, then one line "value" for each voxel asked for.
"""

import sys

import pyopenvdb

grids, _ = pyopenvdb.readAll(sys.argv[1])
names = [grid.name for grid in grids]
grid = pyopenvdb.read(sys.argv[1], sys.argv[2])
print("names", ",".join(names))
print("class", grid.gridClass)
print("type", type(grid).__name__)
print("active", grid.activeVoxelCount())
print("voxel", repr(grid.transform.voxelSize()[0]))
print("background", repr(grid.background))
for key in ("length_unit", "frame", "layer", "palpate:version"):
    print(key, grid.metadata.get(key, "-"))
accessor = grid.getConstAccessor()
for text in sys.argv[3:]:
    value, active = accessor.probeValue(tuple(int(n) for n in text.split(",")))
    print("voxel_value", repr(value), int(active))
