// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Episodes of learned policies; pyfranka/gym makes tasks of them.
#include <franka_sim/simulation/policy_episode.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "shared_simulation.h"

namespace pyfranka {

namespace {

using franka_sim::PolicyControl;
using franka_sim::PolicyEpisode;
using Numbers = py::array_t<double, py::array::c_style>;

PolicyControl controlOf(const std::string& name) {
  static const std::map<std::string, PolicyControl> kControls{
      {"torque", PolicyControl::kTorque},
      {"joint_delta", PolicyControl::kJointDelta},
      {"cartesian_delta", PolicyControl::kCartesianDelta}};
  return kControls.at(name);
}

/// Episodes in a simulation, which they keep alive.
class Episode {
 public:
  Episode(std::shared_ptr<Shared> shared, const PolicyEpisode::Setting& setting)
      : shared_(std::move(shared)), episode_(shared_->simulation(), setting) {}

  PolicyEpisode& episode() noexcept { return episode_; }
  /// Calls a function with the episode.
  template <typename Function>
  void use(Function function) {
    const Shared::Use use(*shared_);
    function(episode_);
  }

 private:
  std::shared_ptr<Shared> shared_;
  PolicyEpisode episode_;
};

// Numbers of so many rows, which must have the right size.
const double* checked(const Numbers& numbers, std::size_t rows, std::size_t columns) {
  if (static_cast<std::size_t>(numbers.size()) != rows * columns) {
    throw std::invalid_argument("Actions and observations must have " + std::to_string(rows) +
                                " x " + std::to_string(columns) + " numbers.");
  }
  return numbers.data();
}

// What is beyond [-1, 1] is clipped, as policies with noise expect.
std::vector<double> clipped(const Numbers& actions, std::size_t rows, std::size_t columns) {
  const double* values = checked(actions, rows, columns);
  std::vector<double> clipped(values, values + rows * columns);
  for (double& value : clipped) {
    if (!std::isfinite(value)) {
      throw std::invalid_argument("An action must be finite numbers.");
    }
    value = std::clamp(value, -1.0, 1.0);
  }
  return clipped;
}

double* writable(Numbers& observations, std::size_t rows, std::size_t columns) {
  checked(observations, rows, columns);
  return observations.mutable_data();
}

void apply(Episode& self, const Numbers& action, double seconds) {
  const std::vector<double> values = clipped(action, 1, self.episode().actionSize());
  self.use([&](PolicyEpisode& episode) { episode.apply(values.data(), seconds); });
}

// After a step of so many seconds; 0: at the beginning.
void observe(Episode& self, double seconds, Numbers& observation) {
  double* to = writable(observation, 1, self.episode().observationSize());
  self.use([&](PolicyEpisode& episode) {
    if (seconds > 0.0) {
      episode.recover(seconds);
    }
    episode.observe(seconds, to);
  });
}

using Episodes = std::vector<Episode*>;

void requireSize(const Episodes& episodes, std::size_t size) {
  if (episodes.empty() || episodes.size() != size) {
    throw std::invalid_argument("There must be as many episodes as rows.");
  }
}

/// @param rests those that are left alone
void applyAll(const Episodes& episodes, const std::vector<bool>& rests, const Numbers& actions,
              double seconds) {
  requireSize(episodes, rests.size());
  const std::size_t size = episodes[0]->episode().actionSize();
  const std::vector<double> values = clipped(actions, episodes.size(), size);
  for (std::size_t i = 0; i < episodes.size(); i++) {
    if (!rests[i]) {
      episodes[i]->use([&](PolicyEpisode& episode) { episode.apply(&values[i * size], seconds); });
    }
  }
}

/// @param observations one row an episode; those that rest keep theirs
void observeAll(const Episodes& episodes, const std::vector<bool>& rests, double seconds,
                Numbers& observations) {
  requireSize(episodes, rests.size());
  const std::size_t size = episodes[0]->episode().observationSize();
  double* to = writable(observations, episodes.size(), size);
  for (std::size_t i = 0; i < episodes.size(); i++, to += size) {
    if (!rests[i]) {
      episodes[i]->use([&](PolicyEpisode& episode) {
        episode.recover(seconds);
        episode.observe(seconds, to);
      });
    }
  }
}

}  // namespace

void bindEpisode(py::module_& module) {
  py::class_<Episode>(module, "Episode", py::module_local(),
                      "Episodes of a policy in a simulation.")
      .def(py::init([](const std::shared_ptr<Shared>& simulation, const std::string& control,
                       const std::string& body, bool hands, const Numbers& workspace) {
             const double* limits = checked(workspace, 2, 3);
             return std::make_unique<Episode>(
                 simulation,
                 PolicyEpisode::Setting{controlOf(control),
                                        hands,
                                        body,
                                        {Eigen::Vector3d(limits), Eigen::Vector3d(limits + 3)}});
           }),
           py::arg("simulation"), py::arg("control"), py::arg("body"), py::arg("hands"),
           py::arg("workspace"))
      .def_property_readonly("size", [](Episode& self) { return self.episode().observationSize(); })
      .def("restart",
           [](Episode& self) { self.use([](PolicyEpisode& episode) { episode.restart(); }); })
      .def("apply", &apply, py::arg("action"), py::arg("seconds"))
      .def("observe", &observe, py::arg("seconds"), py::arg("observation").noconvert())
      .def_property_readonly("reflexes", [](Episode& self) { return self.episode().reflexes(); })
      .def_property_readonly("stopped", [](Episode& self) { return self.episode().stopped(); })
      .def_property_readonly("stuck", [](Episode& self) { return self.episode().stuck(); });
  module.attr("CARTESIAN_SPEEDS") =
      py::make_tuple(franka_sim::kPolicySpeed, franka_sim::kPolicyTurnSpeed);
  module.def("apply_actions", &applyAll, py::arg("episodes"), py::arg("rests"), py::arg("actions"),
             py::arg("seconds"));
  module.def("observe_episodes", &observeAll, py::arg("episodes"), py::arg("rests"),
             py::arg("seconds"), py::arg("observations").noconvert());
}

}  // namespace pyfranka
