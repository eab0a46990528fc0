// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/resource_uri.h>

namespace franka_sim {

std::string fileOfUri(const std::string& uri, const PackageFinder& find) {
  static const std::string kPackage = "package://", kFile = "file://";
  if (uri.compare(0, kFile.size(), kFile) == 0) {
    return uri.substr(kFile.size());
  }
  if (uri.compare(0, kPackage.size(), kPackage) != 0) {
    return uri;
  }
  const std::size_t slash = uri.find('/', kPackage.size());
  // Without a file in it: names such as `sun`, which are not packages; rospack would print errors
  // about them.
  if (slash == std::string::npos) {
    return "";
  }
  return find(uri.substr(kPackage.size(), slash - kPackage.size()), uri.substr(slash + 1));
}

}  // namespace franka_sim
