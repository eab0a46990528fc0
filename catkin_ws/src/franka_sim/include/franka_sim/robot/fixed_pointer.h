// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// A pointer of an object to another one, which assignment leaves as it is: parts that point to
/// each other can then take over the values of other parts by their assignment operators. It is not
/// copied, because a copy would point into the object that it was copied from. Real-time safe.
template <typename Target>
class FixedPointer {
 public:
  explicit FixedPointer(Target* target) noexcept : target_(target) {}
  FixedPointer(const FixedPointer&) = delete;
  // NOLINTNEXTLINE(bugprone-unhandled-self-assignment,cert-oop54-cpp): nothing is assigned
  FixedPointer& operator=(const FixedPointer&) noexcept { return *this; }
  ~FixedPointer() = default;

  Target* get() const noexcept { return target_; }
  Target& operator*() const noexcept { return *target_; }
  Target* operator->() const noexcept { return target_; }

 private:
  Target* target_;
};

}  // namespace franka_sim
