// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Torque steps.
#include "fci_fixture.h"
#include "robot/motion_supervisor.h"

namespace franka_sim::test {

namespace {

TEST(TorqueCommand, StepsAreJudgedFromTheCommandedAndFromTheSaturatedTorque) {
  struct Row {
    double before, next;  // of joint 1, whose motor gives 87 Nm [Nm]
    bool jumps;
  };
  const Row rows[] = {
      {10.0, 11.0, false}, {10.0, 11.1, true},  // 1 Nm in a tick
      {88.5, 89.4, false},                      // near the commanded torque only
      {88.5, 86.1, false},                      // near the saturated torque only
      {88.5, 90.0, true},  {88.5, 85.9, true}, {-95, -86.5, false}, {-95, -85.9, true},
  };
  for (const Row& row : rows) {
    TorqueCommand command(std::array<double, 7>{{87, 87, 87, 87, 12, 12, 12}});
    ASSERT_TRUE(command.receive({{row.before, 0, 0, 0, 0, 0, 0}}));
    EXPECT_EQ(row.jumps, command.jumps({{row.next, 0, 0, 0, 0, 0, 0}}))
        << row.before << " to " << row.next;
  }
}

}  // namespace

}  // namespace franka_sim::test
