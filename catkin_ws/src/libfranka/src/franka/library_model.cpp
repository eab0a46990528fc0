// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <fcntl.h>
#include <franka/exception.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

#include "franka/model_source.h"
#include "network/endpoint.h"

namespace franka {

namespace {

// Functions of the shared object (protocol 8.1). Index 0 to 6: joints, 7: flange, 8: end effector.
using PoseOfJoint = void (*)(const double q[7], double out[16]);
using PoseOfEndEffector = void (*)(const double q[7], const double F_T_EE[16], double out[16]);
using FirstJacobian = void (*)(double out[42]);
using JacobianOfJoint = void (*)(const double q[7], double out[42]);
using JacobianOfEndEffector = void (*)(const double q[7], const double F_T_EE[16], double out[42]);
using Mass = void (*)(const double q[7], const double I_total[9], double m_total,
                      const double F_x_Ctotal[3], double out[49]);
using Coriolis = void (*)(const double q[7], const double dq[7], const double I_total[9],
                          double m_total, const double F_x_Ctotal[3], double out[7]);
using Gravity = void (*)(const double q[7], const double g_earth[3], double m_total,
                         const double F_x_Ctotal[3], double out[7]);

std::array<double, 16> multiply(const std::array<double, 16>& a, const std::array<double, 16>& b) {
  std::array<double, 16> product{};
  for (std::size_t column = 0; column < 4; column++) {
    for (std::size_t row = 0; row < 4; row++) {
      for (std::size_t k = 0; k < 4; k++) {
        product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
      }
    }
  }
  return product;
}

/// Whether all segments that the loader maps are present: it would crash on access beyond the end
/// of a truncated file.
bool isComplete(const std::vector<std::uint8_t>& object) {
  ElfW(Ehdr) header;
  if (object.size() < sizeof(header)) {
    return false;
  }
  std::memcpy(&header, object.data(), sizeof(header));
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
      header.e_phentsize != sizeof(ElfW(Phdr))) {
    return false;
  }
  const auto ends_within = [&object](std::size_t offset, std::size_t size) {
    return offset <= object.size() && size <= object.size() - offset;
  };
  if (!ends_within(header.e_phoff, header.e_phnum * sizeof(ElfW(Phdr)))) {
    return false;
  }
  for (std::size_t i = 0; i < header.e_phnum; i++) {
    ElfW(Phdr) segment;
    std::memcpy(&segment, object.data() + header.e_phoff + i * sizeof(segment), sizeof(segment));
    if (segment.p_type == PT_LOAD && !ends_within(segment.p_offset, segment.p_filesz)) {
      return false;
    }
  }
  return true;
}

std::string pathOf(const network::Descriptor& memory) {
  return "/proc/self/fd/" + std::to_string(memory.get());
}

/// Whether the loader has an object under this path.
bool isLoaded(const std::string& path) {
  void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD);
  if (handle != nullptr) {
    dlclose(handle);
  }
  return handle != nullptr;
}

/// The bytes as a file in memory, under a path that is new to the loader: for a known path, it
/// would return the known object instead of reading the file. Known paths remain from objects that
/// the loader keeps although they were closed, and in a forked process that closed its parent's
/// files.
network::Descriptor inMemory(const std::vector<std::uint8_t>& bytes) {
  network::Descriptor memory(memfd_create("franka_model", MFD_CLOEXEC));
  std::size_t written = 0;
  while (memory.get() >= 0 && written < bytes.size()) {
    const ssize_t count = write(memory.get(), bytes.data() + written, bytes.size() - written);
    if (count <= 0 && errno != EINTR) {
      break;
    }
    written += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  if (memory.get() < 0 || written < bytes.size()) {
    throw ModelException(network::systemError("Cannot keep the model library", errno));
  }
  while (isLoaded(pathOf(memory))) {
    memory = network::Descriptor(fcntl(memory.get(), F_DUPFD_CLOEXEC, memory.get() + 1));
    if (memory.get() < 0) {
      throw ModelException(network::systemError("Cannot keep the model library", errno));
    }
  }
  return memory;
}

/// A loaded shared object. Never written to disk.
class SharedObject {
 public:
  explicit SharedObject(const std::vector<std::uint8_t>& bytes) {
    if (!isComplete(bytes)) {
      throw ModelException(
          "libfranka: The model library that the robot sent is not a whole shared object for this "
          "machine's kind of processor (" +
          std::to_string(bytes.size()) + " bytes arrived).");
    }
    memory_ = inMemory(bytes);
    handle_ = dlopen(pathOf(memory_).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ == nullptr) {
      throw ModelException(std::string("libfranka: Cannot load the model library that the robot "
                                       "sent (") +
                           dlerror() + "). It must be made for this machine's kind of processor.");
    }
  }
  ~SharedObject() {
    if (handle_ != nullptr) {
      dlclose(handle_);
    }
  }
  SharedObject(const SharedObject&) = delete;
  SharedObject& operator=(const SharedObject&) = delete;

  template <typename Function>
  Function get(const std::string& name) const {
    void* const symbol = dlsym(handle_, name.c_str());
    if (symbol == nullptr) {
      throw ModelException("libfranka: The model library that the robot sent lacks the function " +
                           name + ".");
    }
    return reinterpret_cast<Function>(symbol);
  }

 private:
  network::Descriptor memory_;  // open while the object is loaded, so that its path stays unique
  void* handle_{nullptr};
};

/// The Jacobians of all frames in one kind of axes.
struct Jacobians {
  Jacobians(const SharedObject& library, const std::string& prefix)
      : first(library.get<FirstJacobian>(prefix + "1")),
        end_effector(library.get<JacobianOfEndEffector>(prefix + "9")) {
    for (std::size_t i = 0; i < joints.size(); i++) {
      joints[i] = library.get<JacobianOfJoint>(prefix + std::to_string(i + 2));
    }
  }

  FirstJacobian first;
  std::array<JacobianOfJoint, 7> joints;  // joints 2 to 7, flange
  JacobianOfEndEffector end_effector;
};

class LibraryModel : public Model::Source {
 public:
  explicit LibraryModel(const std::vector<std::uint8_t>& bytes)
      : library_(bytes),
        zero_jacobians_(library_, "O_J_J"),
        body_jacobians_(library_, "Ji_J_J"),
        pose_of_end_effector_(library_.get<PoseOfEndEffector>("O_T_J9")),
        mass_(library_.get<Mass>("M_NE")),
        coriolis_(library_.get<Coriolis>("c_NE")),
        gravity_(library_.get<Gravity>("g_NE")) {
    for (std::size_t i = 0; i < poses_.size(); i++) {
      poses_[i] = library_.get<PoseOfJoint>("O_T_J" + std::to_string(i + 1));
    }
  }

  std::array<double, 16> pose(Frame frame, const std::array<double, 7>& q,
                              const std::array<double, 16>& F_T_EE,
                              const std::array<double, 16>& EE_T_K) const override {
    std::array<double, 16> out;
    if (frame >= Frame::kJoint1 && frame <= Frame::kFlange) {
      poses_[static_cast<std::size_t>(frame)](q.data(), out.data());
    } else {
      pose_of_end_effector_(q.data(), tip(frame, F_T_EE, EE_T_K).data(), out.data());
    }
    return out;
  }
  std::array<double, 42> bodyJacobian(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const override {
    return jacobian(body_jacobians_, frame, q, F_T_EE, EE_T_K);
  }
  std::array<double, 42> zeroJacobian(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const override {
    return jacobian(zero_jacobians_, frame, q, F_T_EE, EE_T_K);
  }
  std::array<double, 49> mass(const std::array<double, 7>& q, const std::array<double, 9>& I_total,
                              double m_total,
                              const std::array<double, 3>& F_x_Ctotal) const noexcept override {
    std::array<double, 49> out;
    mass_(q.data(), I_total.data(), m_total, F_x_Ctotal.data(), out.data());
    return out;
  }
  std::array<double, 7> coriolis(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                 const std::array<double, 9>& I_total, double m_total,
                                 const std::array<double, 3>& F_x_Ctotal) const noexcept override {
    std::array<double, 7> out;
    coriolis_(q.data(), dq.data(), I_total.data(), m_total, F_x_Ctotal.data(), out.data());
    return out;
  }
  std::array<double, 7> gravity(
      const std::array<double, 7>& q, double m_total, const std::array<double, 3>& F_x_Ctotal,
      const std::array<double, 3>& gravity_earth) const noexcept override {
    std::array<double, 7> out;
    gravity_(q.data(), gravity_earth.data(), m_total, F_x_Ctotal.data(), out.data());
    return out;
  }

 private:
  /// Transform from the flange to the frame.
  static std::array<double, 16> tip(Frame frame, const std::array<double, 16>& F_T_EE,
                                    const std::array<double, 16>& EE_T_K) {
    if (frame == Frame::kEndEffector) {
      return F_T_EE;
    }
    if (frame == Frame::kStiffness) {
      return multiply(F_T_EE, EE_T_K);
    }
    throw std::invalid_argument("libfranka: Invalid frame given.");
  }

  static std::array<double, 42> jacobian(const Jacobians& jacobians, Frame frame,
                                         const std::array<double, 7>& q,
                                         const std::array<double, 16>& F_T_EE,
                                         const std::array<double, 16>& EE_T_K) {
    std::array<double, 42> out;
    if (frame == Frame::kJoint1) {
      jacobians.first(out.data());
    } else if (frame > Frame::kJoint1 && frame <= Frame::kFlange) {
      jacobians.joints[static_cast<std::size_t>(frame) - 1](q.data(), out.data());
    } else {
      jacobians.end_effector(q.data(), tip(frame, F_T_EE, EE_T_K).data(), out.data());
    }
    return out;
  }

  SharedObject library_;
  Jacobians zero_jacobians_, body_jacobians_;
  std::array<PoseOfJoint, 8> poses_{};  // joints 1 to 7, flange
  PoseOfEndEffector pose_of_end_effector_;
  Mass mass_;
  Coriolis coriolis_;
  Gravity gravity_;
};

}  // namespace

std::unique_ptr<Model::Source> modelFromLibrary(const std::vector<std::uint8_t>& shared_object) {
  return std::make_unique<LibraryModel>(shared_object);
}

}  // namespace franka
