// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/window.h>

#include <stdexcept>

#include "physics/glfw.h"
#include "physics/scene_model.h"

namespace franka_sim {

using physics::glfw;

namespace {

constexpr int kWidth = 1200, kHeight = 900;  ///< [pixel]
constexpr int kMostGeoms = 4000;
constexpr double kZoomStep = 0.05;
constexpr double kContactDot = 0.004;       ///< [m]
constexpr double kMetresPerNewton = 0.005;  ///< length of contact force arrows

void toggle(mjtByte& flag) { flag = flag != 0 ? 0 : 1; }

}  // namespace

struct Window::Impl {
  GLFWwindow* window{nullptr};
  physics::SceneModel drawn;
  mjvScene scene;
  mjrContext context;
  mjvCamera camera;
  mjvOption option;
  bool shows_contacts{false};
  double x{0}, y{0};

  Impl() {
    glfw();  // without the library there is nothing to destroy
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    mjv_defaultOption(&option);
    mjv_defaultCamera(&camera);
    camera.lookat[2] = 0.4;
    camera.distance = 2.2;
    camera.azimuth = 140;
    camera.elevation = -20;
  }

  ~Impl() {
    if (window != nullptr) {
      mjr_freeContext(&context);
      mjv_freeScene(&scene);
      glfw().destroyWindow(window);
    }
    glfw().terminate();
  }

  static Impl& of(GLFWwindow* window) {
    return *static_cast<Impl*>(glfw().getWindowUserPointer(window));
  }

  void connect() {
    glfw().setWindowUserPointer(window, this);
    glfw().setCursorPosCallback(window,
                                [](GLFWwindow* w, double x, double y) { of(w).moveMouse(x, y); });
    glfw().setScrollCallback(window, [](GLFWwindow* w, double, double y) {
      of(w).moveCamera(mjMOUSE_ZOOM, 0, -kZoomStep * y);
    });
    glfw().setKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
      if (action == GLFW_PRESS) {
        of(w).press(key);
      }
    });
  }

  void moveMouse(double to_x, double to_y) {
    int width = 0, height = 0;
    glfw().getWindowSize(window, &width, &height);
    const double dx = (to_x - x) / height, dy = (to_y - y) / height;
    x = to_x;
    y = to_y;
    if (glfw().getMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
      moveCamera(mjMOUSE_ROTATE_H, dx, 0);
      moveCamera(mjMOUSE_ROTATE_V, 0, dy);
    } else if (glfw().getMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS) {
      moveCamera(mjMOUSE_MOVE_V, dx, dy);
    }
  }

  void moveCamera(int action, double dx, double dy) {
    if (drawn.model() != nullptr) {
      mjv_moveCamera(drawn.model(), action, dx, dy, &scene, &camera);
    }
  }

  void press(int key) {
    if (key == GLFW_KEY_C) {
      shows_contacts = !shows_contacts;
    } else if (key == GLFW_KEY_F) {
      option.frame = option.frame == mjFRAME_NONE ? mjFRAME_BODY : mjFRAME_NONE;
    } else if (key == GLFW_KEY_T) {
      toggle(option.flags[mjVIS_TRANSPARENT]);
    }
  }

  mjvGeom* nextGeom(int type, const std::array<double, 3>& at, const double* size) {
    if (scene.ngeom >= scene.maxgeom) {
      return nullptr;
    }
    const float colour[4] = {0.95f, 0.45f, 0.1f, 1};
    mjvGeom* geom = &scene.geoms[scene.ngeom++];
    mjv_initGeom(geom, type, size, at.data(), nullptr, colour);
    geom->category = mjCAT_DECOR;
    return geom;
  }

  /// Draws a dot at each contact and an arrow for its force. The drawn model has visual shapes
  /// only, so contacts come from the simulation.
  void drawContacts(const std::vector<Contact>& contacts) {
    for (const Contact& contact : contacts) {
      const double dot[3] = {kContactDot, kContactDot, kContactDot};
      nextGeom(mjGEOM_SPHERE, contact.position, dot);
      mjvGeom* arrow = nextGeom(mjGEOM_ARROW, contact.position, nullptr);
      if (arrow != nullptr) {
        const std::array<double, 3>& from = contact.position;
        const std::array<double, 3>& f = contact.force;
        mjv_makeConnector(arrow, mjGEOM_ARROW, kContactDot, from[0], from[1], from[2],
                          from[0] + kMetresPerNewton * f[0], from[1] + kMetresPerNewton * f[1],
                          from[2] + kMetresPerNewton * f[2]);
      }
    }
  }

  void load(const std::string& mjcf) {
    if (!drawn.load(mjcf)) {
      return;
    }
    mjModel* model = drawn.model();
    model->vis.quality.offsamples = 0;
    mjr_freeContext(&context);
    mjr_makeContext(model, &context, mjFONTSCALE_100);
    mjv_freeScene(&scene);
    mjv_makeScene(model, &scene, kMostGeoms);
  }
};

Window::Window(const std::string& title) : impl_(std::make_unique<Impl>()) {
  if (glfw().init() == GLFW_FALSE) {
    throw std::runtime_error(
        "There is no display for the simulation's window: set DISPLAY, or start without the window "
        "(without --viewer; in ROS headless:=true).");
  }
  impl_->window = glfw().createWindow(kWidth, kHeight, title.c_str(), nullptr, nullptr);
  if (impl_->window == nullptr) {
    throw std::runtime_error(
        "The display gives no OpenGL window; start without it (without --viewer; in ROS "
        "headless:=true).");
  }
  glfw().makeContextCurrent(impl_->window);
  glfw().swapInterval(0);
  impl_->connect();
}

Window::~Window() = default;

bool Window::draw(const Scene& scene) {
  glfw().makeContextCurrent(impl_->window);
  impl_->load(scene.mjcf);
  impl_->drawn.pose(scene);
  mjv_updateScene(impl_->drawn.model(), impl_->drawn.data(), &impl_->option, nullptr,
                  &impl_->camera, mjCAT_ALL, &impl_->scene);
  if (impl_->shows_contacts) {
    impl_->drawContacts(scene.contacts);
  }
  mjrRect area{0, 0, 0, 0};
  glfw().getFramebufferSize(impl_->window, &area.width, &area.height);
  mjr_setBuffer(mjFB_WINDOW, &impl_->context);
  mjr_render(area, &impl_->scene, &impl_->context);
  glfw().swapBuffers(impl_->window);
  glfw().pollEvents();
  return glfw().windowShouldClose(impl_->window) == GLFW_FALSE;
}

}  // namespace franka_sim
