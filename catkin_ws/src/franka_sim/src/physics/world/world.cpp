// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/world.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "physics/world/world_impl.h"

namespace franka_sim {
namespace {

using physics::StepFault;

template <std::size_t N>
std::array<std::string, N> jointNames(const physics::RobotModel& robot, const std::string& prefix,
                                      const char* what) {
  std::array<std::string, N> names;
  for (std::size_t i = 0; i < N; ++i) {
    names[i] = prefix + std::to_string(i + 1);
    if (!robot.moves(names[i])) {
      throw std::runtime_error("Robot '" + robot.description.name + "' has no " + what +
                               " here: there is no moving joint '" + names[i] + "' in its URDF.");
    }
  }
  return names;
}

std::string quoted(const mjModel& model, int type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name != nullptr ? "'" + std::string(name) + "'" : "without a name";
}

int jointOf(const mjModel& model, const StepFault& fault) {
  if (fault.where != StepFault::Where::kPosition) {
    return model.dof_jntid[fault.index];
  }
  int joint = 0;
  while (joint + 1 < model.njnt && model.jnt_qposadr[joint + 1] <= fault.index) {
    ++joint;
  }
  return joint;
}

std::string sentence(const mjModel& model, const StepFault& fault, double time) {
  const int joint = jointOf(model, fault);
  const int type = model.jnt_type[joint];
  const bool single = type == mjJNT_HINGE || type == mjJNT_SLIDE;
  const std::string owner = single ? "joint " + quoted(model, mjOBJ_JOINT, joint)
                                   : "body " + quoted(model, mjOBJ_BODY, model.jnt_bodyid[joint]);
  const char* const quantity = fault.where == StepFault::Where::kPosition   ? "position"
                               : fault.where == StepFault::Where::kVelocity ? "velocity"
                                                                            : "acceleration";
  return std::string("The physics diverged: the ") + quantity + " of " + owner + " reached " +
         franka_core::numberText(fault.value) + " in SI units at " +
         franka_core::fixedText(time, 3) + " s. The world stands still until it is reset.";
}

}  // namespace

World::World(const std::string& file, ResourceResolver resolve)
    : impl_(std::make_unique<Impl>(file, std::move(resolve))) {
  impl_->news.insert(unsupported());
}

World::~World() = default;

World::Access::Access(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

World::Access::~Access() = default;

World::Impl& World::Access::operator*() const noexcept {
  impl_->finishPreparation();
  return *impl_;
}

std::vector<std::string> World::robots() const {
  std::vector<std::string> names;
  for (const auto& robot : impl_->robots) {
    names.push_back(robot->description.name);
  }
  return names;
}

ArmPlant& World::arm(const std::string& robot, const std::string& arm_id) {
  const auto names = jointNames<7>(impl_->robot(robot), arm_id + "_joint", "arm");
  auto& arm = impl_->arms[robot + "/" + arm_id];
  if (!arm) {
    const auto& offsets = impl_->robot(robot).description.torque_offset;
    std::array<double, 7> offset{};
    for (std::size_t i = 0; i < 7; ++i) {
      const auto found = offsets.find(names[i]);
      offset[i] = found == offsets.end() ? 0.0 : found->second;
    }
    arm = std::make_unique<physics::MujocoArm>(&impl_->view, names, offset);
    physics::MujocoArm::Slots slots;
    for (std::size_t i = 0; i < 7; ++i) {
      slots[i] = impl_->slot(names[i]);
    }
    arm->bind(slots);
  }
  return *arm;
}

HandPlant& World::hand(const std::string& robot, const std::string& arm_id) {
  const auto names = jointNames<2>(impl_->robot(robot), arm_id + "_finger_joint", "hand");
  auto& hand = impl_->hands[robot + "/" + arm_id];
  if (!hand) {
    hand = std::make_unique<physics::MujocoHand>(&impl_->view, names);
    hand->bind({impl_->slot(names[0]), impl_->slot(names[1])});
  }
  return *hand;
}

JointDrive& World::drive(const std::string& robot, const std::string& joint) {
  if (!impl_->robot(robot).moves(joint)) {
    throw std::runtime_error("The robot '" + robot + "' has no joint '" + joint + "' that moves.");
  }
  auto& drive = impl_->drives[joint];
  if (!drive) {
    drive = std::make_unique<physics::MujocoDrive>(&impl_->view, joint);
    drive->bind({impl_->slot(joint)});
  }
  return *drive;
}

bool World::hasHand(const std::string& robot, const std::string& arm_id) const {
  const physics::RobotModel& model = impl_->robot(robot);
  return model.moves(arm_id + "_finger_joint1") && model.moves(arm_id + "_finger_joint2");
}

void World::step() noexcept { impl_->step(); }

void World::prepareStep() noexcept { impl_->prepareStep(); }

void World::setPreparesBeside(bool beside) { impl_->setPreparesBeside(beside); }

void World::prepareBeside() noexcept { impl_->prepareBeside(); }

std::uint64_t World::ticks() const noexcept { return impl_->ticks; }

int World::substeps() const noexcept { return impl_->motor_side.substeps(); }

void World::setSubsteps(Substeps substeps) noexcept {
  impl_->substeps = substeps;
  impl_->disturb();
}

double World::time() const noexcept { return static_cast<double>(impl_->ticks) * kTick; }

void World::reset() { impl_->reset(); }

std::uint64_t World::stateHash() const noexcept { return impl_->hash(); }

std::string World::mjcf(bool visuals) const {
  std::vector<const physics::RobotModel*> robots;
  for (const auto& robot : impl_->robots) {
    robots.push_back(robot.get());
  }
  return impl_->world->merge(robots, visuals);
}

const std::string& World::Impl::faultText() {
  if (fault && fault->where == StepFault::Where::kEngine) {
    return fault_text;
  }
  if (fault && fault_text.empty()) {
    fault_text = sentence(*model, *fault, static_cast<double>(ticks) * kTick);
  }
  return fault_text;
}

void World::Impl::requireRuns() {
  if (fault) {
    throw std::runtime_error(faultText());
  }
}

void World::Impl::clearFaults() noexcept {
  fault.reset();
  fault_text.clear();
  warned = {};
}

bool World::stopped() const noexcept { return impl_->fault.has_value(); }

std::string World::fault() const { return impl_->faultText(); }

std::vector<std::string> World::takeWarnings() {
  struct Kind {
    mjtWarning number;
    const char* sentence;
  };
  static constexpr Kind kKinds[] = {
      {mjWARN_INERTIA,
       "A body's inertia is close to singular: the physics is inexact. Give bodies that move "
       "masses [kg] and inertias [kg m^2] of real ones."},
      {mjWARN_CONTACTFULL,
       "There are more contacts than the limit (nconmax), and some have no effect. Raise nconmax "
       "in <size> of the world file."},
      {mjWARN_CNSTRFULL,
       "There are more constraints (contacts, limits, friction) than the limit (njmax), and some "
       "have no effect. Raise njmax in <size> of the world file, or use fewer objects: there is "
       "room for about 1000 boxes."},
      {mjWARN_BADCTRL, "An actuator's command is not finite or too large: all actuators are off."},
  };
  std::vector<std::string> news;
  for (const std::string& sentence : std::exchange(impl_->news, {})) {
    if (!sentence.empty()) {
      news.push_back(sentence);
    }
  }
  for (const Kind& kind : kKinds) {
    bool& warned = impl_->warned[kind.number];
    if (!warned && impl_->data->warning[kind.number].number > 0) {
      warned = true;
      news.emplace_back(kind.sentence);
    }
  }
  return news;
}

namespace {

/// Under held torques an arm drifts away from its controlled pose: restart this often [ticks].
constexpr std::uint32_t kRound = 200;

/// Computing time of this thread [us]: excludes other programs.
double threadMicroseconds() noexcept {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double bareTickMicroseconds(World& world, std::uint32_t ticks) {
  const mjModel* model = implOf(world).model.get();
  const mjData* present = implOf(world).data.get();
  const physics::DataPtr copy = physics::copyData(*model, *present);
  const auto substeps = static_cast<std::uint32_t>(std::lround(World::kTick / model->opt.timestep));
  double spent = 0.0;
  for (std::uint32_t done = 0; done < ticks; done += kRound) {
    physics::copyData(copy.get(), *model, *present);
    const std::uint32_t steps = std::min(kRound, ticks - done) * substeps;
    const double start = threadMicroseconds();
    for (std::uint32_t i = 0; i < steps; ++i) {
      mj_step(model, copy.get());
    }
    spent += threadMicroseconds() - start;
  }
  return spent / std::max(ticks, 1U);
}

}  // namespace franka_sim
