// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/robot/plant.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// @file
/// What a World contains: functions that read and change its bodies, joints, contacts, gravity and
/// lights by their names. The thread that uses the world calls them, between ticks. All throw
/// std::runtime_error with a sentence for an unknown name; those that change something also while
/// the world has stopped (World::stopped), and for numbers beyond the limits in namespace sizes.
/// Not real-time safe.

namespace franka_sim {

/// Velocity of a body: linear of its origin [m/s] and angular [rad/s], world axes.
struct Twist {
  std::array<double, 3> linear{}, angular{};  ///< [m/s] and [rad/s]
};

/// Pose and velocity of a body.
struct BodyState {
  Pose pose;    ///< in the world frame
  Twist twist;  ///< along world axes
};

/// A contact between two bodies.
struct Contact {
  std::string body1, body2;        ///< names
  std::array<double, 3> position;  ///< world [m]
  std::array<double, 3> force;     ///< on body2, world axes [N]
};

/// What touches a body.
struct Touches {
  std::vector<std::string> robots;  ///< each once
  bool others{false};               ///< anything else
};

/// A robot's link and a body of something else that penetrate each other.
struct Overlap {
  std::string link, body;  ///< names
  double depth;            ///< [m]
};

/// A joint with one degree of freedom.
struct WorldJoint {
  std::string name;     ///< in the world
  bool slides{false};   ///< prismatic, else revolute
  bool limited{false};  ///< has stops
  double damping{0};    ///< [Nm s/rad] or [N s/m]
};

/// What Gazebo calls a model: a robot, an object, or a top-level body of the world file, with all
/// bodies attached to it.
struct WorldModel {
  std::string name;                ///< of the robot, object or body
  std::string body;                ///< its pose is the model's
  std::vector<std::string> links;  ///< names of bodies; those of SDF models begin with `model::`
  std::vector<WorldJoint> joints;  ///< all with one degree of freedom
  bool is_static{false};           ///< whether nothing of it can move
};

/// A camera fixed to the world or to a body: MJCF's `<camera>` or SDF's camera sensor.
struct WorldCamera {
  std::string name;             ///< in the world
  double field_of_view{45};     ///< vertical [deg]
  int width{640}, height{480};  ///< [pixel]; MJCF: attribute user="width height rate"
  double rate{30};              ///< desired pictures per simulated second [Hz]
};

/// @name Bodies, links included
/// @{
Pose bodyPose(const World& world, const std::string& body);  ///< in the world frame
/// Pose and velocity, along world axes.
BodyState bodyState(const World& world, const std::string& body);
/// The same for many bodies in one call, which is faster.
std::vector<BodyState> bodyStates(const World& world, const std::vector<std::string>& names);
/// Poses for drawing, in the order of WorldShapes::bodies (physics/renderer.h).
std::vector<Pose> framePoses(const World& world);
/// @throws std::runtime_error if a body that is not free, or such a pose, cannot be set
void checkBodyPose(const World& world, const std::string& body, const Pose& pose);
/// Free bodies only; velocity becomes 0.
void setBodyPose(World& world, const std::string& body, const Pose& pose);
void setBodyTwist(World& world, const std::string& body, const Twist& twist);  ///< free bodies only
/// Both of the last two; nothing changes when it throws.
void setBodyState(World& world, const std::string& body, const BodyState& state);
/// A force and torque on a body at its origin or at `point` (world), for `ticks` ticks from now.
void pushBody(World& world, const std::string& body, const std::array<double, 3>& force,
              const std::array<double, 3>& torque, std::uint64_t ticks,
              const std::optional<std::array<double, 3>>& point = {});
/// Ends all pushes of a body.
void endPushes(World& world, const std::string& body);
/// @}

/// Mass and inertia of a body with all that is fixed to it.
struct BodyInertia {
  double mass{0};                  ///< [kg]
  std::array<double, 3> center{};  ///< of mass, in the body's frame [m]
  /// xx, xy, xz, yy, yz, zz about the center of mass, along the body's axes [kg m^2]
  std::array<double, 6> inertia{};
  bool gravity{true};  ///< false: gravity does not pull this link
};

/// @throws std::runtime_error with a sentence for an unknown body, and for one that is fixed to
/// another and belongs to that one's inertia
BodyInertia bodyInertia(const World& world, const std::string& body);

/// @name Joints with one degree of freedom
/// @{
JointMeasurement jointState(const World& world, const std::string& joint);  ///< with its torque
/// @throws std::runtime_error if such a position cannot be set
void checkJointPosition(const World& world, const std::string& joint, double position);
/// Teleports; velocity becomes 0.
void setJointPosition(World& world, const std::string& joint, double position);
void setJointVelocity(World& world, const std::string& joint, double velocity);  ///< [rad/s], [m/s]
/// A torque [Nm] or force [N] on a joint of an object, for `ticks` ticks from now. @throws
/// std::runtime_error also for a joint of a robot
void pushJoint(World& world, const std::string& joint, double effort, std::uint64_t ticks);
/// Ends all pushes of a joint.
void endJointPushes(World& world, const std::string& joint);
/// @}

std::vector<Contact> contacts(const World& world);  ///< at this tick
/// What contacts() returns of one body, in brief.
Touches touches(const World& world, const std::string& body);
/// Where a robot penetrates other bodies, by more than 1 mm.
std::vector<Overlap> overlaps(const World& world, const std::string& robot);
/// A sentence about them; empty when there are none.
std::string describeOverlaps(const World& world, const std::string& robot);

std::vector<WorldModel> models(const World& world);    ///< robots first
std::vector<WorldCamera> cameras(const World& world);  ///< of the world file and of objects

std::array<double, 3> gravity(const World& world);  ///< [m/s^2]
/// [m/s^2]; a reset does not change it.
void setGravity(World& world, const std::array<double, 3>& gravity);

/// A light of the world file or of an object, as it is drawn. Lights of SDF links are called
/// model::link::light.
struct WorldLight {
  bool on{true};                                 ///< drawn; false for one that was removed
  bool shadows{true};                            ///< whether it casts them
  std::array<double, 3> diffuse{}, specular{};   ///< red, green, blue: 0 to 1
  std::array<double, 3> attenuation{{1, 0, 0}};  ///< constant, linear [1/m], quadratic [1/m^2]
  std::array<double, 3> position{};              ///< in the world, or in the light's link [m]
  std::array<double, 3> direction{{0, 0, -1}};   ///< likewise, of any length but 0
};

/// @name Lights
/// @throws std::runtime_error with a sentence for an unknown or removed one
/// @{
WorldLight light(const World& world, const std::string& name);
/// Lasts until its object is removed; a reset does not change it. @throws std::runtime_error also
/// for negative colors or attenuations and positions beyond sizes::kMaxPosition
void setLight(World& world, const std::string& name, const WorldLight& light);
/// @}

}  // namespace franka_sim

/// Limits of numbers in a world for a robot arm (chosen here, far above what an arm of 1 m that
/// lifts 3 kg meets). A number beyond them is a typing error or in another unit, and would make the
/// physics diverge.
namespace franka_sim::sizes {

constexpr double kMaxPosition = 1e3;  ///< from the world's origin [m]; of a joint [m] or [rad]
constexpr double kMaxVelocity = 1e3;  ///< [m/s] or [rad/s]
constexpr double kMaxForce = 1e4;     ///< [N] or [Nm]
constexpr std::uint64_t kMaxPushTicks = 1000000;  ///< duration of a push [ticks]
/// Duration of a push that lasts until it is ended (World::reset, endPushes,
/// endJointPushes) [ticks].
constexpr std::uint64_t kEndlessPush = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t kMaxPushes = 1000;  ///< at a time
constexpr double kMaxGravity = 1e2;       ///< [m/s^2]

/// @param what the start of the sentence, for example "The force"
/// @throws std::runtime_error with a sentence that names the first number which is not finite or
/// beyond `largest`, the limit and the unit.
void check(const std::array<double, 3>& values, double largest, const char* unit,
           const std::string& what);
void check(double value, double largest, const char* unit, const std::string& what);

}  // namespace franka_sim::sizes
