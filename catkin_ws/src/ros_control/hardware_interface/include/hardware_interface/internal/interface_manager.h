// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/demangle_symbol.h>
#include <hardware_interface/internal/resource_manager.h>
#include <ros/console.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace hardware_interface {
namespace internal {

template <class T>
std::true_type hasResourceManagerType(typename T::ResourceManagerType*);
template <class T>
std::false_type hasResourceManagerType(...);

/// Whether T is a ResourceManager, recognized by its typedef: std::true_type or std::false_type.
template <class T>
using IsResourceManager = decltype(hasResourceManagerType<T>(nullptr));

}  // namespace internal

/// Hardware interfaces by type. A robot made of several robots combines their interfaces: for a
/// type that several of them have, it returns one interface with the handles of all.
///
/// Registering and looking up are for start-up and the initialization of controllers. Called by one
/// thread at a time. Not real-time safe. Registered interfaces belong to the caller and must
/// outlive the manager; combined ones live as long as the manager.
class InterfaceManager {
 public:
  virtual ~InterfaceManager() = default;

  /// Registers an interface under its type. Another one of the same type is replaced, with a
  /// warning. getInterfaceResources lists the interface's handles at this time; registering it
  /// again updates that list.
  template <class T>
  void registerInterface(T* iface) {
    const std::string type = internal::demangledTypeName<T>();
    const auto known = interfaces_.find(type);
    if (known != interfaces_.end() && known->second != iface) {
      ROS_WARN_STREAM("Replacing previously registered interface '" << type << "'.");
    }
    interfaces_[type] = iface;
    resources_[type] = resourcesOf(*iface, internal::IsResourceManager<T>());
  }

  /// Adds all present and future interfaces of another manager.
  void registerInterfaceManager(InterfaceManager* iface_man) {
    interface_managers_.push_back(iface_man);
  }

  /// The interface of type T, nullptr if there is none. If several managers have one, a combined
  /// interface that stays the same object until their number changes; claims are made on that
  /// object.
  template <class T>
  T* get() {
    const std::string type = internal::demangledTypeName<T>();
    std::vector<T*> found;
    const auto own = interfaces_.find(type);
    if (own != interfaces_.end()) {
      found.push_back(static_cast<T*>(own->second));
    }
    for (InterfaceManager* manager : interface_managers_) {
      T* iface = manager->get<T>();
      if (iface != nullptr) {
        found.push_back(iface);
      }
    }
    if (found.size() < 2) {
      return found.empty() ? nullptr : found.front();
    }
    return combine(type, found, internal::IsResourceManager<T>());
  }

  /// Type names of all interfaces, own ones first, without duplicates.
  std::vector<std::string> getNames() const {
    std::vector<std::string> names;
    names.reserve(interfaces_.size());
    for (const auto& iface : interfaces_) {
      names.push_back(iface.first);
    }
    for (const InterfaceManager* manager : interface_managers_) {
      for (const std::string& name : manager->getNames()) {
        if (std::find(names.begin(), names.end(), name) == names.end()) {
          names.push_back(name);
        }
      }
    }
    return names;
  }

  /// Resources of an interface type at the time of registration, own ones first.
  std::vector<std::string> getInterfaceResources(std::string iface_type) const {
    std::vector<std::string> resources;
    const auto own = resources_.find(iface_type);
    if (own != resources_.end()) {
      resources = own->second;
    }
    for (const InterfaceManager* manager : interface_managers_) {
      const std::vector<std::string> more = manager->getInterfaceResources(iface_type);
      resources.insert(resources.end(), more.begin(), more.end());
    }
    return resources;
  }

 protected:
  typedef std::map<std::string, void*> InterfaceMap;
  typedef std::vector<InterfaceManager*> InterfaceManagerVector;
  typedef std::map<std::string, std::size_t> SizeMap;
  typedef std::map<std::string, std::vector<std::string>> ResourceMap;

  InterfaceMap interfaces_;
  InterfaceMap interfaces_combo_;
  InterfaceManagerVector interface_managers_;
  SizeMap num_ifaces_registered_;  ///< number of interfaces in each combined one
  /// Owns the combined interfaces, outdated ones too: pointers to them may still be in use.
  std::vector<std::shared_ptr<ResourceManagerBase>> interface_destruction_list_;
  ResourceMap resources_;

 private:
  template <class T>
  static std::vector<std::string> resourcesOf(const T& iface, std::true_type /*is_manager*/) {
    return iface.getNames();
  }
  template <class T>
  static std::vector<std::string> resourcesOf(const T& /*iface*/, std::false_type /*is_manager*/) {
    return {};
  }

  template <class T>
  T* combine(const std::string& type, const std::vector<T*>& parts, std::true_type /*is_manager*/) {
    const auto known = interfaces_combo_.find(type);
    if (known != interfaces_combo_.end() && num_ifaces_registered_[type] == parts.size()) {
      return static_cast<T*>(known->second);
    }
    const auto combined = std::make_shared<T>();
    std::vector<typename T::ResourceManagerType*> managers(parts.begin(), parts.end());
    T::ResourceManagerType::concatManagers(managers, combined.get());
    interfaces_combo_[type] = combined.get();
    num_ifaces_registered_[type] = parts.size();
    interface_destruction_list_.push_back(combined);
    return combined.get();
  }
  template <class T>
  T* combine(const std::string& type, const std::vector<T*>& /*parts*/,
             std::false_type /*is_manager*/) {
    ROS_ERROR_STREAM(
        "You cannot register multiple interfaces of the same type which are not of "
        "type ResourceManager. There is no established protocol for combining "
        "them. The type is '"
        << type << "'.");
    return nullptr;
  }
};

}  // namespace hardware_interface
