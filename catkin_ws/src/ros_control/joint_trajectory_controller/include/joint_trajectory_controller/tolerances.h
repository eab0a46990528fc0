// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <control_msgs/FollowJointTrajectoryGoal.h>
#include <control_msgs/JointTolerance.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <cmath>
#include <ios>
#include <string>
#include <vector>

namespace joint_trajectory_controller {

/// The largest allowed error in each quantity of one joint ([rad] or [m] and derivatives); 0
/// disables the check.
template <class Scalar>
struct StateTolerances {
  StateTolerances(Scalar position_tolerance = Scalar(0), Scalar velocity_tolerance = Scalar(0),
                  Scalar acceleration_tolerance = Scalar(0))
      : position(position_tolerance),
        velocity(velocity_tolerance),
        acceleration(acceleration_tolerance) {}

  Scalar position;      ///< [rad] or [m]; 0: any
  Scalar velocity;      ///< of its derivative; 0: any
  Scalar acceleration;  ///< of the second derivative; 0: any
};

/// Tolerances of a controller: on the path, at the goal, and the time allowed after the end to meet
/// the latter [s].
template <class Scalar>
struct SegmentTolerances {
  SegmentTolerances(std::vector<double>::size_type size = 0)
      : state_tolerance(size), goal_state_tolerance(size) {}

  std::vector<StateTolerances<Scalar>> state_tolerance;
  std::vector<StateTolerances<Scalar>> goal_state_tolerance;
  Scalar goal_time_tolerance{0};  ///< [s]; 0: any
};

/// The same for one joint.
template <class Scalar>
struct SegmentTolerancesPerJoint {
  StateTolerances<Scalar> state_tolerance;
  StateTolerances<Scalar> goal_state_tolerance;
  Scalar goal_time_tolerance{0};  ///< [s]; 0: any
};

namespace internal {

/// NaN errors violate every tolerance that is set.
template <class Scalar>
bool isWithin(const std::vector<Scalar>& errors, std::size_t joint, Scalar tolerance) {
  return !(tolerance > 0) || joint >= errors.size() || std::abs(errors[joint]) <= tolerance;
}

}  // namespace internal

/// Whether the errors of joint `joint` in a state are within the tolerances. Real-time safe.
template <class State>
bool isWithinTolerance(const State& error, std::size_t joint,
                       const StateTolerances<typename State::Scalar>& tolerance) {
  return internal::isWithin(error.position, joint, tolerance.position) &&
         internal::isWithin(error.velocity, joint, tolerance.velocity) &&
         internal::isWithin(error.acceleration, joint, tolerance.acceleration);
}

/// Whether the error of a single joint is within the tolerances. Real-time safe. Exception:
/// `show_errors`, which logs a violation.
template <class State>
bool checkStateTolerancePerJoint(const State& state_error,
                                 const StateTolerances<typename State::Scalar>& state_tolerance,
                                 bool show_errors = false) {
  const bool within = isWithinTolerance(state_error, 0, state_tolerance);
  if (!within && show_errors) {
    ROS_ERROR_STREAM("A joint is outside its tolerances: position error "
                     << std::fixed
                     << (state_error.position.empty() ? 0.0 : double(state_error.position[0]))
                     << " of " << double(state_tolerance.position) << ".");
  }
  return within;
}

/// Whether the errors of all joints are within the tolerances; see checkStateTolerancePerJoint().
template <class State>
bool checkStateTolerance(
    const State& state_error,
    const std::vector<StateTolerances<typename State::Scalar>>& state_tolerance,
    bool show_errors = false) {
  for (std::size_t i = 0; i < state_tolerance.size(); ++i) {
    if (!isWithinTolerance(state_error, i, state_tolerance[i])) {
      if (show_errors) {
        ROS_ERROR_STREAM(
            "Joint " << i << " is outside its tolerances: position error " << std::fixed
                     << (i < state_error.position.size() ? double(state_error.position[i]) : 0.0)
                     << " of " << double(state_tolerance[i].position) << ".");
      }
      return false;
    }
  }
  return true;
}

/// Overrides tolerances with those of a message: positive values replace, negative ones disable the
/// check, 0 changes nothing.
template <class Scalar>
void updateStateTolerances(const control_msgs::JointTolerance& message,
                           StateTolerances<Scalar>& tolerances) {
  const auto override = [](double value, Scalar& tolerance) {
    if (value > 0.0) {
      tolerance = static_cast<Scalar>(value);
    } else if (value < 0.0) {
      tolerance = Scalar(0);
    }
  };
  override(message.position, tolerances.position);
  override(message.velocity, tolerances.velocity);
  override(message.acceleration, tolerances.acceleration);
}

/// Overrides a controller's tolerances with those of a goal. Names of other joints are ignored.
template <class Scalar>
void updateSegmentTolerances(const control_msgs::FollowJointTrajectoryGoal& goal,
                             const std::vector<std::string>& joint_names,
                             SegmentTolerances<Scalar>& tolerances) {
  const auto overrideAll = [&](const std::vector<control_msgs::JointTolerance>& messages,
                               std::vector<StateTolerances<Scalar>>& joints) {
    for (const control_msgs::JointTolerance& message : messages) {
      const auto found = std::find(joint_names.begin(), joint_names.end(), message.name);
      if (found != joint_names.end()) {
        updateStateTolerances(message, joints[std::size_t(found - joint_names.begin())]);
      }
    }
  };
  overrideAll(goal.path_tolerance, tolerances.state_tolerance);
  overrideAll(goal.goal_tolerance, tolerances.goal_state_tolerance);
  const double goal_time = goal.goal_time_tolerance.toSec();
  if (goal_time != 0.0) {
    tolerances.goal_time_tolerance = static_cast<Scalar>(std::max(goal_time, 0.0));
  }
}

/// Reads the tolerances of a controller from its namespace `constraints`:
/// `stopped_velocity_tolerance` (0.01; velocity of every joint at the goal), `goal_time` (0), and
/// for each joint `<joint>/trajectory` and `<joint>/goal` (0).
template <class Scalar>
SegmentTolerances<Scalar> getSegmentTolerances(const ros::NodeHandle& nh,
                                               const std::vector<std::string>& joint_names) {
  SegmentTolerances<Scalar> tolerances(joint_names.size());
  double stopped_velocity = 0.01;
  double goal_time = 0.0;
  nh.param("stopped_velocity_tolerance", stopped_velocity, stopped_velocity);
  nh.param("goal_time", goal_time, goal_time);
  tolerances.goal_time_tolerance = static_cast<Scalar>(goal_time);
  for (std::size_t i = 0; i < joint_names.size(); ++i) {
    double path = 0.0;
    double goal = 0.0;
    nh.param(joint_names[i] + "/trajectory", path, path);
    nh.param(joint_names[i] + "/goal", goal, goal);
    tolerances.state_tolerance[i].position = static_cast<Scalar>(path);
    tolerances.goal_state_tolerance[i].position = static_cast<Scalar>(goal);
    tolerances.goal_state_tolerance[i].velocity = static_cast<Scalar>(stopped_velocity);
  }
  return tolerances;
}

}  // namespace joint_trajectory_controller
