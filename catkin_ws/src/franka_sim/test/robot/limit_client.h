// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_core/rotations.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "limit_way.h"

namespace franka_sim::test {

using Vector7 = Eigen::Matrix<double, 7, 1>;

/// Where a client uses 32 bit floats.
enum class Floats {
  kNone,
  kReads,  ///< it takes its history from the states, which carry floats (protocol 10)
  kSends   ///< it computes its commands in floats
};

/// The client's plan: these derivatives after each tick, of seven coordinates (joints, or
/// translation, rotation vector and elbow), integrated from jerk by backward Euler.
struct Intended {
  Vector7 velocity, acceleration, jerk;
};
using Plan = std::vector<Intended>;

inline Plan differentiated(const std::vector<Vector7>& velocities) {
  Plan plan;
  Intended last{Vector7::Zero(), Vector7::Zero(), Vector7::Zero()};
  for (const Vector7& velocity : velocities) {
    const Vector7 acceleration = (velocity - last.velocity) / kTick;
    last = {velocity, acceleration, (acceleration - last.acceleration) / kTick};
    plan.push_back(last);
  }
  return plan;
}

inline Plan planOfJoint(std::size_t joint, const Profile& profile) {
  Plan plan;
  Intended next{Vector7::Zero(), Vector7::Zero(), Vector7::Zero()};
  const Vector7 unit = Vector7::Unit(static_cast<int>(joint));
  for (const double jerk : profile) {
    next.jerk = jerk * unit;
    next.acceleration += next.jerk * kTick;
    next.velocity += next.acceleration * kTick;
    plan.push_back(next);
  }
  return plan;
}

inline Vector7 velocityBetween(const Waypoint& from, const Waypoint& to) {
  const Eigen::Matrix3d turn = to.rotation * from.rotation.transpose();
  Vector7 velocity;
  velocity << to.position - from.position, franka_core::vectorOf(turn), to.q3 - from.q3;
  return velocity / kTick;
}

inline Plan planOfWay(const Way& way, const Profile& profile) {
  const std::vector<Waypoint> points = waypoints(way, profile);
  std::vector<Vector7> velocities;
  for (std::size_t i = 1; i < points.size(); i++) {
    velocities.push_back(velocityBetween(points[i - 1], points[i]));
  }
  return differentiated(velocities);
}

/// Sends a plan through a motion generator, tick by tick, then stands still and finishes. A client
/// that reads floats follows the plan in the derivative under test: rounding would otherwise
/// accumulate.
class LimitClient {
 public:
  LimitClient(Plan plan, Derivative what, Floats floats)
      : plan_(std::move(plan)), what_(what), floats_(floats) {}
  virtual ~LimitClient() = default;

  RobotCommand next(const franka_core::RobotState& state) {
    if (tick_ == 0) {
      begin(state);
    } else {
      if (floats_ == Floats::kReads) {
        read(state);
      }
      const Vector7 velocity = nextVelocity();
      advance(velocity);
    }
    RobotCommand command = makeCommand();
    measure(sentVelocity(command));
    command.motion_generation_finished = tick_ > plan_.size() + kStillTicks;
    tick_++;
    return command;
  }

  /// The largest value of a derivative in the sent commands, as the robot sees it: differences of
  /// the commands, or to the floats in the states.
  template <typename Size>
  double peak(Size size) const {
    double largest = 0.0;
    for (const Intended& sent : sent_) {
      largest = std::max(largest, size(what_ == Derivative::kVelocity       ? sent.velocity
                                       : what_ == Derivative::kAcceleration ? sent.acceleration
                                                                            : sent.jerk));
    }
    return largest;
  }
  const std::vector<Intended>& sent() const { return sent_; }

 protected:
  static constexpr std::size_t kStillTicks = 20;
  static constexpr double kSlowing = 0.8;

  virtual void begin(const franka_core::RobotState& state) = 0;
  /// Takes the history from a state's floats.
  virtual void read(const franka_core::RobotState& state) = 0;
  virtual void advance(const Vector7& velocity) = 0;
  virtual RobotCommand makeCommand() = 0;
  /// Difference between a command and the history.
  virtual Vector7 sentVelocity(const RobotCommand& command) = 0;

  template <std::size_t kSize>
  std::array<double, kSize> rounded(std::array<double, kSize> values, Floats when) const {
    if (floats_ == when) {
      std::transform(values.begin(), values.end(), values.begin(), asFloat);
    }
    return values;
  }

  Intended history_{Vector7::Zero(), Vector7::Zero(), Vector7::Zero()};

 private:
  Vector7 nextVelocity() const {
    if (tick_ > plan_.size()) {
      return kSlowing * history_.velocity;  // only the rounding error remains
    }
    const Intended& next = plan_[tick_ - 1];
    if (what_ == Derivative::kVelocity || floats_ != Floats::kReads) {
      return next.velocity;
    }
    const Vector7 acceleration = what_ == Derivative::kAcceleration
                                     ? next.acceleration
                                     : Vector7(history_.acceleration + next.jerk * kTick);
    return history_.velocity + acceleration * kTick;
  }

  void measure(const Vector7& velocity) {
    const Vector7 acceleration = (velocity - history_.velocity) / kTick;
    history_ = {velocity, acceleration, (acceleration - history_.acceleration) / kTick};
    sent_.push_back(history_);
  }

  Plan plan_;
  Derivative what_;
  Floats floats_;
  std::size_t tick_{0};
  std::vector<Intended> sent_;
};

class JointClient : public LimitClient {
 public:
  JointClient(MotionGeneratorMode mode, std::size_t joint, const Profile& profile, Derivative what,
              Floats floats)
      : LimitClient(planOfJoint(joint, profile), what, floats), mode_(mode) {}

 private:
  using Vector = Eigen::Map<const Vector7>;

  void begin(const franka_core::RobotState& state) override {
    q_ = before_ = rounded(state.q_d, Floats::kReads);
  }
  void read(const franka_core::RobotState& state) override {
    begin(state);
    history_.velocity = Vector(rounded(state.dq_d, Floats::kReads).data());
    history_.acceleration = Vector(rounded(state.ddq_d, Floats::kReads).data());
  }
  void advance(const Vector7& velocity) override {
    Eigen::Map<Vector7>(dq_.data()) = velocity;
    Eigen::Map<Vector7>(q_.data()) += velocity * kTick;
  }
  RobotCommand makeCommand() override {
    return mode_ == MotionGeneratorMode::kJointPosition
               ? jointPositions(rounded(q_, Floats::kSends))
               : jointVelocities(rounded(dq_, Floats::kSends));
  }
  Vector7 sentVelocity(const RobotCommand& command) override {
    if (mode_ == MotionGeneratorMode::kJointVelocity) {
      return Vector(command.dq_c.data());
    }
    const Vector7 velocity = (Vector(command.q_c.data()) - Vector(before_.data())) / kTick;
    before_ = command.q_c;
    return velocity;
  }

  MotionGeneratorMode mode_;
  Joints q_{}, dq_{}, before_{};
};

class CartesianClient : public LimitClient {
 public:
  CartesianClient(MotionGeneratorMode mode, const Way& way, const Profile& profile, Derivative what,
                  Floats floats)
      : LimitClient(planOfWay(way, profile), what, floats), mode_(mode) {}

 private:
  void begin(const franka_core::RobotState& state) override {
    const Transform pose = rounded(state.O_T_EE_c, Floats::kReads);
    const Eigen::Map<const Eigen::Matrix4d> O_T_EE(pose.data());
    now_ = before_ = {O_T_EE.topRightCorner<3, 1>(), O_T_EE.topLeftCorner<3, 3>(),
                      rounded(state.elbow_c, Floats::kReads)[0]};
    sign_ = state.elbow_c[1];
  }
  void read(const franka_core::RobotState& state) override {
    begin(state);
    history_.velocity = seen(state.O_dP_EE_c, state.delbow_c);
    history_.acceleration = seen(state.O_ddP_EE_c, state.ddelbow_c);
  }
  void advance(const Vector7& velocity) override {
    velocity_ = velocity;
    now_.position += velocity.head<3>() * kTick;
    now_.rotation = franka_core::rotationFrom(velocity.segment<3>(3) * kTick) * now_.rotation;
    now_.q3 += velocity[6] * kTick;
  }
  RobotCommand makeCommand() override {
    if (mode_ == MotionGeneratorMode::kCartesianVelocity) {
      Twist O_dP_EE;
      Eigen::Map<Eigen::Matrix<double, 6, 1>>(O_dP_EE.data()) = velocity_.head<6>();
      return withElbow(twist(rounded(O_dP_EE, Floats::kSends)), now_.q3, sign_);
    }
    Transform O_T_EE = franka_core::kIdentityTransform;
    Eigen::Map<Eigen::Matrix4d> matrix(O_T_EE.data());
    matrix.topLeftCorner<3, 3>() = now_.rotation;
    matrix.topRightCorner<3, 1>() = now_.position;
    return withElbow(pose(O_T_EE), now_.q3, sign_);
  }
  Vector7 sentVelocity(const RobotCommand& command) override {
    Vector7 velocity = velocityBetween(before_, now_);
    before_ = now_;
    if (mode_ == MotionGeneratorMode::kCartesianVelocity) {
      velocity.head<6>() = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(command.O_dP_EE_c.data());
    }
    return velocity;
  }

  Vector7 seen(const Twist& twist, const std::array<double, 2>& elbow) const {
    Vector7 values;
    values << Eigen::Map<const Eigen::Matrix<double, 6, 1>>(rounded(twist, Floats::kReads).data()),
        rounded(elbow, Floats::kReads)[0];
    return values;
  }

  MotionGeneratorMode mode_;
  Waypoint now_{}, before_{};
  double sign_{0.0};
  Vector7 velocity_{Vector7::Zero()};
};

}  // namespace franka_sim::test
