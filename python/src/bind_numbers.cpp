// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/chrono.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "bindings.h"
#include "numbers.h"

namespace pyfranka {

namespace {

// Of assigned times [s]; chosen here: as milliseconds it is exact in a double.
constexpr double kMaxTime = 1e12;

// Owned by the module, for as long as the interpreter lives.
PyObject* duration_type = nullptr;
PyObject* version_type = nullptr;

py::object asObject(PyTypeObject& type) {
  return py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(&type));
}

/// A new class derived from a number of Python; pybind11's own classes cannot be.
PyObject* derive(py::module_& module, const char* name, PyTypeObject& base, const char* doc) {
  py::dict members;
  members["__doc__"] = doc;
  members["__module__"] = module.attr("__name__");
  members["__slots__"] = py::tuple();
  py::object type = asObject(PyType_Type)(name, py::make_tuple(asObject(base)), members);
  module.attr(name) = type;
  return type.release().ptr();
}

template <typename Function>
void addMethod(PyObject* type, const char* name, const Function& function, const char* doc) {
  const py::object owner = py::reinterpret_borrow<py::object>(type);
  owner.attr(name) = py::cpp_function(function, py::name(name), py::is_method(owner), doc);
}

/// Like float's own constructor; that of the class takes milliseconds.
py::object makeSeconds(py::handle type, double value) {
  PyObject* made =
      PyFloat_Type.tp_new(reinterpret_cast<PyTypeObject*>(type.ptr()),
                          py::make_tuple(py::float_(value)).ptr(), /* no keywords */ nullptr);
  if (made == nullptr) {
    throw py::error_already_set();
  }
  return py::reinterpret_steal<py::object>(made);
}

std::int64_t milliseconds(const py::object& value) {
  if (PyIndex_Check(value.ptr()) != 0) {
    const std::int64_t length = PyLong_AsLongLong(py::int_(value).ptr());
    if (length == -1 && PyErr_Occurred() != nullptr) {
      throw py::error_already_set();
    }
    return length;
  }
  if (py::isinstance(value, py::module_::import("datetime").attr("timedelta"))) {
    return value.cast<std::chrono::milliseconds>().count();
  }
  throw py::type_error("A Duration is made of whole milliseconds or a datetime.timedelta, not of " +
                       std::string(py::str(py::type::of(value))) + ".");
}

python::Duration newDuration(py::handle type, const python::DurationValue& time,
                             const python::OptionalTimedelta& duration) {
  const py::object& given = duration.is_none() ? static_cast<const py::object&>(time) : duration;
  const std::int64_t length = milliseconds(given);
  if (length < 0) {
    throw std::invalid_argument("A Duration cannot be negative.");
  }
  return makeSeconds(type, franka::Duration(static_cast<std::uint64_t>(length)).toSec());
}

std::int64_t toMilliseconds(const py::object& self) {
  return std::llround(PyFloat_AS_DOUBLE(self.ptr()) * 1e3);
}

}  // namespace

python::Duration seconds(franka::Duration time) { return makeSeconds(duration_type, time.toSec()); }

franka::Duration durationOf(double seconds) {
  if (!(seconds >= 0.0 && seconds <= kMaxTime)) {
    throw std::invalid_argument("A time must be at least 0 and at most 1e12 s.");
  }
  return franka::Duration(static_cast<std::uint64_t>(std::llround(seconds * 1e3)));
}

python::Version version(std::uint16_t number) {
  return py::reinterpret_borrow<py::object>(version_type)(number);
}

void bindNumbers(py::module_& module) {
  duration_type = derive(module, "Duration", PyFloat_Type,
                         "A time of the robot: a float [s], always whole milliseconds.\n\n>>> "
                         "pyfranka.Duration(1500) + 0.5\n2.0");
  const py::object duration = py::reinterpret_borrow<py::object>(duration_type);
  duration.attr("__new__") = py::staticmethod(py::cpp_function(
      &newDuration, py::name("__new__"), py::scope(duration), py::arg("type"),
      py::arg("milliseconds") = 0, py::arg("duration") = py::none(),
      "Of whole milliseconds or of a datetime.timedelta. Raises ValueError if it is negative."));
  addMethod(
      duration_type, "to_sec", [](const py::object& self) { return PyFloat_AS_DOUBLE(self.ptr()); },
      "The time [s].\n\n>>> pyfranka.Duration(1500).to_sec()\n1.5");
  addMethod(duration_type, "to_msec", &toMilliseconds,
            "The time [ms], an int.\n\n>>> pyfranka.Duration(1500).to_msec()\n1500");
  addMethod(
      duration_type, "__getnewargs__",
      [](const py::object& self) { return py::make_tuple(toMilliseconds(self)); },
      "For copies and pickle.");

  version_type = derive(module, "_Version", PyLong_Type,
                        "Version of a protocol: an int. A call returns it, too.");
  addMethod(
      version_type, "__call__",
      [](const py::object& self) {
        return py::reinterpret_steal<py::int_>(PyNumber_Long(self.ptr()));
      },
      "The number.");
}

}  // namespace pyfranka
