// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/sdf/camera_sensor.h"

#include <franka_core/numbers.h>
#include <franka_sim/physics/renderer.h>

#include <cstdint>
#include <optional>
#include <stdexcept>

#include "physics/engine/rotations.h"
#include "physics/mjcf/xml_util.h"
#include "physics/sdf/sdf_frames.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;

int readEdge(const XMLElement& image, const char* name, int fallback, const std::string& camera) {
  const double edge = childNumbers(image, name, {static_cast<double>(fallback)}, camera)[0];
  constexpr int kMax = Renderer::kMaxPictureSide;
  const std::optional<std::int64_t> pixels = franka_core::wholeNumber(edge, 1, kMax);
  if (!pixels) {
    throw std::runtime_error(camera + ": the " + name + " of its image is " + toText({edge}) +
                             "; it must be a whole number of pixels from 1 to " +
                             std::to_string(kMax) + ".");
  }
  return static_cast<int>(*pixels);
}

CameraSensor readCamera(const XMLElement& sensor, const XMLElement& camera,
                        const Eigen::Isometry3d& pose, const std::string& name) {
  const std::string where = "Camera '" + name + "'";
  CameraSensor result;
  result.name = name;
  result.pose = pose * writtenPose(camera, where);
  result.horizontal_view = childNumbers(camera, "horizontal_fov", {1.047}, where)[0];
  if (!(result.horizontal_view > 0 && result.horizontal_view < 180 * kDegree)) {
    throw std::runtime_error(where + ": its horizontal_fov is " + toText({result.horizontal_view}) +
                             "; it must be above 0 and below pi.");
  }
  if (const XMLElement* image = camera.FirstChildElement("image")) {
    result.width = readEdge(*image, "width", 320, where);
    result.height = readEdge(*image, "height", 240, where);
  }
  const double rate = childNumbers(sensor, "update_rate", {0}, where)[0];
  result.rate = rate > 0 ? rate : result.rate;
  return result;
}

}  // namespace

std::vector<CameraSensor> readCameras(const XMLElement& sensor, const Eigen::Isometry3d& pose,
                                      const std::string& name, std::set<std::string>* notes) {
  std::vector<CameraSensor> cameras;
  const bool several = optional(sensor, "type") == "multicamera";
  for (auto* camera = sensor.FirstChildElement("camera"); camera != nullptr;
       camera = camera->NextSiblingElement("camera")) {
    const std::string own = several ? name + "::" + optional(*camera, "name") : name;
    cameras.push_back(readCamera(sensor, *camera, pose, own));
    noteUnknown(*camera, "camera '" + own + "'",
                {"pose", "horizontal_fov", "image", "clip", "save", "depth_camera",
                 "visibility_mask", "optical_frame_id", "camera_info_topic", "trigger_topic"},
                notes);
    if (!several) {
      break;
    }
  }
  if (cameras.empty()) {
    notes->insert("sensor '" + name + "' of type " + optional(sensor, "type"));
  }
  for (auto* plugin = sensor.FirstChildElement("plugin"); plugin != nullptr;
       plugin = plugin->NextSiblingElement("plugin")) {
    const std::string title = "plugin '" + optional(*plugin, "name") + "' (" +
                              optional(*plugin, "filename") + ") of sensor '" + name + "'";
    notes->insert(cameras.empty() ? title : title + " (its pictures have topics of their own)");
  }
  return cameras;
}

void writeCamera(const CameraSensor& camera, const Eigen::Isometry3d& link_pose, XMLElement* body) {
  XMLElement* e = append(body, "camera");
  // SDF's cameras look along x with z up, MuJoCo's along -z with y up.
  Eigen::Matrix3d turn;
  turn << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  Eigen::Isometry3d looking = link_pose * camera.pose;
  looking.linear() = looking.linear() * turn;
  setPose(e, looking);
  const double ratio = static_cast<double>(camera.height) / camera.width;
  const double vertical = 2 * std::atan(std::tan(camera.horizontal_view / 2) * ratio);
  e->SetAttribute("name", camera.name.c_str());
  e->SetAttribute("fovy", toText({vertical / kDegree}).c_str());
  e->SetAttribute("user", toText({static_cast<double>(camera.width),
                                  static_cast<double>(camera.height), camera.rate})
                              .c_str());
}

}  // namespace franka_sim::physics
