// To 3D Slicer from Python.
#include "library/palpate/slicer.h"

#include <memory>
#include <string>

#include "library/python/binding.h"

namespace palpate::python {
namespace {

std::unique_ptr<api::Slicer> make_slicer(int port, bool everywhere, double scale, double newton) {
  return std::make_unique<api::Slicer>(
      api::SlicerOptions{.port = port, .everywhere = everywhere, .scale = scale, .newton = newton});
}

void send_marks(api::Slicer& of, const std::string& name, const py::dict& marks) {
  std::vector<api::Mark> all;
  for (const auto& [words, position] : marks)
    all.push_back({.name = py::str(words).cast<std::string>(), .position = position.cast<api::Point>()});
  unlocked([&] { of.send_marks(name, all); });
}

}  // namespace

void add_slicer(py::module_& m) {
  constexpr auto kUnlocked = py::call_guard<py::gil_scoped_release>();
  py::class_<api::Slicer>(
      m, "Slicer",
      "Sends to 3D Slicer over OpenIGTLink, whose module OpenIGTLinkIF connects to `port` as a client.\n\n"
      "scale: millimetres by length of the data. newton: millimetres of the line that shows a force of\n"
      "a newton. everywhere: other machines may connect, too. Used by one thread.")
      .def(py::init(&make_slicer), py::arg("port") = 18944, py::kw_only(), py::arg("everywhere") = false,
           py::arg("scale") = 1.0, py::arg("newton") = 10.0)
      .def_property_readonly("port", &api::Slicer::port)
      .def("clients", &api::Slicer::clients, "Takes who has come since; how many there are.")
      .def("send_place", &api::Slicer::send_place, py::arg("name"), py::arg("x"), kUnlocked,
           "A transform at a place of shape (3,).")
      .def("send_marks", &send_marks, py::arg("name"), py::arg("marks"), "Places by their names.")
      .def("send_lines", py::overload_cast<const std::string&, const api::Lines&>(&api::Slicer::send_lines),
           py::arg("name"), py::arg("lines"), kUnlocked, "A model of lines, with the error at each point.")
      .def("send_lines", py::overload_cast<const std::string&, const api::Tracts&>(&api::Slicer::send_lines),
           py::arg("name"), py::arg("lines"), kUnlocked)
      .def("send_touch", &api::Slicer::send_touch, py::arg("name"), py::arg("now"), kUnlocked,
           "Probe and proxy as transforms, the force as a line, with `name` before the name of each.")
      .def("send_status", &api::Slicer::send_status, py::arg("name"), py::arg("code"), py::arg("words"),
           kUnlocked, "A line for the log; code 1 is well.");
}

}  // namespace palpate::python
