// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/contacts/constraint_step.h"

#include <algorithm>

namespace franka_sim::physics {

namespace {

/// Of contacts between moving bodies. Chosen here: cubes in layers of 3, 2 and 1 have some 80 and
/// take 1.2 ms a step with Newton's method, 2.1 ms with conjugate gradients; layers of 4 to 1 have
/// some 220 and take 19 and 4 ms.
constexpr int kMaxContactsForNewton = 200;

/// Contacts of a pair of shapes follow each other.
int endOfPair(const mjData& data, int first) noexcept {
  int end = first + 1;
  while (end < data.ncon && data.contact[end].geom1 == data.contact[first].geom1 &&
         data.contact[end].geom2 == data.contact[first].geom2) {
    ++end;
  }
  return end;
}

void shareFriction(mjData* data) noexcept {
  constexpr int kSliding = 3;  // rows of a contact without torsional friction
  for (int first = 0, end = 0; first < data->ncon; first = end) {
    end = endOfPair(*data, first);
    mjContact* const contacts = data->contact;
    if (end - first <= 2 || contacts[first].dim != kSliding) {
      continue;
    }
    const auto distance = [contacts, first](int c) {
      double between[3];
      mju_sub3(between, contacts[c].pos, contacts[first].pos);
      return mju_norm3(between);
    };
    int farthest = first + 1;
    for (int c = first + 2; c < end; ++c) {
      farthest = distance(c) > distance(farthest) ? c : farthest;
    }
    const double share = 0.5 * (end - first);
    for (int c = first; c < end; ++c) {
      if (c != first && c != farthest) {
        contacts[c].dim = 1;
        continue;
      }
      for (double& friction : contacts[c].friction) {
        friction *= share;
      }
    }
  }
}

/// Contacts between bodies that move independently of each other: a robot's own links do not.
int contactsOfMovingBodies(const mjModel& model, const mjData& data) noexcept {
  return static_cast<int>(
      std::count_if(data.contact, data.contact + data.ncon, [&model](const mjContact& contact) {
        const int body1 = model.geom_bodyid[contact.geom1];
        const int body2 = model.geom_bodyid[contact.geom2];
        return model.body_weldid[body1] != 0 && model.body_weldid[body2] != 0 &&
               model.body_rootid[body1] != model.body_rootid[body2];
      }));
}

}  // namespace

void firstHalf(const mjModel* model, mjData* data) {
  const mjWarningStat before = data->warning[mjWARN_CNSTRFULL];
  mj_step1(model, data);
  if (data->warning[mjWARN_CNSTRFULL].number == before.number) {
    return;
  }
  data->warning[mjWARN_CNSTRFULL] = before;
  shareFriction(data);
  mj_makeConstraint(model, data);
  mj_projectConstraint(model, data);
  mj_fwdVelocity(model, data);
}

void solveConstraints(const mjModel& model, mjData* data) {
  if (model.opt.solver != mjSOL_NEWTON || data->ncon <= kMaxContactsForNewton ||
      contactsOfMovingBodies(model, *data) <= kMaxContactsForNewton) {
    mj_fwdConstraint(&model, data);
    return;
  }
  mjModel with_gradients = model;  // the arrays are the model's own
  with_gradients.opt.solver = mjSOL_CG;
  mj_fwdConstraint(&with_gradients, data);
}

}  // namespace franka_sim::physics
