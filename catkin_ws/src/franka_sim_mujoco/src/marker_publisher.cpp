// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "marker_publisher.h"

#include <franka_sim/physics/pose_conversions.h>
#include <franka_sim/physics/world_models.h>
#include <ros/console.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "sim_messages.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

using franka_sim::Shape;
using visualization_msgs::Marker;

constexpr std::chrono::milliseconds kMarkerInterval{50};
constexpr double kMinShownMove = 1e-4;  ///< that is shown [m] (chosen here)
constexpr double kMinShownTurn = 1e-3;  ///< of a quaternion's entry (chosen here)

int typeOf(Shape::Kind kind) {
  switch (kind) {
    case Shape::Kind::kPlane:
    case Shape::Kind::kBox:
      return Marker::CUBE;
    case Shape::Kind::kSphere:
    case Shape::Kind::kEllipsoid:
      return Marker::SPHERE;
    case Shape::Kind::kCylinder:
    case Shape::Kind::kCapsule:
      return Marker::CYLINDER;
    case Shape::Kind::kMesh:
      break;
  }
  return Marker::TRIANGLE_LIST;
}

/// Edges of the box around a shape, which rviz requires [m]; 1 for a mesh.
std::array<double, 3> edgesOf(const Shape& shape) {
  const auto& s = shape.size;
  switch (shape.kind) {
    case Shape::Kind::kPlane:
      return {2 * s[0], 2 * s[1], 0.001};
    case Shape::Kind::kBox:
    case Shape::Kind::kEllipsoid:
      return {2 * s[0], 2 * s[1], 2 * s[2]};
    case Shape::Kind::kSphere:
      return {2 * s[0], 2 * s[0], 2 * s[0]};
    case Shape::Kind::kCylinder:
    case Shape::Kind::kCapsule:
      return {2 * s[0], 2 * s[0], 2 * s[1]};
    case Shape::Kind::kMesh:
      break;
  }
  return {1, 1, 1};
}

void addTriangles(const franka_sim::ShapeMesh& mesh, Marker& marker) {
  for (const std::uint32_t vertex : mesh.faces) {
    geometry_msgs::Point point;
    point.x = mesh.vertices[3 * vertex];
    point.y = mesh.vertices[3 * vertex + 1];
    point.z = mesh.vertices[3 * vertex + 2];
    marker.points.push_back(point);
  }
}

/// Adds one shape, or the three parts of a capsule.
class MarkerWriter {
 public:
  MarkerWriter(const franka_sim::WorldShapes& shapes, const std::vector<franka_sim::Pose>& poses)
      : shapes_(shapes), poses_(poses) {}

  void add(const Shape& shape, visualization_msgs::MarkerArray& message) const {
    addPart(shape, 0.0, message);
    if (shape.kind == Shape::Kind::kCapsule) {
      Shape end = shape;
      end.kind = Shape::Kind::kSphere;
      addPart(end, shape.size[1], message);
      addPart(end, -shape.size[1], message);
    }
  }

 private:
  /// @param along z of the shape [m]
  void addPart(const Shape& shape, double along, visualization_msgs::MarkerArray& message) const {
    Marker marker;
    marker.header.frame_id = "world";  // its time is 0: rviz takes the latest transform
    marker.ns = shapes_.bodies[shape.body];
    marker.id = static_cast<int>(message.markers.size());
    marker.type = typeOf(shape.kind);
    marker.pose =
        toMessage(franka_sim::toPose(toIsometry(poses_[shape.body]) * toIsometry(shape.pose) *
                                     Eigen::Translation3d(0, 0, along)));
    marker.scale = toVector(edgesOf(shape));
    marker.color.r = shape.color[0];
    marker.color.g = shape.color[1];
    marker.color.b = shape.color[2];
    marker.color.a = shape.color[3];
    if (shape.kind == Shape::Kind::kMesh) {
      addTriangles(shapes_.meshes[shape.mesh], marker);
    }
    message.markers.push_back(marker);
  }

  const franka_sim::WorldShapes& shapes_;
  const std::vector<franka_sim::Pose>& poses_;
};

bool isNear(const franka_sim::Pose& one, const franka_sim::Pose& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(one.position[i] - other.position[i]) > kMinShownMove) {
      return false;
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::abs(one.orientation[i] - other.orientation[i]) > kMinShownTurn) {
      return false;
    }
  }
  return true;
}

/// Bodies of robots.
std::set<std::string> linksOfRobots(const franka_sim::World& world) {
  std::set<std::string> names, links;
  for (const std::string& robot : world.robots()) {
    names.insert(robot);
  }
  for (const franka_sim::WorldModel& model : models(world)) {
    if (names.count(model.name) > 0) {
      links.insert(model.links.begin(), model.links.end());
    }
  }
  return links;
}

}  // namespace

visualization_msgs::MarkerArray markersOf(const franka_sim::WorldShapes& shapes,
                                          const std::vector<franka_sim::Pose>& poses) {
  visualization_msgs::MarkerArray message;
  Marker none;
  none.header.frame_id = "world";
  none.action = Marker::DELETEALL;
  message.markers.push_back(none);
  const MarkerWriter writer(shapes, poses);
  for (const Shape& shape : shapes.shapes) {
    const bool endless = shape.size[0] <= 0.0 || shape.size[1] <= 0.0;
    if (shape.kind != Shape::Kind::kPlane || !endless) {
      writer.add(shape, message);
    }
  }
  return message;
}

MarkerPublisher::MarkerPublisher(ros::NodeHandle node, Simulation& simulation)
    : simulation_(simulation),
      publisher_(node.advertise<visualization_msgs::MarkerArray>("markers", 1, true)) {
  thread_ = std::thread([this] { loop(); });
}

MarkerPublisher::~MarkerPublisher() {
  stop_ = true;
  thread_.join();
}

void MarkerPublisher::loop() {
  while (!stop_) {
    std::this_thread::sleep_for(kMarkerInterval);
    if (publisher_.getNumSubscribers() == 0) {
      drawn_ = false;
      continue;
    }
    try {
      publish();
    } catch (const std::exception& error) {
      if (!stop_) {
        ROS_WARN_THROTTLE_NAMED(10.0, "franka_sim_mujoco", "No markers are published: %s",
                                error.what());
      }
    }
  }
}

void MarkerPublisher::publish() {
  std::function<franka_sim::WorldShapes()> read;
  std::set<std::string> robots;
  std::vector<franka_sim::Pose> poses;
  simulation_.withWorld([&](franka_sim::World& world) {
    if (!drawn_ || world.generation() != generation_) {
      generation_ = world.generation();
      read = franka_sim::shapesOf(world);
      robots = linksOfRobots(world);
    }
    poses = framePoses(world);
  });
  if (read) {
    drawn_ = false;
    objects_ = read();
    auto& shapes = objects_.shapes;
    const auto is_robots = [&](const Shape& shape) {
      return robots.count(objects_.bodies[shape.body]) > 0;
    };
    shapes.erase(std::remove_if(shapes.begin(), shapes.end(), is_robots), shapes.end());
    drawn_ = true;
  } else if (!hasMoved(poses)) {
    return;
  }
  published_ = poses;
  publisher_.publish(markersOf(objects_, poses));
}

bool MarkerPublisher::hasMoved(const std::vector<franka_sim::Pose>& poses) const {
  return std::any_of(objects_.shapes.begin(), objects_.shapes.end(), [&](const Shape& shape) {
    return !isNear(poses[shape.body], published_[shape.body]);
  });
}

}  // namespace franka_sim_mujoco
