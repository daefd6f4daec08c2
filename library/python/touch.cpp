// Touch in Python: links, chains and what is felt along a path.
#include "library/palpate/touch.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "library/python/binding.h"

namespace palpate::python {
namespace {

std::vector<double> numbers_of(const py::object& values) {
  const auto array = Array<double>::ensure(values);
  if (!array) throw py::error_already_set();
  if (array.ndim() > 1) throw py::value_error("values: expected a number or a list of them");
  return {array.data(), array.data() + array.size()};
}

api::Chain make_chain(const std::vector<api::Link>& links, double scale, const py::dict& settings,
                      double force_cap, double slew_cap) {
  api::ChainOptions options{.scale = scale, .settings = {}, .force_cap = force_cap, .slew_cap = slew_cap};
  for (const auto& [name, value] : settings)
    options.settings.emplace_back(py::str(name).cast<std::string>(), py::str(value).cast<std::string>());
  return unlocked([&] { return api::Chain(links, options); });
}

api::Touch run(const api::Chain& chain, const Array<double>& path, const py::object& times) {
  const auto points = points_of(path, "path");
  Array<double> at(0);
  if (!times.is_none()) {
    at = Array<double>::ensure(times);
    if (!at) throw py::error_already_set();
    if (at.ndim() != 1 || at.shape(0) != path.shape(0))
      throw py::value_error("times: expected an array of shape (n,), as many as points");
  }
  const std::span<const double> seconds{at.data(), static_cast<std::size_t>(at.size())};
  const api::Watcher watch = watcher();
  return unlocked([&] { return chain.run(points, seconds, watch); });
}

}  // namespace

void add_touch(py::module_& m) {
  py::class_<api::Link>(m, "Link", "One constraint of a chain: what its proxy is held to.");
  m.def("Streamline", &api::Link::streamline, py::arg("field"), py::call_guard<py::gil_scoped_release>(),
        "Held by the streamline through the place where it was caught; stretched too far it is let go.");
  m.def(
      "Isosurface",
      [](const api::Scalar& field, const py::object& values) {
        return api::Link::isosurface(field, numbers_of(values));
      },
      py::arg("field"), py::arg("values"),
      "Surfaces of equal value, one to eight. How they hold is a setting of the chain: \"isosurface.hold\".");
  m.def("Plane", &api::Link::plane, py::arg("point"), py::arg("outward"),
        "A wall: free where (x - point) . outward > 0. Both of shape (3,), data lengths.");
  m.def("Flow", &api::Link::flow, py::arg("field"), py::call_guard<py::gil_scoped_release>(),
        "Carried along by the flow: \"force_field.strength\" newtons where it is fastest.");
  m.def("Potential", &api::Link::potential, py::arg("joules"), py::call_guard<py::gil_scoped_release>(),
        "Pushed down a potential in joules: the force is its negative gradient by metres of the hand.");
  m.def("Drag", &api::Link::drag, "The same drag in all directions.");

  py::class_<api::Touch>(m, "Touch",
                         "What was felt along a path: arrays by point, which cannot be written to.")
      .def("__len__", &api::Touch::count)
      .def_property_readonly(
          "times",
          [](const py::object& self) { return column(self.cast<const api::Touch&>().times(), self); },
          "Of the steps [s], shape (n,).")
      .def_property_readonly(
          "probes",
          [](const py::object& self) {
            const auto probes = self.cast<const api::Touch&>().probes();
            return view({static_cast<py::ssize_t>(probes.size()), py::ssize_t{3}},
                        reinterpret_cast<const double*>(probes.data()), self);
          },
          "Where the hand was, shape (n, 3), data lengths.")
      .def_property_readonly(
          "proxies",
          [](const py::object& self) {
            const auto& touch = self.cast<const api::Touch&>();
            return view({static_cast<py::ssize_t>(touch.count()), static_cast<py::ssize_t>(touch.links()),
                         py::ssize_t{3}},
                        reinterpret_cast<const double*>(touch.proxies().data()), self);
          },
          "Proxy of each link, shape (n, links, 3), data lengths; that of the last one is where the hand is shown.")
      .def_property_readonly(
          "force",
          [](const py::object& self) {
            const auto force = self.cast<const api::Touch&>().force();
            return view({static_cast<py::ssize_t>(force.size()), py::ssize_t{3}},
                        reinterpret_cast<const double*>(force.data()), self);
          },
          "Force on the hand [N], shape (n, 3), after the caps.")
      .def_property_readonly(
          "residual",
          [](const py::object& self) { return column(self.cast<const api::Touch&>().residual(), self); },
          "Distance of the last proxy from its own feature, shape (n,), data lengths.")
      .def_property_readonly(
          "state_code",
          [](const py::object& self) { return column(self.cast<const api::Touch&>().state(), self); },
          "Shape (n,), uint8: of palpate.STATES.");

  py::class_<api::Chain>(
      m, "Chain",
      "Constraints in a row, one to four: the proxy of each is the probe of the next.\n\n"
      "scale: metres of the hand by length of the data; 0: the data's diagonal becomes 0.25 m.\n"
      "settings: by the names in palpate.chain_settings(), SI units: {\"stiffness\": 400.0}.\n"
      "force_cap: largest force [N]. slew_cap: its fastest growth and turn [N/s].")
      .def(py::init(&make_chain), py::arg("links"), py::kw_only(), py::arg("scale") = 0.0,
           py::arg("settings") = py::dict(), py::arg("force_cap") = 4.0, py::arg("slew_cap") = 200.0)
      .def_property_readonly("scale", &api::Chain::scale, "Metres of the hand by length of the data.")
      .def(
          "run", &run, py::arg("path"), py::arg("times") = py::none(),
          "What a hand feels that is where the path says, shape (n, 3), data lengths: one step a point, from a fresh\n"
          "start, as `probe --path` takes them. times: of the points [s], shape (n,), rising; a millisecond apart\n"
          "where there are none.");
  m.def(
      "chain_settings",
      [] {
        py::dict settings;
        for (const auto& [name, value] : api::chain_settings()) settings[py::str(name)] = value;
        return settings;
      },
      "The settings of chains by name, with the values that they have where nothing is said.");
  py::tuple states(api::state_names().size());
  for (std::size_t i = 0; i < api::state_names().size(); ++i) states[i] = api::state_names()[i];
  m.attr("STATES") = states;
}

}  // namespace palpate::python
