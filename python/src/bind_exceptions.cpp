// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>

#include "bindings.h"
#include "other_names.h"

namespace pyfranka {

namespace {

// Owned by the module, for as long as the interpreter lives.
PyObject* control_exception = nullptr;
PyObject* version_exception = nullptr;

/// Raises `type` with its text and attributes.
template <typename Fill>
void raise(PyObject* type, const char* what, Fill fill) {
  py::object error = py::reinterpret_borrow<py::object>(type)(what);
  fill(error);
  PyErr_SetObject(type, error.ptr());
}

template <typename Error>
void bindPlain(py::module_& module, const char* name, const py::object& base, const char* doc) {
  const py::object type = py::register_local_exception<Error>(module, name, base);
  type.attr("__doc__") = doc;
}

}  // namespace

void bindExceptions(py::module_& module) {
  const py::object base =
      py::register_local_exception<franka::Exception>(module, "Exception", PyExc_RuntimeError);
  base.attr("__doc__") = "Base of all errors of a robot; the text is a sentence for the user.";
  alias(module, {{"Exception", "FrankaException"}});
  bindPlain<franka::ModelException>(module, "ModelException", base, "The model is not available.");
  bindPlain<franka::NetworkException>(module, "NetworkException", base,
                                      "The connection cannot be made, or is lost.");
  bindPlain<franka::ProtocolException>(module, "ProtocolException", base,
                                       "The robot sent invalid data.");
  bindPlain<franka::CommandException>(module, "CommandException", base,
                                      "The robot refused or aborted a command.");
  bindPlain<franka::RealtimeException>(module, "RealtimeException", base,
                                       "The system gives this program no real-time priority.");
  bindPlain<franka::InvalidOperationException>(
      module, "InvalidOperationException", base,
      "Not possible now: another operation runs, or the motion has been closed.");

  static py::exception<franka::ControlException> control(module, "ControlException", base);
  control.attr("__doc__") = "A motion was aborted. `log` holds the last records, oldest first.";
  control.attr("__annotations__") = py::dict(py::arg("log") = "list[Record]");
  control_exception = control.ptr();
  static py::exception<franka::IncompatibleVersionException> version(
      module, "IncompatibleVersionException", base);
  version.attr("__doc__") =
      "Robot and library have no protocol in common: `server_version`, `library_version`.";
  version.attr("__annotations__") =
      py::dict(py::arg("server_version") = "int", py::arg("library_version") = "int");
  version_exception = version.ptr();
  py::register_local_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) {
        std::rethrow_exception(pointer);
      }
    } catch (const franka::ControlException& error) {
      raise(control_exception, error.what(), [&](py::object& raised) {
        py::list log;
        for (const franka::Record& record : error.log) {
          log.append(record);
        }
        raised.attr("log") = log;
      });
    } catch (const franka::IncompatibleVersionException& error) {
      raise(version_exception, error.what(), [&](py::object& raised) {
        raised.attr("server_version") = error.server_version;
        raised.attr("library_version") = error.library_version;
      });
    }
  });
}

}  // namespace pyfranka
