// The Python module: the library's face with NumPy arrays in place of spans. Arrays that come in are not copied where
// their type and order fit; arrays that go out belong to the object that they were asked of.

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "library/python/binding.h"

namespace palpate::python {
namespace {

constexpr const char* kSampleDoc =
    "Values at points.\n\n"
    "x: array of shape (n, 3), in the data's lengths. Returns the values and, as uint8, their states: 0 a value,\n"
    "1 outside every cell, 2 the data is NaN or blanked there. Where there is no value it is NaN.";

template <std::size_t N, class Made, class Sampled>
py::tuple sampled(const Array<double>& x, std::vector<py::ssize_t> shape, const Sampled& sample) {
  const auto points = points_of(x, "x");
  shape.insert(shape.begin(), x.shape(0));
  py::array_t<double> values(shape);
  py::array_t<std::uint8_t> status(x.shape(0));
  const std::span<Made> out{reinterpret_cast<Made*>(values.mutable_data()), points.size()};
  const std::span<api::Status> states{reinterpret_cast<api::Status*>(status.mutable_data()), points.size()};
  static_assert(sizeof(Made) == N * sizeof(double) && sizeof(api::Status) == 1);
  unlocked([&] { sample(points, out, states); });
  return py::make_tuple(values, status);
}

template <class Made, class Number, class Shared>
Made uniform_of(const py::array& values, const api::Point& spacing, const api::Point& origin) {
  const Array<Number> numbers = Array<Number>::ensure(values);
  if (!numbers) throw py::error_already_set();
  const Shared shared{{numbers.data(), static_cast<std::size_t>(numbers.size())}, keep(numbers)};
  const std::array<std::int64_t, 3> points{numbers.shape(2), numbers.shape(1), numbers.shape(0)};
  return unlocked([&] { return Made::uniform(points, origin, spacing, shared); });
}

template <class Made>
Made uniform_in(const py::array& values, const api::Point& spacing, const api::Point& origin) {
  return values.dtype().is(py::dtype::of<float>())
             ? uniform_of<Made, float, api::SharedFloats>(values, spacing, origin)
             : uniform_of<Made, double, api::SharedDoubles>(values, spacing, origin);
}

api::Field uniform(const py::array& values, const api::Point& spacing, const api::Point& origin) {
  if (values.ndim() != 4 || values.shape(3) != 3)
    throw py::value_error("values: expected an array of shape (nz, ny, nx, 3)");
  return uniform_in<api::Field>(values, spacing, origin);
}

api::Scalar scalar_uniform(const py::array& values, const api::Point& spacing, const api::Point& origin) {
  if (values.ndim() != 3) throw py::value_error("values: expected an array of shape (nz, ny, nx)");
  return uniform_in<api::Scalar>(values, spacing, origin);
}

api::Field tetrahedra(const Array<double>& points, const Array<std::int64_t>& cells,
                      const Array<double>& values) {
  points_of(points, "points");
  points_of(values, "values");
  if (cells.ndim() != 2 || cells.shape(1) != 4)
    throw py::value_error("cells: expected an array of shape (n, 4)");
  const auto shared = [](const Array<double>& of) {
    return api::SharedDoubles{{of.data(), static_cast<std::size_t>(of.size())}, keep(of)};
  };
  const api::SharedDoubles at = shared(points);
  const api::SharedDoubles with = shared(values);
  const std::span<const std::int64_t> corners{cells.data(), static_cast<std::size_t>(cells.size())};
  return unlocked([&] { return api::Field::tetrahedra(at, corners, with); });
}

api::Direction direction_of(const std::string& name) {
  if (name == "forward") return api::Direction::kForward;
  if (name == "backward") return api::Direction::kBackward;
  if (name == "both") return api::Direction::kBoth;
  throw py::value_error("direction: expected forward, backward or both, not '" + name + "'");
}

std::vector<api::Point> seeds_of(const api::Field& field, const py::object& seeds,
                                 std::uint64_t random_seed) {
  if (py::isinstance<py::str>(seeds)) return field.seeds(seeds.cast<std::string>(), random_seed);
  const auto array = Array<double>::ensure(seeds);
  if (!array) throw py::error_already_set();
  const auto points = points_of(array, "seeds");
  return {points.begin(), points.end()};
}

api::Lines trace(const api::Field& field, const py::object& seeds, const std::string& method,
                 const std::string& direction, double tolerance, double step, double max_length,
                 double max_time, std::int64_t max_steps, int threads, std::uint64_t random_seed) {
  const std::vector<api::Point> from = seeds_of(field, seeds, random_seed);
  const api::TraceOptions options{
      method, direction_of(direction), tolerance, step, max_length, max_time, max_steps, threads};
  const api::Watcher watch = watcher();
  return unlocked([&] { return api::trace(field, from, options, watch); });
}

template <class Handle>
void add_bounds(py::class_<Handle>& handle) {
  handle
      .def_property_readonly(
          "name", [](const Handle& of) { return of.name(); }, "How the field is called.")
      .def_property_readonly(
          "bounds", [](const Handle& of) { return py::make_tuple(of.lower(), of.upper()); },
          "The two corners of the box around the data.")
      .def_property_readonly(
          "notes", [](const Handle& of) { return of.notes(); },
          "What was found and done while the field was made: sentences.");
}

void add_fields(py::module_& m) {
  py::class_<api::Scalar> scalar(m, "Scalar", "A scalar field. Any number of threads may use it at once.");
  add_bounds(scalar);
  scalar
      .def_property_readonly(
          "range", [](const api::Scalar& of) { return py::make_tuple(of.lowest(), of.highest()); },
          "Lowest and highest of the finite values.")
      .def(
          "sample",
          [](const api::Scalar& of, const Array<double>& x) {
            return sampled<1, double>(x, {},
                                      [&](auto at, auto out, auto states) { of.sample(at, out, states); });
          },
          py::arg("x"), kSampleDoc)
      .def(
          "gradient",
          [](const api::Scalar& of, const Array<double>& x) {
            return sampled<3, api::Point>(
                x, {3}, [&](auto at, auto out, auto states) { of.gradient(at, out, states); });
          },
          py::arg("x"), "Gradients at points, shape (n, 3), and their states as sample() gives them.");

  py::class_<api::Field> field(m, "Field", "A vector field. Any number of threads may use it at once.");
  add_bounds(field);
  field
      .def_property_readonly(
          "diagonal", [](const api::Field& of) { return of.diagonal(); },
          "Length of the diagonal of the bounds.")
      .def_property_readonly(
          "max_speed", [](const api::Field& of) { return of.max_speed(); },
          "Largest speed at a point of the grid.")
      .def(
          "sample",
          [](const api::Field& of, const Array<double>& x) {
            return sampled<3, api::Point>(
                x, {3}, [&](auto at, auto out, auto states) { of.sample(at, out, states); });
          },
          py::arg("x"), kSampleDoc)
      .def(
          "jacobian",
          [](const api::Field& of, const Array<double>& x) {
            return sampled<9, std::array<api::Point, 3>>(
                x, {3, 3}, [&](auto at, auto out, auto states) { of.jacobian(at, out, states); });
          },
          py::arg("x"),
          "Derivatives dv_i/dx_j at [n, i, j], shape (n, 3, 3), and their states as sample() gives them.")
      .def(
          "seeds",
          [](const api::Field& of, const std::string& text, std::uint64_t random_seed) {
            const std::vector<api::Point> made = unlocked([&] { return of.seeds(text, random_seed); });
            py::array_t<double> points({static_cast<py::ssize_t>(made.size()), py::ssize_t{3}});
            if (!made.empty()) std::copy_n(made.front().data(), 3 * made.size(), points.mutable_data());
            return points;
          },
          py::arg("text"), py::arg("random_seed") = 1,
          "Places to start lines from, shape (n, 3): \"random:100\", \"grid:8,8,8\", \"line:0,0,0,1,0,0,20\", a file.");
}

void add_data(py::module_& m) {
  py::class_<api::ArrayInfo>(m, "ArrayInfo", "An array of the data, known before its values are read.")
      .def_readonly("name", &api::ArrayInfo::name)
      .def_readonly("type", &api::ArrayInfo::type)
      .def_readonly("components", &api::ArrayInfo::components)
      .def_readonly("tuples", &api::ArrayInfo::tuples)
      .def_readonly("on_points", &api::ArrayInfo::on_points)
      .def("__repr__", [](const api::ArrayInfo& of) {
        return "<ArrayInfo " + of.name + ": " + std::to_string(of.tuples) + " x " +
               std::to_string(of.components) + " " + of.type + (of.on_points ? " on points>" : " on cells>");
      });
  py::class_<api::Data>(m, "Data", "An open data set; its helper program lives as long.")
      .def_property_readonly("format", &api::Data::format)
      .def_property_readonly("arrays", &api::Data::arrays)
      .def_property_readonly("times", &api::Data::times, "Times of the steps; none for a single state.")
      .def_property_readonly("notes", &api::Data::notes, "What the reader has to say: sentences.")
      .def_property_readonly("vectors", &api::Data::vectors, "Names that vector() takes, the default first.")
      .def(
          "vector",
          [](const api::Data& of, const std::string& name, const std::string& time, int threads) {
            const api::Watcher watch = watcher();
            return unlocked([&] { return of.vector(name, time, threads, watch); });
          },
          py::arg("name") = "", py::arg("time") = "first", py::arg("threads") = 0,
          "The vector field of that name; without one the likeliest velocity. time: first, last or a time.")
      .def(
          "scalar",
          [](const api::Data& of, const std::string& name, const std::string& time, int threads) {
            const api::Watcher watch = watcher();
            return unlocked([&] { return of.scalar(name, time, threads, watch); });
          },
          py::arg("name") = "", py::arg("time") = "first", py::arg("threads") = 0,
          "The scalar field of an array: \"pressure\"; \"velocity:0\", \"velocity:magnitude\".");
  m.def(
      "open",
      [](const py::object& files, const std::string& solution, const std::string& cell_values) {
        std::vector<std::string> names;
        const py::object path = py::module_::import("os").attr("fspath");
        if (py::isinstance<py::list>(files) || py::isinstance<py::tuple>(files)) {
          for (const py::handle file : files) names.push_back(path(file).cast<std::string>());
        } else {
          names.push_back(path(files).cast<std::string>());
        }
        const api::Watcher watch = watcher();
        return unlocked([&] { return api::Data::open(names, {solution, cell_values}, watch); });
      },
      py::arg("files"), py::kw_only(), py::arg("solution") = "", py::arg("cell_values") = "recovered",
      "Opens a file of any format that flow opens, or a list of them (blocks, a numbered series).");
  m.def(
      "example", [](const std::string& name) { return unlocked([&] { return api::Field::example(name); }); },
      py::arg("name"), "A built-in field: \"abc\", \"tornado\", …");
  m.def(
      "uniform", &uniform, py::arg("values"), py::arg("spacing") = api::Point{1.0, 1.0, 1.0},
      py::arg("origin") = api::Point{0.0, 0.0, 0.0},
      "The trilinear field of values of shape (nz, ny, nx, 3): values[k, j, i] at origin + (i, j, k) * spacing.\n"
      "float32 and float64 in C order are used where they lie and must not change; others are copied.");
  m.def("scalar", &scalar_uniform, py::arg("values"), py::arg("spacing") = api::Point{1.0, 1.0, 1.0},
        py::arg("origin") = api::Point{0.0, 0.0, 0.0},
        "The trilinear scalar field of values of shape (nz, ny, nx), likewise.");
  m.def(
      "tetrahedra", &tetrahedra, py::arg("points"), py::arg("cells"), py::arg("values"),
      "The field that is linear in each tetrahedron. points (n, 3), cells (m, 4) of their indices, values (n, 3).");
}

void add_lines(py::module_& m) {
  const auto view_of = [](auto member) {
    return
        [member](const py::object& self) { return column((self.cast<const api::Lines&>().*member)(), self); };
  };
  py::class_<api::Lines>(m, "Lines", "Traced lines: arrays by line and by point, which cannot be written to.")
      .def("__len__", &api::Lines::count)
      .def_property_readonly("offsets", view_of(&api::Lines::offsets),
                             "Line l has the points offsets[l] to offsets[l + 1] - 1.")
      .def_property_readonly("seed", view_of(&api::Lines::seed), "By line: which of the seeds.")
      .def_property_readonly("end_code", view_of(&api::Lines::end), "By line: why it ends, of palpate.ENDS.")
      .def_property_readonly("backward", view_of(&api::Lines::backward),
                             "By line: 1 where it was traced against the flow.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            const auto points = self.cast<const api::Lines&>().points();
            return view({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}},
                        reinterpret_cast<const double*>(points.data()), self);
          },
          "By point: positions, shape (n, 3).")
      .def_property_readonly("time", view_of(&api::Lines::time), "By point: from the seed on.")
      .def_property_readonly("arc", view_of(&api::Lines::arc), "By point: length from the seed on.")
      .def_property_readonly("speed", view_of(&api::Lines::speed), "By point.")
      .def_property_readonly("error", view_of(&api::Lines::error),
                             "By point: estimated distance from the true curve of the interpolant.")
      .def_property_readonly("outside_seeds", &api::Lines::outside_seeds,
                             "Seeds in no cell, which give no line.")
      .def_property_readonly("method", &api::Lines::method)
      .def(
          "save",
          [](const api::Lines& of, const py::object& path, bool overwrite) {
            const auto name = py::module_::import("os").attr("fspath")(path).cast<std::string>();
            unlocked([&] { of.save(name, overwrite); });
          },
          py::arg("path"), py::arg("overwrite") = false,
          "Writes .vtp, .tck, .trk or .csv, whole or not at all.");
  m.def(
      "trace", &trace, py::arg("field"), py::arg("seeds"), py::kw_only(), py::arg("method") = "",
      py::arg("direction") = "forward", py::arg("tolerance") = 1e-6, py::arg("step") = 0.0,
      py::arg("max_length") = 0.0, py::arg("max_time") = 0.0, py::arg("max_steps") = 1'000'000,
      py::arg("threads") = 0, py::arg("random_seed") = 1,
      "Lines of the flow from every seed, with their errors: the same as `flow trace`.\n\n"
      "seeds: array of shape (n, 3), or a text as Field.seeds() takes it. tolerance: position error per diagonal\n"
      "travelled, relative to the diagonal. method: exact, dp54, …; without one exact on tetrahedra, dp54 elsewhere.");
  py::tuple ends(api::end_names().size());
  for (std::size_t i = 0; i < api::end_names().size(); ++i) ends[i] = api::end_names()[i];
  m.attr("ENDS") = ends;
}

void add_errors(py::module_& m) {
  static py::exception<api::Error> base(m, "Error");
  static py::exception<api::Error> usage(m, "UsageError", base.ptr());
  static py::exception<api::Error> input(m, "InputError", base.ptr());
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const api::Error& error) {
      const py::object& kind = error.kind() == api::Error::Kind::kUsage      ? usage
                               : error.kind() == api::Error::Kind::kBadInput ? input
                                                                             : base;
      PyErr_SetString(kind.ptr(), error.what());
    }
  });
}

}  // namespace
}  // namespace palpate::python

PYBIND11_MODULE(_palpate, m) {
  namespace python = palpate::python;
  m.attr("__version__") = palpate::api::version();
  python::add_errors(m);
  python::add_fields(m);
  python::add_data(m);
  python::add_lines(m);
  python::add_tensors(m);
  python::add_touch(m);
  python::add_servo(m);
  python::add_picture(m);
  python::add_slicer(m);
}
