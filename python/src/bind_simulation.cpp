// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Worlds with robots in this process; pyfranka/sim gives them their Python interface.
#include <franka_core/numbers.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/simulation/missing_file.h>
#include <franka_sim/simulation/robot_setup.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "arguments.h"
#include "bindings.h"
#include "shared_simulation.h"
#include "step_hooks.h"

namespace pyfranka {

namespace {

using release = py::gil_scoped_release;

constexpr std::uint64_t kTicksBetweenSignals = 1000;  // chosen here: some 20 ms

// Ctrl-C ends a long step.
void step(Shared& self, std::uint64_t ticks, bool warns) {
  const Shared::Use use(self);
  while (ticks > 0) {
    const std::uint64_t next = std::min(ticks, kTicksBetweenSignals);
    {
      const release free;
      self.step(next);
    }
    ticks -= next;
    raiseSignal();  // also of a tick that waited for a client
    self.requireStepped();
  }
  if (warns) {
    for (const std::string& warning : self.simulation().world().takeWarnings()) {
      warnOfStep(warning);
    }
  }
}

// Waits until another thread has left its step. Ctrl-C ends the wait.
void close(Shared& self) {
  constexpr std::chrono::milliseconds kPause{1};  // chosen here: a tick takes less
  while (!self.close()) {
    raiseSignal();
    const release free;
    std::this_thread::sleep_for(kPause);
  }
}

franka_core::WaitMode waitOf(const py::object& name) {
  const std::string word = text(name, "wait");
  const std::optional<franka_core::WaitMode> mode = franka_core::toWaitMode(word);
  if (!mode) {
    throw std::invalid_argument("wait is 'auto', 'spin' or 'block', not '" + word + "'.");
  }
  return *mode;
}

/// @param limit [s]; none: without end
franka_sim::fci::Pace paceOf(bool real_time, const py::object& limit) {
  constexpr double kMaxPatience = 86400.0;  // [s] chosen here
  const auto patience =
      limit.is_none() ? std::optional<double>() : std::optional(number(limit, "patience"));
  if (patience && !(*patience > 0.0 && *patience <= kMaxPatience)) {
    throw std::invalid_argument(
        "patience must be more than 0 and at most 86400 seconds, or 'forever', not " +
        franka_core::numberText(*patience) + ".");
  }
  franka_sim::fci::Pace pace;
  pace.mode =
      real_time ? franka_sim::fci::PaceMode::kRealTime : franka_sim::fci::PaceMode::kFreeRunning;
  pace.patience = franka_sim::fci::Pace::kForever;
  if (patience) {
    const double milliseconds = std::ceil(1e3 * *patience);
    pace.patience = std::chrono::milliseconds(static_cast<std::int64_t>(milliseconds));
  }
  return pace;
}

struct Snapshot {
  franka_sim::SimulationSnapshot condition;
  std::uint64_t ticks;
};

}  // namespace

void bindSimulation(py::module_& module, const py::object& refusal) {
  using franka_sim::Simulation;
  py::register_local_exception<franka_sim::RequestRefused>(module, "RequestRefused", refusal)
      .attr("__doc__") =
      "The robot or its hand cannot do what was requested: its mode does not allow it, or no such "
      "value exists for it. A CommandException, as of a robot on the network.";
  py::register_local_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) {
        std::rethrow_exception(pointer);
      }
    } catch (const franka_sim::MissingFile& error) {
      PyErr_SetString(PyExc_FileNotFoundError, error.what());
    }
  });
  py::class_<Snapshot> snapshot(module, "Snapshot", py::module_local(),
                                "The state of a world and its robots at a tick.\n\n"
                                ">>> snapshot = sim.snapshot()\n>>> sim.restore(snapshot)");
  snapshot.def("__repr__", [](const Snapshot& self) {
    return "<Snapshot at " + franka_core::numberText(1e-3 * double(self.ticks), 9) + " s>";
  });
  refuseCopies(snapshot,
               "A Snapshot cannot be pickled: restore it in the process that has taken it. "
               "Elsewhere make a Simulation with the same world, robots and seed, and repeat what "
               "has been commanded.");
  py::class_<Simulation::Robot>(module, "RobotSetup", py::module_local(),
                                "What is needed to add a robot.")
      .def(py::init([](const std::string& robot, const std::string& name, const std::string& urdf,
                       const py::object& base, double yaw, const std::string& realism, bool hand) {
             const auto position = finite<3>(base, "base");
             return Simulation::Robot{{robot, name, urdf, position, yaw, realism}, hand};
           }),
           py::arg("robot"), py::arg("name"), py::arg("urdf"), py::arg("base"), py::arg("yaw"),
           py::arg("realism"), py::arg("hand"));
  module.def("robot_with_meshes", [](const std::string& robot, const std::string& arm_id) {
    const franka_sim::RobotLook look = franka_sim::robotWithMeshes(robot, arm_id);
    return py::make_tuple(look.urdf, look.missing);
  });
  py::class_<Shared, std::shared_ptr<Shared>> simulation(module, "Simulation", py::module_local(),
                                                         "A world with robots.");
  bindSimulatedRobot(module, simulation);
  simulation
      .def(py::init([](const std::string& world, const std::vector<Simulation::Robot>& robots) {
             const release free;
             return std::make_shared<Shared>(world, robots);
           }),
           py::arg("world"), py::arg("robots"))
      .def(
          "step", [](Shared& self, const py::object& ticks) { step(self, ticksOf(ticks), true); },
          py::arg("ticks"))
      .def(
          "try_out",  // a step that will be undone: it does not warn
          [](Shared& self, const py::object& ticks) { step(self, ticksOf(ticks), false); },
          py::arg("ticks"))
      .def(
          "serve",
          [](Shared& self, const std::string& robot, const py::object& address, bool real_time,
             const py::object& patience, const py::object& wait) {
            franka_sim::fci::Pace pace = paceOf(real_time, patience);
            pace.wait = waitOf(wait);
            self.serve(robot, text(address, "ip"), pace, noSignal);
          },
          py::arg("robot"), py::arg("address"), py::arg("real_time"), py::arg("patience"),
          py::arg("wait"))
      .def("attend", &Shared::attend)
      .def("take_events", &Shared::takeEvents)
      .def("reset", [](Shared& self) { self.use([](Simulation& s) { s.reset(); }); })
      .def("snapshot",
           [](Shared& self) {
             return self.use(
                 [](Simulation& s) { return Snapshot{s.snapshot(), s.world().ticks()}; });
           })
      .def("restore",
           [](Shared& self, const py::object& snapshot) {
             const auto& kept =
                 objectOf<Snapshot>(snapshot, "snapshot", "what snapshot() has returned");
             self.use([&](Simulation& s) { s.restore(kept.condition); });
           })
      .def("stopped",
           [](Shared& self) { return self.use([](Simulation& s) { return s.world().stopped(); }); })
      .def("ticks",
           [](Shared& self) { return self.use([](Simulation& s) { return s.world().ticks(); }); })
      .def("hash",
           [](Shared& self) {
             return self.use([](Simulation& s) { return s.world().stateHash(); });
           })
      .def("require_open", &Shared::requireOpen, "Raises RuntimeError once it is closed.")
      .def("take_warnings",
           [](Shared& self) {
             return self.use([](Simulation& s) { return s.world().takeWarnings(); });
           })
      .def("close", &close);
  bindWorld(simulation);
  bindBatch(module);
  bindEpisode(module);
  module.def(
      "check_realism",
      [](const std::string& text) { franka_sim::readRealism(text, franka_sim::kInProcessProfile); },
      py::arg("realism"), "Raises ValueError for a profile that does not exist.");
  module.def("world_file", &franka_sim::worldFile, py::arg("name"),
             "The file of a world by its name, as Simulation takes it.");
}

}  // namespace pyfranka
