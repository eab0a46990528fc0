// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace franka_example_controllers {

/// Starts the process's Python interpreter unless there is one, and releases its lock. It runs
/// until the process ends: numpy cannot be started twice. Any thread, outside the loop.
/// @throws std::runtime_error with a sentence when Python cannot start
void ensureInterpreter();

/// Holds the interpreter's lock. By Python's own functions, which the modules that a script imports
/// use as well: pybind11's keep a thread state that these do not know of.
class InterpreterLock {
 public:
  InterpreterLock() : state_(PyGILState_Ensure()) {}
  ~InterpreterLock() { PyGILState_Release(state_); }
  InterpreterLock(const InterpreterLock&) = delete;
  InterpreterLock& operator=(const InterpreterLock&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Lets others have the lock that this thread holds.
class InterpreterRelease {
 public:
  InterpreterRelease() : state_(PyEval_SaveThread()) {}
  ~InterpreterRelease() { PyEval_RestoreThread(state_); }
  InterpreterRelease(const InterpreterRelease&) = delete;
  InterpreterRelease& operator=(const InterpreterRelease&) = delete;

 private:
  PyThreadState* state_;
};

/// What Python says of an error: its traceback, and the error itself in the last line. With the
/// interpreter's lock.
std::string tracebackOf(const pybind11::error_already_set& error);

}  // namespace franka_example_controllers
