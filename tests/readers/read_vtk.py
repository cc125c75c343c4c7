"""read_vtk.py FILE...: what VTK reads in .pvd files and the .vtp files they list, and h5py
in a head's .h5: for each FILE a line of JSON, or {"error": why} where it cannot be read.
"""

import json
import os
import sys

import h5py
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkIOXMLParser import vtkXMLDataParser


class Unreadable(Exception):
    pass


def listened(reader, file):
    """The reader of this file, and what it complains about."""
    complaints = []
    for event in ("ErrorEvent", "WarningEvent"):
        reader.AddObserver(event, lambda *_, event=event: complaints.append(event))
    reader.SetFileName(file)
    return complaints


def read_vtp(file):
    reader = vtkXMLPolyDataReader()
    complaints = listened(reader, file)
    reader.Update()
    data = reader.GetOutput()
    time = data.GetFieldData().GetArray("TimeValue")
    # What VTK's parser cannot read it leaves out, often without a word.
    if complaints or reader.GetErrorCode() or not time or not data.GetNumberOfPoints():
        raise Unreadable(f"{os.path.basename(file)}: VTK cannot read it")
    lines = data.GetLines()
    order = vtk_to_numpy(lines.GetConnectivityArray())
    if data.GetNumberOfCells() != data.GetNumberOfLines() or list(order) != list(
        range(data.GetNumberOfPoints())
    ):
        raise Unreadable(f"{os.path.basename(file)}: lines do not take all points in order")
    arrays = data.GetPointData()
    return {
        "file": os.path.basename(file),
        "time": time.GetValue(0),
        "points": vtk_to_numpy(data.GetPoints().GetData()).ravel().tolist(),
        "ends": vtk_to_numpy(lines.GetOffsetsArray())[1:].tolist(),
        "arrays": {
            arrays.GetArrayName(i): vtk_to_numpy(arrays.GetArray(i)).tolist()
            for i in range(arrays.GetNumberOfArrays())
        },
    }


def read_pvd(file):
    """VTK has no reader of .pvd files but the parser that ParaView's is made of."""
    parser = vtkXMLDataParser()
    complaints = listened(parser, file)
    if not parser.Parse() or complaints:
        raise Unreadable(f"{os.path.basename(file)}: VTK cannot read it")
    listed = parser.GetRootElement().FindNestedElementWithName("Collection")
    sets = [listed.GetNestedElement(i) for i in range(listed.GetNumberOfNestedElements())]
    folder = os.path.dirname(file)
    return {
        "times": [float(s.GetAttribute("timestep")) for s in sets],
        "frames": [read_vtp(os.path.join(folder, s.GetAttribute("file"))) for s in sets],
    }


def read_h5(file):
    with h5py.File(file) as head:
        positions = head["positions"]
        return {
            "points_of_a_strand": int(head.attrs["points"]),
            "times": head["series"][:, 0].tolist(),
            "frames": [positions[name][:].ravel().tolist() for name in sorted(positions)],
        }


vtkObject.GlobalWarningDisplayOff()
for name in sys.argv[1:]:
    try:
        print(json.dumps(read_h5(name) if name.endswith(".h5") else read_pvd(name)))
    except Unreadable as problem:
        print(json.dumps({"error": str(problem)}))
