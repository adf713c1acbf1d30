"""What meshes and images hold, read from their bytes and by nibabel: numbers for convert_files_test.cpp.

mesh FILE      triangles, open edges, signed volume, then the box's lower and upper corner; the file's own unit
image FILE     least and greatest value, number of negative voxels times the voxel's volume, then their mean place
"""

import collections
import json
import struct
import sys

import numpy


def stl(data):
    count = struct.unpack_from("<I", data, 80)[0]
    assert len(data) == 84 + 50 * count
    record = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    rows = numpy.frombuffer(data, record, count, 84)
    corners = rows["corners"].astype(float)
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (numpy.einsum("ij,ij->i", normals, rows["normal"]) >= 0).all(), "normals against the winding"
    return corners


def obj(data):
    points, faces = [], []
    for line in data.decode().splitlines():
        words = line.split()
        if words and words[0] == "v":
            points.append([float(w) for w in words[1:4]])
        if words and words[0] == "f":
            faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return numpy.array(points)[numpy.array(faces)]


def ply(data):
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    assert "format binary_little_endian 1.0" in lines
    vertices, faces = (int(line.split()[2]) for line in lines if line.startswith("element"))
    points = numpy.frombuffer(body, "<f8", 3 * vertices).reshape(-1, 3)
    record = numpy.dtype([("count", "u1"), ("corners", "<i4", 3)])
    rows = numpy.frombuffer(body, record, faces, 24 * vertices)
    assert (rows["count"] == 3).all()
    return points[rows["corners"]]


def glb(data):
    magic, version, length, chunk, kind = struct.unpack_from("<4sIII4s", data)
    assert magic == b"glTF" and version == 2 and length == len(data) and kind == b"JSON"
    scene = json.loads(data[20 : 20 + chunk])
    binary = data[20 + chunk + 8 :]

    def array(number, dtype, width):
        accessor = scene["accessors"][number]
        view = scene["bufferViews"][accessor["bufferView"]]
        return numpy.frombuffer(binary, dtype, accessor["count"] * width, view.get("byteOffset", 0))

    part = scene["meshes"][0]["primitives"][0]
    points = array(part["attributes"]["POSITION"], "<f4", 3).reshape(-1, 3).astype(float)
    return points[array(part["indices"], "<u4", 1).reshape(-1, 3)]


def write(numbers):
    print(" ".join(repr(float(n)) for n in numbers))


command, name = sys.argv[1:]
if command == "mesh":
    with open(name, "rb") as file:
        corners = {"stl": stl, "obj": obj, "ply": ply, "glb": glb}[name.rsplit(".", 1)[1]](file.read())
    volume = numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6
    _, names = numpy.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    edges = collections.Counter()
    for a, b, c in names.reshape(-1, 3):
        for edge in ((a, b), (b, c), (c, a)):
            edges[edge] += 1
            edges[edge[::-1]] -= 1
    is_open = sum(count > 0 for count in edges.values())
    write([len(corners), is_open, volume, *corners.min(axis=(0, 1)), *corners.max(axis=(0, 1))])
elif command == "image":
    import nibabel

    image = nibabel.load(name)
    values = numpy.asarray(image.dataobj, dtype=float)
    inside = numpy.argwhere(values < 0)
    places = nibabel.affines.apply_affine(image.affine, inside)
    voxel = abs(numpy.linalg.det(image.affine[:3, :3]))
    assert image.header.get_xyzt_units()[0] == "mm"
    write([values.min(), values.max(), len(inside) * voxel, *places.mean(axis=0)])
    write(image.affine[:3].ravel())
else:
    sys.exit("unknown command")
