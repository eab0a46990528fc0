// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <ros/console.h>
#include <tinyxml.h>

#include <cmath>
#include <locale>
#include <sstream>
#include <string>

#include "pid_reconfigure.h"

namespace control_toolbox {

namespace {

/// Default namespace of dynamic reconfigure.
constexpr const char* kDefaultNamespace = "pid";

/// Reads an optional parameter into `value`, which keeps its default if it is not set. @return
/// false, with an error in the log, if it has the wrong type.
template <class Value>
bool readOptional(const ros::NodeHandle& node, const std::string& name, const char* type,
                  Value& value) {
  if (!node.hasParam(name) || node.getParam(name, value)) {
    return true;
  }
  ROS_ERROR("The PID parameter %s is not %s. Correct it where the parameters are loaded.",
            node.resolveName(name).c_str(), type);
  return false;
}

bool readNumber(const ros::NodeHandle& node, const std::string& name, double& value) {
  return readOptional(node, name, "a number", value);
}

/// 0 without a number, as in the original, with a decimal point in every locale.
double numberOf(const TiXmlElement& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  std::istringstream stream(text != nullptr ? text : "");
  stream.imbue(std::locale::classic());
  double number = 0.0;
  stream >> number;
  return number;
}

bool truthOf(const TiXmlElement& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  return text != nullptr && (std::string(text) == "true" || numberOf(element, attribute) != 0.0);
}

}  // namespace

void Pid::initPid(double p, double i, double d, double i_max, double i_min,
                  const ros::NodeHandle& node) {
  initPid(p, i, d, i_max, i_min, false, node);
}

void Pid::initPid(double p, double i, double d, double i_max, double i_min, bool antiwindup,
                  const ros::NodeHandle& /* node */) {
  initPid(p, i, d, i_max, i_min, antiwindup);
  ros::NodeHandle reconfigure_node(kDefaultNamespace);
  initDynamicReconfig(reconfigure_node);
}

bool Pid::initParam(const std::string& prefix, bool quiet) {
  return init(ros::NodeHandle(prefix), quiet);
}

bool Pid::init(const ros::NodeHandle& node, bool quiet) {
  if (!node.hasParam("p")) {
    if (!quiet) {
      ROS_ERROR("No p gain specified for pid.  Namespace: %s", node.getNamespace().c_str());
    }
    return false;
  }
  Gains gains;
  double clamp = 0.0;
  bool publish_state = false;
  if (!readNumber(node, "p", gains.p_gain_) || !readNumber(node, "i", gains.i_gain_) ||
      !readNumber(node, "d", gains.d_gain_) || !readNumber(node, "i_clamp", clamp)) {
    return false;
  }
  gains.i_max_ = std::abs(clamp);
  gains.i_min_ = -std::abs(clamp);
  if (!readNumber(node, "i_clamp_max", gains.i_max_) ||
      !readNumber(node, "i_clamp_min", gains.i_min_) ||
      !readOptional(node, "antiwindup", "true or false", gains.antiwindup_) ||
      !readOptional(node, "publish_state", "true or false", publish_state)) {
    return false;
  }
  gains.i_max_ = std::abs(gains.i_max_);
  gains.i_min_ = -std::abs(gains.i_min_);

  if (publish_state) {
    state_publisher_ = std::make_shared<realtime_tools::RealtimePublisher<control_msgs::PidState>>(
        node, "state", 1);
  }
  setGains(gains);
  reset();
  ros::NodeHandle reconfigure_node(node);
  initDynamicReconfig(reconfigure_node);
  return true;
}

bool Pid::initXml(TiXmlElement* config) {
  if (config == nullptr) {
    ROS_ERROR("No XML element was given to read the gains of a PID controller from.");
    return false;
  }
  const double clamp = std::abs(numberOf(*config, "iClamp"));
  setGains(numberOf(*config, "p"), numberOf(*config, "i"), numberOf(*config, "d"), clamp, -clamp,
           truthOf(*config, "antiwindup"));
  reset();
  ros::NodeHandle reconfigure_node(kDefaultNamespace);
  initDynamicReconfig(reconfigure_node);
  return true;
}

}  // namespace control_toolbox
