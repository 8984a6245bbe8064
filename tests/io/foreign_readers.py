#!/usr/bin/python3
"""Repose: reads exported points with programs that are not ours, since a format is what its consumers read.

    foreign_readers.py FOLDER [--name NAME]

FOLDER holds NAME.0001.vdb, NAME.0001.ply, NAME.0001.vtp (NAME is out.points unless told) and NAME.json, written
beside them by who exported them:
    {"count": 3, "first_ids": [0, 1, 2], "bounds": [[0, 0, 0], [1, 1, 1]], "spacing": 0.1, "attributes": ["age"]}
first_ids are the ids of the first particles as written; attributes are the names of further scalars, tensors of those
with six components (both may lack).
Debian: libopenvdb-tools (vdb_print, vdb_tool), python3-meshio (PLY with all properties; VTK drops v),
python3-vtk9 (VTP; meshio has no VTP).
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import meshio
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

failures = []


def expect(good, what):
    print(("ok    " if good else "WRONG ") + what)
    if not good:
        failures.append(what)


def expect_points(format_name, points, expected, tolerance):
    """Count and bounds of what one reader saw."""
    expect(len(points) == expected["count"], f"{format_name}: {len(points)} points, expected {expected['count']}")
    if len(points) and expected["count"]:
        seen = np.array([points.min(axis=0), points.max(axis=0)], dtype=float)
        worst = np.abs(seen - np.array(expected["bounds"])).max()
        expect(worst <= tolerance, f"{format_name}: bounds {seen.tolist()} differ by {worst:.3g} m")


def expect_arrays(format_name, arrays, expected):
    """Ids of the first particles and the presence of all attributes; `arrays` by name."""
    ids = arrays.get("id")
    first = expected["first_ids"]
    expect(ids is not None and np.ravel(ids)[: len(first)].tolist() == first, f"{format_name}: first ids {first}")
    for name in expected.get("attributes", []):
        good = name in arrays and np.size(arrays[name]) == expected["count"] and np.isfinite(arrays[name]).all()
        expect(good, f"{format_name}: attribute {name} is whole and finite")


def check_vdb(path, expected):
    """vdb_print tells grid, type and voxel, vdb_tool every position. No program of Debian shows the other values
    of VDB points: that they come back is for the test of our own reader, which is OpenVDB's library."""
    text = subprocess.run(["vdb_print", "-m", str(path)], capture_output=True, text=True, check=True).stdout
    expect(re.search(r"^points\s+ptdataidx32\b", text, re.M) is not None, "vdb_print: a grid of points named points")
    voxel = re.search(r"voxel size: (\S+)", text)
    good = voxel is not None and abs(float(voxel.group(1)) - expected["spacing"]) <= 1e-5 * expected["spacing"]
    expect(good, f"vdb_print: voxel size {expected['spacing']}")
    if expected["count"] == 0:
        expect("file_voxel_count: 0" in text, "vdb_print: no voxels")
        return
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "points.ply"
        subprocess.run(["vdb_tool", "-read", str(path), "-vdb2points", "-write", str(out)], check=True,
                       capture_output=True)
        expect_points("vdb_tool", meshio.read(out).points, expected, 1e-3 * expected["spacing"])


def check_ply(path, expected):
    mesh = meshio.read(path)
    expect_points("meshio PLY", mesh.points, expected, 1e-3 * expected["spacing"])
    expect_arrays("meshio PLY", mesh.point_data, expected)
    parts = [f"{name}_{part}" for name in expected.get("tensors", []) for part in ("xx", "yy", "zz", "xy", "yz", "xz")]
    for name in ("vx", "vy", "vz", "radius", *parts):
        expect(name in mesh.point_data, f"meshio PLY: property {name}")


def check_vtp(path, expected):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    expect(reader.GetErrorCode() == 0, "VTK: reads without an error")
    data = reader.GetOutput()
    count = data.GetNumberOfPoints()
    points = vtk_to_numpy(data.GetPoints().GetData()) if count else np.zeros((0, 3))
    expect_points("VTK", points, expected, 1e-3 * expected["spacing"])
    expect(data.GetNumberOfVerts() == expected["count"], f"VTK: {data.GetNumberOfVerts()} vertex cells")
    table = data.GetPointData()
    arrays = {table.GetArrayName(i): vtk_to_numpy(table.GetArray(i)) for i in range(table.GetNumberOfArrays())}
    expect_arrays("VTK", arrays, expected)
    expect(arrays["v"].shape == (expected["count"], 3), "VTK: v has three components")
    expect("pscale" in arrays, "VTK: pscale")
    for name in expected.get("tensors", []):
        good = name in arrays and arrays[name].shape == (expected["count"], 6) and np.isfinite(arrays[name]).all()
        expect(good, f"VTK: {name} has six components")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--name", default="out.points")
    arguments = parser.parse_args()
    expected = json.loads((arguments.folder / f"{arguments.name}.json").read_text())
    stem = arguments.folder / arguments.name
    for check, extension in ((check_vdb, "vdb"), (check_ply, "ply"), (check_vtp, "vtp")):
        try:
            check(pathlib.Path(f"{stem}.0001.{extension}"), expected)
        except Exception as error:  # a reader that dies is one more failure, not the end of the report
            expect(False, f"{extension}: {error!r}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
