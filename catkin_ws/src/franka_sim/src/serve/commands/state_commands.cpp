// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include "serve/commands/command_groups.h"
#include "serve/robot_report.h"

namespace franka_sim {

void addStateCommands(fci::CommandTable& table, const OperatorContext& context) {
  using fci::line;
  table.add(line("state"), "mode, client, errors and joints", fci::kNotOnPage,
            [&robot = context.robot, &world = context.world] {
              return fci::describe(robot) + (world.stopped() ? "; " + world.fault() : "");
            });
  table.add(line("report"),
            "everything of the robot as one JSON object: state, errors, brakes, inputs, lights, "
            "hand, end effector; `user_stop` lists what presses the user stop",
            fci::kNotOnPage, [context] {
              fci::JsonWriter json;
              json.beginObject().member("time", context.world.time());
              json.member("arm_id", context.arm_id);
              fci::writeReport(context.robot, json);
              return json.member("fault", context.world.fault()).endObject().text();
            });
  table
      .add(line("hash"),
           "hash of all states since the first command: runs with equal hashes are equal. In "
           "lock-step it waits until no motion runs and the world is at rest (at most 10 s of its "
           "time)",
           fci::kNotOnPage,
           [&robot = context.robot] {
             char text[24];
             std::snprintf(text, sizeof(text), "%016llx",
                           static_cast<unsigned long long>(robot.hash()));
             return std::string(text);
           })
      .ready = [&host = context.host] { return host.settled(); };
}

}  // namespace franka_sim
