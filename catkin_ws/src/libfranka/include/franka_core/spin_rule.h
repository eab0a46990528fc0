// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>

/// @file
/// How a thread waits for the other side of a lock-step exchange (decision 53): one rule for the
/// client and for the simulated robot.

namespace franka_core {

/// How a thread waits for an answer.
enum class WaitMode {
  kAuto,   ///< without sleep, as long as that pays and a processor is free
  kSpin,   ///< without sleep, for SpinRule::kMaxSpin at most
  kBlock,  ///< asleep
};

/// `auto`, `spin` or `block`; nothing for any other text. Thread-safe.
std::optional<WaitMode> toWaitMode(const std::string& text);

/// The mode that the environment variable FRANKA_WAIT names; kAuto without it. Not real-time safe.
/// @throws std::invalid_argument with a sentence if it names none.
WaitMode waitModeOfEnvironment();

/// Whether this thread may run on more than one processor. If not, the other side cannot work while
/// this one waits without sleep. Not real-time safe. Thread-safe.
bool hasTwoProcessors() noexcept;

/// Waits without sleep, as long as that is worth it.
///
/// To sleep and to be woken up takes longer than many answers of the other side. But a wait without
/// sleep occupies a processor, which the other side or another pair may need. In kAuto the rule
/// watches its own waits and pauses, that is, lets its caller sleep, if
/// - five waits in a row end without an answer, or
/// - a quarter of the time is lost: it was spent in waits without an answer, or the thread was
///   ready to run and did not.
/// The pause is 32 times as long as the trial that led to it, so on a busy machine trials take 3 %
/// of the time. Measurements: (decision 53).
///
/// Called by one thread at a time. Real-time safe. The only system calls are those of `poll` and of
/// the clock.
class SpinRule {
 public:
  using Clock = std::chrono::steady_clock;  ///< of all times

  /// A wait without sleep is this long at most. Chosen here: it bridges a wake-up of the other side
  /// (50 us where it is slow) and several ticks; if it were shorter, two sides that both sleep
  /// would keep each other asleep.
  static constexpr std::chrono::microseconds kMaxSpin{200};

  /// Chosen here: ten times as long as a poll of several sockets.
  static constexpr std::chrono::microseconds kGap{40};

  /// @param mode kSpin and kBlock do not use the observations above.
  /// @param can_spin without it every mode is kBlock.
  /// @param gap a poll that takes so long was interrupted: the thread did not run.
  explicit SpinRule(WaitMode mode = WaitMode::kAuto, bool can_spin = hasTwoProcessors(),
                    std::chrono::microseconds gap = kGap) noexcept
      : mode_(can_spin ? mode : WaitMode::kBlock), gap_(gap) {}

  WaitMode mode() const noexcept { return mode_; }  ///< as it was given

  /// How long spin() will not wait yet; zero unless it pauses. In kBlock it never does, and this is
  /// zero.
  Clock::duration pauseLeft(Clock::time_point now) const noexcept {
    return mode_ == WaitMode::kAuto && now < resume_at_ ? resume_at_ - now : Clock::duration{};
  }

  /// Calls `poll` until it returns true, for kMaxSpin at most; not at all if the caller should
  /// sleep instead.
  /// @param now the clock; tests have their own.
  /// @returns whether `poll` has returned true.
  template <typename Poll, typename Now>
  bool spin(Poll poll, Now now) {
    const Clock::time_point begin = now();
    if (!begins(begin)) {
      return false;
    }
    Clock::duration away{};
    Clock::time_point before = begin;
    bool answered = poll();
    Clock::time_point after = now();
    while (true) {
      away += after - before >= gap_ ? after - before : Clock::duration{};
      if (answered || after - begin >= kMaxSpin) {
        break;
      }
      before = after;
      answered = poll();
      after = now();
    }
    conclude(begin, after, away, answered);
    return answered;
  }
  template <typename Poll>
  bool spin(Poll poll) {
    return spin(poll, [] { return Clock::now(); });
  }

 private:
  bool begins(Clock::time_point now) noexcept;
  void conclude(Clock::time_point begin, Clock::time_point end, Clock::duration away,
                bool answered) noexcept;
  void beginTrial() noexcept;

  WaitMode mode_;
  Clock::duration gap_;
  Clock::time_point resume_at_{};  ///< end of the pause
  Clock::time_point ended_at_{};   ///< of the last wait
  Clock::duration awake_{};        ///< of this trial, without sleep
  Clock::duration lost_{};         ///< of this trial
  Clock::duration passed_{};       ///< since this trial began
  int without_answer_{0};          ///< waits in a row
};

}  // namespace franka_core
