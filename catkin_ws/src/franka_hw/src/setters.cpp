// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka_core/typed_transform.h>
#include <franka_hw/setters.h>
#include <ros/console.h>

#include <string>

namespace franka_hw {

namespace {

template <typename Matrix>
void makeExact(const std::string& name, Matrix& matrix) {
  const franka_core::TypedTransform typed = franka_core::readTypedTransform(arrayOf<16>(matrix));
  if (!typed.fault.empty()) {
    throw franka::CommandException(name +
                                   " was refused: invalid argument! It is not a column-major 4x4 "
                                   "transform: " +
                                   typed.fault + ".");
  }
  if (!typed.warning.empty()) {
    ROS_WARN_STREAM(name << ": " << typed.warning << ".");
  }
  std::copy(typed.matrix.begin(), typed.matrix.end(), matrix.begin());
}

}  // namespace

franka_msgs::SetEEFrame::Request checkedRequest(franka_msgs::SetEEFrame::Request request) {
  makeExact("NE_T_EE", request.NE_T_EE);
  return request;
}

franka_msgs::SetKFrame::Request checkedRequest(franka_msgs::SetKFrame::Request request) {
  makeExact("EE_T_K", request.EE_T_K);
  return request;
}

}  // namespace franka_hw
