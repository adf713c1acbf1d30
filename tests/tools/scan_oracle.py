"""What numpy and scipy make of label images; the tests of import compare palpate with it.

body CT ABOVE LABELS               voxels of the gap: in the largest piece of CT > ABOVE with its cavities filled,
                                   and of no label; then `label voxels` on a line for each
rays LABELS BODY ABOVE RAYS SETS   RAYS: lines `x y z dx dy dz` in mm, RAS; SETS: `1,2;5,6`. For each ray, marched in
                                   steps of 0.05 mm through the nearest voxels, the way to the body (BODY > ABOVE) and
                                   from there to each set of labels, in mm; -1 if it is not met
segments FILE                      FILE: .seg.nrrd with gzip. For each segment, in the file's order: its voxels, and those that
                                   no later segment has

Images are NIfTI, read by nibabel, or MetaImage with zlib, read here.
"""
import gzip
import os
import re
import sys
import zlib

import nibabel
import numpy
from scipy import ndimage


def read(path):
    """Values and the affine, RAS, mm."""
    if not path.endswith(".mhd"):
        image = nibabel.load(path)
        return numpy.asarray(image.dataobj), image.affine
    header = dict(line.strip().split(" = ", 1) for line in open(path) if " = " in line)
    raw = open(os.path.join(os.path.dirname(path), header["ElementDataFile"]), "rb").read()
    kind = {"MET_SHORT": numpy.int16, "MET_UCHAR": numpy.uint8}[header["ElementType"]]
    size = [int(n) for n in header["DimSize"].split()]
    values = numpy.frombuffer(zlib.decompress(raw), kind).reshape(size, order="F")
    numbers = lambda key: numpy.array([float(n) for n in header[key].split()])
    affine = numpy.eye(4)
    affine[:3, :3] = numbers("TransformMatrix").reshape(3, 3).T * numbers("ElementSpacing")
    affine[:3, 3] = numbers("Offset")
    return values, numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ affine  # LPS


command = sys.argv[1]
if command == "body":
    ct, above, labels = read(sys.argv[2])[0], float(sys.argv[3]), read(sys.argv[4])[0]
    pieces, count = ndimage.label(ct > above)
    body = pieces == numpy.argmax(numpy.bincount(pieces.ravel())[1:]) + 1
    air = numpy.pad(~body, 1, constant_values=True)
    pieces, count = ndimage.label(air, ndimage.generate_binary_structure(3, 2))
    body = (pieces != pieces[0, 0, 0])[1:-1, 1:-1, 1:-1]
    print(numpy.count_nonzero(body & (labels == 0)), 0)
    for label, voxels in zip(*numpy.unique(labels, return_counts=True)):
        print(int(label), int(voxels))
elif command == "rays":
    labels, affine = read(sys.argv[2])
    mask, mask_affine = read(sys.argv[3])
    above = float(sys.argv[4])
    sets = [[int(n) for n in text.split(",")] for text in sys.argv[6].split(";")]
    step = 0.05
    for ray in numpy.loadtxt(sys.argv[5], ndmin=2):
        way = numpy.arange(0.0, 600.0, step)
        points = ray[:3] + way[:, None] * (ray[3:] / numpy.linalg.norm(ray[3:]))

        def along(values, affine):
            index = numpy.rint(nibabel.affines.apply_affine(numpy.linalg.inv(affine), points)).astype(int)
            inside = numpy.all((index >= 0) & (index < values.shape), axis=1)
            result = numpy.zeros(len(points), values.dtype)
            result[inside] = values[tuple(index[inside].T)]
            return numpy.where(inside, result, values.min())

        def first(met):
            return int(numpy.argmax(met)) if met.any() else -1

        skin = first(along(mask, mask_affine) > above)
        found = [first(numpy.isin(along(labels, affine), one)) for one in sets]
        print(skin * step, *[(at - skin) * step if at >= 0 else -1 for at in found])
elif command == "segments":
    header, data = open(sys.argv[2], "rb").read().split(b"\n\n", 1)
    header = header.decode()
    sizes = [int(n) for n in re.search("sizes: (.*)", header).group(1).split()]
    layers = numpy.frombuffer(gzip.decompress(data), numpy.uint8).reshape(sizes, order="F")
    value = lambda n, key: int(re.search("Segment%d_%s:=(.*)" % (n, key), header).group(1))
    count = len(re.findall(r"Segment\d+_LabelValue:=", header))
    segments = [layers[value(n, "Layer")] == value(n, "LabelValue") for n in range(count)]
    for n, segment in enumerate(segments):
        later = numpy.any(segments[n + 1 :], axis=0) if n + 1 < count else numpy.zeros_like(segment)
        print(int(segment.sum()), int((segment & ~later).sum()))
else:
    sys.exit("unknown command")
