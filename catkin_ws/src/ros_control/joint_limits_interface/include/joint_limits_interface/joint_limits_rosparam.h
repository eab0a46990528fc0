// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <joint_limits_interface/joint_limits.h>
#include <ros/console.h>
#include <ros/names.h>
#include <ros/node_handle.h>

#include <initializer_list>
#include <string>

namespace joint_limits_interface {
namespace internal {

/// A parameter and its destination.
struct LimitParam {
  const char* name;
  double* value;
};

/// Reads a parameter; a value of a wrong type is ignored with a warning.
template <class T>
bool readLimit(const ros::NodeHandle& nh, const std::string& name, T& value, const char* kind) {
  if (!nh.hasParam(name)) {
    return false;
  }
  if (nh.getParam(name, value)) {
    return true;
  }
  ROS_WARN_STREAM("Parameter '" << nh.resolveName(name) << "' must be " << kind
                                << ". It is not, so it is ignored.");
  return false;
}

/// Reads all parameters or none. @returns false, without changes, if one of them is missing.
inline bool readAll(const ros::NodeHandle& nh, std::initializer_list<LimitParam> params) {
  for (const LimitParam& param : params) {
    double value = 0.0;
    if (!readLimit(nh, param.name, value, "a number")) {
      return false;
    }
  }
  for (const LimitParam& param : params) {
    nh.getParam(param.name, *param.value);
  }
  return true;
}

/// One kind of limits: a flag `has_<kind>_limits` and its values.
inline void readKind(const ros::NodeHandle& nh, const std::string& kind, bool& has_limits,
                     std::initializer_list<LimitParam> params) {
  const std::string flag_name = "has_" + kind + "_limits";
  bool flag = false;
  if (!readLimit(nh, flag_name, flag, "true or false")) {
    return;
  }
  if (!flag) {
    has_limits = false;
  } else if (readAll(nh, params)) {
    has_limits = true;
  } else {
    ROS_WARN_STREAM("Parameter '" << nh.resolveName(flag_name)
                                  << "' is true, but values that belong to it are missing: the "
                                  << kind << " limits stay as they were.");
  }
}

/// Opens the namespace `joint_limits/<joint>`. @returns false if there is none.
inline bool openLimits(const std::string& joint_name, const ros::NodeHandle& nh,
                       ros::NodeHandle& limits_nh) {
  const std::string limits_namespace = "joint_limits/" + joint_name;
  try {
    if (!nh.hasParam(limits_namespace)) {
      ROS_DEBUG_STREAM("No limits of joint '" << joint_name << "' on the parameter server "
                                              << "(namespace: '" << nh.getNamespace() << "/"
                                              << limits_namespace << "').");
      return false;
    }
    limits_nh = ros::NodeHandle(nh, limits_namespace);
    return true;
  } catch (const ros::InvalidNameException& error) {
    ROS_ERROR_STREAM("Cannot look for limits of joint '" << joint_name << "' on the parameter "
                                                         << "server: " << error.what());
    return false;
  }
}

}  // namespace internal

/// Reads limits from the parameters `joint_limits/<joint_name>/...` of `nh`. Each kind (position,
/// velocity, acceleration, jerk, effort) without the flag `has_<kind>_limits` is unchanged, so
/// parameters can override a URDF in part. Accesses the parameter server. Not real-time safe.
/// @returns false, with `limits` unchanged, without such parameters.
inline bool getJointLimits(const std::string& joint_name, const ros::NodeHandle& nh,
                           JointLimits& limits) {
  ros::NodeHandle limits_nh;
  if (!internal::openLimits(joint_name, nh, limits_nh)) {
    return false;
  }
  internal::readKind(
      limits_nh, "position", limits.has_position_limits,
      {{"min_position", &limits.min_position}, {"max_position", &limits.max_position}});
  internal::readKind(limits_nh, "velocity", limits.has_velocity_limits,
                     {{"max_velocity", &limits.max_velocity}});
  internal::readKind(limits_nh, "acceleration", limits.has_acceleration_limits,
                     {{"max_acceleration", &limits.max_acceleration}});
  internal::readKind(limits_nh, "jerk", limits.has_jerk_limits, {{"max_jerk", &limits.max_jerk}});
  internal::readKind(limits_nh, "effort", limits.has_effort_limits,
                     {{"max_effort", &limits.max_effort}});

  // Only a joint explicitly without position limits can be continuous.
  bool has_position_limits = true;
  limits_nh.getParam("has_position_limits", has_position_limits);
  if (!has_position_limits) {
    internal::readLimit(limits_nh, "angle_wraparound", limits.angle_wraparound, "true or false");
  }
  return true;
}

/// Reads soft limits from the parameters `joint_limits/<joint_name>/...` of `nh`: has_soft_limits
/// (true), k_position, k_velocity, soft_lower_limit and soft_upper_limit. Accesses the parameter
/// server. Not real-time safe. @returns false, with `soft_limits` unchanged, unless all of them are
/// set.
inline bool getSoftJointLimits(const std::string& joint_name, const ros::NodeHandle& nh,
                               SoftJointLimits& soft_limits) {
  ros::NodeHandle limits_nh;
  if (!internal::openLimits(joint_name, nh, limits_nh)) {
    return false;
  }
  bool has_soft_limits = false;
  if (!internal::readLimit(limits_nh, "has_soft_limits", has_soft_limits, "true or false") ||
      !has_soft_limits) {
    return false;
  }
  return internal::readAll(limits_nh, {{"k_position", &soft_limits.k_position},
                                       {"k_velocity", &soft_limits.k_velocity},
                                       {"soft_lower_limit", &soft_limits.min_position},
                                       {"soft_upper_limit", &soft_limits.max_position}});
}

}  // namespace joint_limits_interface
