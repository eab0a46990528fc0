// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/tick.h>
#include <franka_sim/physics/joint_drive.h>
#include <franka_sim/robot/plant.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim {

/// Position [m] and unit quaternion (w, x, y, z) in the world frame.
struct Pose {
  std::array<double, 3> position{};
  std::array<double, 4> orientation{{1, 0, 0, 0}};
};

/// Turns `package://name/path` (or `model://`, `file://`, or a plain path) into a file name; empty
/// when unknown.
using ResourceResolver = std::function<std::string(const std::string& uri)>;

/// How a robot's link differs from its URDF.
struct LinkError {
  double mass{0};                    ///< as a share of the link's mass and inertia
  std::array<double, 3> centre{};    ///< shift of the centre of mass, in the link's frame [m]
  double added_mass{0};              ///< a point mass on the link [kg]
  std::array<double, 3> added_at{};  ///< where, in the link's frame [m]

  bool exists() const noexcept {
    return mass != 0.0 || added_mass != 0.0 || centre != std::array<double, 3>{};
  }
};

/// A robot to add to the world: its simulatable URDF (xacro argument gazebo:=true).
struct RobotDescription {
  std::string name;  ///< unique in the world; the arm_id for an arm
  std::string urdf;  ///< the text; link and joint names are kept as they are
  ResourceResolver resolve;
  Pose base;  ///< of the URDF's root, unless that is a link named `world`
  std::map<std::string, double> initial_positions;  ///< joint name -> [rad] or [m]
  std::map<std::string, double> rotor_inertia;      ///< joint name -> armature [kg m^2]; else none
  /// Joint name -> friction, beside that of the URDF's <dynamics>, which the joints of Franka arms
  /// and hands do not have.
  std::map<std::string, JointFriction> friction;
  /// Joint name -> offset of its torque sensor [Nm]: an arm's motors bring the reading, not the
  /// torque itself, to the commanded value.
  std::map<std::string, double> torque_offset;
  std::map<std::string, LinkError> link_errors;  ///< link name -> what its URDF does not say
  /// Joint stops that differ from the URDF's limits (decision 8): name -> {lower, upper}.
  std::map<std::string, std::array<double, 2>> stops;
};

struct Contact {
  std::string body1, body2;
  std::array<double, 3> position;  ///< world [m]
  std::array<double, 3> force;     ///< on body2, world axes [N]
};

/// A robot's link and a body of something else that penetrate each other.
struct Overlap {
  std::string link, body;
  double depth;  ///< [m]
};

/// Velocity of a body: linear of its origin [m/s] and angular [rad/s], world axes.
struct Twist {
  std::array<double, 3> linear{}, angular{};
};

/// Pose and velocity of a body.
struct BodyState {
  Pose pose;
  Twist twist;
};

/// A joint with one degree of freedom.
struct WorldJoint {
  std::string name;
  bool slides{false};   ///< prismatic, else revolute
  bool limited{false};  ///< has stops
  double damping{0};    ///< [Nm s/rad] or [N s/m]
};

/// What Gazebo calls a model: a robot, an object, or a top-level body of the world file, with all
/// bodies attached to it.
struct WorldModel {
  std::string name;
  std::string body;                ///< its pose is the model's
  std::vector<std::string> links;  ///< names of bodies; those of SDF models begin with `model::`
  std::vector<WorldJoint> joints;
  bool is_static{false};
};

/// A camera fixed to the world or to a body: MJCF's <camera> or SDF's camera sensor.
struct WorldCamera {
  std::string name;
  double field_of_view{45};     ///< vertical [deg]
  int width{640}, height{480};  ///< [pixel]; MJCF: attribute user="width height rate"
  double rate{30};              ///< desired pictures per simulated second [Hz]
};

/// The dynamic state of a world at a tick. Copies share it.
class Snapshot {
 public:
  struct Content;
  explicit Snapshot(std::shared_ptr<const Content> content = nullptr)
      : content_(std::move(content)) {}
  const Content* content() const noexcept { return content_.get(); }

 private:
  std::shared_ptr<const Content> content_;
};

/// The simulated world: an MJCF or SDF world file with robots from URDFs, stepped in ticks of 1 ms.
///
/// Only one thread at a time may call it. Functions that change the set of robots allocate and
/// throw std::runtime_error with a sentence; `step` and the plants neither allocate nor throw.
class World {
 public:
  /// @param file the world, MJCF or SDF; empty: ground, light and sky only.
  /// @param resolve finds files that SDF texts name by package:// and model://
  /// @throws std::runtime_error naming the file and the error of MuJoCo or sdformat.
  explicit World(const std::string& file = "", ResourceResolver resolve = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  static constexpr double kTick = franka_core::kTick;  ///< [s]
  static constexpr int kSubsteps = 2;  ///< per tick: a grasp slips above 0.5 ms (decision 18)

  /// Adds a robot; the state of everything else is kept. Nothing changes when it throws.
  void addRobot(const RobotDescription& robot);
  void removeRobot(const std::string& name);
  std::vector<std::string> robots() const;

  /// Adds an object: SDF with one model, MJCF with bodies, or a lone MJCF <body>. The state of
  /// everything else is kept; nothing changes when it throws.
  /// @param pose of the text's origin in the world
  void addObject(const std::string& name, const std::string& text, const Pose& pose);
  void removeObject(const std::string& name);
  std::vector<std::string> objects() const;
  /// One sentence that names elements of the world file's SDF (or of an object) that are not
  /// simulated; empty when there are none.
  std::string unsupported(const std::string& object = "") const;

  /// Names of all bodies (links included) and of all joints with one degree of freedom.
  std::vector<std::string> bodies() const;
  std::vector<std::string> joints() const;
  std::vector<WorldCamera> cameras() const;
  /// Robots first.
  std::vector<WorldModel> models() const;
  /// A number that changes when a robot or an object comes or goes.
  std::uint64_t generation() const noexcept;
  /// Names of all bodies, links included, for drawing: unnamed ones too, each once. The order is
  /// that of framePoses(), as long as generation() is the same.
  std::vector<std::string> frames() const;

  /// Plants stay valid until their robot is removed, also when other robots are added.
  /// @throws std::runtime_error when the robot has no joints `<arm_id>_joint1..7` (arm) or no
  /// `<arm_id>_finger_joint1..2` (hand).
  ArmPlant& arm(const std::string& robot, const std::string& arm_id);
  HandPlant& hand(const std::string& robot, const std::string& arm_id);
  bool hasHand(const std::string& robot, const std::string& arm_id) const;
  /// The drive of a single joint, valid as long as plants are. A joint is driven either by a plant
  /// or by this. A joint that follows another (mimic) takes efforts, but no positions.
  /// @throws std::runtime_error when there is no such joint or it does not move
  JointDrive& drive(const std::string& robot, const std::string& joint);

  /// One tick of 1 ms. Does nothing once the world has stopped.
  void step() noexcept;
  /// Computes in advance the part of the next tick that no input can change, for a moment of idle
  /// time. Neither the visible state nor later results change.
  void prepareStep() noexcept;
  /// Whether the physics has diverged: a position, velocity or acceleration was not finite or
  /// beyond 1e10. The world then stands still, unchanged, until reset() or restore(), and functions
  /// that change its state throw. (MuJoCo alone would reset it silently.) Real-time safe.
  bool stopped() const noexcept;
  /// Why it has stopped: a sentence; empty while it runs.
  std::string fault() const;
  /// Sentences for MuJoCo's warnings since the last call, each once until a reset.
  std::vector<std::string> takeWarnings();
  std::uint64_t ticks() const noexcept;  ///< since the start; reset() sets it to 0
  double time() const noexcept;          ///< [s]

  /// Resets everything to where it was first put, warm starts included.
  void reset();

  /// Saves the complete state for restore(): what follows is the same to the last bit. A snapshot
  /// is valid until a robot or object comes or goes (then restore throws); it includes the tick
  /// count.
  Snapshot snapshot() const;
  void restore(const Snapshot& snapshot);

  // Limits of these arguments: physics/sizes.h.
  std::array<double, 3> gravity() const;
  void setGravity(const std::array<double, 3>& gravity);  ///< [m/s^2]; a reset does not change it
  Pose bodyPose(const std::string& body) const;
  /// Poses of all frames().
  std::vector<Pose> framePoses() const;
  void setBodyPose(const std::string& body,
                   const Pose& pose);  ///< free bodies only; velocity becomes 0
  Twist bodyTwist(const std::string& body) const;
  /// For many bodies in one call, which is faster. @throws std::runtime_error for an unknown one
  std::vector<BodyState> bodyStates(const std::vector<std::string>& names) const;
  void setBodyTwist(const std::string& body, const Twist& twist);  ///< free bodies only
  JointMeasurement joint(const std::string& joint) const;
  void setJointPosition(const std::string& joint,
                        double position);  ///< teleport; velocity becomes 0
  void setJointVelocity(const std::string& joint, double velocity);  ///< [rad/s] or [m/s]
  /// A force and torque on a body at its origin or at `point` (world), for `ticks` ticks from now.
  void push(const std::string& body, const std::array<double, 3>& force,
            const std::array<double, 3>& torque, std::uint64_t ticks);
  void pushAt(const std::string& body, const std::array<double, 3>& point,
              const std::array<double, 3>& force, std::uint64_t ticks);
  std::vector<Contact> contacts() const;
  /// Where a robot penetrates other bodies, by more than 1 mm. Allocates.
  std::vector<Overlap> overlaps(const std::string& robot) const;
  /// A sentence about them; empty when there are none.
  std::string describeOverlaps(const std::string& robot) const;
  /// Hash of the complete dynamic state: equal hash, equal future (decision 22).
  std::uint64_t stateHash() const noexcept;

  /// The merged model as MJCF text, for inspection and for reference benchmarks. `visuals` adds the
  /// visual meshes, which the stepped model leaves out.
  std::string mjcf(bool visuals) const;

  struct Impl;
  Impl& impl() noexcept { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace franka_sim
