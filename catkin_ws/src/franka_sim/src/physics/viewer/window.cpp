// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/window.h>
#include <franka_sim/physics/world_pushes.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "physics/engine/engine_error.h"
#include "physics/engine/rotations.h"
#include "physics/pictures/scene_model.h"
#include "physics/viewer/glfw.h"
#include "physics/viewer/mouse_push.h"
#include "physics/viewer/pace_meter.h"

namespace franka_sim {

using physics::glfw;

namespace {

constexpr int kWidth = 1200, kHeight = 900;  ///< [pixel]
/// For what is shown besides the model's geoms (chosen here).
constexpr int kSpareWindowGeoms = 4000;
constexpr double kZoomStep = 0.05;
constexpr double kContactDot = 0.004;         ///< [m]
constexpr double kMetersPerNewton = 0.005;    ///< length of contact force arrows
constexpr std::uint64_t kMaxPushTicks = 100;  ///< [ticks], for each picture
constexpr float kOrange[4] = {0.95f, 0.45f, 0.1f, 1};
constexpr float kGreen[4] = {0.1f, 0.75f, 0.3f, 1};

// Two columns.
constexpr const char* kHelpKeys =
    "left button\nright button\nwheel\nCtrl + left button\nC\nF\nT\nR\nH";
constexpr const char* kHelpTexts =
    "turns\nshifts\nzooms\npushes a body\ncontacts and their forces\nframes of the bodies\n"
    "translucent bodies\nview as at the start\nthis help";

void toggle(mjtByte& flag) { flag = flag != 0 ? 0 : 1; }

}  // namespace

struct Window::Impl {
  const physics::Glfw& library{glfw()};  // without it there is nothing to destroy
  GLFWwindow* window{nullptr};
  physics::SceneModel drawn;
  mjvScene scene;
  mjrContext context;
  mjvCamera camera;
  mjvOption option;
  physics::MousePush push;
  PaceMeter pace;
  bool shows_contacts{false}, shows_help{false};
  double x{0}, y{0};

  Impl() {
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    mjv_defaultOption(&option);
    lookFromTheFront();
  }

  void lookFromTheFront() {
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
      library.destroyWindow(window);
    }
    library.terminate();
  }

  static Impl& of(GLFWwindow* window) {
    return *static_cast<Impl*>(glfw().getWindowUserPointer(window));
  }

  void connect() {
    glfw().setWindowUserPointer(window, this);
    glfw().setCursorPosCallback(window,
                                [](GLFWwindow* w, double x, double y) { of(w).moveMouse(x, y); });
    glfw().setMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
      if (button == GLFW_MOUSE_BUTTON_LEFT) {
        of(w).pressMouse(action == GLFW_PRESS && (modifiers & GLFW_MOD_CONTROL) != 0);
      }
    });
    glfw().setScrollCallback(window, [](GLFWwindow* w, double, double y) {
      of(w).moveCamera(mjMOUSE_ZOOM, 0, -kZoomStep * y);
    });
    glfw().setKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
      if (action == GLFW_PRESS) {
        of(w).press(key);
      }
    });
  }

  void pressMouse(bool pushes) {
    push.release();
    int width = 0, height = 0;
    glfw().getWindowSize(window, &width, &height);
    if (pushes && width > 0 && height > 0) {
      push.grab(drawn, option, scene, static_cast<double>(width) / height, x / width, y / height);
    }
  }

  void moveMouse(double to_x, double to_y) {
    int width = 0, height = 0;
    glfw().getWindowSize(window, &width, &height);
    const double dx = (to_x - x) / height, dy = (to_y - y) / height;
    x = to_x;
    y = to_y;
    if (push.holds()) {
      push.move(drawn, scene, dx, dy);
    } else if (glfw().getMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
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
    } else if (key == GLFW_KEY_R) {
      lookFromTheFront();
    } else if (key == GLFW_KEY_H || key == GLFW_KEY_F1) {
      shows_help = !shows_help;
    }
  }

  mjvGeom* nextGeom(int type, const double* at, const double* size, const float* color) {
    if (scene.ngeom >= scene.maxgeom) {
      return nullptr;
    }
    mjvGeom* geom = &scene.geoms[scene.ngeom++];
    mjv_initGeom(geom, type, size, at, nullptr, color);
    geom->category = mjCAT_DECOR;
    return geom;
  }

  void drawArrow(const double* from, const double* to, double dot, const float* color) {
    const double size[3] = {dot, dot, dot};
    nextGeom(mjGEOM_SPHERE, from, size, color);
    mjvGeom* arrow = nextGeom(mjGEOM_ARROW, from, nullptr, color);
    if (arrow != nullptr) {
      mjv_makeConnector(arrow, mjGEOM_ARROW, dot, from[0], from[1], from[2], to[0], to[1], to[2]);
    }
  }

  /// Draws a dot at each contact and an arrow for its force. The drawn model has visual shapes
  /// only, so contacts come from the simulation.
  void drawContacts(const std::vector<Contact>& contacts) {
    for (const Contact& contact : contacts) {
      double to[3];
      mju_addScl3(to, contact.position.data(), contact.force.data(), kMetersPerNewton);
      drawArrow(contact.position.data(), to, kContactDot, kOrange);
    }
  }

  void drawPush(const BodyPush& by_mouse) {
    drawArrow(by_mouse.point.data(), push.target(), 2 * kContactDot, kGreen);
  }

  void drawTexts(const mjrRect& area, const Scene& drawn_scene,
                 const std::vector<std::string>& lines) {
    std::string left = franka_core::fixedText(drawn_scene.time, 3) + " s";
    const std::string at_pace = pace.text(drawn_scene.time);
    left += at_pace.empty() ? "" : "   " + at_pace;
    for (const std::string& line : lines) {
      left += "\n" + line;
    }
    if (!drawn_scene.fault.empty()) {
      left += "\n" + drawn_scene.fault;
    }
    overlay(mjGRID_TOPLEFT, area, left.c_str(), nullptr);
    if (shows_help) {
      overlay(mjGRID_BOTTOMLEFT, area, kHelpKeys, kHelpTexts);
    } else {
      overlay(mjGRID_BOTTOMLEFT, area, "H", "help");
    }
    if (const std::optional<BodyPush> by_mouse = push.push()) {
      const std::string text = by_mouse->body + ": " +
                               franka_core::fixedText(mju_norm3(by_mouse->force.data()), 1) + " N";
      overlay(mjGRID_TOPRIGHT, area, text.c_str(), nullptr);
    }
  }

  void overlay(int place, const mjrRect& area, const char* left, const char* right) const {
    mjr_overlay(mjFONT_NORMAL, place, area, left, right, &context);
  }

  void load(const std::string& mjcf) {
    if (!drawn.load(mjcf)) {
      return;
    }
    mjModel* model = drawn.model();
    model->vis.quality.offsamples = 0;
    mjr_freeContext(&context);
    mjr_makeContext(model, &context, mjFONTSCALE_150);
    mjv_freeScene(&scene);
    mjv_makeScene(model, &scene, model->ngeom + kSpareWindowGeoms);
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

bool Window::draw(const Scene& scene, const std::vector<std::string>& lines) {
  const physics::EngineErrorScope scope;
  glfw().makeContextCurrent(impl_->window);
  impl_->load(scene.mjcf);
  impl_->drawn.pose(scene);
  impl_->push.update(impl_->drawn, scene.time);
  mjv_updateScene(impl_->drawn.model(), impl_->drawn.data(), &impl_->option, nullptr,
                  &impl_->camera, mjCAT_ALL, &impl_->scene);
  if (impl_->shows_contacts) {
    impl_->drawContacts(scene.contacts);
  }
  if (const std::optional<BodyPush> by_mouse = push()) {
    impl_->drawPush(*by_mouse);
  }
  mjrRect area{0, 0, 0, 0};
  glfw().getFramebufferSize(impl_->window, &area.width, &area.height);
  mjr_setBuffer(mjFB_WINDOW, &impl_->context);
  mjr_render(area, &impl_->scene, &impl_->context);
  impl_->drawTexts(area, scene, lines);
  glfw().swapBuffers(impl_->window);
  glfw().pollEvents();
  return glfw().windowShouldClose(impl_->window) == GLFW_FALSE;
}

std::optional<BodyPush> Window::push() const { return impl_->push.push(); }

void PushByMouse::act(World& world, const std::optional<BodyPush>& push) {
  const std::uint64_t now = world.ticks();
  const std::uint64_t passed = now > ticks_ ? now - ticks_ : 0;  // a reset begins at 0 again
  ticks_ = now;
  if (push && passed > 0 && !world.stopped()) {
    try {
      pushBody(world, push->body, push->force, {}, std::min(passed, kMaxPushTicks), push->point);
    } catch (const std::runtime_error&) {  // NOLINT(bugprone-empty-catch)
      // The body has been removed since the picture; the next picture does not show it.
    }
  }
}

}  // namespace franka_sim
