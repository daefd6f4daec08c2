"""Reads the images of tests/loaders/images/image_peers_test.cpp with other programs' libraries, and compares each voxel with the
formula: one line a library with how many were right, a line for each that was not, one for each library that is absent.

    image_peers.py MANIFEST      one JSON object a line: what, format, type, file, files (of a series), base, origin, axes
"""
import itertools
import json
import sys
import warnings

warnings.simplefilter("ignore")
SHAPE = (5, 4, 3)


def value_at(case, i, j, k):
    return case["base"] + 2 * i + 3 * j + 5 * k


def of_vtk(case):
    """Values by (i, j, k), and the place of a voxel where the reader tells it."""
    import vtk

    vtk.vtkObject.GlobalWarningDisplayOff()
    readers = {
        "VTK XML": vtk.vtkXMLImageDataReader,
        "VTK legacy": vtk.vtkStructuredPointsReader,
        "MetaImage": vtk.vtkMetaImageReader,
        "NIfTI": vtk.vtkNIFTIImageReader,
    }
    if case["format"] not in readers or case["file"].endswith(".hdr"):
        return None
    if case["format"] == "MetaImage" and case["type"].endswith("int64"):
        return "refused"  # VTK 9.1 writes beyond its memory
    if ".mha, text" in case["what"] and ", big" in case["what"]:
        return None  # MetaIO turns numbers of text around, too
    reader = readers[case["format"]]()
    reader.SetFileName(case["file"])
    reader.Update()
    image = reader.GetOutput()
    array = image.GetPointData().GetScalars()
    if image.GetDimensions() != SHAPE or array is None or array.GetNumberOfTuples() != 60:
        return "refused"
    values = {v: array.GetTuple1(v[0] + 5 * (v[1] + 4 * v[2])) for v in itertools.product(*map(range, SHAPE))}
    if case["format"] == "NIfTI":
        m, h = reader.GetSFormMatrix(), image.GetSpacing()
        return values, lambda v: [m.GetElement(r, 3) + sum(m.GetElement(r, c) * h[c] * v[c] for c in range(3)) for r in range(3)]
    if case["format"] == "MetaImage":
        return values, None  # VTK 9.1 leaves the directions out
    return values, lambda v: place(image, v)


def place(image, v):
    x = [0.0] * 3
    image.TransformIndexToPhysicalPoint(list(v), x)
    return x


def of_nibabel(case):
    import nibabel

    if case["format"] != "NIfTI":
        return None
    image = nibabel.load(case["file"])
    data = image.dataobj.get_unscaled()
    values = {v: data[v] for v in itertools.product(*map(range, SHAPE))}
    return values, lambda v: list(image.affine[:3, :3] @ v + image.affine[:3, 3])


def of_pydicom(case):
    import pydicom

    if case["format"] != "DICOM":
        return None
    values, corner, step = {}, {}, None
    for k, file in enumerate(case["files"]):
        slice_ = pydicom.dcmread(file)
        pixels = slice_.pixel_array
        row, column = slice_.ImageOrientationPatient[:3], slice_.ImageOrientationPatient[3:]
        down, across = slice_.PixelSpacing
        step = [float(across) * x for x in row], [float(down) * x for x in column]
        corner[k] = slice_.ImagePositionPatient
        for i, j in itertools.product(range(5), range(4)):
            values[i, j, k] = pixels[j, i]
    lps = lambda v: [float(corner[v[2]][c]) + step[0][c] * v[0] + step[1][c] * v[1] for c in range(3)]
    return values, lambda v: [-lps(v)[0], -lps(v)[1], lps(v)[2]]


def fault(case, read):
    values, place_of = read
    for v in itertools.product(*map(range, SHAPE)):
        wanted = value_at(case, *v)
        if float(values[v]) != float(wanted):
            return f"{values[v]} at {v} in place of {wanted}"
        if place_of is None:
            continue
        expected = [case["origin"][r] + sum(case["axes"][c][r] * v[c] for c in range(3)) for r in range(3)]
        if max(abs(a - b) for a, b in zip(place_of(v), expected)) > 1e-5:
            return f"voxel {v} at {place_of(v)} in place of {expected}"
    return None


def main():
    with open(sys.argv[1], encoding="utf-8") as lines:
        cases = [json.loads(line) for line in lines]
    for name, module, read in (("VTK", "vtk", of_vtk), ("nibabel", "nibabel", of_nibabel), ("pydicom", "pydicom", of_pydicom)):
        try:
            __import__(module)
        except ImportError:
            print("absent", name)
            continue
        right, refused = 0, set()
        for case in cases:
            try:
                got = read(case)
            except Exception as problem:  # of whatever library
                refused.add(f"{case['format']} {case['type']}: {type(problem).__name__}")
                continue
            if got is None:
                continue
            if got == "refused":
                refused.add(f"{case['format']} {case['type']}")
                continue
            wrong = fault(case, got)
            if wrong is None:
                right += 1
            else:
                print("wrong", name, case["what"] + ":", wrong)
        print("right", name, right, "refused:", ", ".join(sorted(refused)) or "none")


main()
