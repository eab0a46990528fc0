// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/pictures/gl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/osmesa.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "physics/pictures/run_time_library.h"

namespace franka_sim::physics {
namespace {

class EglContext final : public GlContext {
 public:
  EglContext() : library_("libEGL.so.1") {
    openDisplay();
    createContext();
    makeCurrent();
    release();
  }
  ~EglContext() override { destroy_context_(display_, context_); }
  void makeCurrent() override {
    // The API and what is current in it are those of the thread.
    before_.api = query_api_();
    before_.context = current_context_();
    before_.display = current_display_();
    before_.draw = current_surface_(EGL_DRAW);
    before_.read = current_surface_(EGL_READ);
    bind_api_(EGL_OPENGL_API);
    if (make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      bind_api_(before_.api);
      throw std::runtime_error("EGL cannot make its context current");
    }
  }
  void release() noexcept override {
    make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    bind_api_(before_.api);
    if (before_.context != EGL_NO_CONTEXT) {
      make_current_(before_.display, before_.draw, before_.read, before_.context);
    }
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
    const EGLenum api = query_api_();
    bind_api_(EGL_OPENGL_API);
    const EGLint attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                 EGL_NONE};
    EGLConfig config{};
    EGLint count = 0;
    call<decltype(&eglChooseConfig)>("eglChooseConfig")(display_, attributes, &config, 1, &count);
    context_ = call<decltype(&eglCreateContext)>("eglCreateContext")(
        display_, count > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    bind_api_(api);
    if (context_ == EGL_NO_CONTEXT) {
      throw std::runtime_error("EGL gives no OpenGL context");
    }
  }

  /// What was current in the thread.
  struct Before {
    EGLenum api;
    EGLContext context;
    EGLDisplay display;
    EGLSurface draw, read;
  };

  RunTimeLibrary library_;
  // What release() and the destructor need, which must not fail.
  decltype(&eglQueryAPI) query_api_{call<decltype(&eglQueryAPI)>("eglQueryAPI")};
  decltype(&eglBindAPI) bind_api_{call<decltype(&eglBindAPI)>("eglBindAPI")};
  decltype(&eglGetCurrentContext) current_context_{
      call<decltype(&eglGetCurrentContext)>("eglGetCurrentContext")};
  decltype(&eglGetCurrentDisplay) current_display_{
      call<decltype(&eglGetCurrentDisplay)>("eglGetCurrentDisplay")};
  decltype(&eglGetCurrentSurface) current_surface_{
      call<decltype(&eglGetCurrentSurface)>("eglGetCurrentSurface")};
  decltype(&eglMakeCurrent) make_current_{call<decltype(&eglMakeCurrent)>("eglMakeCurrent")};
  decltype(&eglDestroyContext) destroy_context_{
      call<decltype(&eglDestroyContext)>("eglDestroyContext")};
  EGLDisplay display_{EGL_NO_DISPLAY};
  EGLContext context_{EGL_NO_CONTEXT};
  Before before_{};
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
    release();
  }
  ~OsMesaContext() override { destroy_context_(context_); }
  void makeCurrent() override {
    before_.context = current_context_();
    if (before_.context != nullptr) {
      GLint format = 0;
      get_integer_(OSMESA_TYPE, &before_.type);
      get_buffer_(before_.context, &before_.width, &before_.height, &format, &before_.buffer);
    }
    if (make_current_(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSize, kSize) != GL_TRUE) {
      throw std::runtime_error("OSMesa cannot make its context current");
    }
  }
  void release() noexcept override {
    make_current_(nullptr, nullptr, 0, 0, 0);
    if (before_.context != nullptr && before_.buffer != nullptr) {
      make_current_(before_.context, before_.buffer, static_cast<GLenum>(before_.type),
                    before_.width, before_.height);
    }
  }
  std::string name() const override { return "OSMesa"; }

 private:
  /// What was current in the thread.
  struct Before {
    OSMesaContext context;
    void* buffer;
    GLint type, width, height;
  };
  static constexpr int kSize = 64;  ///< of the window; pictures go to a framebuffer object

  RunTimeLibrary library_;
  // What release() and the destructor need, which must not fail.
  decltype(&OSMesaMakeCurrent) make_current_{
      library_.find<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent")};
  decltype(&OSMesaDestroyContext) destroy_context_{
      library_.find<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")};
  decltype(&OSMesaGetCurrentContext) current_context_{
      library_.find<decltype(&OSMesaGetCurrentContext)>("OSMesaGetCurrentContext")};
  decltype(&OSMesaGetIntegerv) get_integer_{
      library_.find<decltype(&OSMesaGetIntegerv)>("OSMesaGetIntegerv")};
  decltype(&OSMesaGetColorBuffer) get_buffer_{
      library_.find<decltype(&OSMesaGetColorBuffer)>("OSMesaGetColorBuffer")};
  std::vector<unsigned char> buffer_;
  OSMesaContext context_{nullptr};
  Before before_{};
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

/// Drivers, and MuJoCo's table of their functions, are used by one thread at a time.
std::mutex gl_mutex;

/// In a forked process another thread may have held the mutex, which nobody releases there.
std::unique_lock<std::mutex> lockGl() {
  requireGlProcess();
  return std::unique_lock<std::mutex>(gl_mutex);
}

}  // namespace

CurrentContext::CurrentContext(GlContext& context) : lock_(lockGl()), context_(context) {
  context_.makeCurrent();
}
CurrentContext::~CurrentContext() { context_.release(); }

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
  const std::lock_guard<std::mutex> lock(gl_mutex);
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
