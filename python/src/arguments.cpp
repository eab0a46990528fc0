// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

namespace pyfranka {

namespace {

[[noreturn]] void refuse(const py::object& value, const char* name, const char* what) {
  PyErr_Clear();
  throw py::type_error(std::string(name) + " must be " + what + ", not " +
                       std::string(py::repr(value)) + ".");
}

bool isNumpysBool(const py::object& value) {
  const char* const type = Py_TYPE(value.ptr())->tp_name;
  return std::string(type) == "numpy.bool_" || std::string(type) == "numpy.bool";
}

}  // namespace

std::int64_t wholeNumber(const py::object& value, const char* name) {
  const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (!index) {
    refuse(value, name, "a whole number");
  }
  int overflow = 0;
  const long long result = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
  if (overflow != 0) {
    throw std::invalid_argument(std::string(name) +
                                " is too large: " + std::string(py::str(index)) + ".");
  }
  return result;
}

double number(const py::object& value, const char* name) {
  const double result = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) {
    refuse(value, name, "a number");
  }
  if (!std::isfinite(result)) {
    throw std::invalid_argument(std::string(name) + " must be a finite number, not " +
                                std::string(py::repr(value)) + ".");
  }
  return result;
}

bool yesOrNo(const py::object& value, const char* name) {
  if (PyBool_Check(value.ptr()) || isNumpysBool(value)) {
    return PyObject_IsTrue(value.ptr()) == 1;
  }
  if (PyLong_Check(value.ptr())) {
    const long number = PyLong_AsLong(value.ptr());
    if (number == 0 || number == 1) {
      return number == 1;
    }
  }
  refuse(value, name, "True or False");
}

std::string text(const py::object& value, const char* name) {
  if (!PyUnicode_Check(value.ptr())) {
    refuse(value, name, "a text");
  }
  const char* const utf8 = PyUnicode_AsUTF8(value.ptr());
  if (utf8 == nullptr) {
    refuse(value, name, "a text of Unicode characters");
  }
  return utf8;
}

}  // namespace pyfranka
