// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>

/// @file
/// What Python expects of a long step: that Ctrl-C ends it, and that warnings come as its own.

namespace pyfranka {

/// False once a signal has raised an exception of Python, which then is set. Call without the
/// interpreter's lock or with it.
inline bool noSignal() {
  const pybind11::gil_scoped_acquire lock;
  return PyErr_Occurred() == nullptr && PyErr_CheckSignals() == 0;
}

/// Throws what noSignal has seen. Call with the interpreter's lock.
inline void raiseSignal() {
  if (!noSignal()) {
    throw pybind11::error_already_set();
  }
}

/// A RuntimeWarning for the caller of step(), a function in Python.
inline void warnOfStep(const std::string& sentence) {
  constexpr int kCallerOfStep = 2;
  if (PyErr_WarnEx(PyExc_RuntimeWarning, sentence.c_str(), kCallerOfStep) != 0) {
    throw pybind11::error_already_set();
  }
}

}  // namespace pyfranka
