// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/contacts/contact_capacity.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace franka_sim::physics {

namespace {

/// A box in a pile has four contacts with each of the four boxes below it, and as many with
/// neighbors at two of its sides (chosen here).
constexpr int kContactsOfMovingGeom = 24;
/// Memory grows with the square of the rows: with fewer of them contacts share their friction,
/// which needs 32 rows for a box on four others.
constexpr int kContactsWithRowsOfMovingGeom = 11;
/// A robot has enough for a grasp and several links in contact, each shape for a box on a table. An
/// arm with a hand has 43 shapes, which rarely touch anything, so there are rows for one contact of
/// each: several arms may be one robot. The most takes some 35 MB (chosen here).
constexpr int kMinContactsOfRobot = 40;
constexpr int kContactsOfRobotGeom = 4;
constexpr int kMaxContactsWithRowsOfRobot = 300;
constexpr int kMinContacts = 100;
/// Pads of a gripper have torsional friction.
constexpr int kRowsOfGraspContact = 4;
/// MuJoCo 2.2 counts the bytes of a state in an int. For r rows and v degrees of freedom, its
/// matrices of constraints take 12 r^2 + 24 r v; the rest of it gets what remains of the int.
constexpr double kMaxMatrixBytes = 2.08e9;
/// The stack is memory that is used where it is needed only; MuJoCo counts it in an int, too.
constexpr double kMaxStack = 2.5e8;  // [numbers]

int rowsWithoutContacts(const mjModel& model, const std::vector<int>& robot_of_body) {
  int rows = 6 * model.neq + 3 * model.ntendon;
  for (int j = 0; j < model.njnt; ++j) {
    rows += model.jnt_limited[j] != 0 ? 2 : 0;
  }
  for (int dof = 0; dof < model.nv; ++dof) {
    const bool of_robot = robot_of_body[model.dof_bodyid[dof]] >= 0;  // which sets friction later
    rows += of_robot || model.dof_frictionloss[dof] > 0 ? 1 : 0;
  }
  return rows;
}

}  // namespace

void setContactCapacity(mjModel* model, const std::vector<int>& robot_of_body,
                        const GivenSizes& given) {
  std::vector<bool> collides(model->ngeom);
  int rows_of_contact = 3;
  for (int geom = 0; geom < model->ngeom; ++geom) {
    collides[geom] = (model->geom_contype[geom] | model->geom_conaffinity[geom]) != 0;
    if (collides[geom]) {
      rows_of_contact = std::max(rows_of_contact, model->geom_condim[geom]);
    }
  }
  for (int pair = 0; pair < model->npair; ++pair) {
    collides[model->pair_geom1[pair]] = collides[model->pair_geom2[pair]] = true;
  }
  std::map<int, int> shapes;  // that move and collide: per robot, and -1 of all objects
  for (const int robot : robot_of_body) {
    shapes.emplace(robot, 0);
  }
  for (int geom = 0; geom < model->ngeom; ++geom) {
    const int body = model->geom_bodyid[geom];
    shapes[robot_of_body[body]] += collides[geom] && model->body_weldid[body] != 0 ? 1 : 0;
  }
  const int geoms = shapes[-1];
  shapes.erase(-1);
  int contacts_of_robots = 0;
  int contacts_with_rows_of_robots = 0;
  for (const auto& [robot, count] : shapes) {
    contacts_of_robots += std::max(kContactsOfRobotGeom * count, kMinContactsOfRobot);
    contacts_with_rows_of_robots +=
        std::clamp(count, kMinContactsOfRobot, kMaxContactsWithRowsOfRobot);
  }
  if (!given.nconmax) {
    model->nconmax = std::max(kContactsOfMovingGeom * geoms, kMinContacts) + contacts_of_robots;
  }
  if (!given.njmax) {
    const double v = model->nv;
    const double most = std::sqrt(v * v + kMaxMatrixBytes / 12) - v;
    const int contacts = std::max(kContactsWithRowsOfMovingGeom * geoms, kMinContacts);
    const double rows = rowsWithoutContacts(*model, robot_of_body) + rows_of_contact * contacts +
                        kRowsOfGraspContact * contacts_with_rows_of_robots;
    model->njmax = static_cast<int>(std::min(rows, most));
  }
  if (!given.nstack) {
    const double side = model->njmax + model->neq + model->nv;
    model->nstack = std::max(model->nstack, static_cast<int>(std::min(5 * side * side, kMaxStack)));
  }
}

}  // namespace franka_sim::physics
