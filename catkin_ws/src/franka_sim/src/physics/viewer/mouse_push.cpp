// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/viewer/mouse_push.h"

#include <algorithm>
#include <cmath>

#include "physics/engine/rotations.h"

namespace franka_sim::physics {

namespace {

// Chosen here: 10 cm of the mouse give 15 N, below the thresholds of a collision by default.
constexpr double kStiffness = 150;     ///< [N/m]
constexpr double kMaxForce = 100;      ///< [N]
constexpr double kFrequency = 8;       ///< of a light body on the spring [rad/s]
constexpr double kMaxPhase = 0.5;      ///< of its swing between two pictures [rad]
constexpr double kDampingRatio = 0.7;  ///< of free bodies

bool isFree(const mjModel& model, int body) {
  return model.body_jntnum[body] > 0 && model.jnt_type[model.body_jntadr[body]] == mjJNT_FREE;
}

/// The geom that is drawn at a place of the window; -1: none. @param point on its surface
int geomAt(const mjModel* model, const mjData* data, const mjvOption& option, const mjvScene& scene,
           double aspect, double x, double y, double* point) {
  int geom = -1, skin = -1;
#if mjVERSION_HEADER >= 300
  int flex = -1;
  mjv_select(model, data, &option, aspect, x, 1 - y, &scene, point, &geom, &flex, &skin);
#else
  mjv_select(model, data, &option, aspect, x, 1 - y, &scene, point, &geom, &skin);
#endif
  return geom;
}

}  // namespace

void MousePush::grab(SceneModel& drawn, const mjvOption& option, const mjvScene& scene,
                     double aspect, double x, double y) {
  release();
  const mjModel* model = drawn.model();
  if (model == nullptr) {
    return;
  }
  double point[3];
  const int geom = geomAt(model, drawn.data(), option, scene, aspect, x, y, point);
  if (geom < 0) {
    return;
  }
  const int body = model->geom_bodyid[geom];
  const char* name = mj_id2name(model, mjOBJ_BODY, body);
  if (model->body_weldid[body] == 0 || name == nullptr) {
    return;  // it is a part of the ground, or has no name
  }
  Grab grab{name, body, {}, {}, {}, {}, -1, 0, false, model};
  std::copy_n(point, 3, grab.point);
  std::copy_n(point, 3, grab.target);
  const mjData* data = drawn.data();
  double offset[3];
  mju_sub3(offset, point, data->xpos + 3 * body);
  mju_rotVecMatT(grab.local, offset, data->xmat + 9 * body);
  grab.mass = model->body_subtreemass[model->body_rootid[body]];
  grab.is_free = isFree(*model, model->body_rootid[body]);
  grab_ = grab;
}

void MousePush::move(const SceneModel& drawn, const mjvScene& scene, double dx, double dy) {
  if (!grab_) {
    return;
  }
  double eye[3], ahead[3], up[3], right[3], way[3];
  mjv_cameraInModel(eye, ahead, up, &scene);
  mju_cross(right, ahead, up);
  mju_sub3(way, grab_->target, eye);
  const double height =
      2 * mju_dot3(way, ahead) * std::tan(0.5 * kDegree * drawn.model()->vis.global.fovy);
  mju_addToScl3(grab_->target, right, height * dx);
  mju_addToScl3(grab_->target, up, -height * dy);
}

void MousePush::update(const SceneModel& drawn, double time) {
  if (!grab_) {
    return;
  }
  if (drawn.model() != grab_->model) {
    release();  // something came or went
    return;
  }
  double point[3], velocity[3]{};
  mju_rotVecMat(point, grab_->local, drawn.data()->xmat + 9 * grab_->id);
  mju_addTo3(point, drawn.data()->xpos + 3 * grab_->id);
  double frequency = kFrequency;
  if (grab_->time >= 0 && time > grab_->time) {
    const double passed = time - grab_->time;
    mju_sub3(velocity, point, grab_->point);
    mju_scl3(velocity, velocity, 1 / passed);
    // A delayed spring force would increase the oscillation.
    frequency = std::min(kFrequency, kMaxPhase / passed);
  }
  const double stiffness = std::min(kStiffness, grab_->mass * frequency * frequency);
  mju_sub3(grab_->force, grab_->target, point);
  mju_scl3(grab_->force, grab_->force, stiffness);
  if (grab_->is_free) {
    mju_addToScl3(grab_->force, velocity, -2 * kDampingRatio * std::sqrt(stiffness * grab_->mass));
  }
  const double size = mju_norm3(grab_->force);
  if (size > kMaxForce) {
    mju_scl3(grab_->force, grab_->force, kMaxForce / size);
  }
  std::copy_n(point, 3, grab_->point);
  grab_->time = time;
}

std::optional<BodyPush> MousePush::push() const {
  if (!grab_) {
    return std::nullopt;
  }
  BodyPush push{grab_->body, {}, {}};
  std::copy_n(grab_->point, 3, push.point.begin());
  std::copy_n(grab_->force, 3, push.force.begin());
  return push;
}

}  // namespace franka_sim::physics
