// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/serve/scene_text.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "serve/json_writer.h"

namespace franka_sim {

namespace {

/// Bytes as text (RFC 4648, section 4).
std::string toBase64(std::string_view bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; k++) {
      group = (group << 8) | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; k++) {
      text += k <= count ? kLetters[(group >> (18 - 6 * k)) & 63U] : '=';
    }
  }
  return text;
}

using fci::JsonWriter;
using fci::Reply;

constexpr std::size_t kMeshPart = 11700;  // [bytes]: 15600 characters of an answer's 16000

const char* nameOf(Shape::Kind kind) {
  constexpr std::array<const char*, 7> kNames{"plane",    "sphere", "capsule", "ellipsoid",
                                              "cylinder", "box",    "mesh"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string meshName(std::size_t index) { return "mesh" + std::to_string(index); }

// Single precision: 0.1 um at a distance of 1 m, and half as much text.
std::array<float, 7> numbersOf(const Pose& pose) {
  std::array<float, 7> numbers;
  const auto end = std::copy(pose.position.begin(), pose.position.end(), numbers.begin());
  std::copy(pose.orientation.begin(), pose.orientation.end(), end);
  return numbers;
}

void write(const Shape& shape, JsonWriter& json) {
  json.beginObject().member("body", shape.body).member("kind", nameOf(shape.kind));
  json.member("size", shape.size).member("pose", numbersOf(shape.pose));
  json.member("color", shape.color);
  json.member("mesh", shape.kind == Shape::Kind::kMesh ? meshName(shape.mesh) : "");
  json.endObject();
}

template <typename Number>
void append(const std::vector<Number>& numbers, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
}

// A thread inherits the priority of the ticks, with which this work must not compete.
void leavePriority() {
  const sched_param ordinary{};
  sched_setscheduler(0, SCHED_OTHER, &ordinary);
}

}  // namespace

SceneText::SceneText(World& world, Robots robots) : world_(world), robots_(std::move(robots)) {
  shapesOf(world);
}

SceneText::Content SceneText::contentOf(const WorldShapes& shapes) {
  Content content;
  JsonWriter json;
  json.beginObject().key("bodies").beginArray();
  for (const std::string& body : shapes.bodies) {
    json.beginObject().member("name", body).endObject();
  }
  json.endArray().key("shapes").beginArray();
  for (const Shape& shape : shapes.shapes) {
    write(shape, json);
  }
  content.bodies_and_shapes = json.endArray().text();
  for (const ShapeMesh& mesh : shapes.meshes) {
    Content::Mesh& added = content.meshes.emplace_back();
    added.vertices = mesh.vertices.size() / 3;
    added.faces = mesh.faces.size() / 3;
    append(mesh.vertices, &added.bytes);
    append(mesh.faces, &added.bytes);
  }
  return content;
}

// The shapes of the present world; null while they are being read.
const SceneText::Content* SceneText::content() {
  const auto reads = [this] {
    return reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
  };
  if (reading_.valid() && reads()) {
    return nullptr;
  }
  if (!reading_.valid() || generation_ != world_.generation()) {
    generation_ = world_.generation();
    reading_ = std::async(std::launch::async, [read = shapesOf(world_)] {
      leavePriority();
      return contentOf(read());
    });
    return nullptr;
  }
  return &reading_.get();
}

Reply SceneText::describe() {
  return Reply([this]() -> std::optional<std::string> {
    const Content* const read = content();
    if (read == nullptr) {
      return {};
    }
    JsonWriter robots;
    robots.beginArray();
    for (const SceneRobot& robot : robots_()) {
      robots.beginObject().member("arm_id", robot.arm_id).member("type", robot.type).endObject();
    }
    return read->bodies_and_shapes + ",\"robots\":" + robots.endArray().text() + "}";
  });
}

Reply SceneText::mesh(const std::string& name, std::size_t offset) {
  return Reply([this, name, offset]() -> std::optional<std::string> {
    const Content* const read = content();
    if (read == nullptr) {
      return {};
    }
    std::size_t index = 0;
    while (index < read->meshes.size() && meshName(index) != name) {
      index++;
    }
    if (index == read->meshes.size()) {
      throw std::invalid_argument("There is no mesh '" + name + "'; the line scene names them.");
    }
    const Content::Mesh& mesh = read->meshes[index];
    if (offset > mesh.bytes.size()) {
      throw std::invalid_argument("Mesh '" + name + "' has " + std::to_string(mesh.bytes.size()) +
                                  " bytes; " + std::to_string(offset) + " lies beyond them.");
    }
    const std::string part = mesh.bytes.substr(offset, kMeshPart);
    const std::size_t next = offset + part.size();
    JsonWriter json;
    json.beginObject().member("vertices", mesh.vertices).member("faces", mesh.faces);
    json.key("next");
    next < mesh.bytes.size() ? json.value(next) : json.null();
    return json.member("data", toBase64(part)).endObject().text();
  });
}

std::string SceneText::poses() const {
  JsonWriter json;
  json.beginArray();
  for (const Pose& pose : framePoses(world_)) {
    json.value(numbersOf(pose));
  }
  return json.endArray().text();
}

}  // namespace franka_sim
