// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/engine/file_registry.h"

#include <franka_core/fnv_hash.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>

namespace franka_sim::physics {

namespace {

/// An absolute path below which no real file can exist.
constexpr const char* kPlace = "/dev/null/";

/// Texts are passed between threads (stepping, drawing) and outlive their worlds, so the files must
/// too.
struct Store {
  std::mutex mutex;
  std::map<std::string, std::string> files;
};

Store& store() {
  static Store store;
  return store;
}

std::uint64_t hashOf(const std::string& content) {
  franka_core::FnvHash hash;
  for (const char c : content) {
    hash.addByte(static_cast<std::uint8_t>(c));
  }
  return hash.value();
}

std::set<std::string> namedIn(const std::string& text) {
  std::set<std::string> names;
  for (std::size_t at = text.find(kPlace); at != std::string::npos; at = text.find(kPlace, at)) {
    const std::size_t end = text.find_first_of("\"'", at);
    names.insert(text.substr(at, end - at));
    at = end;
  }
  return names;
}

}  // namespace

void addRegisteredFiles(const std::string& mjcf, mjVFS* files) {
  Store& kept = store();
  const std::lock_guard<std::mutex> lock(kept.mutex);
  for (const std::string& name : namedIn(mjcf)) {
    const auto found = kept.files.find(name);
    if (found == kept.files.end()) {
      continue;  // MuJoCo reports the missing file
    }
    const std::string& content = found->second;
    if (mj_makeEmptyFileVFS(files, name.c_str(), static_cast<int>(content.size())) != 0) {
      throw std::runtime_error("its meshes are more than " + std::to_string(mjMAXVFS - 1) +
                               " or there is not enough memory for them.");
    }
    std::memcpy(files->filedata[mj_findFileVFS(files, name.c_str())], content.data(),
                content.size());
  }
}

std::string registerFile(const std::string& content, const std::string& extension) {
  Store& kept = store();
  const std::lock_guard<std::mutex> lock(kept.mutex);
  for (std::uint64_t hash = hashOf(content);; ++hash) {
    char number[17];
    std::snprintf(number, sizeof number, "%016llx", static_cast<unsigned long long>(hash));
    const auto [entry, is_new] = kept.files.emplace(kPlace + (number + extension), content);
    if (is_new || entry->second == content) {
      return entry->first;
    }
  }
}

}  // namespace franka_sim::physics
