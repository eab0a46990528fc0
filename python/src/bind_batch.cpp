// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Simulations that are stepped together; pyfranka/sim/batch.py gives them their Python interface.
#include <franka_sim/simulation/batch.h>
#include <pybind11/stl.h>

#include <deque>
#include <optional>
#include <utility>

#include "bindings.h"
#include "shared_simulation.h"

namespace pyfranka {

namespace {

using Worlds = std::vector<std::shared_ptr<Shared>>;
using Names = std::optional<std::vector<std::string>>;

/// A batch that keeps its simulations alive and uses all of them during a call.
class Batch {
 public:
  Batch(Worlds worlds, int threads, const Names& observe)
      : worlds_(std::move(worlds)),
        batch_(simulations(worlds_), threads,
               observe ? *observe : franka_sim::Observer::usualNames(worlds_.at(0)->simulation())) {
  }

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
    const py::gil_scoped_release free;
    function(batch_);
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
  py::class_<Batch>(module, "Batch", "Simulations that are stepped together.")
      .def(py::init([](Worlds worlds, int threads, const Names& observe) {
             return std::make_unique<Batch>(std::move(worlds), threads, observe);
           }),
           py::arg("worlds"), py::arg("threads"), py::arg("observe"))
      .def(
          "step",
          [](Batch& self, std::int64_t ticks) {
            const std::uint64_t count = ticksOf(ticks);
            self.use([count](franka_sim::SimulationBatch& batch) { batch.step(count); });
          },
          py::arg("ticks"))
      .def("observe",
           [](Batch& self) {
             self.use([](franka_sim::SimulationBatch& batch) { batch.observe(); });
           })
      .def_property_readonly("observations", &observations)
      .def_property_readonly("layout", &layout);
}

}  // namespace pyfranka
