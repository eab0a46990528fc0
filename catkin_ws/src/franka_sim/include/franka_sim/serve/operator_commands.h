// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/renderer.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/robot/whole_robot.h>
#include <franka_sim/serve/line_server.h>
#include <franka_sim/serve/sim_robot.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <string>
#include <vector>

namespace franka_sim {

/// The objects that the commands of one robot's control interface change; all outlive the server.
struct OperatorContext {
  fci::SimRobot& robot;  ///< at whose address the line came
  std::string arm_id;    ///< the robot's prefix in the world
  fci::Host& host;       ///< of all robots
  World& world;          ///< of all robots
  /// Sets the world and all robots to their initial state.
  /// @throws std::exception with a sentence, such as within a motion
  std::function<void()> reset;
  std::function<void()> quit;  ///< ends the program
};

/// Adds the commands of the control interface (docs/franka_sim.md): buttons and switches of the
/// robot, its safety controller and hand, the quality of its link, and changes of the world.
void addOperatorCommands(fci::LineServer& lines, const OperatorContext& context);

/// @name The switches of the operator
/// By the rules that the robot has (SafetyRules).
/// @throws std::runtime_error "CODE: Sentence." if a rule refuses it; those that open a
/// port also when another program has taken it: what it belongs to is off then
/// @{
void setUserStop(WholeRobot& robot, bool pressed);
void setGuiding(WholeRobot& robot, bool active);
void setBrakes(WholeRobot& robot, bool closed);
void setFci(fci::SimRobot& robot, bool active);
void setPower(fci::SimRobot& robot, bool on);
void setEndEffectorPower(fci::SimRobot& robot, bool on);
/// @}

/// The line `reset` of a world in which all robots are served.
/// @throws std::invalid_argument with a sentence if a motion runs
void resetWorld(World& world, const std::vector<fci::SimRobot*>& robots, fci::Host& host);

/// Adds the line `hand` (docs/franka_sim.md): commands of the Franka hand.
/// @param robot with any tool; it outlives the server
void addHandCommands(fci::LineServer& lines, WholeRobot& robot);

/// Adds the commands of the robot's safety controller: stops, brakes, FCI, operating mode, guiding,
/// self-test, errors, the end effector and motions by Desk; and the report of its state.
void addSafetyCommands(fci::LineServer& lines, const OperatorContext& context);

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

/// Adds the lines `scene`, `mesh` and `poses` (docs/franka_sim.md). World and scene outlive the
/// server.
void addSceneCommands(fci::LineServer& lines, const World& world, SceneText& scene);

}  // namespace franka_sim
