// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace franka_example_controllers {

/// Starts the process's Python interpreter unless it runs, and releases its lock. It runs until the
/// process ends: numpy cannot be started twice. Thread-safe. Not real-time safe. @throws
/// std::runtime_error with a sentence if Python cannot start
void ensureInterpreter();

/// Holds the interpreter's lock, by Python's own functions, which modules imported by a script use
/// as well: pybind11's use a thread state that these do not know.
class InterpreterLock {
 public:
  InterpreterLock() : state_(PyGILState_Ensure()) {}
  ~InterpreterLock() { PyGILState_Release(state_); }
  InterpreterLock(const InterpreterLock&) = delete;
  InterpreterLock& operator=(const InterpreterLock&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Releases the lock of this thread for other threads.
class InterpreterRelease {
 public:
  InterpreterRelease() : state_(PyEval_SaveThread()) {}
  ~InterpreterRelease() { PyEval_RestoreThread(state_); }
  InterpreterRelease(const InterpreterRelease&) = delete;
  InterpreterRelease& operator=(const InterpreterRelease&) = delete;

 private:
  PyThreadState* state_;
};

/// Python's text of an error: its traceback, with the error itself in the last line. With the
/// interpreter's lock.
std::string tracebackOf(const pybind11::error_already_set& error);

}  // namespace franka_example_controllers
