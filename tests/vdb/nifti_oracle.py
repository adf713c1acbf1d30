"""What nibabel and scipy make of NIfTI files; the tests compare palpate with it.

affine FILE...          3 x 4 affine of each file, one file a line, row by row
conflict FILE...        by how many voxels sform and qform differ at a corner; 0 if only one is set
values FILE...          scaled voxel values, i fastest, one file a line
interpolate FILE PTS    order-1 intensity at each line of PTS (x y z, the file's unit), one a line
"""
import sys

import nibabel
import numpy
from scipy.ndimage import map_coordinates


def write(numbers):
    print(" ".join(repr(float(x)) for x in numbers))


command, files = sys.argv[1], sys.argv[2:]
if command == "affine":
    for name in files:
        write(nibabel.load(name).affine[:3].ravel())
elif command == "conflict":
    for name in files:
        header = nibabel.load(name).header
        apart = 0.0
        if header["sform_code"] > 0 and header["qform_code"] > 0:
            corners = [[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
            index = numpy.array(corners) * (numpy.array(header.get_data_shape()[:3]) - 1)
            there = nibabel.affines.apply_affine(header.get_qform(), index)
            back = nibabel.affines.apply_affine(numpy.linalg.inv(header.get_sform()), there)
            apart = numpy.linalg.norm(back - index, axis=1).max()
        write([apart])
elif command == "values":
    for name in files:
        write(numpy.asarray(nibabel.load(name).dataobj, dtype=float).ravel(order="F"))
elif command == "interpolate":
    image = nibabel.load(files[0])
    data = numpy.asarray(image.dataobj, dtype=float)
    points = numpy.loadtxt(files[1], ndmin=2)
    index = nibabel.affines.apply_affine(numpy.linalg.inv(image.affine), points).T
    for value in map_coordinates(data, index, order=1, mode="constant", cval=numpy.nan):
        print(repr(float(value)))
else:
    sys.exit("unknown command")
