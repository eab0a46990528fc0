// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/tick.h>
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
  std::array<double, 3> position{};                 ///< [m]
  std::array<double, 4> orientation{{1, 0, 0, 0}};  ///< w, x, y, z
};

/// Turns an address (`package://name/path`, or one that begins with `model` or `file`) or a plain
/// path into a file name; empty when unknown.
using ResourceResolver = std::function<std::string(const std::string& uri)>;

/// How a robot's link differs from its URDF.
struct LinkError {
  double mass{0};                    ///< as a share of the link's mass and inertia
  std::array<double, 3> center{};    ///< shift of the center of mass, in the link's frame [m]
  double added_mass{0};              ///< a point mass on the link [kg]
  std::array<double, 3> added_at{};  ///< where, in the link's frame [m]

  /// Whether there is a difference.
  bool exists() const noexcept {
    return mass != 0.0 || added_mass != 0.0 || center != std::array<double, 3>{};
  }
};

/// A robot to add to the world: its simulatable URDF (xacro argument gazebo:=true).
struct RobotDescription {
  std::string name;          ///< unique in the world; the arm_id for an arm
  std::string urdf;          ///< the text; link and joint names are kept as they are
  ResourceResolver resolve;  ///< finds its meshes
  Pose base;                 ///< of the URDF's root, unless that is a link named `world`
  std::map<std::string, double> initial_positions;  ///< joint name -> [rad] or [m]
  std::map<std::string, double> rotor_inertia;      ///< joint name -> armature [kg m^2]; else none
  /// Joint name -> friction, in addition to that of the URDF's `<dynamics>`, which the joints of
  /// Franka arms and hands do not have.
  std::map<std::string, JointFriction> friction;
  /// Joint name -> offset of its torque sensor [Nm]: an arm's motors produce the reading, not the
  /// torque itself, to the commanded value.
  std::map<std::string, double> torque_offset;
  std::map<std::string, LinkError> link_errors;  ///< link name -> difference from its URDF
  /// Joint stops that differ from the URDF's limits (decision 8): name -> {lower, upper}.
  std::map<std::string, std::array<double, 2>> stops;
};

/// How many physics steps a tick has.
enum class Substeps {
  kAdaptive,  ///< one while robots move freely, World::kSmallSteps otherwise (decision 58)
  kSmall,     ///< always World::kSmallSteps
};

/// The dynamic state of a world at a tick. Copies share it; it may outlive its world.
class Snapshot {
 public:
  struct Content;
  explicit Snapshot(std::shared_ptr<const Content> content = nullptr)
      : content_(std::move(content)) {}
  /// For World; empty for a snapshot of nothing.
  const Content* content() const noexcept { return content_.get(); }

 private:
  std::shared_ptr<const Content> content_;
};

/// A robot or an object that is added to a world or removed from it, in three steps, because the
/// second one takes up to seconds: World::beginAddRobot() and the like, compile(), World::apply().
class WorldChange {
 public:
  struct Content;
  explicit WorldChange(std::shared_ptr<Content> content) : content_(std::move(content)) {}
  /// Compiles the new model. Any thread may call it while another one uses the world, and may step
  /// it. Not real-time safe. @throws std::runtime_error with a sentence if the change is impossible
  void compile();
  Content& content() noexcept { return *content_; }  ///< for World

 private:
  std::shared_ptr<Content> content_;
};

/// The simulated world: an MJCF or SDF world file with robots from URDFs, stepped in ticks of 1 ms.
/// What is in it - bodies, joints, contacts, models, cameras, gravity, lights - is read and changed
/// by the functions of the headers physics/world_*.h.
///
/// Called by one thread at a time, those functions included. Functions that change the set of
/// robots allocate and throw std::runtime_error with a sentence.
class World {
 public:
  /// @param file the world, MJCF or SDF; empty: ground, light and sky only.
  /// @param resolve finds files that SDF texts name by package:// and model://
  /// @throws std::runtime_error naming the file and the error, MuJoCo's or the SDF reader's.
  explicit World(const std::string& file = "", ResourceResolver resolve = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  static constexpr double kTick = franka_core::kTick;  ///< [s]
  /// Physics steps of a tick in which something is close: a grasp slips above 0.5 ms (decision 18).
  static constexpr int kSmallSteps = 2;

  /// Adds a robot; the state of everything else is kept. Nothing changes when it throws.
  void addRobot(const RobotDescription& robot);
  void removeRobot(const std::string& name);  ///< its state is lost
  std::vector<std::string> robots() const;    ///< names

  /// Adds an object: SDF with one model, MJCF with bodies, a lone MJCF `<body>`, or the URDF of an
  /// object (urdf_text.h). The state of everything else is kept; nothing changes when it throws.
  /// @param pose of the text's origin in the world
  void addObject(const std::string& name, const std::string& text, const Pose& pose);
  void removeObject(const std::string& name);  ///< its state is lost
  std::vector<std::string> objects() const;    ///< names

  /// @name First step of a change. The four functions above make all three steps.
  /// @{
  WorldChange beginAddRobot(const RobotDescription& robot) const;
  WorldChange beginRemoveRobot(const std::string& name) const;
  WorldChange beginAddObject(const std::string& name, const std::string& text,
                             const Pose& pose) const;
  WorldChange beginRemoveObject(const std::string& name) const;
  /// @}
  /// Last step: what is added begins in its initial state; all else keeps the state that it has
  /// now. A second call takes the change back, to the bit, and a third one makes it again: plants
  /// of its robots stay valid meanwhile, unused. Takes less than a tick. Not real-time safe.
  /// @throws std::logic_error before compile(), or if another change was applied since the first
  /// step
  void apply(WorldChange& change);

  /// One sentence that names elements of the world file (or of an object or robot) that are not
  /// simulated as they are written; empty when there are none.
  std::string unsupported(const std::string& name = "") const;

  /// Names of all bodies (links included) and of all joints with one degree of freedom.
  std::vector<std::string> bodies() const;
  /// @copydoc bodies()
  std::vector<std::string> joints() const;
  /// A number that changes when a robot or an object comes or goes. No other world of this process
  /// has it.
  std::uint64_t generation() const noexcept;
  /// Plants stay valid until their robot is removed and the change that did it no longer exists,
  /// also when other robots are added.
  /// @throws std::runtime_error when the robot has no joints `<arm_id>_joint1..7` (arm) or no
  /// `<arm_id>_finger_joint1..2` (hand).
  ArmPlant& arm(const std::string& robot, const std::string& arm_id);
  /// @copydoc arm()
  HandPlant& hand(const std::string& robot, const std::string& arm_id);
  /// Whether hand() would find one.
  bool hasHand(const std::string& robot, const std::string& arm_id) const;
  /// The drive of a single joint, valid as long as plants are. A joint is driven either by a plant
  /// or by this. A joint that follows another (mimic) takes efforts, but no positions.
  /// @throws std::runtime_error when there is no such joint or it does not move
  JointDrive& drive(const std::string& robot, const std::string& joint);

  /// One tick of 1 ms. Does nothing once the world has stopped. Real-time safe.
  void step() noexcept;
  /// Computes in advance the part of the next tick that no input can change, for a moment of idle
  /// time. Neither the visible state nor later results change. Real-time safe.
  void prepareStep() noexcept;
  /// Gives the world a thread that prepares steps, or takes it away. It occupies a processor while
  /// requests come, unless others need that. Not real-time safe.
  void setPreparesBeside(bool beside);
  /// Starts prepareStep() on that thread, if there is one; call right after step(). All functions
  /// of this class wait for its end; plants need not, except to close or open brakes.
  void prepareBeside() noexcept;
  /// Whether the physics has diverged: a position, velocity or acceleration was not finite or
  /// beyond 1e10, or MuJoCo has failed. The world then stands still, unchanged, until reset() or
  /// restore(), and functions that change its state throw. (MuJoCo alone would reset it silently.)
  /// Real-time safe.
  bool stopped() const noexcept;
  /// Why it has stopped: a sentence; empty while it runs.
  std::string fault() const;
  /// Sentences since the last call: unsupported() of what was added, and MuJoCo's warnings, each
  /// once until a reset.
  std::vector<std::string> takeWarnings();
  std::uint64_t ticks() const noexcept;  ///< since the start; reset() sets it to 0
  /// Physics steps of the last tick: 1 or kSmallSteps (decision 58). Real-time safe.
  int substeps() const noexcept;
  /// kAdaptive at the start.
  void setSubsteps(Substeps substeps) noexcept;
  double time() const noexcept;  ///< [s]

  /// Resets everything to its initial state, warm starts included.
  void reset();

  /// Saves the complete state for restore(): what follows is the same to the last bit. It includes
  /// the tick count.
  Snapshot snapshot() const;
  /// Goes back to a snapshot.
  /// @param snapshot of this world, or of another one with equal robots and objects
  /// @throws std::runtime_error if the robots or objects differ; nothing has changed
  void restore(const Snapshot& snapshot);

  /// Hash of the complete dynamic state: equal hash, equal future (decision 22).
  std::uint64_t stateHash() const noexcept;

  /// The merged model as MJCF text, for inspection and for reference benchmarks. `visuals` adds the
  /// visual meshes, which the stepped model leaves out.
  std::string mjcf(bool visuals) const;

  struct Impl;

 private:
  friend Impl& implOf(const World& world) noexcept;

  /// Access to the implementation, which waits for what is being prepared.
  class Access {
   public:
    explicit Access(std::unique_ptr<Impl> impl);
    ~Access();
    Impl* operator->() const noexcept { return &**this; }
    Impl& operator*() const noexcept;

   private:
    std::unique_ptr<Impl> impl_;
  };

  Access impl_;
};

/// Time of the bare mj_step calls of a tick [us], with the same model and substeps, from the
/// present state with the present torques held: the reference of the simulation's benchmark. Works
/// on copies of the state; the world does not change. Allocates.
double bareTickMicroseconds(World& world, std::uint32_t ticks);

/// Whether a URDF describes an object that is free to move, as Gazebo's spawner takes it: it has
/// neither a Franka arm, nor transmissions, nor a plugin of ros_control, nor a link `world`.
/// Thread-safe. Not real-time safe. @returns false for a text that is not a URDF
bool isUrdfOfObject(const std::string& urdf);

/// The URDF with the joints fixed that have no range (as physics does), so that parsers that refuse
/// a revolute joint without limits read it. The same text if there are none.
/// Thread-safe. Not real-time safe. @throws std::runtime_error for limits that are not numbers
std::string withHeldJoints(const std::string& urdf);

}  // namespace franka_sim
