// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limit_way.h"

namespace franka_sim::test {

/// A path on which these limits can be reached while the joints stay within theirs.
struct LimitWay {
  unsigned protocol;
  std::vector<Derivative> stages;
  Way way;
  double taken;  ///< the largest used share of the arm's other limits, at 99 % of the limits
  int draws;     ///< of WaySearch
};

inline const std::vector<Derivative> kVelocityOnly{Derivative::kVelocity};
inline const std::vector<Derivative> kAllButVelocity{Derivative::kAcceleration, Derivative::kJerk};
inline const std::vector<Derivative> kAllStages{Derivative::kVelocity, Derivative::kAcceleration,
                                                Derivative::kJerk};

/// Found by WaySearch; the table of docs/design/limits.md.
inline const std::vector<LimitWay> kLimitWays{
    {5,
     kVelocityOnly,
     {Part::kTranslation, {{1.07, 1.20, -0.57, -0.71, 2.80, 2.73, -0.57}}, {0, 0, 1}, 0.6, true},
     0.60,
     1000},
    {5,
     kAllButVelocity,
     {Part::kTranslation, {{0, 1.09, -0.01, -0.89, 0.78, 1.75, 2.28}}, {0.05, 0.54, 0.40}},
     0.89,
     100000},
    {5,
     kAllStages,
     {Part::kRotation, {{0, 0.97, 2.83, -1.04, -1.73, 2.90, 1.87}}, {-0.11, -0.28, -0.89}},
     0.72,
     4000},
    {5, kAllStages, {Part::kElbow, {{0, 0.99, 0.31, -0.74, 0.56, 0.36, 0.04}}}, 0.50, 4000},
    {10,
     kVelocityOnly,
     {Part::kTranslation, {{0.62, -1.41, 1.84, -0.17, 1.90, 2.67, -0.07}}, {0, 0, 1}, 0.6, true},
     0.75,
     1000},
    {10,
     kAllButVelocity,
     {Part::kTranslation, {{0, -0.59, -2.38, -0.95, -1.87, 1.26, 0.57}}, {-0.77, 0.57, -0.93}},
     0.88,
     100000},
    {10,
     kAllStages,
     {Part::kRotation, {{0, 0.17, 0.02, -2.80, -1.37, 2.01, 1.42}}, {0.34, -0.67, -0.84}},
     0.71,
     4000},
    {10, kAllStages, {Part::kElbow, {{0, 0.54, 0.27, -0.99, 0.24, 4.39, 1.76}}}, 0.53, 4000},
};

/// The fastest straight path found, by its share of the translation limit.
struct StraightWay {
  unsigned protocol;
  double share;
  Way way;
};

constexpr int kStraightDraws = 10000;
constexpr double kTooMuch = 0.05;  ///< at this excess, as many draws find no path

inline const std::vector<StraightWay> kStraightWays{
    {5,
     0.65,
     {Part::kTranslation, {{0, 0.92, -0.38, -1.74, 0.55, 2.54, 1.48}}, {0.08, 0.38, -0.03}}},
    {10,
     0.40,
     {Part::kTranslation, {{0, 1.15, 1.10, -1.52, 2.20, 2.03, -1.95}}, {0.30, -0.66, 0.27}}},
};

}  // namespace franka_sim::test
