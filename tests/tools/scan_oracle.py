"""What numpy and scipy make of label images; the tests of import compare palpate with it.

body CT ABOVE LABELS               voxels of the gap: in the largest piece of CT > ABOVE with its cavities filled,
                                   and of no label; then `label voxels` on a line for each
rays LABELS BODY ABOVE RAYS SETS   RAYS: lines `x y z dx dy dz` in mm, RAS; SETS: `1,2;5,6`. For each ray, marched in
                                   steps of 0.05 mm through the nearest voxels, the way to the body (BODY > ABOVE) and
                                   from there to each set of labels, in mm; -1 if it is not met
ring LABELS BODY LANDMARK SLICE COUNT SETS
                                   rays in SLICE through the middle of the largest disc there that fits into label LANDMARK (the head
                                   of a femur), COUNT of them all around: `x y z dx dy dz`, from 400 mm away inwards, in mm, RAS; the
                                   way to the body (BODY > 0) and to each set of labels, in steps of 0.02 mm through the nearest
                                   voxels, -1 if it is not met; the angle in degrees between the ray and the normal of each of these
                                   borders, smoothed over 2 mm; how far the ray goes through one voxel
slab FILE COLUMNS FIRST LAST OUT   of an image, as NIfTI, the slices FIRST to LAST of the first COLUMNS of voxels
runs LABELS BODY RAY SETS          RAY: `x,y,z,dx,dy,dz` in mm, RAS. Where what the ray is in changes, in mm, and to what: 0 outside, 1 the body, 2
                                   and so on SETS
borders LABELS BODY POINTS SETS    POINTS: lines `n x y z`, n is 0 for the body, else of SETS. For each point, how far it is from the border of
                                   the voxels of that set, in mm
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


def label_sets(labels, body, text):
    """Masks of the body and of each set of labels: `1,2;5,6`."""
    masks = [body > 0]
    for one in text.split(";"):
        numbers = [int(n) for n in one.split(",")]
        chosen = numpy.zeros(max(int(labels.max()), *numbers) + 1, bool)
        chosen[numbers] = True
        masks.append(chosen[labels])
    return masks


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
elif command == "ring":
    labels, affine = read(sys.argv[2])
    spacing = numpy.linalg.norm(affine[:3, :3], axis=0)
    masks = label_sets(labels, read(sys.argv[3])[0], sys.argv[7])
    level = int(sys.argv[5])
    disc = ndimage.distance_transform_edt(labels[:, :, level] == int(sys.argv[4]))
    middle = numpy.array([*numpy.unravel_index(disc.argmax(), disc.shape), level], float)

    def normal(mask, index):
        """Of the smoothed mask, in mm; its gradient there."""
        place = numpy.rint(index).astype(int)
        low = numpy.maximum(place - 12, 0)
        part = mask[tuple(slice(a, b) for a, b in zip(low, place + 13))].astype(float)
        slope = numpy.array([
            ndimage.map_coordinates(
                ndimage.gaussian_filter(part, 2.0 / spacing, order=numpy.eye(3, dtype=int)[axis], mode="nearest"),
                (index - low)[:, None], order=1)[0] / spacing[axis] for axis in range(3)])
        return slope / max(numpy.linalg.norm(slope), 1e-9)

    step = 0.02
    for n in range(int(sys.argv[6])):
        angle = 2.0 * numpy.pi * n / int(sys.argv[6])
        way = numpy.array([numpy.cos(angle), numpy.sin(angle), 0.0])  # a direction in voxels and in mm alike, because slices are square
        points = middle + (numpy.arange(0.0, 400.0, step)[:, None] - 400.0) * way / spacing
        index = numpy.rint(points).astype(int)
        inside = numpy.all((index >= 0) & (index < labels.shape), axis=1)
        found, angles = [], []
        for mask in masks:
            met = numpy.zeros(len(points), bool)
            met[inside] = mask[tuple(index[inside].T)]
            first = int(numpy.argmax(met)) if met.any() else -1
            found.append(first * step if first >= 0 else -1)
            angles.append(numpy.degrees(numpy.arccos(min(1.0, abs(normal(mask, points[first]) @ way)))) if first >= 0 else 90)
        turned = affine[:3, :3] / spacing @ way
        print(*nibabel.affines.apply_affine(affine, points[0]), *turned, *found, *angles, 1.0 / numpy.abs(way / spacing).max())
elif command == "slab":
    values, affine = read(sys.argv[2])
    columns, slices = int(sys.argv[3]), [int(n) for n in sys.argv[4:6]]
    affine = affine @ nibabel.affines.from_matvec(numpy.eye(3), [0, 0, slices[0]])
    slab = nibabel.Nifti1Image(values[:columns, :, slices[0] : slices[1] + 1], affine)
    slab.header.set_xyzt_units("mm")
    nibabel.save(slab, sys.argv[6])
elif command == "runs":
    labels, affine = read(sys.argv[2])
    masks = label_sets(labels, read(sys.argv[3])[0], sys.argv[5])
    kind = numpy.zeros(labels.shape, int)
    for number, mask in enumerate(masks, 1):
        kind[mask] = number
    step = 0.02
    start, way = numpy.array([float(n) for n in sys.argv[4].split(",")]).reshape(2, 3)
    points = start + numpy.arange(0.0, 600.0, step)[:, None] * way
    index = numpy.rint(nibabel.affines.apply_affine(numpy.linalg.inv(affine), points)).astype(int)
    inside = numpy.all((index >= 0) & (index < labels.shape), axis=1)
    met = numpy.zeros(len(points), int)
    met[inside] = kind[tuple(index[inside].T)]
    for n in numpy.flatnonzero(numpy.diff(met)) + 1:
        print(n * step, met[n])
elif command == "borders":
    labels, affine = read(sys.argv[2])
    spacing = numpy.linalg.norm(affine[:3, :3], axis=0)
    masks = label_sets(labels, read(sys.argv[3])[0], sys.argv[5])
    for number, *point in numpy.loadtxt(sys.argv[4], ndmin=2):
        mask = masks[int(number)]
        index = nibabel.affines.apply_affine(numpy.linalg.inv(affine), point)
        place = numpy.rint(index).astype(int)
        low = numpy.maximum(place - 6, 0)
        part = mask[tuple(slice(a, b) for a, b in zip(low, place + 7))]
        others = numpy.argwhere(part != mask[tuple(place)]) + low
        # Distance to the nearest voxel box of the other kind; a box begins half a voxel from its
        # center.
        gap = numpy.maximum(numpy.abs(others - index) - 0.5, 0.0) * spacing
        print(numpy.sqrt((gap**2).sum(1)).min() if len(gap) else 1e9)
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
