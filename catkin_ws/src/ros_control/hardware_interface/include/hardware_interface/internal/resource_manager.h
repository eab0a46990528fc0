// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <hardware_interface/internal/demangle_symbol.h>
#include <ros/console.h>

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hardware_interface {

/// Common base of all resource managers, for ownership independent of the handle type.
class ResourceManagerBase {
 public:
  virtual ~ResourceManagerBase() = default;
};

/// Named handles of one kind. Filled at start-up and read while controllers are initialized. Called
/// by one thread at a time. Not real-time safe.
/// @tparam ResourceHandle copyable, with `std::string getName() const`
template <class ResourceHandle>
class ResourceManager : public ResourceManagerBase {
 public:
  typedef ResourceManager<ResourceHandle> ResourceManagerType;

  /// Names of all handles, sorted.
  std::vector<std::string> getNames() const {
    std::vector<std::string> names;
    names.reserve(resource_map_.size());
    for (const auto& resource : resource_map_) {
      names.push_back(resource.first);
    }
    return names;
  }

  /// Adds a handle; one of the same name is replaced, with a warning.
  void registerHandle(const ResourceHandle& handle) {
    const auto found = resource_map_.find(handle.getName());
    if (found == resource_map_.end()) {
      resource_map_.insert(std::make_pair(handle.getName(), handle));
      return;
    }
    ROS_WARN_STREAM("Replacing previously registered handle '"
                    << handle.getName() << "' in '" << internal::demangledTypeName(*this) << "'.");
    found->second = handle;
  }

  /// A copy of the named handle. @throws std::logic_error for an unknown name.
  ResourceHandle getHandle(const std::string& name) {
    const auto found = resource_map_.find(name);
    if (found == resource_map_.end()) {
      throw std::logic_error("Could not find resource '" + name + "' in '" +
                             internal::demangledTypeName(*this) + "'.");
    }
    return found->second;
  }

  /// Copies the handles of all managers, in the order given, into `result`.
  static void concatManagers(std::vector<ResourceManagerType*>& managers,
                             ResourceManagerType* result) {
    for (const ResourceManagerType* manager : managers) {
      for (const auto& resource : manager->resource_map_) {
        result->registerHandle(resource.second);
      }
    }
  }

 protected:
  typedef std::map<std::string, ResourceHandle> ResourceMap;
  ResourceMap resource_map_;
};

}  // namespace hardware_interface
