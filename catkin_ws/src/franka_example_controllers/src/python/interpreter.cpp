// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "interpreter.h"

#include <dlfcn.h>

#include <mutex>
#include <stdexcept>

namespace franka_example_controllers {

namespace {

namespace py = pybind11;

// Thread switch interval requested of a script, so that other threads run within a cycle; Python's
// default of 5 ms would delay them by five cycles.
constexpr double kSwitchInterval = 1e-4;  // [s]

/// Keeps the library that contains an address until the process ends. Python's extension modules
/// need Python's symbols to be global, and Python keeps pointers to our functions.
void keepLibraryOf(void* address, int flags) {
  Dl_info info;
  if (dladdr(address, &info) != 0) {
    dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE | flags);
  }
}

void start() {
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.install_signal_handlers = 0;
  config.parse_argv = 0;
  // ROS's interpreter, which need not be the first one in PATH.
  PyStatus status = PyConfig_SetBytesString(&config, &config.program_name, PYTHON_PROGRAM);
  if (PyStatus_Exception(status) == 0) {
    status = Py_InitializeFromConfig(&config);
  }
  PyConfig_Clear(&config);
  if (PyStatus_Exception(status) != 0) {
    throw std::runtime_error(std::string("Python could not start: ") +
                             (status.err_msg != nullptr ? status.err_msg : "no reason given") +
                             ".");
  }
  py::module_::import("sys").attr("setswitchinterval")(kSwitchInterval);
  PyEval_SaveThread();
}

}  // namespace

void ensureInterpreter() {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  if (Py_IsInitialized() != 0) {
    return;
  }
  keepLibraryOf(reinterpret_cast<void*>(&Py_InitializeFromConfig), RTLD_GLOBAL);
  keepLibraryOf(reinterpret_cast<void*>(&ensureInterpreter), 0);
  start();
}

std::string tracebackOf(const py::error_already_set& error) {
  try {
    const py::object trace = error.trace() ? py::object(error.trace()) : py::none();
    const py::object lines = py::module_::import("traceback")
                                 .attr("format_exception")(error.type(), error.value(), trace);
    return py::str("").attr("join")(lines).attr("rstrip")().cast<std::string>();
  } catch (const py::error_already_set&) {
    return error.what();
  }
}

}  // namespace franka_example_controllers
