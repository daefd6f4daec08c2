// The servo in Python: what Python does is ask and tell; the thread that steps the chain runs none of it.
#include "library/palpate/servo.h"

#include <memory>
#include <string>

#include "library/python/binding.h"

namespace palpate::python {
namespace {

std::vector<double> seconds_of(const py::object& times) {
  if (times.is_none()) return {};
  const auto array = Array<double>::ensure(times);
  if (!array) throw py::error_already_set();
  return {array.data(), array.data() + array.size()};
}

api::Device simulated(const py::object& path, const py::object& times, const std::string& profile,
                      const std::string& hand) {
  const api::ArmOptions arm{.profile = profile, .hand = hand};
  if (path.is_none()) return api::Device::simulated(arm);
  const auto array = Array<double>::ensure(path);
  if (!array) throw py::error_already_set();
  return api::Device::simulated(points_of(array, "path"), seconds_of(times), arm);
}

/// Ends at close(), or with the object.
class Servo {
 public:
  Servo(const api::Device& device, const api::Chain& chain, double rate)
      : servo_(unlocked([&] { return std::make_unique<api::Servo>(device, chain, rate); })) {}
  ~Servo() { close(); }

  // The thread that ends may have to wait for its tick, and the chain's arrays for Python's lock.
  void close() {
    unlocked([&] { servo_.reset(); });
  }
  api::Servo& running() {
    if (!servo_) throw py::value_error("this servo is closed");
    return *servo_;
  }

 private:
  std::unique_ptr<api::Servo> servo_;
};

}  // namespace

void add_servo(py::module_& m) {
  py::class_<api::Device>(m, "Device", "What a hand is on; each servo makes one of its own from it.")
      .def_static("led", &api::Device::led,
                  "Shows no force; the hand goes where Servo.lead() says, as with a mouse.")
      .def_static(
          "path",
          [](const Array<double>& points, const py::object& times) {
            return api::Device::path(points_of(points, "points"), seconds_of(times));
          },
          py::arg("points"), py::arg("times") = py::none(),
          "Shows no force; the hand moves along a path of shape (n, 3), data lengths, at the times [s], else a\n"
          "millisecond apart.")
      .def_static("simulated", &simulated, py::arg("path") = py::none(), py::arg("times") = py::none(),
                  py::kw_only(), py::arg("profile") = "", py::arg("hand") = "relaxed",
                  "A simulated arm in a simulated hand, which follows a path or, without one, Servo.lead().");

  py::class_<api::ServoNow>(m, "ServoNow", "The last step, and how the thread fares.")
      .def_readonly("time", &api::ServoNow::time, "[s] of a steady clock.")
      .def_readonly("present", &api::ServoNow::present, "Whether a hand is on the device.")
      .def_readonly("probe", &api::ServoNow::probe, "Where the hand is, data lengths.")
      .def_readonly("proxy", &api::ServoNow::proxy, "Where the last link holds it, data lengths.")
      .def_readonly("force", &api::ServoNow::force, "On the hand [N].")
      .def_readonly("state_code", &api::ServoNow::state, "Of palpate.STATES.")
      .def_readonly("armed", &api::ServoNow::armed)
      .def_readonly("real_time", &api::ServoNow::real_time, "The thread has the priority that it asked for.")
      .def_readonly("steps", &api::ServoNow::steps)
      .def_readonly("late", &api::ServoNow::late, "Steps begun more than half a period after their time.")
      .def_readonly("skipped", &api::ServoNow::skipped, "Steps whose time had passed.")
      .def_readonly("dropped", &api::ServoNow::dropped, "Steps that nobody took in time.");

  py::class_<Servo>(
      m, "Servo",
      "A chain on a device, stepped `rate` times a second by a thread in which nothing of Python runs.\n\n"
      "Used by one thread, best in a `with` block: close() ends it, and the device is told a zero force.")
      .def(py::init<const api::Device&, const api::Chain&, double>(), py::arg("device"), py::arg("chain"),
           py::arg("rate") = 1000.0)
      .def(
          "lead", [](Servo& of, const api::Point& x) { of.running().lead(x); }, py::arg("x"),
          "Where the hand is to be, shape (3,), data lengths: the first call takes hold.")
      .def("let_go", [](Servo& of) { of.running().let_go(); })
      .def(
          "set_chain",
          [](Servo& of, const api::Chain& chain) {
            api::Servo& running = of.running();
            unlocked([&] { running.set_chain(chain); });
          },
          py::arg("chain"), "Another chain from the next step on; the force grows from zero.")
      .def(
          "arm", [](Servo& of) { of.running().arm(); }, "Force again, from zero.")
      .def(
          "force_off", [](Servo& of) { of.running().force_off(); }, "No force until arm().")
      .def("now",
           [](Servo& of) {
             api::Servo& running = of.running();
             return unlocked([&] { return running.now(); });
           })
      .def(
          "steps",
          [](Servo& of) {
            api::Servo& running = of.running();
            return unlocked([&] { return running.steps(); });
          },
          "The steps since the last call, oldest first; 4 s of them are kept.")
      .def("close", &Servo::close)
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](Servo& of, const py::args&) { of.close(); });
}

}  // namespace palpate::python
