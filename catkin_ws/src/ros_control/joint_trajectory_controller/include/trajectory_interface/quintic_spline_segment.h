// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <trajectory_interface/pos_vel_acc_state.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace trajectory_interface {

/// A polynomial of time between two states, one per degree of freedom: linear if only positions are
/// given at both ends, cubic with velocities, quintic with accelerations as well. Before its start
/// and after its end the state is that of the nearer end, at rest.
///
/// Real-time safe. Exceptions: sizes other than in the call before, and init() when it throws.
template <class ScalarType>
class QuinticSplineSegment {
 public:
  typedef ScalarType Scalar;  ///< of positions
  typedef Scalar Time;        ///< [s]
  typedef PosVelAccState<Scalar> State;

  QuinticSplineSegment() = default;
  /// Like init().
  QuinticSplineSegment(const Time& start_time, const State& start_state, const Time& end_time,
                       const State& end_state) {
    init(start_time, start_state, end_time, end_state);
  }

  /// @param start_time, end_time [s]; if equal, the start state counts.
  /// @throws std::invalid_argument if the end is before the start, positions are missing, or sizes
  /// differ; the segment is then unchanged.
  void init(const Time& start_time, const State& start_state, const Time& end_time,
            const State& end_state) {
    check(start_time, start_state, end_time, end_state);
    const bool cubic = !start_state.velocity.empty() && !end_state.velocity.empty();
    const bool quintic =
        cubic && !start_state.acceleration.empty() && !end_state.acceleration.empty();
    start_time_ = start_time;
    duration_ = end_time - start_time;
    end_time_ = end_time;
    coefficients_.resize(start_state.position.size());
    for (std::size_t i = 0; i < coefficients_.size(); ++i) {
      const Scalar p0 = start_state.position[i];
      const Scalar p1 = end_state.position[i];
      if (quintic) {
        coefficients_[i] = quinticThrough(p0, start_state.velocity[i], start_state.acceleration[i],
                                          p1, end_state.velocity[i], end_state.acceleration[i]);
      } else if (cubic) {
        coefficients_[i] = cubicThrough(p0, start_state.velocity[i], p1, end_state.velocity[i]);
      } else {
        coefficients_[i] = lineThrough(p0, p1);
      }
    }
  }

  /// The state at a time [s], in vectors of size() elements each.
  void sample(const Time& time, State& state) const {
    state.position.resize(size());
    state.velocity.resize(size());
    state.acceleration.resize(size());
    const bool inside = time >= start_time_ && time <= end_time_;
    const Scalar t = std::min(std::max(time - start_time_, Scalar(0)), duration_);
    for (std::size_t i = 0; i < coefficients_.size(); ++i) {
      const Coefficients& c = coefficients_[i];
      state.position[i] = c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
      state.velocity[i] =
          inside ? c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])))
                 : Scalar(0);
      state.acceleration[i] =
          inside ? 2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5])) : Scalar(0);
    }
  }

  /// @name When the segment begins and ends
  /// @{
  Time startTime() const { return start_time_; }
  Time endTime() const { return end_time_; }
  /// @}
  /// Number of degrees of freedom.
  unsigned int size() const { return static_cast<unsigned int>(coefficients_.size()); }

 private:
  typedef std::array<Scalar, 6> Coefficients;  ///< of t^0 to t^5, t since the start

  static void refuse(const std::string& reason) {
    throw std::invalid_argument("Quintic spline segment can't be constructed: " + reason);
  }

  static void check(Time start_time, const State& start, Time end_time, const State& end) {
    if (!(end_time >= start_time)) {
      refuse("end_time < start_time.");
    }
    if (start.position.empty() || end.position.empty()) {
      refuse("start and end positions must not be empty.");
    }
    if (start.position.size() != end.position.size()) {
      refuse("start and end positions differ in size.");
    }
    const auto fits = [&](const std::vector<Scalar>& values) {
      return values.empty() || values.size() == start.position.size();
    };
    if (!fits(start.velocity) || !fits(end.velocity)) {
      refuse("velocities differ in size from the positions.");
    }
    if (!fits(start.acceleration) || !fits(end.acceleration)) {
      refuse("accelerations differ in size from the positions.");
    }
  }

  Coefficients lineThrough(Scalar p0, Scalar p1) const {
    return {p0, duration_ > 0 ? (p1 - p0) / duration_ : Scalar(0), 0, 0, 0, 0};
  }

  Coefficients cubicThrough(Scalar p0, Scalar v0, Scalar p1, Scalar v1) const {
    Coefficients c{p0, v0, 0, 0, 0, 0};
    if (duration_ > 0) {
      const Scalar t = duration_;
      const Scalar t2 = t * t;
      c[2] = (3 * (p1 - p0) - (2 * v0 + v1) * t) / t2;
      c[3] = (2 * (p0 - p1) + (v0 + v1) * t) / (t2 * t);
    }
    return c;
  }

  Coefficients quinticThrough(Scalar p0, Scalar v0, Scalar a0, Scalar p1, Scalar v1,
                              Scalar a1) const {
    Coefficients c{p0, v0, a0 / 2, 0, 0, 0};
    if (duration_ > 0) {
      const Scalar t = duration_;
      const Scalar t2 = t * t;
      const Scalar t3 = t2 * t;
      const Scalar d = p1 - p0;
      c[3] = (20 * d - (12 * v0 + 8 * v1) * t - (3 * a0 - a1) * t2) / (2 * t3);
      c[4] = (-30 * d + (16 * v0 + 14 * v1) * t + (3 * a0 - 2 * a1) * t2) / (2 * t3 * t);
      c[5] = (12 * d - 6 * (v0 + v1) * t + (a1 - a0) * t2) / (2 * t3 * t2);
    }
    return c;
  }

  std::vector<Coefficients> coefficients_;
  Time start_time_{0};
  Time end_time_{0};
  Time duration_{0};
};

}  // namespace trajectory_interface
