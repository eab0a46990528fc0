// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/world_contacts.h>

#include <algorithm>
#include <utility>

#include "physics/world/world_impl.h"

namespace franka_sim {

namespace {

/// Penetration of bodies that rest on each other is smaller (chosen here).
constexpr double kOverlap = 1e-3;  // [m]

}  // namespace

std::vector<Contact> contacts(const World& world) {
  World::Impl& impl = implOf(world);
  std::vector<Contact> result;
  for (const GeomContact& contact : impl.contacts()) {
    result.push_back({impl.geom_links[contact.geom1], impl.geom_links[contact.geom2],
                      contact.position, contact.force});
  }
  return result;
}

Touches touches(const World& world, const std::string& body) {
  World::Impl& impl = implOf(world);
  impl.frame(body);
  Touches touches;
  for (const GeomContact& contact : impl.contacts()) {
    const bool first = impl.geom_links[contact.geom1] == body;
    if (!first && impl.geom_links[contact.geom2] != body) {
      continue;
    }
    const int robot = impl.owners.robot_of_geom[first ? contact.geom2 : contact.geom1];
    if (robot < 0) {
      touches.others = true;
      continue;
    }
    const std::string& name = impl.robots[robot]->description.name;
    if (std::find(touches.robots.begin(), touches.robots.end(), name) == touches.robots.end()) {
      touches.robots.push_back(name);
    }
  }
  return touches;
}

std::vector<Overlap> overlaps(const World& world, const std::string& robot) {
  World::Impl& impl = implOf(world);
  const physics::RobotModel& own = impl.robot(robot);
  const auto owned = [&own](const std::string& link) {
    return std::any_of(own.urdf.links.begin(), own.urdf.links.end(),
                       [&link](const physics::UrdfLink& candidate) {
                         return candidate.name != "world" && candidate.name == link;
                       });
  };
  const mjData& data = impl.findContacts();
  std::vector<Overlap> result;
  for (int c = 0; c < data.ncon; ++c) {
    const mjContact& contact = data.contact[c];
    std::string link = impl.geom_links[contact.geom1], body = impl.geom_links[contact.geom2];
    if (owned(body)) {
      std::swap(link, body);
    }
    if (contact.dist > -kOverlap || !owned(link) || owned(body)) {
      continue;
    }
    const auto same = std::find_if(result.begin(), result.end(), [&](const Overlap& other) {
      return other.link == link && other.body == body;
    });
    if (same == result.end()) {
      result.push_back({link, body, -contact.dist});
    } else {
      same->depth = std::max(same->depth, -contact.dist);
    }
  }
  return result;
}

std::string describeOverlaps(const World& world, const std::string& robot) {
  std::string list;
  for (const Overlap& overlap : overlaps(world, robot)) {
    list += (list.empty() ? "" : ", ") + overlap.link + " and " +
            (overlap.body.empty() ? "the ground or another fixed shape" : overlap.body) + " by " +
            franka_core::fixedText(1e3 * overlap.depth, 0) + " mm";
  }
  return list.empty() ? list
                      : "The robot '" + robot +
                            "' begins within other bodies, which will push it: " + list + ".";
}

}  // namespace franka_sim
