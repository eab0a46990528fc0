// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/world/world_change.h"

#include "physics/contacts/contact_capacity.h"

namespace franka_sim {

void physics::placeInitially(const mjModel& model, mjData* data, const Robots& robots) {
  for (const auto& robot : robots) {
    for (const UrdfJoint& joint : robot->urdf.joints) {
      const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
      if (joint.type != UrdfJoint::Type::kFixed && id >= 0) {
        data->qpos[model.jnt_qposadr[id]] = robot->initialPosition(joint);
      }
    }
  }
}

std::vector<int> physics::robotOfBody(const mjModel& model, const Robots& robots) {
  std::vector<int> robot_of_body(model.nbody, -1);
  for (std::size_t r = 0; r < robots.size(); ++r) {
    for (const Segment& segment : robots[r]->segments) {
      const std::string& link = robots[r]->urdf.links[segment.link].name;
      const int body = mj_name2id(&model, mjOBJ_BODY, link.c_str());
      if (body > 0) {
        robot_of_body[body] = static_cast<int>(r);
      }
    }
  }
  return robot_of_body;
}

void WorldChange::compile() { content_->compile(); }

void WorldChange::Content::compile() {
  if (describe) {
    describe(*this);
  }
  std::vector<const physics::RobotModel*> list;
  for (const auto& robot : robots) {
    list.push_back(robot.get());
  }
  const std::string title =
      list.empty() ? world->title()
                   : world->title() + " with robot '" + list.back()->description.name + "'";
  model = physics::compile(world->merge(list, false), title);
  physics::setContactCapacity(model.get(), physics::robotOfBody(*model, robots),
                              world->givenSizes());
  identity = physics::identityOf(*model, list);
  data = physics::makeData(*model);
  mj_resetData(model.get(), data.get());
  physics::placeInitially(*model, data.get(), robots);
}

}  // namespace franka_sim
