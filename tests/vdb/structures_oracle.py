"""Structures that were segmented one by one, as nibabel, pydicom and numpy read and write them.

split LABELS FOLDER            each label of a NIfTI file as a mask FOLDER/sNNN.nii.gz
masks FOLDER COUNT SEED        COUNT voxels of a folder of masks: `x y z label` in mm, RAS; labels are the files from 1 by
                               name, and where several overlap it is the one of fewest voxels, of equal ones the last
seg FILE COUNT SEED            the same of a DICOM segmentation; labels are its segments' numbers
contours FILE SERIES COUNT SEED
                               the same of an RT structure set on the slices of a DICOM folder; labels are its ROIs from 1
nrrd FILE COUNT SEED           the same of a .seg.nrrd with gzip; labels are its segments from 1, where several overlap
                               the last
write_older FILE OLDER         a .seg.nrrd as programs wrote it before segments shared layers: a layer for each, of ones,
                               without label values
write_seg LABELS KIND FILE     a NIfTI file of labels as a DICOM segmentation, KIND: binary, implicit, fractional, labelmap,
                               packed (a label map in RLE); but for label maps without the planes where a segment is not
write_contours SEED SLICES FILE
                               an RT structure set of random polygons, some in others, on SLICES slices of 3 mm from z = 10 mm

Half of the voxels are of a structure, if there are so many; the others are any.
"""
import gzip
import os
import re
import sys

import nibabel
import numpy
import pydicom
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.sequence import Sequence

LPS = numpy.diag([-1.0, -1.0, 1.0, 1.0])


def merge(masks, labels):
    """The smallest has what several share; of equal ones the last."""
    out = numpy.zeros(masks[0].shape, int)
    order = sorted(range(len(masks)), key=lambda n: -int(numpy.count_nonzero(masks[n])))
    for n in order:
        out[masks[n]] = labels[n]
    return out


def tell(labels, affine, count, seed):
    random = numpy.random.default_rng(seed)
    index = random.integers(0, labels.shape, (count, 3))
    inside = numpy.argwhere(labels > 0)
    half = min(count // 2, len(inside))
    index[:half] = inside[random.choice(len(inside), half, replace=False)]
    for place, point in zip(index, nibabel.affines.apply_affine(affine, index)):
        print(*(repr(float(x)) for x in point), labels[tuple(place)])


def frame_affine(orientation, spacing, origin, step):
    """Of (column, row, plane), LPS."""
    affine = numpy.eye(4)
    along = numpy.array(orientation, float).reshape(2, 3)
    affine[:3, 0] = along[0] * float(spacing[1])
    affine[:3, 1] = along[1] * float(spacing[0])
    affine[:3, 2] = step
    affine[:3, 3] = origin
    return affine


def new_file(path, sop_class, syntax):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = sop_class
    meta.MediaStorageSOPInstanceUID = "1.2.3.4"
    meta.TransferSyntaxUID = syntax
    file = FileDataset(path, {}, file_meta=meta, preamble=b"\0" * 128)
    file.is_little_endian = True
    file.is_implicit_VR = syntax == pydicom.uid.ImplicitVRLittleEndian
    file.SOPClassUID = sop_class
    file.SOPInstanceUID = "1.2.3.4"
    file.SeriesInstanceUID = "1.2.3"
    return file


def item(**values):
    out = Dataset()
    for key, value in values.items():
        setattr(out, key, value)
    return out


def write_seg(labels_path, kind, path):
    image = nibabel.load(labels_path)
    data = numpy.asarray(image.dataobj).astype(int)
    to_patient = LPS @ image.affine
    spacing = numpy.linalg.norm(to_patient[:3, :3], axis=0)
    syntax = pydicom.uid.ImplicitVRLittleEndian if kind == "implicit" else pydicom.uid.ExplicitVRLittleEndian
    is_packed, kind = kind == "packed", "labelmap" if kind == "packed" else kind
    sop_class = "1.2.840.10008.5.1.4.1.1.66." + ("7" if kind == "labelmap" else "4")
    file = new_file(path, sop_class, syntax)
    file.Modality = "SEG"
    file.Rows, file.Columns = data.shape[1], data.shape[0]
    file.SamplesPerPixel, file.PhotometricInterpretation, file.PixelRepresentation = 1, "MONOCHROME2", 0
    bits = {"labelmap": 16, "fractional": 8}.get(kind, 1)
    file.BitsAllocated = file.BitsStored = bits
    file.HighBit = bits - 1
    file.SegmentationType = {"labelmap": "LABELMAP", "fractional": "FRACTIONAL"}.get(kind, "BINARY")
    if kind == "fractional":
        file.SegmentationFractionalType, file.MaximumFractionalValue = "PROBABILITY", 200
    numbers = [int(n) for n in numpy.unique(data) if n > 0]
    file.SegmentSequence = Sequence(
        [
            item(
                SegmentNumber=n,
                SegmentLabel="part %d" % n,
                SegmentAlgorithmType="MANUAL",
                RecommendedDisplayCIELabValue=[34885, 53485, 50171],  # red
                SegmentedPropertyTypeCodeSequence=Sequence(
                    [item(CodeValue="10200004", CodingSchemeDesignator="SCT", CodeMeaning="Liver")]
                ),
            )
            for n in numbers
        ]
    )
    shared = item(
        PlaneOrientationSequence=Sequence(
            [
                item(
                    ImageOrientationPatient=[
                        "%.10f" % x for x in (to_patient[:3, :2] / spacing[:2]).T.ravel()
                    ]
                )
            ]
        ),
        PixelMeasuresSequence=Sequence(
            [
                item(
                    PixelSpacing=["%.8f" % spacing[1], "%.8f" % spacing[0]],
                    SliceThickness="%.8f" % spacing[2],
                    SpacingBetweenSlices="%.8f" % spacing[2],
                )
            ]
        ),
    )
    file.SharedFunctionalGroupsSequence = Sequence([shared])
    frames, groups = [], []
    random = numpy.random.default_rng(7)
    for n in numbers if kind != "labelmap" else [None]:
        planes = list(range(data.shape[2]))
        if n is not None:
            planes = [k for k in planes if (data[:, :, k] == n).any()]
            random.shuffle(planes)  # the order of planes is not defined
        for k in planes:
            plane = data[:, :, k].T  # rows, columns
            frames.append(plane if n is None else plane == n)
            place = to_patient @ [0, 0, k, 1]
            group = item(PlanePositionSequence=Sequence([item(ImagePositionPatient=["%.8f" % x for x in place[:3]])]))
            if n is not None:
                group.SegmentIdentificationSequence = Sequence([item(ReferencedSegmentNumber=n)])
            groups.append(group)
    file.PerFrameFunctionalGroupsSequence = Sequence(groups)
    file.NumberOfFrames = len(frames)
    pixels = numpy.array(frames)
    if kind == "labelmap":
        raw = pixels.astype("<u2").tobytes()
    elif kind == "fractional":
        # Values from half of the largest one on, and values just below it.
        raw = numpy.where(pixels, random.integers(100, 201, pixels.shape), random.integers(0, 100, pixels.shape))
        raw = raw.astype("u1").tobytes()
    else:
        raw = numpy.packbits(pixels.ravel(), bitorder="little").tobytes()
    file.PixelData = raw + b"\0" * (len(raw) % 2)
    file["PixelData"].VR = "OW" if kind in ("labelmap", "implicit") else "OB"
    if is_packed:
        file.compress(pydicom.uid.RLELossless)
    file.save_as(path, write_like_original=False)


def read_seg(path):
    file = pydicom.dcmread(path)
    rows, columns, count = file.Rows, file.Columns, int(file.NumberOfFrames)
    if file.file_meta.TransferSyntaxUID == pydicom.uid.RLELossless:
        frames = file.pixel_array
    elif file.BitsAllocated == 1:
        bits = numpy.unpackbits(numpy.frombuffer(file.PixelData, "u1"), bitorder="little")
        frames = bits[: rows * columns * count].reshape(count, rows, columns) > 0
    else:
        frames = numpy.frombuffer(file.PixelData, "u1" if file.BitsAllocated == 8 else "<u2")
        frames = frames[: rows * columns * count].reshape(count, rows, columns)
        if file.SegmentationType == "FRACTIONAL":
            frames = 2 * frames.astype(int) >= int(file.MaximumFractionalValue)
    shared = file.SharedFunctionalGroupsSequence[0]
    orientation = numpy.array(shared.PlaneOrientationSequence[0].ImageOrientationPatient, float)
    measures = shared.PixelMeasuresSequence[0]
    normal = numpy.cross(orientation[:3], orientation[3:])
    groups = file.PerFrameFunctionalGroupsSequence
    places = numpy.array([g.PlanePositionSequence[0].ImagePositionPatient for g in groups], float)
    step = normal * float(measures.SpacingBetweenSlices)
    first = places[numpy.argmin(places @ normal)]
    plane = numpy.rint((places - first) @ normal / float(measures.SpacingBetweenSlices)).astype(int)
    affine = LPS @ frame_affine(orientation, measures.PixelSpacing, first, step)
    shape = (columns, rows, int(plane.max()) + 1)
    if file.SegmentationType == "LABELMAP":
        labels = numpy.zeros(shape, int)
        for k, frame in zip(plane, frames):
            labels[:, :, k] = frame.T
        return labels, affine
    numbers = [int(s.SegmentNumber) for s in file.SegmentSequence]
    masks = [numpy.zeros(shape, bool) for _ in numbers]
    for k, frame, group in zip(plane, frames, groups):
        of = numbers.index(int(group.SegmentIdentificationSequence[0].ReferencedSegmentNumber))
        masks[of][:, :, k] |= frame.T
    return merge(masks, numbers), affine


def read_nrrd(path):
    """Header, and the segments as masks, with their affine, RAS, mm."""
    header, data = open(path, "rb").read().split(b"\n\n", 1)
    header = header.decode()
    line = lambda key: re.search("^%s: (.*)$" % key, header, re.M).group(1)
    sizes = [int(n) for n in line("sizes").split()]
    layers = numpy.frombuffer(gzip.decompress(data), numpy.uint8).reshape(sizes, order="F")
    layers = layers.reshape([-1] + sizes[-3:], order="F")
    numbers = lambda text: numpy.array([float(n) for n in re.findall(r"[-+.\deE]+", text)])
    affine = numpy.eye(4)
    affine[:3, :3] = numbers(line("space directions").replace("none", "")).reshape(3, 3).T
    affine[:3, 3] = numbers(line("space origin"))
    count = len(re.findall(r"^Segment\d+_Name:=", header, re.M))

    def value(n, key, otherwise):
        found = re.search("^Segment%d_%s:=(.*)$" % (n, key), header, re.M)
        return int(found.group(1)) if found else otherwise

    masks = [layers[value(n, "Layer", n)] == value(n, "LabelValue", 1) for n in range(count)]
    return header, masks, LPS @ affine if "left-posterior" in line("space") else affine


def write_older(path, older):
    header, masks, _ = read_nrrd(path)
    header = re.sub(r"^Segment\d+_(LabelValue|Layer):=.*\n", "", header, flags=re.M)
    size = " ".join(str(n) for n in masks[0].shape)
    header = re.sub("^sizes: .*$", "sizes: %d %s" % (len(masks), size), header, flags=re.M)
    data = numpy.array(masks, numpy.uint8).ravel(order="F").tobytes()
    open(older, "wb").write(header.encode() + b"\n\n" + gzip.compress(data, 1))


def write_contours(seed, slices, path):
    random = numpy.random.default_rng(seed)
    file = new_file(path, "1.2.840.10008.5.1.4.1.1.481.3", pydicom.uid.ExplicitVRLittleEndian)
    file.Modality = "RTSTRUCT"
    file.SeriesInstanceUID = "1.2.9"
    rois, contours, observations = [], [], []
    for number in (3, 4, 8):
        rois.append(item(ROINumber=number, ROIName="roi %d" % number))
        loops = []
        for k in range(1, slices - 1):
            center = random.uniform(20, 40, 2)
            turn = numpy.linspace(0, 2 * numpy.pi, 40, endpoint=False)
            radius = 9 * (1 + 0.3 * numpy.sin(3 * turn + random.uniform(0, 6)))
            for share in (1.0, 0.45) if number != 8 else (1.0,):  # the inner loop is a hole
                xy = center + share * radius[:, None] * numpy.column_stack([numpy.cos(turn), numpy.sin(turn)])
                xyz = numpy.column_stack([xy, numpy.full(len(xy), 10.0 + 3.0 * k)])
                loops.append(
                    item(
                        ContourGeometricType="CLOSED_PLANAR",
                        NumberOfContourPoints=len(xyz),
                        ContourData=["%.6f" % x for x in xyz.ravel()],
                    )
                )
        contours.append(item(ReferencedROINumber=number, ROIDisplayColor=[255, 0, 51], ContourSequence=Sequence(loops)))
        observations.append(
            item(
                ObservationNumber=number,
                ReferencedROINumber=number,
                RTROIInterpretedType="ORGAN",
                RTROIIdentificationCodeSequence=Sequence(
                    [item(CodeValue="10200004", CodingSchemeDesignator="SCT", CodeMeaning="Liver")]
                ),
            )
        )
    file.StructureSetROISequence = Sequence(rois)
    file.ROIContourSequence = Sequence(contours)
    file.RTROIObservationsSequence = Sequence(observations)
    series = item(SeriesInstanceUID="1.2.3")
    study = item(RTReferencedSeriesSequence=Sequence([series]))
    file.ReferencedFrameOfReferenceSequence = Sequence([item(RTReferencedStudySequence=Sequence([study]))])
    file.save_as(path, write_like_original=False)


def read_contours(path, folder):
    """Even-odd by the angle's crossings of a ray, point by point."""
    slices = [pydicom.dcmread(os.path.join(folder, name)) for name in os.listdir(folder)]
    slices = [s for s in slices if "ImagePositionPatient" in s]
    slices.sort(key=lambda s: float(s.ImagePositionPatient[2]))
    places = numpy.array([s.ImagePositionPatient for s in slices], float)
    step = (places[-1] - places[0]) / (len(slices) - 1)
    affine = frame_affine(slices[0].ImageOrientationPatient, slices[0].PixelSpacing, places[0], step)
    shape = (slices[0].Columns, slices[0].Rows, len(slices))
    file = pydicom.dcmread(path)
    numbers = [int(r.ROINumber) for r in file.StructureSetROISequence]
    masks = [numpy.zeros(shape, bool) for _ in numbers]
    columns, rows = numpy.meshgrid(numpy.arange(shape[0]), numpy.arange(shape[1]), indexing="ij")
    for roi in file.ROIContourSequence:
        mask = masks[numbers.index(int(roi.ReferencedROINumber))]
        for loop in roi.ContourSequence:
            xyz = numpy.array(loop.ContourData, float).reshape(-1, 3)
            index = nibabel.affines.apply_affine(numpy.linalg.inv(affine), xyz)
            inside = numpy.zeros(shape[:2], bool)
            for a, b in zip(index, numpy.roll(index, -1, axis=0)):
                crosses = (a[1] > rows) != (b[1] > rows)
                with numpy.errstate(divide="ignore", invalid="ignore"):
                    at = a[0] + (rows - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
                inside ^= crosses & (columns < at)
            mask[:, :, int(round(index[0, 2]))] ^= inside
    return merge(masks, list(range(1, len(masks) + 1))), LPS @ affine


command, words = sys.argv[1], sys.argv[2:]
if command == "split":
    image = nibabel.load(words[0])
    data = numpy.asarray(image.dataobj).astype(int)
    for label in numpy.unique(data):
        if label > 0:
            mask = nibabel.Nifti1Image((data == label).astype(numpy.uint8), image.affine)
            mask.header.set_xyzt_units("mm")
            nibabel.save(mask, os.path.join(words[1], "s%03d.nii.gz" % label))
elif command == "masks":
    names = sorted(name for name in os.listdir(words[0]) if name.endswith(".nii.gz"))
    images = [nibabel.load(os.path.join(words[0], name)) for name in names]
    masks = [numpy.asarray(image.dataobj) > 0 for image in images]
    tell(merge(masks, list(range(1, len(masks) + 1))), images[0].affine, int(words[1]), int(words[2]))
elif command == "seg":
    tell(*read_seg(words[0]), int(words[1]), int(words[2]))
elif command == "contours":
    tell(*read_contours(words[0], words[1]), int(words[2]), int(words[3]))
elif command == "nrrd":
    _, masks, affine = read_nrrd(words[0])
    labels = numpy.zeros(masks[0].shape, int)
    for number, mask in enumerate(masks, 1):
        labels[mask] = number
    tell(labels, affine, int(words[1]), int(words[2]))
elif command == "write_older":
    write_older(*words)
elif command == "write_seg":
    write_seg(*words)
elif command == "write_contours":
    write_contours(int(words[0]), int(words[1]), words[2])
else:
    sys.exit("unknown command")
