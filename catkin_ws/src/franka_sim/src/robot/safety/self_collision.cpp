// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/safety/self_collision.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace franka_sim {

namespace {

constexpr double kCosineOf45Degrees = 0.70710678118654752440;
constexpr double kOverlapJitter = 1e-4;  // [m], chosen here: allowed growth of an overlap at rest

struct Ends {
  Eigen::Vector3d from, to;
};

constexpr bool canMeet(int a, int b) noexcept {
  const int low = a < b ? a : b;
  const int high = a < b ? b : a;
  return high - low >= 2 && !(low == 1 && high == 3);
}

double translationOf(const std::array<double, 16>& transform) noexcept {
  return Eigen::Vector3d(&transform[12]).norm();
}

// The capsules in O.
std::array<Ends, kCapsuleCount> place(const franka_core::ArmModel& model,
                                      const std::array<double, 7>& q) noexcept {
  std::array<Eigen::Isometry3d, 9> frames;
  frames[0] = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < 7; i++) {
    Eigen::Isometry3d joint;
    joint.matrix() = Eigen::Map<const Eigen::Matrix4d>(model.links()[i].origin.data());
    frames[i + 1] = frames[i] * joint * Eigen::AngleAxisd(q[i], Eigen::Vector3d::UnitZ());
  }
  Eigen::Isometry3d flange;
  flange.matrix() = Eigen::Map<const Eigen::Matrix4d>(model.flange().data());
  frames[kHandLink] = frames[7] * flange *
                      Eigen::AngleAxisd(-std::acos(kCosineOf45Degrees), Eigen::Vector3d::UnitZ());

  std::array<Ends, kCapsuleCount> placed;
  for (std::size_t i = 0; i < kCapsuleCount; i++) {
    const Capsule& capsule = kCapsules[i];
    const Eigen::Isometry3d& frame = frames[static_cast<std::size_t>(capsule.link)];
    placed[i].from = frame * Eigen::Vector3d(capsule.from.data());
    placed[i].to = frame * Eigen::Vector3d(capsule.to.data());
  }
  return placed;
}

double distanceOf(const Ends& a, const Ends& b) noexcept {
  const Eigen::Vector3d u = a.to - a.from;
  const Eigen::Vector3d v = b.to - b.from;
  const Eigen::Vector3d r = a.from - b.from;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double ur = u.dot(r);
  const double vr = v.dot(r);
  const double determinant = uu * vv - uv * uv;
  // Nearest point on a if both lines were infinite; parallel ones may start anywhere.
  double s =
      determinant > 1e-12 * uu * vv ? std::clamp((uv * vr - ur * vv) / determinant, 0.0, 1.0) : 0.0;
  // The nearest point on b to that, and if it is beyond b's end, the nearest on a to that end.
  double t = vv > 0.0 ? (uv * s + vr) / vv : 0.0;
  if (t < 0.0 || t > 1.0 || vv <= 0.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0.0 ? std::clamp((uv * t - ur) / uu, 0.0, 1.0) : 0.0;
  }
  return (r + s * u - t * v).norm();
}

}  // namespace

double segmentDistance(const std::array<double, 3>& a0, const std::array<double, 3>& a1,
                       const std::array<double, 3>& b0, const std::array<double, 3>& b1) noexcept {
  return distanceOf({Eigen::Vector3d(a0.data()), Eigen::Vector3d(a1.data())},
                    {Eigen::Vector3d(b0.data()), Eigen::Vector3d(b1.data())});
}

void SelfCollision::measure(const franka_core::ArmModel& model,
                            const std::array<double, 7>& q) noexcept {
  const std::array<Ends, kCapsuleCount> placed = place(model, q);
  const std::size_t count = has_hand_ ? kCapsuleCount : kCapsuleCount - 2;
  std::size_t pair = 0;
  for (std::size_t i = 0; i < kCapsuleCount; i++) {
    for (std::size_t j = i + 1; j < kCapsuleCount; j++, pair++) {
      distance_[pair] = std::numeric_limits<double>::infinity();
      if (j < count && canMeet(kCapsules[i].link, kCapsules[j].link)) {
        distance_[pair] =
            distanceOf(placed[i], placed[j]) - kCapsules[i].radius - kCapsules[j].radius;
      }
    }
  }
}

void SelfCollision::fitReaches(const franka_core::ArmModel& model) noexcept {
  reaches_.fill(0.0);
  for (const Capsule& capsule : kCapsules) {
    double reach = std::max(Eigen::Vector3d(capsule.from.data()).norm(),
                            Eigen::Vector3d(capsule.to.data()).norm());
    int link = capsule.link;
    if (link == kHandLink) {
      reach += translationOf(model.flange());
      link = 7;
    }
    for (auto joint = static_cast<std::size_t>(link); joint-- > 0;) {
      reaches_[joint] = std::max(reaches_[joint], reach);
      reach += translationOf(model.links()[joint].origin);
    }
  }
}

void SelfCollision::keepFreeWay(const std::array<double, 7>& q) noexcept {
  free_q_ = q;
  free_way_ = *std::min_element(distance_.begin(), distance_.end()) - kOverlapJitter;
}

bool SelfCollision::isWithinFreeWay(const std::array<double, 7>& q) const noexcept {
  double way = 0.0;
  for (std::size_t i = 0; i < q.size(); i++) {
    way += reaches_[i] * std::abs(q[i] - free_q_[i]);
  }
  return way < free_way_;
}

LinkPair SelfCollision::closest(const franka_core::ArmModel& model,
                                const std::array<double, 7>& q) noexcept {
  measure(model, q);
  LinkPair closest{0, 0, std::numeric_limits<double>::infinity()};
  std::size_t pair = 0;
  for (std::size_t i = 0; i < kCapsuleCount; i++) {
    for (std::size_t j = i + 1; j < kCapsuleCount; j++, pair++) {
      if (distance_[pair] < closest.distance) {
        closest = {kCapsules[i].link, kCapsules[j].link, distance_[pair]};
      }
    }
  }
  return closest;
}

void SelfCollision::begin(const franka_core::ArmModel& model,
                          const std::array<double, 7>& q) noexcept {
  fitReaches(model);
  measure(model, q);
  for (std::size_t pair = 0; pair < kPairs; pair++) {
    allowed_[pair] = std::min(0.0, distance_[pair] - kOverlapJitter);
  }
  keepFreeWay(q);
}

bool SelfCollision::violated(const franka_core::ArmModel& model,
                             const std::array<double, 7>& q) noexcept {
  if (isWithinFreeWay(q)) {
    return false;
  }
  measure(model, q);
  keepFreeWay(q);
  std::size_t pair = 0;
  for (std::size_t i = 0; i < kCapsuleCount; i++) {
    for (std::size_t j = i + 1; j < kCapsuleCount; j++, pair++) {
      if (distance_[pair] < allowed_[pair]) {
        overlapping_pair_ = {kCapsules[i].link, kCapsules[j].link, distance_[pair]};
        return true;
      }
      allowed_[pair] = std::min(0.0, std::max(allowed_[pair], distance_[pair] - kOverlapJitter));
    }
  }
  return false;
}

}  // namespace franka_sim
