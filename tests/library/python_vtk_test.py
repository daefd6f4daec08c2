"""The filter of VTK: on images and tetrahedra, against the closed form and beside vtkStreamTracer."""

import unittest

import numpy as np
import palpate
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData, vtkRectilinearGrid
from vtkmodules.vtkFiltersFlowPaths import vtkStreamTracer
from vtkmodules.vtkFiltersGeneral import vtkDataSetTriangleFilter

from palpate.vtk import StreamTracer, field_of


def turning(n=17):
    """(-y, x, 0.25) on [-1, 1]^3: linear, so that every interpolation of it is exact."""
    image = vtkImageData()
    image.SetDimensions(n, n, n)
    image.SetSpacing(3 * [2.0 / (n - 1)])
    image.SetOrigin(-1.0, -1.0, -1.0)
    x = np.array([image.GetPoint(i) for i in range(image.GetNumberOfPoints())])
    array = numpy_to_vtk(np.stack([-x[:, 1], x[:, 0], np.full(len(x), 0.25)], axis=1), deep=True)
    array.SetName("v")
    image.GetPointData().AddArray(array)
    return image


def seeds_of(places):
    points = vtkPoints()
    for place in places:
        points.InsertNextPoint(place)
    poly = vtkPolyData()
    poly.SetPoints(points)
    return poly


class Filter(unittest.TestCase):
    def trace(self, data, **settings):
        tracer = StreamTracer()
        tracer.SetInputDataObject(0, data)
        tracer.SetInputDataObject(1, seeds_of([[0.5, 0.0, -0.5], [0.0, 0.25, -0.5]]))
        for name, value in settings.items():
            getattr(tracer, "Set" + name)(value)
        tracer.Update()
        return tracer.GetOutputDataObject(0)

    def check_helices(self, lines, count):
        self.assertEqual(lines.GetNumberOfLines(), count)
        x = vtk_to_numpy(lines.GetPoints().GetData())
        error = vtk_to_numpy(lines.GetPointData().GetArray("error"))
        time = vtk_to_numpy(lines.GetPointData().GetArray("time"))
        seed = vtk_to_numpy(lines.GetCellData().GetArray("seed"))
        for line in range(count):
            cell = lines.GetCell(line)
            ids = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
            self.assertGreater(len(ids), 10)
            radius, start = ((0.5, 0.0), (0.25, 0.5 * np.pi))[seed[line]]
            t = time[ids]
            true = np.stack([radius * np.cos(start + t), radius * np.sin(start + t), -0.5 + 0.25 * t], axis=1)
            off = np.linalg.norm(x[ids] - true, axis=1)
            self.assertTrue((off <= error[ids] + 1e-12).all(), off.max())
        self.assertEqual({lines.GetCellData().GetAbstractArray("termination").GetValue(i) for i in range(count)}, {"left_domain"})

    def test_an_image(self):
        self.check_helices(self.trace(turning(), Tolerance=1e-9, Direction="forward"), 2)
        self.check_helices(self.trace(turning(), Tolerance=1e-9, Direction="both", Vectors="v"), 4)

    def test_tetrahedra(self):
        split = vtkDataSetTriangleFilter()
        split.SetInputData(turning(9))
        split.Update()
        self.check_helices(self.trace(split.GetOutput(), Direction="forward"), 2)

    def test_it_runs_again_where_a_setting_changed(self):
        tracer = StreamTracer()
        tracer.SetInputDataObject(0, turning())
        tracer.SetSeeds("grid:2,2,2")
        tracer.SetDirection("forward")
        tracer.Update()
        self.assertEqual(tracer.GetOutputDataObject(0).GetNumberOfLines(), 8)
        tracer.SetDirection("both")
        tracer.Update()
        self.assertEqual(tracer.GetOutputDataObject(0).GetNumberOfLines(), 16)

    def test_beside_the_tracer_of_vtk(self):
        image = turning()
        image.GetPointData().SetActiveVectors("v")
        theirs = vtkStreamTracer()
        theirs.SetInputData(image)
        theirs.SetSourceData(seeds_of([[0.5, 0.0, -0.5]]))
        theirs.SetIntegratorTypeToRungeKutta45()
        theirs.SetMaximumPropagation(100.0)
        theirs.Update()
        theirs = vtk_to_numpy(theirs.GetOutput().GetPoints().GetData())
        t = (theirs[:, 2] + 0.5) / 0.25  # both follow the same helix
        true = np.stack([0.5 * np.cos(t), 0.5 * np.sin(t)], axis=1)
        self.assertLess(np.linalg.norm(theirs[:, :2] - true, axis=1).max(), 0.01)
        ours = vtk_to_numpy(self.trace(image, Direction="forward").GetPoints().GetData())
        self.assertGreater(len(theirs), 10)
        self.assertAlmostEqual(ours[:, 2].max(), 1.0, places=12)  # to the border, where theirs stops a step before
        self.assertLessEqual(theirs[:, 2].max(), 1.0)

    def test_other_grids_are_refused_with_what_helps(self):
        with self.assertRaisesRegex(palpate.UsageError, "vtkCellDataToPointData"):
            field_of(vtkImageData())
        grid = vtkRectilinearGrid()
        grid.SetDimensions(2, 2, 2)
        array = numpy_to_vtk(np.zeros((8, 3)), deep=True)
        array.SetName("v")
        grid.GetPointData().AddArray(array)
        with self.assertRaisesRegex(palpate.UsageError, "vtkDataSetTriangleFilter"):
            field_of(grid)


if __name__ == "__main__":
    unittest.main()
