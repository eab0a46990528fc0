// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cxxabi.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <typeinfo>

namespace hardware_interface {
namespace internal {

/// Readable form of a mangled C++ name; the name itself if it cannot be demangled.
/// Clients compare the result with literals such as "hardware_interface::EffortJointInterface", so
/// it is exactly the result of the compiler's ABI library. Thread-safe. Not real-time safe.
inline std::string demangleSymbol(const char* name) {
  int status = -1;
  const std::unique_ptr<char, void (*)(void*)> readable(
      abi::__cxa_demangle(name, nullptr, nullptr, &status), std::free);
  return status == 0 && readable ? std::string(readable.get()) : std::string(name);
}

/// Readable name of the static type T.
template <class T>
std::string demangledTypeName() {
  return demangleSymbol(typeid(T).name());
}

/// Readable name of the dynamic type of a value.
template <class T>
std::string demangledTypeName(const T& value) {
  return demangleSymbol(typeid(value).name());
}

}  // namespace internal
}  // namespace hardware_interface
