// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_shapes.h>
#include <franka_sim/serve/reply.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <string>
#include <vector>

namespace franka_sim {

/// A robot, as programs that draw the world need it.
struct SceneRobot {
  std::string arm_id;  ///< prefix of its links
  std::string type;    ///< "panda" or "fr3"
};

/// The world's shapes as text, for several LineServers. They are read in a thread of their own,
/// since that takes seconds, once for each set of robots and objects. All functions are called by
/// the stepping thread.
class SceneText {
 public:
  using Robots = std::function<std::vector<SceneRobot>()>;  ///< returns the robots of the world

  /// Writes the model's text in advance, so that no tick has to.
  /// @param world outlives this @param robots of the world, now
  SceneText(World& world, Robots robots);

  /// Answers the line `scene`: a JSON object with bodies, shapes and robots.
  /// @throws std::runtime_error (the reply does) with a sentence when the model does not compile
  fci::Reply describe();
  /// Answers the line `mesh`: a JSON object with the part of a mesh that begins at this byte.
  /// @throws std::invalid_argument (the reply does) with a sentence
  fci::Reply mesh(const std::string& name, std::size_t offset);
  /// Answers the line `poses`: a JSON list, position [m] and quaternion w, x, y, z of each body.
  std::string poses() const;

 private:
  struct Content {
    std::string bodies_and_shapes;  ///< members of a JSON object, which is not closed
    /// A triangle mesh.
    struct Mesh {
      std::size_t vertices, faces;  ///< counts
      std::string bytes;            ///< vertices as float32 x, y, z; faces as three uint32
    };
    std::vector<Mesh> meshes;
  };

  static Content contentOf(const WorldShapes& shapes);
  const Content* content();

  World& world_;
  Robots robots_;
  std::uint64_t generation_{0};  ///< of the world that is read
  std::shared_future<Content> reading_;
};

}  // namespace franka_sim
