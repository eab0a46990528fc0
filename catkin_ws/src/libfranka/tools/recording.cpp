// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "recording.h"

#include <franka/exception.h>
#include <franka/model.h>
#include <franka/robot.h>
#include <franka_core/smooth_step.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace franka_info {

namespace {

constexpr std::uint64_t kInterval = 5;  // [ms]
constexpr double kSwing = 0.25;         // [rad] to either side
constexpr double kSoft = 2.0;           // [s] in which the swing grows, and shrinks at the end
/// Angular frequencies of the joints [rad/s]: no two are multiples of each other, so that each
/// joint is seen in both directions at many poses of the others. At most 0.71 rad/s.
constexpr std::array<double, 7> kFrequencies{1.51, 1.73, 1.97, 2.17, 2.39, 2.61, 2.83};

class Recorder {
 public:
  /// Nothing is allocated in `add` until the time is over.
  explicit Recorder(double seconds) {
    states_.reserve(static_cast<std::size_t>(1000.0 * seconds / kInterval) + 2);
  }

  /// @returns the time since the first state [s]
  double add(const franka::RobotState& state) {
    const std::uint64_t now = state.time.toMSec();
    if (states_.empty()) {
      start_ = now;
    }
    if (states_.size() < states_.capacity() &&
        (states_.empty() || now >= states_.back().time.toMSec() + kInterval)) {
      states_.push_back(state);
    }
    return 1e-3 * static_cast<double>(now - start_);
  }

  void write(const franka::Model& model, std::ofstream& stream) const {
    stream.precision(9);
    writeTitles(stream);
    for (const franka::RobotState& state : states_) {
      writeRow(stream, model, state);
    }
    stream.close();
  }

 private:
  static void writeTitles(std::ofstream& stream) {
    stream << "time";
    for (const char* signal : {"q", "dq", "tau_J", "tau_J_d", "tau_ext_hat_filtered", "dq_d",
                               "ddq_d", "gravity", "mass", "moment_x", "moment_y", "moment_z"}) {
      for (int joint = 1; joint <= 7; joint++) {
        stream << "," << signal << joint;
      }
    }
    stream << "\n";
  }

  static void write(std::ofstream& stream, const std::array<double, 7>& values) {
    for (const double value : values) {
      stream << "," << value;
    }
  }

  void writeRow(std::ofstream& stream, const franka::Model& model,
                const franka::RobotState& state) const {
    stream << 1e-3 * static_cast<double>(state.time.toMSec() - start_);
    const std::array<double, 7> gravity =
        model.gravity(state.q, state.m_total, state.F_x_Ctotal, state.O_ddP_O);
    for (const auto& signal : {state.q, state.dq, state.tau_J, state.tau_J_d,
                               state.tau_ext_hat_filtered, state.dq_d, state.ddq_d, gravity}) {
      write(stream, signal);
    }
    // The torques of a load are linear in its mass and in its moment, mass times center.
    const std::array<double, 7> at_flange = loaded(model, state, 1.0, {});
    write(stream, difference(at_flange, loaded(model, state, 0.0, {}), 1.0));
    for (std::size_t axis = 0; axis < 3; axis++) {
      std::array<double, 3> center{};
      center[axis] = 1.0;
      const std::array<double, 7> ahead = loaded(model, state, 1.0, center);
      center[axis] = -1.0;  // terms with the square of the center vanish in the difference
      write(stream, difference(ahead, loaded(model, state, 1.0, center), 0.5));
    }
    stream << "\n";
  }

  /// The torques of the desired motion with a point mass as load [Nm].
  static std::array<double, 7> loaded(const franka::Model& model, const franka::RobotState& state,
                                      double mass, const std::array<double, 3>& center) {
    std::array<double, 7> torque = model.gravity(state.q, mass, center, state.O_ddP_O);
    const std::array<double, 7> coriolis = model.coriolis(state.q, state.dq_d, {}, mass, center);
    const std::array<double, 49> inertia = model.mass(state.q, {}, mass, center);
    for (std::size_t i = 0; i < 7; i++) {
      torque[i] += coriolis[i];
      for (std::size_t j = 0; j < 7; j++) {
        torque[i] += inertia[7 * j + i] * state.ddq_d[j];
      }
    }
    return torque;
  }

  static std::array<double, 7> difference(std::array<double, 7> a, const std::array<double, 7>& b,
                                          double factor) {
    for (std::size_t i = 0; i < 7; i++) {
      a[i] = factor * (a[i] - b[i]);
    }
    return a;
  }

  std::vector<franka::RobotState> states_;
  std::uint64_t start_{0};
};

void requireGood(const std::ofstream& stream, const std::string& file) {
  if (!stream) {
    throw std::runtime_error("The file " + file + " cannot be written.");
  }
}

void swing(franka::Robot& robot, double seconds, Recorder& recorder) {
  std::array<double, 7> start{};
  double time = 0.0;
  robot.control([&](const franka::RobotState& state, franka::Duration period) {
    if (time == 0.0) {
      start = state.q_d;
    }
    time += period.toSec();
    recorder.add(state);
    const double size = kSwing * franka_core::smoothStep(time / kSoft) *
                        franka_core::smoothStep((seconds - time) / kSoft);
    franka::JointPositions target(start);
    for (std::size_t i = 0; i < 7; i++) {
      target.q[i] += size * std::sin(kFrequencies[i] * time);
    }
    return time < seconds ? target : franka::MotionFinished(target);
  });
}

}  // namespace

void record(const RecordingOptions& options) {
  franka::Robot robot(options.address, franka::RealtimeConfig::kIgnore);
  const franka::Model model = robot.loadModel();
  std::ofstream stream(options.file);
  requireGood(stream, options.file);  // before the robot moves
  Recorder recorder(options.seconds);
  try {
    if (options.moves) {
      swing(robot, options.seconds, recorder);
    } else {
      robot.read(
          [&](const franka::RobotState& state) { return recorder.add(state) < options.seconds; });
    }
  } catch (const franka::Exception&) {
    recorder.write(model, stream);
    std::fprintf(stderr, "franka_info: what was recorded until the error is in %s.\n",
                 options.file.c_str());
    throw;
  }
  recorder.write(model, stream);
  requireGood(stream, options.file);
}

}  // namespace franka_info
