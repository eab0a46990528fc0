// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Docstrings of the module's functions with the public names of their types, and sentences for
// wrong arguments, both made by pyfranka/_public_names.py. Without that package the module works as
// pybind11 made it: so its type stubs are written.
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include "bindings.h"

namespace pyfranka {

namespace {

/// pybind11's function behind each function of the module.
PyCFunctionWithKeywords pybind11_call = nullptr;
/// The sentence for arguments of a wrong type. Owned by the module, for as long as the interpreter
/// lives.
PyObject* explanation = nullptr;

/// Replaces pybind11's TypeError, which lists signatures, by one with a sentence.
void explainError(PyObject* self, PyObject* arguments, PyObject* keywords) {
  py::error_already_set error;
  try {
    const py::object given =
        keywords == nullptr ? py::dict() : py::reinterpret_borrow<py::object>(keywords);
    const py::object sentence = py::handle(explanation)(py::handle(self), py::str(error.value()),
                                                        py::handle(arguments), given);
    if (!sentence.is_none()) {
      PyErr_SetObject(PyExc_TypeError, sentence.ptr());
      return;
    }
  } catch (const py::error_already_set&) {
    // pybind11's own text is better than an error of the explanation.
  }
  error.restore();
}

PyObject* call(PyObject* self, PyObject* arguments, PyObject* keywords) {
  PyObject* const result = pybind11_call(self, arguments, keywords);
  if (result == nullptr && explanation != nullptr && PyErr_ExceptionMatches(PyExc_TypeError) != 0) {
    explainError(self, arguments, keywords);
  }
  return result;
}

void publish(const py::object& function, const py::object& doc) {
  if (!PyCFunction_Check(function.ptr())) {
    throw py::type_error("Only functions of this module can be published.");
  }
  PyMethodDef& definition = *reinterpret_cast<PyCFunctionObject*>(function.ptr())->m_ml;
  const auto ours = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&call));
  if (definition.ml_meth != ours) {
    pybind11_call =
        reinterpret_cast<PyCFunctionWithKeywords>(reinterpret_cast<void (*)()>(definition.ml_meth));
    definition.ml_meth = ours;
  }
  if (!doc.is_none()) {
    char* const text = strdup(doc.cast<std::string>().c_str());
    if (text == nullptr) {
      throw std::bad_alloc();
    }
    std::free(const_cast<char*>(definition.ml_doc));
    definition.ml_doc = text;  // freed by pybind11
  }
}

}  // namespace

void bindCalls(py::module_& module) {
  module.def("_publish", &publish, py::arg("function"), py::arg("doc"),
             "Gives a function of this module its docstring, and sentences for wrong arguments.");
  module.def(
      "_explain_with",
      [](const py::function& function) {
        Py_XDECREF(explanation);
        explanation = py::object(function).release().ptr();
      },
      py::arg("function"),
      "Chooses the function that turns (self, text, arguments, keywords) of a TypeError into a "
      "sentence, or returns None.");
}

}  // namespace pyfranka
