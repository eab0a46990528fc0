// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/pose_conversions.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/physics/world_lights.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "physics/contacts/collision_scope.h"
#include "physics/contacts/geom_contact.h"
#include "physics/contacts/object_rest.h"
#include "physics/contacts/ownership.h"
#include "physics/contacts/robot_clearance.h"
#include "physics/engine/engine_error.h"
#include "physics/engine/model_data.h"
#include "physics/engine/model_identity.h"
#include "physics/joints/joint_frictions.h"
#include "physics/joints/motor_side.h"
#include "physics/joints/mujoco_arm.h"
#include "physics/joints/mujoco_drive.h"
#include "physics/joints/mujoco_hand.h"
#include "physics/joints/plant_view.h"
#include "physics/mjcf/mjcf_world.h"
#include "physics/stepping/links_without_gravity.h"
#include "physics/stepping/preparation_thread.h"
#include "physics/stepping/step_fault.h"
#include "physics/stepping/step_preparation.h"
#include "physics/world/frame.h"
#include "physics/world/push.h"
#include "physics/world/world_change.h"

namespace franka_sim {

/// The implementation of World: what it is made of, the merged model and its state. Called by the
/// thread that uses the world; prepareStep() also by the thread that prepares steps. Positions [m]
/// and velocities [m/s] in the world frame.
struct World::Impl {
  Impl(const std::string& file, ResourceResolver resolve);

  // World file with objects, and robots, in the order of addition.
  std::shared_ptr<const physics::MjcfWorld> world;
  physics::Robots robots;
  std::map<std::string, std::unique_ptr<physics::MujocoArm>> arms;      ///< "<robot>/<arm_id>"
  std::map<std::string, std::unique_ptr<physics::MujocoHand>> hands;    ///< "<robot>/<arm_id>"
  std::map<std::string, std::unique_ptr<physics::MujocoDrive>> drives;  ///< by the joint's name

  // The merged model and its state.
  physics::ModelPtr model;
  physics::DataPtr data;
  physics::MotorSide motor_side;
  physics::JointFrictions frictions;
  physics::HoldLimits hold_limits;
  physics::PlantView view;
  std::map<std::string, Frame> frames;
  /// All bodies, in MuJoCo's order and some without a name; then the links and bodies in them.
  std::vector<NamedFrame> ordered_frames;
  std::vector<std::string> geom_links;  ///< per geom, the link or body shown in contacts
  std::vector<Push> pushes;
  std::uint64_t ticks{0};
  physics::StepPreparation preparation;
  physics::Ownership owners;
  physics::RobotClearance clearance;
  physics::ObjectRest object_rest;
  physics::CollisionScope collisions;
  physics::LinksWithoutGravity without_gravity;
  Substeps substeps{Substeps::kAdaptive};
  // Whether the last step's contacts are kept in kept_contacts, because the data holds those of the
  // next step.
  bool contacts_kept{false};
  bool objects_held{false};  ///< in the last step: it computed no contacts of theirs
  std::vector<GeomContact> kept_contacts;
  bool kinematics_fresh{false};
  std::vector<double> kept_qpos;  ///< preallocated copy, so that reading allocates nothing
  std::optional<physics::StepFault> fault;  ///< why the world stands still
  std::string fault_text;                   ///< its sentence; written on first use
  std::array<bool, mjNWARNING> warned{};    ///< MuJoCo's warnings that were taken
  std::set<std::string> news;               ///< sentences that takeWarnings() has not returned yet
  std::string visual_mjcf;                  ///< for pictures; written on first use

  std::uint64_t generation{0};  ///< number of the model; no other one of this process has it
  physics::ModelIdentity identity;
  std::optional<std::array<double, 3>> set_gravity;  ///< other than the world file's
  std::map<std::string, WorldLight> set_lights;      ///< the same, in their bodies' frames
  /// Calls prepareStep(). The last member: it ends before the others do.
  std::unique_ptr<physics::PreparationThread> preparation_thread;

  /// A change that begins with the present world and robots.
  std::shared_ptr<WorldChange::Content> beginChange() const;
  /// Exchanges the model and what it was compiled from with those of the change. The present state
  /// is carried over by name. Strong guarantee.
  void exchange(WorldChange::Content& change);
  /// @throws std::runtime_error when a body of that name exists
  void checkNewBody(const std::string& body, const std::string& of) const;
  void step() noexcept;
  void prepareStep() noexcept;
  void setPreparesBeside(bool beside);
  void prepareBeside() noexcept;
  void finishPreparation() noexcept {
    if (preparation_thread) {
      preparation_thread->finish();
    }
  }
  /// Decides about the next tick and sets the length of its physics steps; returns their number.
  int startTick();
  const std::vector<GeomContact>& contacts() noexcept;  ///< of the last step
  /// Searches the present state for contacts, and keeps those of the last step for contacts().
  /// @returns data with what was found, without forces. @throws EngineError
  const mjData& findContacts();
  bool isObject(int body) const noexcept;  ///< one that can move
  const std::string& faultText();
  void requireRuns();  ///< throws the fault's sentence
  void clearFaults() noexcept;
  void reset();
  std::uint64_t hash() const noexcept;

  physics::JointSlot slot(const std::string& joint) const;  ///< throws
  Frame frame(const std::string& body) const;               ///< throws
  int freeJoint(const std::string& body) const;             ///< joint id; throws
  Eigen::Isometry3d pose(const Frame& frame);
  void updateKinematics() noexcept;
  void addPush(const Push& push);
  /// Takes the forces of all pushes away until a tick applies them.
  void clearPushes() noexcept;
  /// Call after a change of the state from outside.
  void disturb() noexcept;
  bool has(const std::string& joint) const noexcept;
  const physics::RobotModel& robot(const std::string& name) const;  ///< throws

 private:
  void index(WorldChange::Content& change);
  void orderFrames();
  void bindPlants(WorldChange::Content& change);
  void stop(const physics::StepFault& why) noexcept;
  void stop(const physics::EngineError& error) noexcept;
  void advance();
  bool isPushed() const noexcept;
  bool pushesObjects() const noexcept;
  void applyPushes() noexcept;
  void retirePushes() noexcept;
};

/// For other sources of physics/, and tests.
inline World::Impl& implOf(const World& world) noexcept { return *world.impl_; }

}  // namespace franka_sim
