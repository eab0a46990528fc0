// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/controller_loader_interface.h>

#include <memory>
#include <mutex>
#include <pluginlib/class_loader.hpp>
#include <string>
#include <vector>

namespace controller_manager {

namespace internal {

/// Held while plugin libraries are loaded: a process may have several managers, and registrations
/// of a library belong to the loader that opens it.
inline std::mutex& pluginMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace internal

/// Loads controllers from plugin libraries.
/// @tparam T base class of the plugins, derived from controller_interface::ControllerBase
template <class T>
class ControllerLoader : public ControllerLoaderInterface {
 public:
  /// @param package that exports the plugins @param base_class C++ name of T
  ControllerLoader(const std::string& package, const std::string& base_class)
      : ControllerLoaderInterface(base_class), package_(package), base_class_(base_class) {
    reload();
  }

  controller_interface::ControllerBaseSharedPtr createInstance(
      const std::string& lookup_name) override {
    const std::lock_guard<std::mutex> lock(internal::pluginMutex());
    return controller_loader_->createUniqueInstance(lookup_name);
  }

  std::vector<std::string> getDeclaredClasses() override {
    return controller_loader_->getDeclaredClasses();
  }

  void reload() override {
    const std::lock_guard<std::mutex> lock(internal::pluginMutex());
    controller_loader_ = std::make_shared<pluginlib::ClassLoader<T>>(package_, base_class_);
  }

 private:
  std::string package_;
  std::string base_class_;
  std::shared_ptr<pluginlib::ClassLoader<T>> controller_loader_;
};

}  // namespace controller_manager
