// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <thread>
#include <type_traits>

namespace control_toolbox {
namespace detail {

/// A small value that any number of threads can read without waiting for a writer.
///
/// Writes use a ring of copies. A reader copies the newest one and checks whether it was
/// overwritten meanwhile, which takes as many writes as the ring is long; then it tries again. A
/// suspended writer blocks other writers, never a reader.
///
/// Thread-safe. Real-time safe. Exceptions: the constructor and set().
///
/// @tparam T trivially copyable.
template <class T>
class Snapshot {
  static_assert(std::is_trivially_copyable<T>::value, "the value is copied word by word");

 public:
  explicit Snapshot(const T& value) { store(value); }
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

  /// The value last set.
  T get() const noexcept {
    while (true) {
      const std::uint64_t number = newest_.load(std::memory_order_acquire);
      const Slot& slot = ring_[number % kSlots];
      Words words;
      for (std::size_t i = 0; i < kWords; ++i) {
        words[i] = slot.words[i].load(std::memory_order_acquire);
      }
      // The writer claims a slot by its number before it writes the words: if the number is
      // unchanged after reading, the words are consistent.
      if (slot.number.load(std::memory_order_relaxed) == number) {
        T value;
        std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
        return value;
      }
    }
  }

  /// Sets the value; waits while another thread sets it. Not real-time safe.
  void set(const T& value) noexcept {
    while (!trySet(value)) {
      std::this_thread::yield();
    }
  }

  /// Sets the value unless another thread is setting it. @return whether it was set.
  bool trySet(const T& value) noexcept {
    if (writing_.test_and_set(std::memory_order_acquire)) {
      return false;
    }
    store(value);
    writing_.clear(std::memory_order_release);
    return true;
  }

 private:
  static constexpr std::size_t kSlots = 8;
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, kWords>;
  struct Slot {
    std::atomic<std::uint64_t> number{0};
    std::array<std::atomic<std::uint64_t>, kWords> words{};
  };

  void store(const T& value) noexcept {
    Words words{};
    std::memcpy(words.data(), static_cast<const void*>(&value), sizeof(T));
    const std::uint64_t number = newest_.load(std::memory_order_relaxed) + 1;
    Slot& slot = ring_[number % kSlots];
    slot.number.store(number, std::memory_order_relaxed);
    // Each word is written after the claim above: a reader of a new word sees the new number.
    for (std::size_t i = 0; i < kWords; ++i) {
      slot.words[i].store(words[i], std::memory_order_release);
    }
    newest_.store(number, std::memory_order_release);
  }

  std::array<Slot, kSlots> ring_{};
  std::atomic<std::uint64_t> newest_{0};
  std::atomic_flag writing_ = ATOMIC_FLAG_INIT;
};

}  // namespace detail
}  // namespace control_toolbox
