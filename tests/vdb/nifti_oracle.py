"""What nibabel, scipy and pydicom make of scans; the tests compare palpate with it.

affine FILE...          3 x 4 affine of each file, one file a line, row by row
conflict FILE...        by how many voxels sform and qform differ at a corner; 0 if only one is set
values FILE...          scaled voxel values, i fastest, one file a line
histogram FILE...       each scaled value and how often it comes, one file a line
mean SERIES SEG A B     of a DICOM folder: the mean where the NIfTI labels SEG are from A to B, and how many voxels;
                        places are compared by the files' own affines, each put together here
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
elif command == "histogram":
    for name in files:
        values, counts = numpy.unique(numpy.asarray(nibabel.load(name).dataobj, dtype=float), return_counts=True)
        write(numpy.column_stack([values, counts]).ravel())
elif command == "mean":
    import os

    import pydicom

    folder, labels, low, high = files
    slices = [pydicom.dcmread(os.path.join(folder, name)) for name in os.listdir(folder)]
    along = numpy.array(slices[0].ImageOrientationPatient, dtype=float).reshape(2, 3)
    normal = numpy.cross(along[0], along[1])
    slices.sort(key=lambda s: numpy.dot(normal, numpy.array(s.ImagePositionPatient, dtype=float)))
    places = numpy.array([s.ImagePositionPatient for s in slices], dtype=float)
    to_patient = numpy.eye(4)  # of (column, row, slice), LPS
    to_patient[:3, 0] = along[0] * float(slices[0].PixelSpacing[1])
    to_patient[:3, 1] = along[1] * float(slices[0].PixelSpacing[0])
    to_patient[:3, 2] = (places[-1] - places[0]) / (len(slices) - 1)
    to_patient[:3, 3] = places[0]
    segmentation = nibabel.load(labels)
    data = numpy.asarray(segmentation.dataobj)
    index = numpy.argwhere((data >= int(low)) & (data <= int(high)))
    world = nibabel.affines.apply_affine(segmentation.affine, index) * [-1, -1, 1]
    there = numpy.rint(nibabel.affines.apply_affine(numpy.linalg.inv(to_patient), world)).astype(int)
    total = 0.0
    for k, one in enumerate(slices):
        here = there[there[:, 2] == k]
        pixels = one.pixel_array.astype(float) * float(one.RescaleSlope) + float(one.RescaleIntercept)
        total += pixels[here[:, 1], here[:, 0]].sum()
    write([total / len(there), len(there)])
elif command == "interpolate":
    image = nibabel.load(files[0])
    data = numpy.asarray(image.dataobj, dtype=float)
    points = numpy.loadtxt(files[1], ndmin=2)
    index = nibabel.affines.apply_affine(numpy.linalg.inv(image.affine), points).T
    for value in map_coordinates(data, index, order=1, mode="constant", cval=numpy.nan):
        print(repr(float(value)))
else:
    sys.exit("unknown command")
