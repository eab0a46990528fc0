// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/osmesa.h>
#include <franka_sim/physics/renderer.h>
#include <franka_sim/physics/scene.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_joints.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

#include "physics/pictures/gl_context.h"
#include "physics/pictures/run_time_library.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

std::array<int, 3> pixel(const Picture& picture, int x, int y) {
  const std::uint8_t* p = &picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width + x)];
  return {p[0], p[1], p[2]};
}

/// MuJoCo loads OpenGL once per process, so all tests share one renderer.
class RendererTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    renderer_ = std::make_unique<Renderer>();
    world_ = std::make_unique<World>(test::world("stone"));
    RobotDescription description = robot("panda");
    description.base.position = {-0.5, 0, 0};
    world_->addRobot(description);
  }
  static void TearDownTestSuite() {
    renderer_.reset();
    world_.reset();
  }
  /// Over a point 0.15 m in front of the trays, which lie side by side.
  static Camera above() {
    Camera camera;
    camera.position = {0.16, 0, 2.0};
    camera.target = {0.15, 0, 0.42};
    return camera;
  }

  static std::unique_ptr<Renderer> renderer_;
  static std::unique_ptr<World> world_;
};

std::unique_ptr<Renderer> RendererTest::renderer_;
std::unique_ptr<World> RendererTest::world_;

TEST_F(RendererTest, UsesTheRequestedBackend) {
  const char* requested = std::getenv("FRANKA_SIM_RENDERER");
  const std::string backend = renderer_->backend();
  if (requested == nullptr) {
    EXPECT_TRUE(backend == "EGL" || backend == "OSMesa");
  } else {
    EXPECT_EQ(std::string(requested) == "egl" ? "EGL" : "OSMesa", backend);
  }
}

/// The camera looks down and a little back: x of the world points down in the picture, y to the
/// right.
TEST_F(RendererTest, ShowsTheTraysAtTheirPositions) {
  const Picture picture = renderer_->render(captureScene(*world_), above(), 320, 240);
  ASSERT_EQ(3u * 320 * 240, picture.rgb.size());
  std::array<double, 2> blue_sum{}, red_sum{};
  int blue = 0, red = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const auto [r, g, b] = pixel(picture, x, y);
      if (b > 100 && b > 2 * r) {
        ++blue;
        blue_sum[0] += x;
        blue_sum[1] += y;
      } else if (r > 80 && r > 2 * b && r > 2 * g) {
        ++red;
        red_sum[0] += x;
        red_sum[1] += y;
      }
    }
  }
  ASSERT_GT(blue, 200);
  ASSERT_GT(red, 200);
  const double blue_x = blue_sum[0] / blue, red_x = red_sum[0] / red;
  EXPECT_NEAR(160, 0.5 * (blue_x + red_x), 15);
  EXPECT_GT(red_x - blue_x, 40) << "the blue tray is to the left";
  EXPECT_LT(blue_sum[1] / blue, 110) << "and both are in the upper half";
  EXPECT_LT(red_sum[1] / red, 110);
}

TEST_F(RendererTest, ShowsTheRobotAndTheStoneMoving) {
  const auto rgb = [] { return renderer_->render(captureScene(*world_), Camera(), 200, 150).rgb; };
  const auto before = rgb();
  setJointPosition(*world_, "panda_joint1", 0.8);
  EXPECT_NE(before, rgb());
  setJointPosition(*world_, "panda_joint1", 0.0);
  EXPECT_EQ(before, rgb());
  Pose other = bodyPose(*world_, "stone");
  other.position[1] = 0.219654;
  setBodyPose(*world_, "stone", other);
  EXPECT_NE(before, rgb());
}

TEST_F(RendererTest, ShowsLightsAsTheyAreSet) {
  World empty;
  const auto rgb = [&] { return renderer_->render(captureScene(empty), Camera(), 64, 48).rgb; };
  const auto sum = [](const std::vector<std::uint8_t>& values) {
    return std::accumulate(values.begin(), values.end(), 0);
  };
  const auto before = rgb();
  WorldLight changed = light(empty, "sun");
  changed.diffuse = {0.1, 0.1, 0.1};
  setLight(empty, "sun", changed);
  const auto dim = rgb();
  EXPECT_LT(sum(dim), sum(before));
  changed.on = false;
  setLight(empty, "sun", changed);
  EXPECT_LT(sum(rgb()), sum(dim));
  World other;
  EXPECT_EQ(before, renderer_->render(captureScene(other), Camera(), 64, 48).rgb);
}

TEST_F(RendererTest, LeavesOutNoneOfManyGeoms) {
  std::string geoms;
  for (int i = 0; i < 4500; i++) {
    geoms += "<geom type='box' size='.001 .001 .001' pos='0 0 -9' rgba='0 0 1 1'/>";
  }
  const franka_test::TemporaryFolder folder;
  World many(folder.write("many.xml", "<mujoco><worldbody><light pos='0 0 3'/>" + geoms +
                                          "<geom type='box' size='1 1 1' rgba='1 0 0 1'/>"
                                          "</worldbody></mujoco>"));
  const std::array<int, 3> center =
      pixel(renderer_->render(captureScene(many), above(), 32, 24), 16, 12);
  EXPECT_GT(center[0], 2 * center[2]) << "the last geom, red, fills the picture";
}

TEST_F(RendererTest, RefusesInvalidSizesAndCameras) {
  const Scene scene = captureScene(*world_);
  expectSentence([&] { renderer_->render(scene, above(), 0, 10); }, {"0 x 10"});
  expectSentence([&] { renderer_->render(scene, above(), 100, 100000); }, {"100000"});
  Camera camera;
  camera.target = camera.position;
  expectSentence([&] { renderer_->render(scene, camera, 10, 10); }, {"camera"});
  camera = Camera();
  camera.field_of_view = 200;
  expectSentence([&] { renderer_->render(scene, camera, 10, 10); }, {"field of view"});
}

TEST_F(RendererTest, DrawsAfterAnotherRendererHasEnded) {
  const Scene scene = captureScene(*world_);
  const Picture before = renderer_->render(scene, above(), 200, 100);
  {
    Renderer other;
    EXPECT_EQ(before.rgb, other.render(captureScene(*world_), above(), 200, 100).rgb);
    EXPECT_EQ(1000, renderer_->render(scene, above(), 1000, 800).width);  // the buffer grows
  }
  EXPECT_EQ(before.rgb, renderer_->render(scene, above(), 200, 100).rgb);
}

TEST_F(RendererTest, RenderersOfSeveralThreadsWaitForEachOther) {
  const Scene scene = captureScene(*world_);
  const Picture expected = renderer_->render(scene, above(), 64, 48);
  Renderer made_here;  // and used there
  std::array<int, 3> equal{};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < equal.size(); i++) {
    threads.emplace_back([&, i] {
      const auto own = i == 0 ? nullptr : std::make_unique<Renderer>();
      Renderer& renderer = own ? *own : made_here;
      for (int k = 0; k < 5; k++) {
        equal[i] += renderer.render(scene, above(), 64, 48).rgb == expected.rgb ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ((std::array<int, 3>{5, 5, 5}), equal);
}

/// A program may draw with contexts of its own.
TEST_F(RendererTest, LeavesTheContextOfTheCallersThreadCurrent) {
  if (renderer_->backend() == "EGL") {
    const physics::RunTimeLibrary egl("libEGL.so.1");
    const auto current = egl.find<decltype(&eglGetCurrentContext)>("eglGetCurrentContext");
    const auto make_current = egl.find<decltype(&eglMakeCurrent)>("eglMakeCurrent");
    const auto address = egl.find<decltype(&eglGetProcAddress)>("eglGetProcAddress");
    const auto display_of =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(address("eglGetPlatformDisplayEXT"));
    EGLDisplay display = display_of(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    egl.find<decltype(&eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API);
    EGLContext own = egl.find<decltype(&eglCreateContext)>("eglCreateContext")(
        display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    ASSERT_EQ(EGL_TRUE, make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, own));
    renderer_->render(captureScene(*world_), above(), 64, 48);
    EXPECT_EQ(own, current());
    {
      Renderer other;
    }
    EXPECT_EQ(own, current());
    make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl.find<decltype(&eglDestroyContext)>("eglDestroyContext")(display, own);
  } else {
    const physics::RunTimeLibrary mesa("libOSMesa.so.8");
    const auto current = mesa.find<decltype(&OSMesaGetCurrentContext)>("OSMesaGetCurrentContext");
    OSMesaContext own =
        mesa.find<decltype(&OSMesaCreateContext)>("OSMesaCreateContext")(OSMESA_RGBA, nullptr);
    std::array<unsigned char, 4 * 16 * 16> buffer;
    ASSERT_EQ(GL_TRUE, mesa.find<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent")(
                           own, buffer.data(), GL_UNSIGNED_BYTE, 16, 16));
    renderer_->render(captureScene(*world_), above(), 64, 48);
    EXPECT_EQ(own, current());
    {
      Renderer other;
    }
    EXPECT_EQ(own, current());
    mesa.find<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")(own);
  }
}

TEST(RendererChoice, RefusesUnknownBackends) {
  const char* requested = std::getenv("FRANKA_SIM_RENDERER");
  const std::string kept = requested == nullptr ? "" : requested;
  setenv("FRANKA_SIM_RENDERER", "vulkan", 1);
  expectSentence([] { Renderer renderer; }, {"FRANKA_SIM_RENDERER", "vulkan", "osmesa"});
  if (requested == nullptr) {
    unsetenv("FRANKA_SIM_RENDERER");
  } else {
    setenv("FRANKA_SIM_RENDERER", kept.c_str(), 1);
  }
}

}  // namespace
}  // namespace franka_sim::test
