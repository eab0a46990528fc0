// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/contacts/robot_clearance.h"

#include <franka_core/tick.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/engine/rotations.h"

namespace franka_sim::physics {

namespace {

// Chosen here [m]. Of 3000 random poses of an arm, each joint within 0.5 rad of the start pose, 98
// % are farther from themselves than the widest. The narrower ones are for hands over a table.
constexpr std::array<double, 4> kMargins{0.05, 0.02, 0.008, 0.003};
// The share of a margin by which robots may move after a check. The rest is for objects that creep.
constexpr double kAllowed = 0.8;
// Ticks from a check to the next one, at most.
constexpr int kMaxCheckInterval = 1000;
constexpr int kRetry = 8;  // if something was near
// A way that joints cannot have: a position is out of range, and the step will report it.
constexpr double kNoWay = 1e6;  // [m]

/// Ticks in which two objects that creep come no nearer than what is left of a margin.
constexpr int ticksOfCreep(double margin) noexcept {
  const double left = (1.0 - kAllowed) * margin;
  const double ticks = left / (2.0 * Ownership::kRests * franka_core::kTick);
  return ticks < kMaxCheckInterval ? static_cast<int>(ticks) : kMaxCheckInterval;
}

/// The largest distance from a body's origin to a point of a geom that it carries, in any pose of
/// the joints [m].
std::vector<double> reaches(const mjModel& model) {
  std::vector<double> reach(model.nbody, 0.0);
  for (int body = model.nbody - 1; body > 0; --body) {
    const int first = model.body_geomadr[body];
    for (int geom = first; geom < first + model.body_geomnum[body]; ++geom) {
      reach[body] =
          std::max(reach[body], mju_norm3(model.geom_pos + 3 * geom) + model.geom_rbound[geom]);
    }
    double slides = 0.0;
    double offset = 0.0;
    const int joint = model.body_jntadr[body];
    for (int j = joint; j < joint + model.body_jntnum[body]; ++j) {
      offset = std::max(offset, mju_norm3(model.jnt_pos + 3 * j));
      if (model.jnt_type[j] == mjJNT_SLIDE) {
        const double* range = model.jnt_range + 2 * j;
        slides += model.jnt_limited[j] ? std::max(std::abs(range[0]), std::abs(range[1])) : 1e3;
      }
    }
    reach[body] += offset;
    const int parent = model.body_parentid[body];
    reach[parent] = std::max(reach[parent],
                             reach[body] + offset + slides + mju_norm3(model.body_pos + 3 * body));
  }
  return reach;
}

}  // namespace

/// Enlarges the margins of robots, without effect of the contacts in them.
class RobotClearance::Margins {
 public:
  Margins(const RobotClearance& clearance, mjModel* model, double margin) noexcept
      : clearance_(clearance), model_(model) {
    for (const int geom : clearance_.robot_geoms_) {
      model_->geom_margin[geom] += margin;
    }
    for (const int pair : clearance_.robot_pairs_) {
      model_->pair_margin[pair] += margin;
    }
  }
  ~Margins() {
    for (const int geom : clearance_.robot_geoms_) {
      model_->geom_margin[geom] = clearance_.geom_margins_[geom];
    }
    for (const int pair : clearance_.robot_pairs_) {
      model_->pair_margin[pair] = clearance_.pair_margins_[pair];
    }
  }
  Margins(const Margins&) = delete;
  Margins& operator=(const Margins&) = delete;

 private:
  const RobotClearance& clearance_;
  mjModel* model_;
};

/// Checks one pose with several margins. Restores positions and contacts at its end.
class RobotClearance::Scan {
 public:
  Scan(RobotClearance& clearance, mjModel* model, mjData* data) noexcept
      : clearance_(clearance),
        model_(model),
        data_(data),
        contacts_(data->ncon),
        full_(data->warning[mjWARN_CONTACTFULL]) {
    // mj_kinematics makes quaternions unit ones in place; a check must not change later results.
    copyQuaternions(*model, data->qpos, clearance.kept_qpos_.data());
    std::copy_n(data->contact, contacts_, clearance.kept_contacts_.begin());
    mj_kinematics(model, data);
  }
  ~Scan() {
    copyQuaternions(*model_, clearance_.kept_qpos_.data(), data_->qpos);
    std::copy_n(clearance_.kept_contacts_.begin(), contacts_, data_->contact);
    data_->ncon = contacts_;
    data_->warning[mjWARN_CONTACTFULL] = full_;
  }
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;

  /// Whether nothing is within a margin of a robot.
  bool isFree(std::size_t margin) {
    {
      const Margins margins(clearance_, model_, kMargins[margin]);
      mj_collision(model_, data_);
    }
    bool free = data_->warning[mjWARN_CONTACTFULL].number == full_.number;
    bool free_of_objects = free;
    for (int i = 0; i < data_->ncon; ++i) {
      const mjContact& contact = data_->contact[i];
      const std::vector<int>& robots = clearance_.owners_->robot_of_geom;
      if (robots[contact.geom1] >= 0 || robots[contact.geom2] >= 0) {
        free = false;
        free_of_objects = free_of_objects && !clearance_.is_of_object_[contact.geom1] &&
                          !clearance_.is_of_object_[contact.geom2];
      }
    }
    data_->warning[mjWARN_CONTACTFULL] = full_;
    free_ = std::max(free_, free ? kMargins[margin] : 0.0);
    free_of_objects_ = std::max(free_of_objects_, free_of_objects ? kMargins[margin] : 0.0);
    return free;
  }
  /// The widest of the checked margins that were free, and free of objects [m].
  double free() const noexcept { return free_; }
  double freeOfObjects() const noexcept { return free_of_objects_; }

 private:
  RobotClearance& clearance_;
  mjModel* model_;
  mjData* data_;
  int contacts_;
  mjWarningStat full_;
  double free_{0.0}, free_of_objects_{0.0};
};

void RobotClearance::fit(const mjModel& model, const Ownership& owners) {
  disturb();
  owners_ = &owners;
  joints_.clear();
  robot_geoms_.clear();
  robot_pairs_.clear();
  is_of_object_.assign(model.ngeom, false);
  geom_margins_.assign(model.geom_margin, model.geom_margin + model.ngeom);
  pair_margins_.assign(model.pair_margin, model.pair_margin + model.npair);
  for (int geom = 0; geom < model.ngeom; ++geom) {
    is_of_object_[geom] = owners.isOfObject(model, geom);
    if (owners.robot_of_geom[geom] >= 0) {
      robot_geoms_.push_back(geom);
    }
  }
  for (int pair = 0; pair < model.npair; ++pair) {
    if (owners.isPairOfRobot(model, pair)) {
      robot_pairs_.push_back(pair);
    }
  }
  fitJoints(model);
  state_.checked_qpos.assign(model.nq, 0.0);
  kept_qpos_.assign(model.nq, 0.0);
  kept_contacts_.resize(model.nconmax);
}

void RobotClearance::fitJoints(const mjModel& model) {
  const std::vector<double> reach = reaches(model);
  possible_ = !robot_geoms_.empty() && model.opt.collision == mjCOL_ALL;
  std::size_t robots = 0;
  for (int joint = 0; joint < model.njnt; ++joint) {
    const int body = model.jnt_bodyid[joint];
    const int type = model.jnt_type[joint];
    if (owners_->robot_of_body[body] < 0) {
      continue;
    }
    const auto robot = static_cast<std::size_t>(owners_->robot_of_body[body]);
    possible_ = possible_ && (type == mjJNT_HINGE || type == mjJNT_SLIDE);
    joints_.push_back({model.jnt_qposadr[joint], model.jnt_dofadr[joint], robot,
                       type == mjJNT_SLIDE ? 1.0 : reach[body]});
    robots = std::max(robots, robot + 1);
  }
  travel_.assign(robots, 0.0);
}

template <typename Change>
double RobotClearance::largestSum(const Change& change) noexcept {
  std::fill(travel_.begin(), travel_.end(), 0.0);
  for (const Joint& joint : joints_) {
    travel_[joint.robot] += joint.reach * std::abs(change(joint));
  }
  double largest = 0.0;
  double second = 0.0;
  for (const double travel : travel_) {
    second = std::max(second, std::min(travel, largest));
    largest = std::max(largest, travel);
  }
  return largest + second;
}

double RobotClearance::maxDisplacement(const double* qpos, const double* others) noexcept {
  return largestSum([&](const Joint& joint) { return qpos[joint.qpos] - others[joint.qpos]; });
}

// From wide to narrow, beginning with the last free margin.
void RobotClearance::check(mjModel* model, mjData* data) {
  Scan scan(*this, model, data);
  std::size_t margin = state_.margin;
  bool free = scan.isFree(margin);
  if (free && margin > 0 && scan.isFree(margin - 1)) {
    --margin;
  }
  while (!free && margin + 1 < kMargins.size()) {
    ++margin;
    free = scan.isFree(margin);
  }
  state_.margin = margin;
  state_.way = kAllowed * scan.free();
  state_.objects_way = kAllowed * scan.freeOfObjects();
  state_.until_check = scan.free() > 0.0 ? ticksOfCreep(scan.free()) : kRetry;
}

// The motion of robots since the last check, and in this tick.
void RobotClearance::updateClear(double way, const mjData& data) noexcept {
  const double ahead = way + franka_core::kTick * largestSum([&](const Joint& joint) {
                               return data.qvel[joint.dof];
                             });
  const bool valid = state_.until_check > 0 && owners_->objectsRest(data);
  state_.clear = valid && ahead < state_.way;
  state_.objects_clear = valid && ahead < state_.objects_way;
}

void RobotClearance::startTick(mjModel* model, mjData* data) {
  if (!possible_ || !used_ || state_.decided) {
    return;
  }
  state_.decided = true;
  const double way = maxDisplacement(data->qpos, state_.checked_qpos.data());
  const bool was_clear = state_.clear;
  const bool were_objects_clear = state_.objects_clear;
  updateClear(way, *data);
  const bool ends = (was_clear && !state_.clear) || (were_objects_clear && !state_.objects_clear);
  if (ends || state_.until_check <= 0) {
    state_.until_check = kRetry;
    state_.way = state_.objects_way = 0.0;
    if (owners_->objectsRest(*data) && way < kNoWay) {
      std::copy_n(data->qpos, model->nq, state_.checked_qpos.begin());
      check(model, data);
      updateClear(0.0, *data);
      state_.until_check = state_.clear ? state_.until_check : kRetry;
    }
  }
  --state_.until_check;
}

}  // namespace franka_sim::physics
