// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_properties.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "physics/world_impl.h"

namespace franka_sim {
namespace {

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

void checkPush(std::size_t others, const std::string& body, std::uint64_t ticks) {
  if (ticks > sizes::kMaxPushTicks && ticks != sizes::kEndlessPush) {
    throw std::runtime_error("The push on body '" + body + "' lasts " + std::to_string(ticks) +
                             " ms; give at most " + std::to_string(sizes::kMaxPushTicks) + ".");
  }
  if (others >= sizes::kMaxPushes) {
    throw std::runtime_error("The push on body '" + body +
                             "' is refused: " + std::to_string(sizes::kMaxPushes) +
                             " pushes act already. Wait until they end.");
  }
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

std::array<double, 3> World::gravity() const {
  const double* g = impl_->model->opt.gravity;
  return {g[0], g[1], g[2]};
}

Pose World::bodyPose(const std::string& body) const {
  return toPose(impl_->pose(impl_->frame(body)));
}

std::vector<Pose> World::framePoses() const {
  std::vector<Pose> poses;
  poses.reserve(impl_->ordered_frames.size());
  for (const NamedFrame& named : impl_->ordered_frames) {
    poses.push_back(toPose(impl_->pose(named.frame)));
  }
  return poses;
}

void World::checkBodyPose(const std::string& body, const Pose& pose) const {
  impl_->freeJoint(body);
  sizes::check(pose.position, sizes::kMaxPosition, "m", "The position for body '" + body + "'");
  if (!hasUnitOrientation(pose)) {
    throw std::runtime_error("The orientation for body '" + body + "' is not a unit quaternion.");
  }
}

void World::setBodyPose(const std::string& body, const Pose& pose) {
  checkBodyPose(body, pose);
  impl_->requireRuns();
  const int joint = impl_->freeJoint(body);
  const Frame frame = impl_->frame(body);
  const bool is_body = frame.pose.matrix().isIdentity(0);
  const Eigen::Isometry3d place =
      is_body ? toIsometry(pose) : toIsometry(pose) * frame.pose.inverse();
  double* qpos = impl_->data->qpos + impl_->model->jnt_qposadr[joint];
  Eigen::Vector3d::Map(qpos) = place.translation();
  const Eigen::Quaterniond unit =
      is_body ? quaternion(pose).normalized() : Eigen::Quaterniond(place.linear()).normalized();
  qpos[3] = unit.w();
  qpos[4] = unit.x();
  qpos[5] = unit.y();
  qpos[6] = unit.z();
  mju_zero(impl_->data->qvel + impl_->model->jnt_dofadr[joint], 6);
  impl_->disturb();
}

JointMeasurement World::joint(const std::string& joint) const {
  const physics::JointSlot slot = impl_->slot(joint);
  return {impl_->data->qpos[slot.qpos], impl_->data->qvel[slot.dof],
          impl_->motor_side.torque(slot.dof)};
}

void World::setJointPosition(const std::string& joint, double position) {
  const physics::JointSlot slot = impl_->slot(joint);
  const int id = mj_name2id(impl_->model.get(), mjOBJ_JOINT, joint.c_str());
  impl_->requireRuns();
  sizes::check(position, sizes::kMaxPosition, "m or rad", "The position for joint '" + joint + "'");
  const double* range = impl_->model->jnt_range + 2 * id;
  if (impl_->model->jnt_limited[id] && (position < range[0] || position > range[1])) {
    throw std::runtime_error("Joint '" + joint + "' cannot be put at " +
                             franka_core::numberText(position) + ", its stops are at " +
                             franka_core::numberText(range[0]) + " and " +
                             franka_core::numberText(range[1]) + ".");
  }
  impl_->data->qpos[slot.qpos] = position;
  impl_->data->qvel[slot.dof] = 0;
  impl_->disturb();
  for (auto& [key, arm] : impl_->arms) {
    arm->jointWasMoved(joint);
  }
  for (auto& [key, drive] : impl_->drives) {
    drive->jointWasMoved(joint);
  }
}

void World::push(const std::string& body, const std::array<double, 3>& force,
                 const std::array<double, 3>& torque, std::uint64_t ticks) {
  const Frame frame = impl_->frame(body);
  impl_->requireRuns();
  sizes::check(force, sizes::kMaxForce, "N", "The force on body '" + body + "'");
  sizes::check(torque, sizes::kMaxForce, "Nm", "The torque on body '" + body + "'");
  checkPush(impl_->pushes.size(), body, ticks);
  if (ticks > 0) {
    impl_->addPush(
        {body, frame.body, frame.pose.translation(), vector(force), vector(torque), ticks});
  }
}

void World::pushAt(const std::string& body, const std::array<double, 3>& point,
                   const std::array<double, 3>& force, std::uint64_t ticks) {
  const Frame frame = impl_->frame(body);
  impl_->requireRuns();
  sizes::check(point, sizes::kMaxPosition, "m", "The point of the push");
  sizes::check(force, sizes::kMaxForce, "N", "The force on body '" + body + "'");
  checkPush(impl_->pushes.size(), body, ticks);
  if (ticks > 0) {
    const Frame origin{frame.body, Eigen::Isometry3d::Identity()};
    impl_->addPush({body, frame.body, impl_->pose(origin).inverse() * vector(point), vector(force),
                    Eigen::Vector3d::Zero(), ticks});
  }
}

std::vector<Contact> World::contacts() const {
  std::vector<Contact> result;
  for (const GeomContact& contact : impl_->contacts()) {
    result.push_back({impl_->geom_links[contact.geom1], impl_->geom_links[contact.geom2],
                      contact.position, contact.force});
  }
  return result;
}

Touches World::touches(const std::string& body) const {
  impl_->frame(body);
  Touches touches;
  for (const GeomContact& contact : impl_->contacts()) {
    const bool first = impl_->geom_links[contact.geom1] == body;
    if (!first && impl_->geom_links[contact.geom2] != body) {
      continue;
    }
    const int robot = impl_->owners.robot_of_geom[first ? contact.geom2 : contact.geom1];
    if (robot < 0) {
      touches.others = true;
      continue;
    }
    const std::string& name = impl_->robots[robot]->description.name;
    if (std::find(touches.robots.begin(), touches.robots.end(), name) == touches.robots.end()) {
      touches.robots.push_back(name);
    }
  }
  return touches;
}

std::uint64_t World::stateHash() const noexcept { return impl_->hash(); }

std::string World::mjcf(bool visuals) const {
  std::vector<const physics::RobotModel*> robots;
  for (const auto& robot : impl_->robots) {
    robots.push_back(robot.get());
  }
  return impl_->world->merge(robots, visuals);
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
