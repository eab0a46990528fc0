// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/window.h>
#include <mujoco/mujoco.h>

#include <optional>
#include <string>

#include "physics/pictures/scene_model.h"

namespace franka_sim::physics {

/// A push by the mouse: a point of a body is grabbed and pulled by a spring towards the mouse, in
/// the plane through that point that faces the camera. Called by one thread, with the window's
/// OpenGL context.
class MousePush {
 public:
  /// Grabs what is drawn at a place of the window, if it can move.
  /// @param x from the left, y from the top, as shares of the window
  void grab(SceneModel& drawn, const mjvOption& option, const mjvScene& scene, double aspect,
            double x, double y);
  /// Moves the mouse by shares of the window's height, to the right and downwards.
  void move(const SceneModel& drawn, const mjvScene& scene, double dx, double dy);
  void release() noexcept { grab_.reset(); }
  bool holds() const noexcept { return grab_.has_value(); }

  /// Computes the force in the world's present pose. Call once for each picture. @param time [s]
  void update(const SceneModel& drawn, double time);
  /// The push; empty if nothing is grabbed.
  std::optional<BodyPush> push() const;
  /// The point towards which the mouse pulls [m].
  const double* target() const noexcept { return grab_->target; }

 private:
  struct Grab {
    std::string body;
    int id;                ///< in the model that is drawn
    double local[3];       ///< the point in the body's frame
    double point[3];       ///< the same in the world
    double target[3];      ///< in the world
    double force[3];       ///< [N]
    double time;           ///< of the last update [s]
    double mass;           ///< of all that is attached [kg]
    bool is_free;          ///< not held by anything
    const mjModel* model;  ///< of the moment of the grab
  };

  std::optional<Grab> grab_;
};

}  // namespace franka_sim::physics
