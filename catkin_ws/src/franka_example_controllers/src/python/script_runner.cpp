// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "script_runner.h"

#include <franka_core/numbers.h>
#include <pthread.h>
#include <ros/console.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include "interpreter.h"
#include "script.h"
#include "waking.h"

namespace franka_example_controllers {

namespace {

namespace py = pybind11;

enum Order : int { kLoad, kStart, kUpdate, kStop, kEnd };

constexpr double kEndLimit = 2.0;   // [s] for a script to end in the destructor
constexpr int kInterruptions = 20;  // of a late script
constexpr auto kBetweenInterruptions = std::chrono::milliseconds(100);

/// Gives a thread the scheduling of the calling thread, which waits for it: otherwise threads of
/// lower priority could delay both.
void scheduleLikeThisThread(pthread_t thread) {
  int policy = 0;
  sched_param parameter{};
  if (pthread_getschedparam(pthread_self(), &policy, &parameter) == 0 && policy != SCHED_OTHER) {
    pthread_setschedparam(thread, policy, &parameter);
  }
}

}  // namespace

/// Data of both threads. Orders are numbered; between an order and its answer only the worker
/// accesses data that is not atomic, at other times only the thread that gives orders.
struct ScriptRunner::Shared {
  explicit Shared(franka_core::WaitMode waiting)
      : spins_for_order(waiting), spins_for_answer(waiting) {}

  Semaphore ordered, answered;
  franka_core::SpinRule spins_for_order, spins_for_answer;
  std::atomic<unsigned> orders{0}, answers{0};
  std::shared_ptr<ModelGate> gate{std::make_shared<ModelGate>()};
  pthread_t thread{};
  std::atomic<unsigned long> python_thread{0};
  std::atomic<bool> late{false};

  int order{kEnd};
  std::optional<ScriptSource> source;
  std::optional<franka_hw::FrankaModelHandle> model;
  franka::RobotState state;
  double period{0.0};
  double limit{0.0};
  ArmCommand command;
  std::string failure;  // of the order, written by the worker
  bool failed{false};

  bool busy() const {
    return orders.load(std::memory_order_relaxed) != answers.load(std::memory_order_acquire);
  }
  void give(int what) {
    order = what;
    orders.fetch_add(1, std::memory_order_release);
    ordered.post();
  }
  void awaitOrder();
  void work();
  void carryOut(std::optional<Script>& script);
};

void ScriptRunner::Shared::awaitOrder() {
  if (!spins_for_order.spin([this] { return busy(); })) {
    while (!busy()) {
      ordered.wait();
    }
  }
  ordered.drain();
}

void ScriptRunner::Shared::work() {
  const InterpreterLock interpreter;
  python_thread = PyThread_get_thread_ident();
  std::optional<Script> script;
  for (bool ends = false; !ends;) {
    {
      const InterpreterRelease others;
      awaitOrder();
    }
    failed = false;
    ends = order == kEnd;
    carryOut(script);
    answers.fetch_add(1, std::memory_order_release);
    answered.post();
  }
}

void ScriptRunner::Shared::carryOut(std::optional<Script>& script) {
  try {
    switch (order) {
      case kLoad:
        script.emplace(*source, *model, gate);
        break;
      case kStart:
        script->starting(state);
        break;
      case kUpdate:
        command = script->update(state, period);
        break;
      case kStop:
        script->stopping();
        break;
      default:
        script.reset();
    }
  } catch (const py::error_already_set& error) {
    failure = tracebackOf(error);
    failed = true;
  } catch (const std::exception& error) {
    failure = error.what();
    failed = true;
  }
  if (late) {
    // A late interruption must not affect the next order.
    PyThreadState_SetAsyncExc(python_thread, nullptr);
  }
  if (failed && (late || order == kStop)) {
    ROS_ERROR(
        "PythonController: %s\n%s",
        late ? "the script that was late was interrupted here:" : "the script's stopping() failed:",
        failure.c_str());
  }
}

ScriptRunner::ScriptRunner(franka_core::WaitMode waiting) {
  ensureInterpreter();
  shared_ = std::make_shared<Shared>(waiting);
  std::thread worker([shared = shared_] { shared->work(); });
  shared_->thread = worker.native_handle();
  worker.detach();
}

ScriptRunner::~ScriptRunner() {
  if (!awaitAnswer(kEndLimit / 4)) {
    shared_->late = true;
    interrupt();
  }
  // A script that does not end is abandoned; its thread owns its data.
  if (awaitAnswer(kEndLimit)) {
    shared_->give(kEnd);
    awaitAnswer(kEndLimit);
  } else {
    ROS_ERROR("PythonController: the script does not end; its thread is left behind.");
  }
}

std::string ScriptRunner::load(const ScriptSource& source,
                               const franka_hw::FrankaModelHandle& model, double limit) {
  shared_->source = source;
  shared_->model.emplace(model);
  shared_->give(kLoad);
  if (!awaitAnswer(limit)) {
    shared_->late = true;
    interrupt();
    return "It did not load within " + franka_core::numberText(limit) + " s.";
  }
  return shared_->failed ? shared_->failure : "";
}

// --- from the loop -------------------------------------------------------------------------------

bool ScriptRunner::awaitAnswer(double limit) {
  Shared& shared = *shared_;
  const timespec deadline = deadlineAfter(limit);
  if (!shared.spins_for_answer.spin([&] { return !shared.busy(); })) {
    while (shared.busy()) {
      if (!shared.answered.waitUntil(deadline)) {
        return !shared.busy();
      }
    }
  }
  shared.answered.drain();
  return true;
}

bool ScriptRunner::exchange(int order, const franka::RobotState& state, double period,
                            double limit) {
  Shared& shared = *shared_;
  shared.limit = limit;
  shared.state = state;
  shared.period = period;
  shared.gate->open();
  shared.give(order);
  const bool answered = awaitAnswer(limit);
  shared.gate->close();
  if (!answered) {
    shared.late = true;
  }
  return answered && !shared.failed;
}

bool ScriptRunner::start(const franka::RobotState& state, double limit) {
  shared_->limit = limit;
  // Remaining work of the last run, such as stopping, counts as well.
  if (!awaitAnswer(limit)) {
    shared_->late = true;
    return false;
  }
  shared_->late = false;
  scheduleLikeThisThread(shared_->thread);
  return exchange(kStart, state, 0.0, limit);
}

bool ScriptRunner::update(const franka::RobotState& state, double period, double limit,
                          ArmCommand& command) {
  if (!exchange(kUpdate, state, period, limit)) {
    return false;
  }
  command = shared_->command;
  return true;
}

void ScriptRunner::stop() {
  if (!shared_->busy()) {
    shared_->give(kStop);
  }
}

// --- outside -------------------------------------------------------------------------------------

std::string ScriptRunner::reason() const {
  if (!shared_->late) {
    return shared_->failure;
  }
  std::ostringstream text;
  text << "The script did not answer within the " << 1e3 * shared_->limit
       << " ms that it is allowed.";
  return text.str();
}

void ScriptRunner::interrupt() {
  if (!shared_->late || !shared_->busy()) {
    return;
  }
  // In a separate thread: a script that keeps the interpreter's lock would block the caller.
  std::thread([shared = shared_, order = shared_->orders.load()] {
    const auto answered = [&] { return static_cast<int>(shared->answers - order) >= 0; };
    for (int i = 0; i < kInterruptions && !answered(); ++i) {
      {
        const InterpreterLock interpreter;
        if (!answered()) {
          PyThreadState_SetAsyncExc(shared->python_thread, PyExc_SystemExit);
        }
      }
      std::this_thread::sleep_for(kBetweenInterruptions);
    }
  }).detach();
}

}  // namespace franka_example_controllers
