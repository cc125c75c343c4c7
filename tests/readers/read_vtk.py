"""What VTK reads in .pvd files and the .vtp files they list, and h5py in the .h5 of a head."""
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy
from own import Unreadable
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkIOXMLParser import vtkXMLDataParser

vtkObject.GlobalWarningDisplayOff()


@dataclass
class VtkFrame:
    file: str
    time: float
    counts: list
    points: numpy.ndarray
    arrays: dict


@dataclass
class VtkReading:
    file: str
    times: list
    frames: list


def listened(reader, path):
    """Gives a reader its file; returns a list that gets its complaints."""
    complaints = []
    for event in ("ErrorEvent", "WarningEvent"):
        reader.AddObserver(event, lambda *_, event=event: complaints.append(event))
    reader.SetFileName(str(path))
    return complaints


def read_vtp(path):
    reader = vtkXMLPolyDataReader()
    complaints = listened(reader, path)
    reader.Update()
    data = reader.GetOutput()
    time = data.GetFieldData().GetArray("TimeValue")
    # What VTK's parser cannot read it leaves out, often without a word.
    if complaints or reader.GetErrorCode() or not time or not data.GetNumberOfPoints():
        raise Unreadable(f"{path.name}: VTK cannot read it")
    lines = data.GetLines()
    order = vtk_to_numpy(lines.GetConnectivityArray())
    if data.GetNumberOfCells() != data.GetNumberOfLines() or list(order) != list(range(data.GetNumberOfPoints())):
        raise Unreadable(f"{path.name}: lines do not take all points in order")
    arrays = data.GetPointData()
    # Copies: VTK frees its arrays with the reader.
    return VtkFrame(path.name, time.GetValue(0), numpy.diff(vtk_to_numpy(lines.GetOffsetsArray())).tolist(),
                    vtk_to_numpy(data.GetPoints().GetData()).astype(float),
                    {arrays.GetArrayName(i): vtk_to_numpy(arrays.GetArray(i)).astype(float)
                     for i in range(arrays.GetNumberOfArrays())})


def read_pvd(path):
    """VTK has no reader of .pvd files but the parser that ParaView's is made of."""
    parser = vtkXMLDataParser()
    complaints = listened(parser, path)
    if not parser.Parse() or complaints:
        raise Unreadable(f"{path.name}: VTK cannot read it")
    listed = parser.GetRootElement().FindNestedElementWithName("Collection")
    sets = [listed.GetNestedElement(i) for i in range(listed.GetNumberOfNestedElements())]
    return VtkReading(path.name, [float(each.GetAttribute("timestep")) for each in sets],
                      [read_vtp(path.parent / each.GetAttribute("file")) for each in sets])


def read_h5(path):
    """Returns the points of each frame, strands x points of a strand x 3."""
    with h5py.File(Path(path)) as head:
        points = int(head.attrs["points"])
        positions = head["positions"]
        return [positions[name][:].reshape(-1, points, 3) for name in sorted(positions)]
