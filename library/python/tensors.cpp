// Tensors, tracts and layers in Python.
#include "library/palpate/tensors.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "library/palpate/hearts.h"
#include "library/python/binding.h"

namespace palpate::python {
namespace {

/// @param affine of shape (3, 4) or (4, 4): voxel indices to coordinates; None: unit voxels at the origin.
api::VoxelGrid grid_of(const py::object& affine, const std::array<std::int64_t, 3>& voxels) {
  api::VoxelGrid grid{.voxels = voxels};
  if (affine.is_none()) return grid;
  const auto matrix = Array<double>::ensure(affine);
  if (!matrix) throw py::error_already_set();
  if (matrix.ndim() != 2 || matrix.shape(0) < 3 || matrix.shape(0) > 4 || matrix.shape(1) != 4)
    throw py::value_error("affine: expected an array of shape (4, 4) or (3, 4)");
  for (py::ssize_t row = 0; row < 3; ++row) {
    const auto axis = static_cast<std::size_t>(row);
    for (std::size_t k = 0; k < 3; ++k) grid.axes[k][axis] = matrix.at(row, static_cast<py::ssize_t>(k));
    grid.origin[axis] = matrix.at(row, 3);
  }
  return grid;
}

py::array_t<double> affine_of(const api::VoxelGrid& grid) {
  py::array_t<double> affine(std::vector<py::ssize_t>{4, 4});
  for (py::ssize_t row = 0; row < 4; ++row) {
    for (py::ssize_t column = 0; column < 4; ++column) {
      const auto axis = static_cast<std::size_t>(row), k = static_cast<std::size_t>(column);
      affine.mutable_at(row, column) = row == 3      ? (column == 3 ? 1.0 : 0.0)
                                       : column == 3 ? grid.origin[axis]
                                                     : grid.axes[k][axis];
    }
  }
  return affine;
}

std::vector<py::ssize_t> shape_of(const api::VoxelGrid& grid, py::ssize_t numbers) {
  std::vector<py::ssize_t> shape{grid.voxels[2], grid.voxels[1], grid.voxels[0]};
  if (numbers > 1) shape.push_back(numbers);
  return shape;
}

api::Tensors fit(const Array<float>& signals, const Array<double>& bvals, const Array<double>& bvecs,
                 const py::object& affine, bool weighted, bool masked, int threads) {
  if (signals.ndim() != 4) throw py::value_error("signals: expected an array of shape (nz, ny, nx, volumes)");
  if (bvals.ndim() != 1) throw py::value_error("bvals: expected an array of shape (volumes,)");
  api::WeightedImage image{
      .grid = grid_of(affine, {signals.shape(2), signals.shape(1), signals.shape(0)}),
      .signals = {{signals.data(), static_cast<std::size_t>(signals.size())}, keep(signals)},
      .weightings = {bvals.data(), bvals.data() + bvals.size()},
      .directions = {}};
  const auto directions = points_of(bvecs, "bvecs");
  image.directions.assign(directions.begin(), directions.end());
  const api::Watcher watch = watcher();
  return unlocked([&] { return api::fit_tensors(image, {weighted, masked, threads}, watch); });
}

py::array measure(const api::Tensors& tensors, const std::string& name, int threads) {
  auto* numbers = new std::vector<float>(unlocked([&] { return tensors.measure(name, threads); }));
  const py::capsule owner(numbers, [](void* kept) { delete static_cast<std::vector<float>*>(kept); });
  const auto& voxels = tensors.grid().voxels;
  const auto count = static_cast<std::size_t>(voxels[0] * voxels[1] * voxels[2]);
  return py::array_t<float>(shape_of(tensors.grid(), static_cast<py::ssize_t>(numbers->size() / count)),
                            numbers->data(), owner);
}

api::Tracts trace_tracts(const api::Tensors& tensors, const Array<double>& seeds, const std::string& method,
                         double tolerance, double step, double cutoff, double max_angle, double min_length,
                         double max_length, int threads) {
  const auto from = points_of(seeds, "seeds");
  const api::TractOptions options{method,    tolerance,  step,       cutoff,
                                  max_angle, min_length, max_length, threads};
  const api::Watcher watch = watcher();
  return unlocked([&] { return api::tracts(tensors, from, options, watch); });
}

py::tuple wall_layers(const Array<double>& points, const Array<std::int64_t>& cells, int threads) {
  points_of(points, "points");
  if (cells.ndim() != 2 || cells.shape(1) != 4)
    throw py::value_error("cells: expected an array of shape (n, 4)");
  const api::SharedDoubles at{{points.data(), static_cast<std::size_t>(points.size())}, keep(points)};
  const std::span<const std::int64_t> corners{cells.data(), static_cast<std::size_t>(cells.size())};
  const api::Watcher watch = watcher();
  const api::Layers found = unlocked([&] { return api::layers(at, corners, threads, watch); });
  py::array_t<double> depth(static_cast<py::ssize_t>(found.depth.size()));
  std::copy(found.depth.begin(), found.depth.end(), depth.mutable_data());
  return py::make_tuple(depth, found.notes);
}

void add_tensor_class(py::module_& m) {
  py::class_<api::Tensors>(m, "Tensors",
                           "An image of diffusion tensors. Any number of threads may use it at once.")
      .def_property_readonly(
          "values",
          [](const py::object& self) {
            const auto& tensors = self.cast<const api::Tensors&>();
            return view(shape_of(tensors.grid(), 6), tensors.values().data(), self);
          },
          "xx xy xz yy yz zz of each voxel, shape (nz, ny, nx, 6), float32, in the inverse unit of the weightings.\n"
          "NaN where there is no tensor.")
      .def_property_readonly(
          "affine", [](const api::Tensors& of) { return affine_of(of.grid()); },
          "From voxel indices (i, j, k) to coordinates, shape (4, 4); values[k, j, i] is voxel (i, j, k).")
      .def(
          "measure", &measure, py::arg("name"), py::arg("threads") = 0,
          "A number a voxel, shape (nz, ny, nx), float32: \"fa\", \"md\", \"cl\", \"cp\", \"cs\", \"mode\"; or three, shape\n"
          "(nz, ny, nx, 3): \"v1\", \"color\". NaN where there is no tensor.")
      .def_property_readonly("notes", &api::Tensors::notes,
                             "What was assumed or found, and how the fit went: sentences.");
  m.def(
      "open_tensors",
      [](const py::object& file, const py::object& bval, const py::object& bvec, int threads) {
        const py::object path = py::module_::import("os").attr("fspath");
        const auto name = [&path](const py::object& of) {
          return of.is_none() ? std::string() : path(of).cast<std::string>();
        };
        const std::string image = name(file), weightings = name(bval), directions = name(bvec);
        const api::Watcher watch = watcher();
        return unlocked([&] { return api::Tensors::open(image, weightings, directions, threads, watch); });
      },
      py::arg("file"), py::kw_only(), py::arg("bval") = py::none(), py::arg("bvec") = py::none(),
      py::arg("threads") = 0,
      "Opens an image that `dtmri` opens: tensors, or signals with their gradients, to which tensors are fitted.");
  m.def(
      "example_tensors",
      [](const std::string& name) { return unlocked([&] { return api::Tensors::example(name); }); },
      py::arg("name"), "A built-in image of tensors: \"helix\", …");
  m.def(
      "fit_tensors", &fit, py::arg("signals"), py::arg("bvals"), py::arg("bvecs"), py::kw_only(),
      py::arg("affine") = py::none(), py::arg("weighted") = true, py::arg("masked") = true,
      py::arg("threads") = 0,
      "Tensors of diffusion-weighted signals of shape (nz, ny, nx, volumes): signals[k, j, i] is voxel (i, j, k) at\n"
      "affine @ (i, j, k, 1). float32 in C order is not copied. bvals: shape (volumes,), s/mm^2. bvecs: shape\n"
      "(volumes, 3), in the axes of the coordinates, zero where there is no direction. weighted: least squares with\n"
      "weights, else ordinary. masked: the background has no tensor.");
}

}  // namespace

void add_tensors(py::module_& m) {
  add_tensor_class(m);
  py::class_<api::Tracts>(m, "Tracts", "Tracts: arrays by line and by point, which cannot be written to.")
      .def("__len__", &api::Tracts::count)
      .def_property_readonly(
          "offsets",
          [](const py::object& self) { return column(self.cast<const api::Tracts&>().offsets(), self); },
          "Line l has the points offsets[l] to offsets[l + 1] - 1.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            const auto points = self.cast<const api::Tracts&>().points();
            return view({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}},
                        reinterpret_cast<const float*>(points.data()), self);
          },
          "By point: positions, shape (n, 3), float32, coordinates of the image.")
      .def_property_readonly(
          "error",
          [](const py::object& self) { return column(self.cast<const api::Tracts&>().error(), self); },
          "By point: sum of the steps' error estimates from the seed on, coordinate lengths.")
      .def_property_readonly(
          "seed", [](const py::object& self) { return column(self.cast<const api::Tracts&>().seed(), self); },
          "By line: which of the seeds.")
      .def_property_readonly(
          "end_codes",
          [](const py::object& self) {
            const auto ends = self.cast<const api::Tracts&>().ends();
            return view({static_cast<py::ssize_t>(ends.size()), py::ssize_t{2}},
                        reinterpret_cast<const std::uint8_t*>(ends.data()), self);
          },
          "By line: why its first and its last point are its ends, shape (n, 2), uint8, of palpate.ENDS.")
      .def_property_readonly("notes", &api::Tracts::notes,
                             "What became of seeds that gave no line, and of lines that are not here.")
      .def(
          "save",
          [](const api::Tracts& of, const py::object& path, bool overwrite) {
            const auto name = py::module_::import("os").attr("fspath")(path).cast<std::string>();
            unlocked([&] { of.save(name, overwrite); });
          },
          py::arg("path"), py::arg("overwrite") = false,
          "Writes .tck, .trk, .trx, .vtp or .csv, whole or not at all.");
  m.def(
      "tracts", &trace_tracts, py::arg("tensors"), py::arg("seeds"), py::kw_only(),
      py::arg("method") = "dp54", py::arg("tolerance") = 1e-4, py::arg("step") = 0.0, py::arg("cutoff") = 0.2,
      py::arg("max_angle") = 0.0, py::arg("min_length") = 0.0, py::arg("max_length") = 0.0,
      py::arg("threads") = 0,
      "Tracts from every seed, shape (n, 3), to both sides: the same as `dtmri trace`.\n\n"
      "method: euler, rk4 or dp54. step: between points; 0: a quarter of a voxel. cutoff: lines end where the FA falls\n"
      "below it. max_angle: degrees between neighbouring pieces; 0: a radius of curvature of a voxel.");
  m.def(
      "layers", &wall_layers, py::arg("points"), py::arg("cells"), py::kw_only(), py::arg("threads") = 0,
      "How deep in the wall of a heart each point lies: points (n, 3), cells (m, 4) of their indices. Returns depths,\n"
      "shape (n,), from 0 at the inner to 1 at the outer surface (NaN in parts that touch neither), and notes.");
}

}  // namespace palpate::python
