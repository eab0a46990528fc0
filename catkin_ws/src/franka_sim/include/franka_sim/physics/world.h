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

/// A robot to put into the world: its simulatable URDF (xacro argument gazebo:=true).
struct RobotDescription {
  std::string name;  ///< unique in the world; the arm_id for an arm
  std::string urdf;  ///< the text; link and joint names are kept as they are
  ResourceResolver resolve;
  Pose base;  ///< where the URDF's root stands when that is not a link named `world`
  std::map<std::string, double> initial_positions;  ///< joint name -> [rad] or [m]
  // For joints not named: no rotor inertia; friction and damping of the URDF's <dynamics>, but none
  // for the joints of Franka arms and hands.
  std::map<std::string, double> rotor_inertia;     ///< joint name -> armature [kg m^2]
  std::map<std::string, double> coulomb_friction;  ///< joint name -> [Nm]
  std::map<std::string, double> damping;           ///< joint name -> [Nm s/rad]
  /// Joint stops that differ from the URDF's limits (decision 8): name -> {lower, upper}.
  std::map<std::string, std::array<double, 2>> stops;
};

struct Contact {
  std::string body1, body2;
  std::array<double, 3> position;  ///< world [m]
  std::array<double, 3> force;     ///< on body2, world axes [N]
};

/// A robot's link and a body that is none of its links, one within the other.
struct Overlap {
  std::string link, body;
  double depth;  ///< [m]
};

/// How a body moves: linear velocity of its origin [m/s] and angular velocity [rad/s], world axes.
struct Twist {
  std::array<double, 3> linear{}, angular{};
};

/// Where a body is and how it moves.
struct BodyState {
  Pose pose;
  Twist twist;
};

/// A joint with one degree of freedom.
struct WorldJoint {
  std::string name;
  bool slides{false};   ///< or turns
  bool limited{false};  ///< has stops
  double damping{0};    ///< [Nm s/rad] or [N s/m]
};

/// What Gazebo calls a model: a robot, an object, or a body of the world file that hangs on nothing
/// else, with all that hangs on it.
struct WorldModel {
  std::string name;
  std::string body;                ///< whose pose is the model's
  std::vector<std::string> links;  ///< names of bodies; those of SDF models begin with `model::`
  std::vector<WorldJoint> joints;
  bool is_static{false};
};

/// A camera that stands in the world or on a body: MJCF's <camera> or SDF's camera sensor.
struct WorldCamera {
  std::string name;
  double field_of_view{45};     ///< vertical [deg]
  int width{640}, height{480};  ///< [pixel]; MJCF: attribute user="width height rate"
  double rate{30};              ///< wanted pictures a simulated second [Hz]
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

/// The scene: an MJCF or SDF world file with robots from URDFs, stepped in ticks of 1 ms.
///
/// One thread at a time may call it. Everything that changes the set of robots allocates and throws
/// std::runtime_error with a sentence; `step` and the plants neither allocate nor throw.
class World {
 public:
  /// @param file the world, MJCF or SDF; empty means an empty one: ground, light and sky.
  /// @param resolve finds what SDF texts name by package:// and model://
  /// @throws std::runtime_error naming the file and what MuJoCo or sdformat says about it.
  explicit World(const std::string& file = "", ResourceResolver resolve = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  static constexpr double kTick = franka_core::kTick;  ///< [s]
  static constexpr int kSubsteps = 2;  ///< per tick: a grasp slips above 0.5 ms (decision 18)

  /// Merges a robot in; everything already there keeps its state. Nothing changes when it throws.
  void addRobot(const RobotDescription& robot);
  void removeRobot(const std::string& name);
  std::vector<std::string> robots() const;

  /// Puts an object in: SDF with one model, MJCF with bodies, or a lone MJCF <body>. Everything
  /// already there keeps its state; nothing changes when it throws.
  /// @param pose where the text's origin comes to stand
  void addObject(const std::string& name, const std::string& text, const Pose& pose);
  void removeObject(const std::string& name);
  std::vector<std::string> objects() const;
  /// One sentence that names what the SDF of the world file (or of an object) asks for and nobody
  /// simulates; empty when there is nothing.
  std::string unsupported(const std::string& object = "") const;

  /// Names of all bodies (links included) and of all joints with one degree of freedom.
  std::vector<std::string> bodies() const;
  std::vector<std::string> joints() const;
  std::vector<WorldCamera> cameras() const;
  /// Robots first.
  std::vector<WorldModel> models() const;

  /// Plants stay valid until their robot is removed, over additions of other robots too.
  /// @throws std::runtime_error when the robot has no joints `<arm_id>_joint1..7` (arm) or no
  /// `<arm_id>_finger_joint1..2` (hand).
  ArmPlant& arm(const std::string& robot, const std::string& arm_id);
  HandPlant& hand(const std::string& robot, const std::string& arm_id);
  bool hasHand(const std::string& robot, const std::string& arm_id) const;
  /// The drive of a single joint, valid as plants are. One joint has one driver: a plant or this.
  /// A joint that follows another (mimic) takes efforts, but no positions.
  /// @throws std::runtime_error when there is no such joint or it does not move
  JointDrive& drive(const std::string& robot, const std::string& joint);

  /// One tick of 1 ms. Once the world has stopped, nothing happens.
  void step() noexcept;
  /// Does ahead what of the next tick is certain already, for a moment when there is nothing else
  /// to do. It changes neither what anybody sees nor what comes.
  void prepareStep() noexcept;
  /// Whether the physics has diverged: a position, velocity or acceleration was not finite or
  /// beyond 1e10. The world then stands still, as it was, until reset() or restore(); what would
  /// change its state throws. MuJoCo alone would reset it in silence. Real-time safe.
  bool stopped() const noexcept;
  /// Why it has stopped: a sentence; empty while it runs.
  std::string fault() const;
  /// Sentences for what MuJoCo has warned of since the last call, each once until a reset.
  std::vector<std::string> takeWarnings();
  std::uint64_t ticks() const noexcept;  ///< since the start; reset() sets it to 0
  double time() const noexcept;          ///< [s]

  /// Everything to where it was first put, warm starts included.
  void reset();

  /// Everything as it is now, and back to it: what follows is the same to the last bit. A snapshot
  /// holds until a robot or object comes or goes (then restore throws); it counts ticks too.
  Snapshot snapshot() const;
  void restore(const Snapshot& snapshot);

  // Numbers from outside are limited: physics/sizes.h.
  std::array<double, 3> gravity() const;
  void setGravity(const std::array<double, 3>& gravity);  ///< [m/s^2]; a reset does not change it
  Pose bodyPose(const std::string& body) const;
  void setBodyPose(const std::string& body,
                   const Pose& pose);  ///< free bodies only; velocity becomes 0
  Twist bodyTwist(const std::string& body) const;
  /// Of many bodies at once, which costs less. @throws std::runtime_error for an unknown one
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
  /// Where a robot stands within other bodies, by more than 1 mm. Allocates.
  std::vector<Overlap> overlaps(const std::string& robot) const;
  /// A sentence about them; empty when there are none.
  std::string describeOverlaps(const std::string& robot) const;
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

}  // namespace franka_sim
