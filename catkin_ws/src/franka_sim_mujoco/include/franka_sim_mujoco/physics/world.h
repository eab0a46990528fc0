// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/robot/plant.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// Position [m] and unit quaternion (w, x, y, z) in the world frame.
struct Pose {
  std::array<double, 3> position{};
  std::array<double, 4> orientation{{1, 0, 0, 0}};
};

/// Turns `package://name/path` (or `file://`, or a plain path) into a file name; empty when
/// unknown.
using ResourceResolver = std::function<std::string(const std::string& uri)>;

/// A robot to put into the world: its simulatable URDF (xacro argument gazebo:=true).
struct RobotDescription {
  std::string name;  ///< unique in the world; the arm_id for an arm
  std::string urdf;  ///< the text; link and joint names are kept as they are
  ResourceResolver resolve;
  Pose base;  ///< where the URDF's root stands when that is not a link named `world`
  std::map<std::string, double> initial_positions;  ///< joint name -> [rad] or [m]
  std::map<std::string, double> rotor_inertia;      ///< joint name -> armature [kg m^2]
  std::map<std::string, double> coulomb_friction;   ///< joint name -> [Nm]
  std::map<std::string, double> damping;            ///< joint name -> [Nm s/rad]
  /// Joint stops that differ from the URDF's limits (decision 8): name -> {lower, upper}.
  std::map<std::string, std::array<double, 2>> stops;
};

struct Contact {
  std::string body1, body2;
  std::array<double, 3> position;  ///< world [m]
  std::array<double, 3> force;     ///< on body2, world axes [N]
};

struct JointMeasurement {
  double position{0}, velocity{0}, effort{0};  ///< [rad|m, rad/s|m/s, Nm|N]
};

/// The scene: an MJCF world file with robots from URDFs, stepped in ticks of 1 ms.
///
/// One thread at a time may call it. Everything that changes the set of robots allocates and throws
/// std::runtime_error with a sentence; `step` and the plants neither allocate nor throw.
class World {
 public:
  /// @param mjcf_file the world; empty means an empty one: ground, light and sky.
  /// @throws std::runtime_error naming the file and what MuJoCo says about it.
  explicit World(const std::string& mjcf_file = "");
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  static constexpr double kTick = 1e-3;  ///< [s]
  static constexpr int kSubsteps = 2;    ///< physics steps a tick (decision 3, mujoco.md)

  /// Merges a robot in; everything already there keeps its state. Nothing changes when it throws.
  void addRobot(const RobotDescription& robot);
  void removeRobot(const std::string& name);
  std::vector<std::string> robots() const;

  /// Plants stay valid until their robot is removed, over additions of other robots too.
  /// @throws std::runtime_error when the robot has no joints `<arm_id>_joint1..7` (arm) or no
  /// `<arm_id>_finger_joint1..2` (hand).
  ArmPlant& arm(const std::string& robot, const std::string& arm_id);
  HandPlant& hand(const std::string& robot, const std::string& arm_id);
  bool hasHand(const std::string& robot, const std::string& arm_id) const;

  /// One tick of 1 ms.
  void step() noexcept;
  std::uint64_t ticks() const noexcept;  ///< since the start; reset() sets it to 0
  double time() const noexcept;          ///< [s]

  /// Everything to where it was first put, warm starts included.
  void reset();

  std::array<double, 3> gravity() const;
  Pose bodyPose(const std::string& body) const;
  void setBodyPose(const std::string& body,
                   const Pose& pose);  ///< free bodies only; velocity becomes 0
  JointMeasurement joint(const std::string& joint) const;
  void setJointPosition(const std::string& joint,
                        double position);  ///< teleport; velocity becomes 0
  /// A force and torque on a body at its origin or at `point` (world), for `ticks` ticks from now.
  void push(const std::string& body, const std::array<double, 3>& force,
            const std::array<double, 3>& torque, std::uint64_t ticks);
  void pushAt(const std::string& body, const std::array<double, 3>& point,
              const std::array<double, 3>& force, std::uint64_t ticks);
  std::vector<Contact> contacts() const;
  /// Bytes that identify the whole dynamic state: equal hash, equal future (decision 22).
  std::uint64_t stateHash() const noexcept;

  /// The merged model as MJCF text, for a look and for reference benchmarks. `visuals` adds the
  /// visual meshes, which the stepped model leaves out.
  std::string mjcf(bool visuals) const;

  struct Impl;
  Impl& impl() noexcept { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace franka_sim_mujoco
