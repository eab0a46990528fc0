// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "param_reader.h"

#include <franka_core/numbers.h>
#include <ros/names.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cmath>
#include <sstream>

namespace franka_sim_mujoco {

namespace {

using XmlRpc::XmlRpcValue;

std::string describe(const XmlRpcValue& value) {
  std::ostringstream text;
  value.write(text);
  return text.str();
}

[[noreturn]] void refuse(const ros::NodeHandle& node, const std::string& name,
                         const std::string& expected, const std::string& found) {
  throw std::invalid_argument("The parameter " + node.resolveName(name) + " must be " + expected +
                              " but is " + found + ".");
}

/// False for a name that ROS cannot have: an arm or a joint may have a hyphen.
bool get(const ros::NodeHandle& node, const std::string& name, XmlRpcValue& value) {
  std::string why;
  return ros::names::validate(name, why) && node.getParam(name, value);
}

bool toNumber(const XmlRpcValue& value, double& number) {
  XmlRpcValue copy(value);
  if (value.getType() == XmlRpcValue::TypeInt) {
    number = static_cast<int>(copy);
  } else if (value.getType() == XmlRpcValue::TypeDouble) {
    number = static_cast<double>(copy);
  } else {
    return false;
  }
  return std::isfinite(number);
}

bool listToNumbers(const XmlRpcValue& list, std::vector<double>& numbers) {
  for (int i = 0; i < list.size(); ++i) {
    double number;
    if (!toNumber(list[i], number)) {
      return false;
    }
    numbers.push_back(number);
  }
  return true;
}

bool stringToNumbers(const std::string& text, std::vector<double>& numbers) {
  std::istringstream words(text);
  std::string word;
  while (words >> word) {
    const std::optional<double> number = franka_core::readNumber(word);
    if (!number) {
      return false;
    }
    numbers.push_back(*number);
  }
  return true;
}

template <typename T>
std::optional<T> readTyped(const ros::NodeHandle& node, const std::string& name,
                           XmlRpcValue::Type type, const char* expected) {
  XmlRpcValue value;
  if (!get(node, name, value)) {
    return std::nullopt;
  }
  if (value.getType() != type) {
    refuse(node, name, expected, describe(value));
  }
  return static_cast<T>(value);
}

}  // namespace

std::optional<std::vector<double>> readNumbers(const ros::NodeHandle& node, const std::string& name,
                                               std::size_t count) {
  XmlRpcValue value;
  if (!get(node, name, value)) {
    return std::nullopt;
  }
  const std::string expected =
      std::to_string(count) + " finite numbers (a list, or a text with spaces between them)";
  std::vector<double> numbers;
  bool readable = false;
  if (value.getType() == XmlRpcValue::TypeArray) {
    readable = listToNumbers(value, numbers);
  } else if (value.getType() == XmlRpcValue::TypeString) {
    readable = stringToNumbers(static_cast<std::string>(value), numbers);
  }
  if (!readable) {
    refuse(node, name, expected, describe(value));
  }
  if (numbers.size() != count) {
    refuse(node, name, expected, std::to_string(numbers.size()) + ": " + describe(value));
  }
  return numbers;
}

std::optional<double> readNumber(const ros::NodeHandle& node, const std::string& name) {
  XmlRpcValue value;
  if (!get(node, name, value)) {
    return std::nullopt;
  }
  double number;
  if (!toNumber(value, number)) {
    refuse(node, name, "a finite number", describe(value));
  }
  return number;
}

std::optional<std::string> readString(const ros::NodeHandle& node, const std::string& name) {
  return readTyped<std::string>(node, name, XmlRpcValue::TypeString, "a text");
}

std::optional<bool> readBool(const ros::NodeHandle& node, const std::string& name) {
  return readTyped<bool>(node, name, XmlRpcValue::TypeBoolean, "true or false");
}

}  // namespace franka_sim_mujoco
