/// What the files of the Python module share: arrays that are not copied, work without Python's lock.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "library/palpate/palpate.h"

namespace palpate::python {

namespace py = pybind11;

template <class Number>
using Array = py::array_t<Number, py::array::c_style | py::array::forcecast>;

/// A Python object that a C++ object keeps alive, from whatever thread it ends in.
inline std::shared_ptr<const void> keep(py::object object) {
  auto* kept = new py::object(std::move(object));
  return {static_cast<const void*>(kept), [kept](const void*) {
            const py::gil_scoped_acquire lock;
            delete kept;
          }};
}

inline std::span<const api::Point> points_of(const Array<double>& x, const char* name) {
  if (x.ndim() != 2 || x.shape(1) != 3)
    throw py::value_error(std::string(name) + ": expected an array of shape (n, 3)");
  return {reinterpret_cast<const api::Point*>(x.data()), static_cast<std::size_t>(x.shape(0))};
}

/// Memory of `owner` as an array that cannot be written to.
template <class Number>
py::array view(const std::vector<py::ssize_t>& shape, const Number* data, py::handle owner) {
  py::array_t<Number> array(shape, data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

template <class Number>
py::array column(std::span<const Number> values, py::handle owner) {
  return view({static_cast<py::ssize_t>(values.size())}, values.data(), owner);
}

/// A signal that Python has to see (Ctrl-C) ends the work.
inline bool no_signal(const std::string&, double) {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  return true;
}

/// Signals reach the main thread alone; elsewhere the work needs nobody who watches.
inline api::Watcher watcher() {
  const py::module_ threading = py::module_::import("threading");
  const bool main = threading.attr("current_thread")().is(threading.attr("main_thread")());
  return main ? api::Watcher(no_signal) : api::Watcher();
}

template <class Work>
auto unlocked(const Work& work) {
  const py::gil_scoped_release free;
  return work();
}

/// @name The parts of the module, a file each
/// @{
void add_tensors(py::module_& m);  ///< tensors, tracts, layers
void add_touch(py::module_& m);
void add_servo(py::module_& m);  ///< after it
void add_picture(py::module_& m);
void add_slicer(py::module_& m);  ///< after tensors and the servo
/// @}

}  // namespace palpate::python
