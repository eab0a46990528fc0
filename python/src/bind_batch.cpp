// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Simulations that are stepped together; pyfranka/sim/batch.py gives them their Python interface.
#include <franka_sim/simulation/batch.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "bindings.h"
#include "shared_simulation.h"
#include "step_hooks.h"

namespace pyfranka {

namespace {

using Worlds = std::vector<std::shared_ptr<Shared>>;
using ObservedNames = std::optional<std::vector<std::string>>;

/// A batch that keeps its simulations alive and uses all of them during a call.
class Batch {
 public:
  Batch(Worlds worlds, int threads, const ObservedNames& observe)
      : worlds_(std::move(worlds)),
        batch_(
            simulations(worlds_), threads,
            observe ? *observe : franka_sim::Observer::defaultNames(worlds_.at(0)->simulation())) {}

  /// Calls a function with the batch, without the interpreter's lock.
  template <typename Function>
  void use(Function function) {
    std::deque<Shared::Use> uses;
    for (const std::shared_ptr<Shared>& world : worlds_) {
      uses.emplace_back(*world);
      if (world->served()) {
        throw std::runtime_error(
            "A world of the batch is served on the network; step it by itself.");
      }
    }
    {
      const py::gil_scoped_release free;
      function(batch_);
    }
    for (const std::shared_ptr<Shared>& world : worlds_) {
      world->requireStepped();
    }
  }
  /// Steps all, warns, and ends at Ctrl-C.
  void step(std::uint64_t ticks) {
    std::map<std::string, std::string> warnings;
    use([&](franka_sim::SimulationBatch& batch) {
      batch.step(ticks, [this] { return !isClosed() && noSignal(); });
      warnings = takeWarnings();
    });
    raiseSignal();
    for (const auto& [warning, worlds] : warnings) {
      const bool one = worlds.find(',') == std::string::npos;
      warnOfStep((one ? "World " : "Worlds ") + worlds + ": " + warning);
    }
  }
  /// Puts another simulation in the place of a world, which may be closed.
  void replace(std::size_t number, const std::shared_ptr<Shared>& world) {
    const std::shared_ptr<Shared> present = worlds_.at(number);
    std::optional<Shared::Use> stepped;  // by another thread, which is refused
    if (present != world && !present->closed()) {
      stepped.emplace(*present);
    }
    world->use([&](franka_sim::Simulation& simulation) { batch_.replace(number, simulation); });
    worlds_[number] = world;
  }
  const franka_sim::SimulationBatch& batch() const noexcept { return batch_; }
  std::size_t rows() const noexcept { return worlds_.size(); }

 private:
  static std::vector<franka_sim::Simulation*> simulations(const Worlds& worlds) {
    std::vector<franka_sim::Simulation*> result;
    for (const std::shared_ptr<Shared>& world : worlds) {
      result.push_back(&world->simulation());
    }
    return result;
  }

  bool isClosed() const {
    return std::any_of(worlds_.begin(), worlds_.end(),
                       [](const std::shared_ptr<Shared>& world) { return world->closed(); });
  }

  // Sentences with the numbers of the worlds that they are about. Call within use().
  std::map<std::string, std::string> takeWarnings() {
    std::map<std::string, std::string> numbers;
    for (std::size_t i = 0; i < worlds_.size(); i++) {
      for (const std::string& warning : worlds_[i]->simulation().world().takeWarnings()) {
        std::string& list = numbers[warning];
        list += (list.empty() ? "" : ", ") + std::to_string(i);
      }
    }
    return numbers;
  }

  Worlds worlds_;
  franka_sim::SimulationBatch batch_;
};

py::array observations(const py::object& self) {
  const Batch& batch = self.cast<const Batch&>();
  const auto columns = static_cast<py::ssize_t>(batch.batch().rowSize());
  py::array_t<double> view({static_cast<py::ssize_t>(batch.rows()), columns},
                           batch.batch().observations().data(), self);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

py::list layout(const Batch& self) {
  py::list list;
  std::size_t at = 0;
  for (const franka_sim::Observer::Value& value : self.batch().layout()) {
    list.append(py::make_tuple(value.name, at, at + value.size));
    at += value.size;
  }
  return list;
}

}  // namespace

void bindBatch(py::module_& module) {
  py::class_<Batch>(module, "Batch", py::module_local(), "Simulations that are stepped together.")
      .def(py::init([](Worlds worlds, int threads, const ObservedNames& observe) {
             return std::make_unique<Batch>(std::move(worlds), threads, observe);
           }),
           py::arg("worlds"), py::arg("threads"), py::arg("observe"))
      .def(
          "step", [](Batch& self, const py::object& ticks) { self.step(ticksOf(ticks)); },
          py::arg("ticks"))
      .def("observe",
           [](Batch& self) {
             self.use([](franka_sim::SimulationBatch& batch) { batch.observe(); });
           })
      .def("replace", &Batch::replace, py::arg("number"), py::arg("world"))
      .def_property_readonly("observations", &observations)
      .def_property_readonly("layout", &layout);
}

}  // namespace pyfranka
