// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/numbers.h>
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world_properties.h>
#include <gtest/gtest.h>
#include <source_file.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace franka_sim::test {

constexpr std::array<double, 7> kHome{0, -0.785, 0, -2.356, 0, 1.571, 0.785};
constexpr double kRotorInertia = 0.1;

/// `panda` or `fr3`, with hand, root `<arm_id>_link0`.
inline std::string urdfOf(const std::string& arm_id) {
  return franka_test::readSource("franka_sim/robots/" + arm_id + ".urdf");
}

inline std::string world(const std::string& name) {
  return franka_test::sourceFile("franka_sim/worlds/" + name + ".xml");
}

inline Pose at(double x, double y, double z) {
  Pose pose;
  pose.position = {x, y, z};
  return pose;
}

inline std::string replaceAll(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// A robot in its home pose, named `arm_id`, with the numbers of `kind`.
inline RobotDescription robot(const std::string& kind, const std::string& arm_id) {
  RobotDescription description;
  description.name = arm_id;
  description.urdf = replaceAll(urdfOf(kind), kind + "_", arm_id + "_");
  setInitialPositions(kHome, arm_id, description);
  for (int i = 0; i < 7; ++i) {
    const std::string joint = arm_id + "_joint" + std::to_string(i + 1);
    description.rotor_inertia[joint] = kRotorInertia;
    description.stops[joint] = {-4.7, 4.7};
  }
  return description;
}

inline RobotDescription robot(const std::string& kind) { return robot(kind, kind); }

/// The hand with closed fingers as payload at the flange, from the numbers of the description.
inline franka_core::Payload handPayload(const std::string& kind = "panda") {
  const auto body = [](double mass, std::array<double, 3> com, std::array<double, 3> moments) {
    franka_core::Payload payload;
    payload.mass = mass;
    payload.com = com;
    payload.inertia = {moments[0], 0, 0, 0, moments[1], 0, 0, 0, moments[2]};
    return payload;
  };
  if (kind == "fr3") {  // as Desk configures it
    return body(0.73, {-0.01, 0, 0.03}, {0.001, 0.0025, 0.0017});
  }
  const std::array<double, 3> finger{2.375e-06, 2.375e-06, 7.5e-07};
  franka_core::Payload hand = body(0.73, {-0.01, 0, 0.03}, {0.001, 0.0025, 0.0017});
  hand = combine(hand, body(0.015, {0, 0, 0.0584}, finger));
  hand = combine(hand, body(0.015, {0, 0, 0.0584}, finger));
  // The hand is turned by -45 degrees about the flange's z: R I R^T, written out in the plane.
  constexpr double kC = 0.70710678118654752440;
  franka_core::Payload turned = hand;
  turned.com = {kC * hand.com[0] + kC * hand.com[1], -kC * hand.com[0] + kC * hand.com[1],
                hand.com[2]};
  const double xx = hand.inertia[0], yy = hand.inertia[4];
  turned.inertia[0] = turned.inertia[4] = 0.5 * (xx + yy);
  turned.inertia[1] = turned.inertia[3] = 0.5 * (yy - xx);
  // Products with z vanish: the hand's com has y = 0, and its product xz transforms like a vector.
  const double xz = hand.inertia[6], yz = hand.inertia[7];
  turned.inertia[2] = turned.inertia[6] = kC * xz + kC * yz;
  turned.inertia[5] = turned.inertia[7] = -kC * xz + kC * yz;
  return turned;
}

/// Holds or moves the arm by gravity compensation and joint springs.
class ArmHolder {
 public:
  explicit ArmHolder(ArmPlant* arm, const std::string& kind = "panda")
      : arm_(arm),
        model_(franka_core::ArmModel::fromUrdf(urdfOf(kind), kind)),
        payload_(handPayload(kind)) {}

  std::array<double, 7> torques(const std::array<double, 7>& q_d,
                                const std::array<double, 7>& dq_d = {}) const noexcept {
    constexpr std::array<double, 7> kStiffness{1500, 1500, 1500, 1500, 600, 600, 600};
    const ArmMeasurement m = arm_->measure();
    std::array<double, 7> tau = model_.gravity(m.q, payload_);
    const auto coriolis = model_.coriolis(m.q, m.dq, payload_);
    for (int i = 0; i < 7; ++i) {
      const double damping = 1.2 * std::sqrt(kStiffness[i]);
      tau[i] += coriolis[i] + kStiffness[i] * (q_d[i] - m.q[i]) + damping * (dq_d[i] - m.dq[i]);
    }
    return tau;
  }
  void hold(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d = {}) noexcept {
    arm_->applyTorques(torques(q_d, dq_d));
  }
  const franka_core::ArmModel& model() const noexcept { return model_; }
  const franka_core::Payload& payload() const noexcept { return payload_; }

 private:
  ArmPlant* arm_;
  franka_core::ArmModel model_;
  franka_core::Payload payload_;
};

/// Expects a std::runtime_error whose sentence contains all parts.
template <typename Function>
void expectSentence(Function function, std::initializer_list<const char*> parts) {
  try {
    function();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    for (const char* part : parts) {
      EXPECT_NE(std::string::npos, text.find(part)) << "'" << part << "' is not in: " << text;
    }
  }
}

}  // namespace franka_sim::test
