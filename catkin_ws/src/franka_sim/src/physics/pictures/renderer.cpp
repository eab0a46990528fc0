// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/renderer.h>
#include <franka_sim/physics/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "physics/engine/engine_error.h"
#include "physics/engine/rotations.h"
#include "physics/pictures/gl_context.h"
#include "physics/pictures/scene_model.h"

namespace franka_sim {
namespace {

/// MuJoCo leaves out, without a warning, what a scene has no room for. Besides its geoms a model
/// has sites, tendons and skins (room chosen here).
constexpr int kSpareGeoms = 1000;

/// MuJoCo's free camera turns about the point it looks at.
mjvCamera freeCamera(const Camera& camera) {
  const Eigen::Vector3d from(camera.position.data());
  const Eigen::Vector3d to(camera.target.data());
  const Eigen::Vector3d line = to - from;
  if (!line.allFinite() || line.norm() < 1e-6) {
    throw std::runtime_error("The camera cannot look from a point to that same point.");
  }
  mjvCamera result;
  mjv_defaultCamera(&result);
  result.type = mjCAMERA_FREE;
  result.distance = line.norm();
  std::copy(camera.target.begin(), camera.target.end(), result.lookat);
  result.azimuth = std::atan2(line.y(), line.x()) / physics::kDegree;
  result.elevation = std::asin(line.z() / line.norm()) / physics::kDegree;
  return result;
}

void checkSize(int width, int height) {
  constexpr int kMax = Renderer::kMaxPictureSide;
  if (width < 1 || height < 1 || width > kMax || height > kMax) {
    throw std::runtime_error(
        "A picture of " + std::to_string(width) + " x " + std::to_string(height) +
        " pixels cannot be drawn; each side can have 1 to " + std::to_string(kMax) + ".");
  }
}

/// Converts the z-buffer (rows from the bottom) to distances (rows from the top). 1 is the far end
/// of the drawn range: no hit.
std::vector<float> toMeters(const std::vector<float>& buffer, const mjModel& model, int width,
                            int height) {
  const double near = model.vis.map.znear * model.stat.extent;
  const double far = model.vis.map.zfar * model.stat.extent;
  std::vector<float> meters(buffer.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double z = buffer[static_cast<std::size_t>(height - 1 - y) * width + x];
      meters[static_cast<std::size_t>(y) * width + x] =
          z >= 1 ? std::numeric_limits<float>::infinity()
                 : static_cast<float>(near * far / (far - z * (far - near)));
    }
  }
  return meters;
}

/// MuJoCo's cameras look along -z with y up; optical frames along z with y down.
Pose opticalFrame(const mjData& data, int camera) {
  Eigen::Matrix3d turn =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.cam_xmat + 9 * camera);
  turn.col(1) = -turn.col(1);
  turn.col(2) = -turn.col(2);
  const Eigen::Quaterniond q(turn);
  const double* p = data.cam_xpos + 3 * camera;
  return {{p[0], p[1], p[2]}, {q.w(), q.x(), q.y(), q.z()}};
}

}  // namespace

struct Renderer::Impl {
  std::unique_ptr<physics::GlContext> gl{physics::makeGlContext()};
  physics::SceneModel drawn;
  mjvScene scene;
  mjrContext context;

  Impl() {
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
  }
  ~Impl() {
    try {
      const physics::CurrentContext current(*gl);
      mjr_freeContext(&context);
    } catch (const std::runtime_error&) {  // NOLINT(bugprone-empty-catch)
      // What the driver holds ends with its context.
    }
    mjv_freeScene(&scene);
  }

  /// Compiles and uploads only if the set of objects changed or the picture is larger than the
  /// buffer.
  void prepare(const std::string& text, int width, int height) {
    const bool other_model = drawn.load(text);
    if (!other_model && width <= context.offWidth && height <= context.offHeight) {
      return;
    }
    mjModel* model = drawn.model();
    if (other_model) {
      mjv_freeScene(&scene);
      mjv_makeScene(model, &scene, model->ngeom + kSpareGeoms);
    }
    model->vis.global.offwidth = std::max(width, context.offWidth);
    model->vis.global.offheight = std::max(height, context.offHeight);
    model->vis.quality.offsamples = 0;
    mjr_freeContext(&context);
    mjr_makeContext(model, &context, mjFONTSCALE_100);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
    if (context.currentBuffer != mjFB_OFFSCREEN) {
      throw std::runtime_error("The graphics driver (" + gl->name() +
                               ") gives no buffer to draw pictures into.");
    }
  }

  /// Draws in the picture's size. @param depth null or an array with one entry per pixel
  void draw(mjvCamera* view, float* depth, Picture* picture) {
    mjvOption option;
    mjv_defaultOption(&option);
    mjv_updateScene(drawn.model(), drawn.data(), &option, nullptr, view, mjCAT_ALL, &scene);
    const mjrRect area{0, 0, picture->width, picture->height};
    mjr_render(area, &scene, &context);
    const std::size_t row = 3u * picture->width;
    std::vector<std::uint8_t> upside_down(row * picture->height);
    mjr_readPixels(upside_down.data(), depth, area, &context);
    picture->rgb.resize(upside_down.size());
    for (int y = 0; y < picture->height; ++y) {
      std::copy_n(upside_down.begin() + row * (picture->height - 1 - y), row,
                  picture->rgb.begin() + row * y);
    }
  }
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() {
  if (!physics::isGlProcess()) {
    impl_.release();  // NOLINT(bugprone-unused-return-value): its driver cannot be used here
  }
}

std::string Renderer::backend() const { return impl_->gl->name(); }

Picture Renderer::render(const Scene& scene, const Camera& camera, int width, int height) {
  checkSize(width, height);
  if (!(camera.field_of_view > 1 && camera.field_of_view < 170)) {
    throw std::runtime_error("The camera's field of view must lie between 1 and 170 degrees.");
  }
  mjvCamera view = freeCamera(camera);
  const physics::EngineErrorScope scope;
  const physics::CurrentContext current(*impl_->gl);
  impl_->prepare(scene.mjcf, width, height);
  impl_->drawn.pose(scene);
  impl_->drawn.model()->vis.global.fovy = static_cast<float>(camera.field_of_view);
  Picture picture;
  picture.width = width;
  picture.height = height;
  impl_->draw(&view, nullptr, &picture);
  return picture;
}

Picture Renderer::render(const Scene& scene, const std::string& camera, int width, int height) {
  checkSize(width, height);
  const physics::EngineErrorScope scope;
  const physics::CurrentContext current(*impl_->gl);
  impl_->prepare(scene.mjcf, width, height);
  impl_->drawn.pose(scene);
  const mjModel& model = *impl_->drawn.model();
  const int id = mj_name2id(&model, mjOBJ_CAMERA, camera.c_str());
  if (id < 0) {
    throw std::runtime_error("There is no camera '" + camera + "' in the simulated world.");
  }
  mjvCamera view;
  mjv_defaultCamera(&view);
  view.type = mjCAMERA_FIXED;
  view.fixedcamid = id;
  Picture picture;
  picture.width = width;
  picture.height = height;
  std::vector<float> depth(static_cast<std::size_t>(width) * height);
  impl_->draw(&view, depth.data(), &picture);
  picture.depth = toMeters(depth, model, width, height);
  picture.camera = opticalFrame(*impl_->drawn.data(), id);
  return picture;
}

}  // namespace franka_sim
