// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "limit_way.h"

namespace franka_sim::test {

/// Target of a search: one path for these stages of a part.
struct Target {
  unsigned protocol;
  std::vector<Derivative> stages;
  Part part;
  double share{0.99};  ///< of the limits
  double rod{0.0};     ///< see Way
  bool round{false};
};

/// Judges a path over all stages.
inline Judgement judge(const Target& target, const Way& way, double enough = 1e9) {
  const MotionLimits limits = motionLimitsOfProtocol(target.protocol);
  WayJudge judge(limits);
  Judgement worst;
  for (const Derivative stage : target.stages) {
    const Judgement judgement =
        judge.judge(way, profileOf(way, stage, boundsOf(limits, way.part), target.share), enough);
    worst = judgement.share > worst.share ? judgement : worst;
  }
  return worst;
}

struct Found {
  Way way{};
  Judgement judgement{2.0, "nothing found"};
};

/// Draws paths with a fixed seed and keeps the one with the largest margin. Coordinates are rounded
/// to 0.01, so that the result can be written down.
class WaySearch {
 public:
  explicit WaySearch(const Target& target)
      : target_(target), limits_(motionLimitsOfProtocol(target.protocol)) {}

  Found best(int draws) {
    Found found;
    for (int i = 0; i < draws; i++) {
      const Way way = draw();
      const Judgement judgement = judge(target_, way, found.judgement.share);
      if (judgement.share < found.judgement.share) {
        found = {way, judgement};
      }
    }
    return found;
  }

 private:
  double between(double low, double high) {
    const double drawn = low + (high - low) * (engine_() / 4294967296.0);
    return 0.01 * std::round(100.0 * drawn);
  }

  Way draw() {
    Way way{target_.part, {}, {}, target_.rod, target_.round};
    for (std::size_t i = 0; i < 7; i++) {
      way.start[i] = between(limits_.arm.q_min[i], limits_.arm.q_max[i]);
    }
    if (!way.round) {
      way.start[0] = 0.0;  // has no effect on the result
    }
    way.axis = {between(-1, 1), between(-1, 1), between(-1, 1)};
    return way;
  }

  Target target_;
  MotionLimits limits_;
  std::mt19937 engine_;
};

}  // namespace franka_sim::test
