// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/gl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/osmesa.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "physics/run_time_library.h"

namespace franka_sim::physics {
namespace {

class EglContext final : public GlContext {
 public:
  EglContext() : library_("libEGL.so.1") {
    openDisplay();
    createContext();
    makeCurrent();
  }
  ~EglContext() override {
    release();
    destroy_context_(display_, context_);
  }
  void makeCurrent() override {
    // The API is bound per thread.
    call<decltype(&eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API);
    if (make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      throw std::runtime_error("EGL cannot make its context current");
    }
  }
  void release() noexcept override {
    make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  std::string name() const override { return "EGL"; }

 private:
  template <typename Function>
  Function call(const char* name) const {
    return library_.find<Function>(name);
  }

  void openDisplay() {
    const auto address = call<decltype(&eglGetProcAddress)>("eglGetProcAddress");
    const auto platformDisplay =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(address("eglGetPlatformDisplayEXT"));
    if (platformDisplay != nullptr) {
      display_ = platformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    }
    if (display_ == EGL_NO_DISPLAY ||
        call<decltype(&eglInitialize)>("eglInitialize")(display_, nullptr, nullptr) != EGL_TRUE) {
      throw std::runtime_error("EGL has no surfaceless display");
    }
  }

  void createContext() {
    call<decltype(&eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API);
    const EGLint attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                 EGL_NONE};
    EGLConfig config{};
    EGLint count = 0;
    call<decltype(&eglChooseConfig)>("eglChooseConfig")(display_, attributes, &config, 1, &count);
    context_ = call<decltype(&eglCreateContext)>("eglCreateContext")(
        display_, count > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT) {
      throw std::runtime_error("EGL gives no OpenGL context");
    }
  }

  RunTimeLibrary library_;
  // What release() and the destructor need, which must not fail.
  decltype(&eglMakeCurrent) make_current_{call<decltype(&eglMakeCurrent)>("eglMakeCurrent")};
  decltype(&eglDestroyContext) destroy_context_{
      call<decltype(&eglDestroyContext)>("eglDestroyContext")};
  EGLDisplay display_{EGL_NO_DISPLAY};
  EGLContext context_{EGL_NO_CONTEXT};
};

class OsMesaContext final : public GlContext {
 public:
  OsMesaContext() : library_("libOSMesa.so.8"), buffer_(4 * kSize * kSize) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              24,
                              OSMESA_STENCIL_BITS,
                              8,
                              OSMESA_PROFILE,
                              OSMESA_COMPAT_PROFILE,
                              0,
                              0};
    context_ = library_.find<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs")(
        attributes, nullptr);
    if (context_ == nullptr) {
      throw std::runtime_error("OSMesa gives no OpenGL context");
    }
    makeCurrent();
  }
  ~OsMesaContext() override { destroy_context_(context_); }
  void makeCurrent() override {
    if (make_current_(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSize, kSize) != GL_TRUE) {
      throw std::runtime_error("OSMesa cannot make its context current");
    }
  }
  void release() noexcept override { make_current_(nullptr, nullptr, 0, 0, 0); }
  std::string name() const override { return "OSMesa"; }

 private:
  static constexpr int kSize = 64;  ///< of the window; pictures go to a framebuffer object

  RunTimeLibrary library_;
  // What release() and the destructor need, which must not fail.
  decltype(&OSMesaMakeCurrent) make_current_{
      library_.find<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent")};
  decltype(&OSMesaDestroyContext) destroy_context_{
      library_.find<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")};
  std::vector<unsigned char> buffer_;
  OSMesaContext context_{nullptr};
};

/// The process that made the first context; 0 before. A driver's state is that of the process, too.
std::atomic<pid_t> gl_process{0};

template <typename Context>
std::unique_ptr<GlContext> attempt(const char* name, std::string* problems) {
  try {
    return std::make_unique<Context>();
  } catch (const std::runtime_error& error) {
    *problems += std::string(problems->empty() ? "" : "; ") + name + ": " + error.what();
    return nullptr;
  }
}

}  // namespace

bool isGlProcess() noexcept {
  const pid_t process = gl_process;
  return process == 0 || process == getpid();
}

void requireGlProcess() {
  if (!isGlProcess()) {
    throw std::runtime_error(
        "Pictures were drawn before this process was forked, and graphics drivers do not survive "
        "that. Draw in the other process, fork before the first picture, or start a new process "
        "(multiprocessing: the start method spawn).");
  }
}

std::unique_ptr<GlContext> makeGlContext() {
  requireGlProcess();
  const char* variable = std::getenv("FRANKA_SIM_RENDERER");
  const std::string requested = variable == nullptr ? "" : variable;
  if (!requested.empty() && requested != "egl" && requested != "osmesa") {
    throw std::runtime_error("The environment variable FRANKA_SIM_RENDERER is '" + requested +
                             "'; it can be egl or osmesa.");
  }
  gl_process = getpid();
  std::string problems;
  std::unique_ptr<GlContext> context;
  if (requested != "osmesa") {
    context = attempt<EglContext>("EGL", &problems);
  }
  if (!context && requested != "egl") {
    context = attempt<OsMesaContext>("OSMesa", &problems);
  }
  if (!context) {
    throw std::runtime_error("No pictures can be drawn (" + problems +
                             "); install the packages libegl1 and libgl1-mesa-dri, or libosmesa6.");
  }
  return context;
}

}  // namespace franka_sim::physics
