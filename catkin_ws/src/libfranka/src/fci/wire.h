// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/protocol.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// @file
/// Little-endian, packed numbers, independent of the machine's own order. Callers check sizes
/// first, so that reader and writer stay within the buffer.

namespace franka_core::fci::wire {

template <typename Unsigned>
inline Unsigned load(const std::uint8_t* from) noexcept {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); i++) {
    value = static_cast<Unsigned>(value | static_cast<Unsigned>(Unsigned{from[i]} << (8 * i)));
  }
  return value;
}

template <typename Unsigned>
inline void store(Unsigned value, std::uint8_t* to) noexcept {
  for (std::size_t i = 0; i < sizeof(Unsigned); i++) {
    to[i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

inline double loadF64(const std::uint8_t* from) noexcept {
  const auto bits = load<std::uint64_t>(from);
  double value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

inline double loadF32(const std::uint8_t* from) noexcept {
  const auto bits = load<std::uint32_t>(from);
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

inline void storeF64(double value, std::uint8_t* to) noexcept {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  store(bits, to);
}

inline void storeF32(double value, std::uint8_t* to) noexcept {
  const auto narrow = static_cast<float>(value);
  std::uint32_t bits;
  std::memcpy(&bits, &narrow, sizeof(bits));
  store(bits, to);
}

/// Reads values from the front of a buffer of sufficient size. Records invalid values.
class Reader {
 public:
  explicit Reader(const std::uint8_t* from) noexcept : from_(from) {}

  template <typename Unsigned>
  Unsigned integer() noexcept {
    const auto value = load<Unsigned>(from_);
    from_ += sizeof(Unsigned);
    return value;
  }
  double number() noexcept {
    const double value = loadF64(from_);
    from_ += sizeof(double);
    finite_ = finite_ && std::isfinite(value);
    return value;
  }
  bool boolean() noexcept {
    const auto value = integer<std::uint8_t>();
    good_booleans_ = good_booleans_ && value <= 1;
    return value != 0;
  }
  void operator()(double& value) noexcept { value = number(); }
  void operator()(bool& value) noexcept { value = boolean(); }
  template <typename T, std::size_t kSize>
  void operator()(std::array<T, kSize>& values) noexcept {
    for (T& value : values) {
      (*this)(value);
    }
  }
  template <typename First, typename... Rest>
  void operator()(First& first, Rest&... rest) noexcept {
    (*this)(first);
    ((*this)(rest), ...);
  }

  bool finite() const noexcept { return finite_; }
  CodecError booleans() const noexcept {
    return good_booleans_ ? CodecError::kNone : CodecError::kBadBoolean;
  }

 private:
  const std::uint8_t* from_;
  bool finite_{true};
  bool good_booleans_{true};
};

/// Appends values to a buffer of sufficient size.
class Writer {
 public:
  explicit Writer(std::uint8_t* to) noexcept : to_(to) {}

  template <typename Unsigned>
  void integer(Unsigned value) noexcept {
    store(value, to_);
    to_ += sizeof(Unsigned);
  }
  void operator()(double value) noexcept {
    storeF64(value, to_);
    to_ += sizeof(double);
  }
  void operator()(bool value) noexcept { integer<std::uint8_t>(value ? 1 : 0); }
  template <typename T, std::size_t kSize>
  void operator()(const std::array<T, kSize>& values) noexcept {
    for (const T& value : values) {
      (*this)(value);
    }
  }
  template <typename First, typename... Rest>
  void operator()(const First& first, const Rest&... rest) noexcept {
    (*this)(first);
    ((*this)(rest), ...);
  }

 private:
  std::uint8_t* to_;
};

}  // namespace franka_core::fci::wire
