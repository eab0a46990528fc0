// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/sdf/sdf_frames.h"

#include <franka_core/rotations.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;

/// More references in a row than frames in any world mean a circle.
constexpr int kMaxDepth = 200;

bool isScope(const std::string& frame) {
  return frame.empty() || frame == "__model__" || frame == "world";
}

std::string frameOfPose(const XMLElement& element) {
  const XMLElement* pose = element.FirstChildElement("pose");
  return pose == nullptr ? std::string() : optional(*pose, "relative_to");
}

/// The reference frame of an element whose pose names none.
std::string defaultFrame(const XMLElement& element) {
  const std::string kind = element.Name();
  if (kind == "joint") {
    return childText(element, "child");
  }
  return kind == "frame" ? optional(element, "attached_to") : std::string();
}

/// Counts references that are being followed.
class Descent {
 public:
  Descent(int* depth, const std::string& title) : depth_(depth) {
    if (*depth_ >= kMaxDepth) {
      throw std::runtime_error(title + ": the poses of frames refer to each other in a circle.");
    }
    ++*depth_;
  }
  ~Descent() { --*depth_; }
  Descent(const Descent&) = delete;
  Descent& operator=(const Descent&) = delete;

 private:
  int* depth_;
};

}  // namespace

Eigen::Isometry3d writtenPose(const XMLElement& element, const std::string& where) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const XMLElement* pose = element.FirstChildElement("pose");
  if (pose == nullptr || pose->GetText() == nullptr) {
    return result;
  }
  const bool quaternion = optional(*pose, "rotation_format") == "quat_xyzw";
  const std::vector<double> n = toNumbers(pose->GetText(), where + ", <pose>");
  if (n.size() != (quaternion ? 7 : 6)) {
    throw std::runtime_error(where + ": <pose> needs " + (quaternion ? "7" : "6") +
                             " numbers and has " + std::to_string(n.size()) + ".");
  }
  result.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
  if (quaternion) {
    result.linear() = Eigen::Quaterniond(n[6], n[3], n[4], n[5]).normalized().matrix();
    return result;
  }
  const double unit = pose->BoolAttribute("degrees") ? M_PI / 180 : 1.0;
  result.linear() = franka_core::rotationFromRpy({unit * n[3], unit * n[4], unit * n[5]});
  return result;
}

bool isMerged(const XMLElement& model) {
  const auto* parent = model.Parent()->ToElement();
  return model.BoolAttribute("merge") && std::strcmp(parent->Name(), "model") == 0;
}

SdfFrames::SdfFrames(const XMLElement& scope, const std::string& title)
    : scope_(scope), title_(title) {
  for (const XMLElement* child = scope.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string kind = child->Name();
    if (kind != "link" && kind != "joint" && kind != "frame" && kind != "model") {
      continue;
    }
    const std::string name = required(*child, "name", title_);
    Frame frame{child, nullptr};
    if (kind == "model") {
      frame.model = std::make_unique<SdfFrames>(*child, title_);
    }
    if (!frames_.emplace(name, std::move(frame)).second) {
      throw std::runtime_error(title_ + ": two elements of one scope are called '" + name +
                               "'; names must differ.");
    }
  }
}

std::pair<std::string, std::string> SdfFrames::split(const std::string& name) const {
  const std::size_t at = frames_.count(name) > 0 ? std::string::npos : name.find("::");
  const std::string first = name.substr(0, at);
  for (auto own = frames_.begin(); frames_.count(first) == 0 && own != frames_.end(); ++own) {
    if (own->second.model != nullptr && isMerged(*own->second.element) &&
        own->second.model->frames_.count(first) > 0) {
      return {own->first, name};
    }
  }
  return {first, at == std::string::npos ? std::string() : name.substr(at + 2)};
}

const SdfFrames::Frame& SdfFrames::find(const std::string& name) const {
  const auto found = frames_.find(name);
  if (found == frames_.end()) {
    throw std::runtime_error(title_ + ": the frame or link '" + name + "' is not there.");
  }
  return found->second;
}

const SdfFrames& SdfFrames::model(const std::string& name) const {
  const Frame& frame = find(name);
  if (frame.model == nullptr) {
    throw std::runtime_error(title_ + ": '" + name + "' is not a model.");
  }
  return *frame.model;
}

Eigen::Isometry3d SdfFrames::pose(const std::string& frame) const {
  if (isScope(frame)) {
    return Eigen::Isometry3d::Identity();
  }
  const Descent descent(&depth_, title_);
  const auto [first, rest] = split(frame);
  const Frame& found = find(first);
  Eigen::Isometry3d result = poseOf(*found.element, defaultFrame(*found.element));
  if (found.model != nullptr) {
    // The pose of a model is that of its placement frame.
    const std::string placed = optional(*found.element, "placement_frame");
    result = placed.empty() ? result : result * found.model->pose(placed).inverse();
  }
  return rest.empty() ? result : result * model(first).pose(rest);
}

Eigen::Isometry3d SdfFrames::poseOf(const XMLElement& element, const std::string& frame) const {
  const std::string named = frameOfPose(element);
  return pose(named.empty() ? frame : named) *
         writtenPose(element, title_ + ": '" + optional(element, "name") + "'");
}

Eigen::Isometry3d SdfFrames::poseIn(const XMLElement& element, const std::string& frame) const {
  const std::string named = frameOfPose(element);
  if (named.empty() || named == frame) {
    return writtenPose(element, title_ + ": '" + optional(element, "name") + "'");
  }
  return pose(frame).inverse() * poseOf(element, frame);
}

std::string SdfFrames::linkOf(const std::string& frame) const {
  if (frame == "world") {
    return frame;
  }
  if (isScope(frame)) {
    return canonicalLink();
  }
  const Descent descent(&depth_, title_);
  const auto [first, rest] = split(frame);
  const Frame& found = find(first);
  if (found.model != nullptr) {
    return first + "::" + found.model->linkOf(rest);
  }
  return std::strcmp(found.element->Name(), "link") == 0 ? first
                                                         : linkOf(defaultFrame(*found.element));
}

std::string SdfFrames::canonicalLink() const {
  std::string link = optional(scope_, "canonical_link");
  if (!link.empty()) {
    return linkOf(link);
  }
  if (const XMLElement* first = scope_.FirstChildElement("link")) {
    return required(*first, "name", title_);
  }
  if (const XMLElement* inner = scope_.FirstChildElement("model")) {
    return linkOf(required(*inner, "name", title_));
  }
  return "world";
}

}  // namespace franka_sim::physics
