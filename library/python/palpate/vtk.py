"""A filter of VTK: lines with their errors, in place of vtkStreamTracer."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy  # type: ignore[import]
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase  # type: ignore[import]
from vtkmodules.vtkCommonDataModel import (  # type: ignore[import]
    VTK_TETRA,
    vtkCellArray,
    vtkDataSet,
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray  # type: ignore[import]

from . import ENDS, Field, Lines, UsageError, tetrahedra, trace, uniform

__all__ = ["StreamTracer", "field_of", "lines_to_vtk"]


def field_of(data: Any, vectors: str = "") -> Field:
    """The field of an image, or of a mesh of tetrahedra, and its vectors at points, which are not copied where they are
    float32 or float64.

    vectors: the name of the array; without one the active vectors, else the only array of three components.
    UsageError: for other grids, with what makes one of these of them.
    """
    points = data.GetPointData()
    array = points.GetArray(vectors) if vectors else points.GetVectors()
    if array is None and not vectors:
        three = [i for i in range(points.GetNumberOfArrays()) if points.GetArray(i) and points.GetArray(i).GetNumberOfComponents() == 3]
        array = points.GetArray(three[0]) if len(three) == 1 else None
    if array is None or array.GetNumberOfComponents() != 3:
        names = ", ".join(str(points.GetArrayName(i)) for i in range(points.GetNumberOfArrays())) or "none"
        raise UsageError(
            f"vectors at points are expected, by name; there are {names}. Of cells: put vtkCellDataToPointData before this"
        )
    values = vtk_to_numpy(array)
    if isinstance(data, vtkImageData):
        if not data.GetDirectionMatrix().IsIdentity():
            raise UsageError("the image is turned against the axes: put vtkDataSetTriangleFilter before this")
        nx, ny, nz = data.GetDimensions()
        return uniform(values.reshape(nz, ny, nx, 3), data.GetSpacing(), data.GetPoint(0))
    if isinstance(data, vtkUnstructuredGrid):
        if data.GetNumberOfCells() > 0 and (vtk_to_numpy(data.GetCellTypesArray()) == VTK_TETRA).all():
            cells = vtk_to_numpy(data.GetCells().GetConnectivityArray()).reshape(-1, 4)
            return tetrahedra(vtk_to_numpy(data.GetPoints().GetData()).astype(np.float64, copy=False), cells, values)
    raise UsageError(
        f"{data.GetClassName()}: an image or tetrahedra are expected; put vtkDataSetTriangleFilter (ParaView: Tetrahedralize) before this"
    )


def lines_to_vtk(lines: Lines, poly: Any = None) -> Any:
    """The lines as vtkPolyData: `time`, `arc`, `speed`, `error` by point; `seed` and `termination` by line."""
    poly = vtkPolyData() if poly is None else poly
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.array(lines.points), deep=True))
    poly.SetPoints(points)
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtkIdTypeArray(np.array(lines.offsets, np.int64), deep=True),
        numpy_to_vtkIdTypeArray(np.arange(len(lines.points), dtype=np.int64), deep=True),
    )
    poly.SetLines(cells)
    for name in ("time", "arc", "speed", "error"):
        column = numpy_to_vtk(np.array(getattr(lines, name)), deep=True)
        column.SetName(name)
        poly.GetPointData().AddArray(column)
    seed = numpy_to_vtk(np.array(lines.seed, np.int32), deep=True)
    seed.SetName("seed")
    poly.GetCellData().AddArray(seed)
    words = vtkStringArray()
    words.SetName("termination")
    for code in lines.end_code:
        words.InsertNextValue(ENDS[code])
    poly.GetCellData().AddArray(words)
    return poly


class StreamTracer(VTKPythonAlgorithmBase):  # type: ignore[misc]
    """Input 0: an image, or tetrahedra, with vectors at points. Input 1, where there is one: its points are the seeds; else
    Seeds says them, as `flow trace --seeds` does. Output: vtkPolyData, as lines_to_vtk() makes it."""

    def __init__(self) -> None:
        super().__init__(nInputPorts=2, nOutputPorts=1, outputType="vtkPolyData")
        self._vectors = ""
        self._seeds = "random:100"
        self._options: dict[str, Any] = {"direction": "both", "tolerance": 1e-6, "max_length": 0.0, "method": ""}

    def FillInputPortInformation(self, port: int, info: Any) -> int:
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet" if port == 0 else "vtkPointSet")
        if port == 1:
            info.Set(self.INPUT_IS_OPTIONAL(), 1)
        return 1

    def _set(self, **options: Any) -> None:
        if any(self._options[name] != value for name, value in options.items()):
            self._options.update(options)
            self.Modified()

    def SetVectors(self, name: str) -> None:
        """Of an array at points; empty: as field_of() finds it."""
        if name != self._vectors:
            self._vectors = name
            self.Modified()

    def SetSeeds(self, text: str) -> None:
        """As `flow trace --seeds`: "random:100", "grid:4,4,4", "point:x,y,z", …"""
        if text != self._seeds:
            self._seeds = text
            self.Modified()

    def SetDirection(self, word: str) -> None:
        """forward, backward or both."""
        self._set(direction=word)

    def SetTolerance(self, value: float) -> None:
        """Position error per diagonal travelled, relative to the diagonal."""
        self._set(tolerance=value)

    def SetMaximumLength(self, value: float) -> None:
        """In the data's unit; 0: 10 diagonals."""
        self._set(max_length=value)

    def SetMethod(self, word: str) -> None:
        """exact, dp54, …; empty: exact on tetrahedra, dp54 elsewhere."""
        self._set(method=word)

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:
        data = vtkDataSet.GetData(inputs[0], 0)
        field = field_of(data, self._vectors)
        sources = vtkPointSet.GetData(inputs[1], 0) if inputs[1].GetNumberOfInformationObjects() > 0 else None
        seeds: Any = self._seeds
        if sources is not None:
            seeds = vtk_to_numpy(sources.GetPoints().GetData()).astype(np.float64)
        lines_to_vtk(trace(field, seeds, **self._options), vtkPolyData.GetData(outputs, 0))
        return 1
