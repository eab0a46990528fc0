// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The small classes of robot, each alone.
#include <franka_sim/robot/command_filter.h>
#include <franka_sim/robot/command_window.h>
#include <franka_sim/robot/contact_monitor.h>
#include <franka_sim/robot/external_wrench.h>
#include <franka_sim/robot/finger_force.h>
#include <franka_sim/robot/joint_impedance.h>
#include <franka_sim/robot/low_pass.h>
#include <franka_sim/robot/standstill.h>
#include <franka_sim/robot/ticket_log.h>
#include <franka_sim/robot/transforms.h>
#include <franka_sim/robot/width_ramp.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace franka_sim::test {

namespace {

TEST(LowPass, HasTheFirstOrderGainAndReachesItsInput) {
  LowPass<1> filter(100.0);
  EXPECT_NEAR(0.385869545, filter.update({{1.0}})[0], 1e-9);  // T / (T + 1 / (2 pi 100))
  for (int i = 0; i < 100; i++) {
    filter.update({{1.0}});
  }
  EXPECT_NEAR(1.0, filter.output()[0], 1e-12);
  filter.restart();
  EXPECT_EQ(0.0, filter.output()[0]);
}

TEST(CommandWindow, CountsTheLastHundredSlots) {
  CommandWindow window;
  EXPECT_EQ(0.0, window.rate());
  window.record(true);
  EXPECT_EQ(1.0, window.rate());
  window.record(false);
  EXPECT_EQ(0.5, window.rate());
  for (int i = 0; i < 98; i++) {
    window.record(true);
  }
  EXPECT_DOUBLE_EQ(0.99, window.rate());
  window.record(true);  // pushes a success out
  EXPECT_DOUBLE_EQ(0.99, window.rate());
  window.record(true);  // pushes the failure out
  EXPECT_DOUBLE_EQ(1.0, window.rate());
  window.clear();
  EXPECT_EQ(0.0, window.rate());
}

TEST(ContactMonitor, IncludesItsUpperThreshold) {
  ContactMonitor<1> monitor;
  struct Row {
    double value, contact, collision;
  };
  for (const Row& row : {Row{0, 0, 0}, Row{10, 0, 0}, Row{10.001, 1, 0}, Row{-10.001, 1, 0},
                         Row{20, 1, 0}, Row{-20, 1, 0}, Row{-20.001, 0, 1}, Row{0, 0, 1}}) {
    monitor.update({{row.value}}, {{10}}, {{20}});
    EXPECT_EQ(row.contact, monitor.contact()[0]) << row.value;
    EXPECT_EQ(row.collision, monitor.collision()[0]) << row.value;
  }
  monitor.clear();
  EXPECT_EQ(0.0, monitor.collision()[0]);
}

TEST(ContactMonitor, EqualThresholdsGiveNoContact) {
  ContactMonitor<1> monitor;
  for (const double value : {19.0, 20.0}) {
    monitor.update({{value}}, {{20}}, {{20}});
    EXPECT_EQ(0.0, monitor.contact()[0]);
    EXPECT_EQ(0.0, monitor.collision()[0]);
  }
}

TEST(JointImpedance, IsSpringDamperAndCoriolis) {
  std::array<double, 49> mass{};
  for (std::size_t i = 0; i < 7; i++) {
    mass[8 * i] = 0.9;
  }
  std::array<double, 7> k{{400, 100, 0, 0, 0, 0, 0}};
  std::array<double, 7> b;
  b.fill(0.1);
  const JointImpedance law(k, b);
  const std::array<double, 7> tau =
      law.torque({{0.1, 0, 0.5}}, {{0, 0.2, 1}}, {}, {{0.3, 0, 0}}, mass, {{0, 0, 0, 7}});
  EXPECT_NEAR(400 * 0.1 - 1.4 * 20 * 0.3, tau[0], 1e-12);
  EXPECT_NEAR(1.4 * 10 * 0.2, tau[1], 1e-12);
  EXPECT_EQ(0.0, tau[2]) << "no stiffness, no damping";
  EXPECT_EQ(7.0, tau[3]);
}

TEST(ExternalWrench, InvertsTheTransposedJacobianAtK) {
  // A Jacobian of a Cartesian machine whose seventh joint equals the first.
  std::array<double, 42> J{};
  for (std::size_t i = 0; i < 6; i++) {
    J[6 * i + i] = 1.0;
  }
  J[36] = 1.0;
  Transform O_T_EE = {{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}};
  Transform EE_T_K = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}};
  ExternalWrench map;
  map.update(O_T_EE, J, EE_T_K);
  ASSERT_FALSE(map.singular());
  // K lies at r = (0, 1, 0) in O; a force f and a moment m there turn the joints by f, and m + r x
  // f.
  const std::array<double, 6> F{{1, 2, 3, 4, 5, 6}};
  const std::array<double, 7> tau{{1, 2, 3, 4 + 3, 5, 6 - 1, 1}};
  const std::array<double, 6> wrench = map.inBase(tau);
  for (std::size_t i = 0; i < 6; i++) {
    EXPECT_NEAR(F[i], wrench[i], 1e-12) << i;
  }
  const std::array<double, 6> in_K = map.inStiffness(wrench);
  const std::array<double, 6> expected{{2, -1, 3, 5, -4, 6}};
  for (std::size_t i = 0; i < 6; i++) {
    EXPECT_NEAR(expected[i], in_K[i], 1e-12) << i;
  }
}

TEST(Transforms, MultiplyInTheRightOrder) {
  const Transform turn = {{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  Transform shift = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}};
  const Transform turned = multiply(turn, shift);
  EXPECT_EQ(-2, turned[12]);
  EXPECT_EQ(1, turned[13]);
  EXPECT_EQ(3, turned[14]);
}

TEST(WidthRamp, MovesAtItsSpeedAndEndsExactly) {
  for (const double speed : {0.0007, 0.02, 0.1}) {
    for (const double target : {0.0, 0.0300001, 0.08}) {
      WidthRamp ramp;
      ramp.start(0.03, target, speed);
      double last = 0.03;
      double fastest = 0.0;
      int ticks = 0;
      while (!ramp.arrived() && ticks < 200000) {
        ramp.step(1e-3);
        const double step = std::abs(ramp.width() - last) / 1e-3;
        fastest = std::max(fastest, step);
        last = ramp.width();
        EXPECT_GE(ramp.width(), std::min(0.03, target));
        EXPECT_LE(ramp.width(), std::max(0.03, target));
        ticks++;
      }
      EXPECT_EQ(target, ramp.width());
      EXPECT_EQ(0.0, ramp.velocity());
      EXPECT_LE(fastest, speed * (1 + 1e-9));
      const double way = std::abs(target - 0.03);
      const double expected = way > speed * speed ? way / speed + speed : 2.0 * std::sqrt(way);
      EXPECT_NEAR(expected, 1e-3 * ticks, 0.01 + 0.01 * expected) << speed << " " << target;
    }
  }
}

TEST(WidthRamp, WithoutSpeedStays) {
  WidthRamp ramp;
  ramp.start(0.03, 0.08, 0.0);
  for (int i = 0; i < 1000; i++) {
    ramp.step(1e-3);
  }
  EXPECT_EQ(0.03, ramp.width());
  EXPECT_FALSE(ramp.arrived());
  ramp.hold(0.05);
  EXPECT_TRUE(ramp.arrived());
}

TEST(Standstill, CountsAfterTheFirstMotionOrTheTimeout) {
  Standstill standstill(3);
  standstill.restart();
  EXPECT_FALSE(standstill.update(0, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(0, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(0, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(0.002, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(0.001, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(-0.001, 0.001, 1e-3));
  EXPECT_TRUE(standstill.update(0, 0.001, 1e-3));
  standstill.restart();
  int ticks = 0;
  while (!standstill.update(0, 0.001, 1e-3)) {
    ticks++;
  }
  EXPECT_NEAR(202, ticks + 1, 1);
}

TEST(Standstill, RestartsAfterEveryMotion) {
  Standstill standstill(3);
  standstill.restart();
  standstill.countFromNow();
  EXPECT_FALSE(standstill.update(0, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(0, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(0.01, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(0, 0.001, 1e-3));
  EXPECT_FALSE(standstill.update(0, 0.001, 1e-3));
  EXPECT_TRUE(standstill.update(0, 0.001, 1e-3));
}

TEST(FingerForce, LimitsTheIntegral) {
  FingerForce finger({100, 50, 1});
  EXPECT_NEAR(1 + 50 * 0.01 * 1e-3 + 8 * 0.5, finger.update(0.01, 0.5, 1e-3), 1e-12);
  for (int i = 0; i < 1000000; i++) {
    finger.update(0.04, 0, 1e-3);
  }
  EXPECT_NEAR(4 + 10, finger.update(0.04, 0, 1e-3), 1e-12);
  finger.restart();
  EXPECT_NEAR(0.0, finger.update(0, 0, 1e-3), 1e-12);
}

// Like the client's filter: a pose that is not quite orthogonal counts as the nearest rotation.
TEST(CommandFilter, TakesTheNearestRotationOfAPose) {
  franka_core::fci::SetFiltersRequest cutoffs{1000, 1000, 100, 1000, 1000};
  franka_core::RobotState state;
  Eigen::Map<Eigen::Matrix4d> pose(state.O_T_EE_c.data());
  pose.setIdentity();
  pose.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  pose(0, 1) += 8e-6;
  pose(2, 0) -= 7e-6;
  pose(1, 1) += 5e-6;
  franka_core::RobotCommand command;
  command.O_T_EE_c = state.O_T_EE_c;
  CommandFilter filter;
  ASSERT_TRUE(filter.set(cutoffs));
  filter.begin(state);
  const Eigen::Matrix4d filtered = Eigen::Matrix4d::Map(filter.apply(command).O_T_EE_c.data());
  const Eigen::Matrix3d nearest = Eigen::Affine3d(pose).rotation();
  EXPECT_LT((filtered.topLeftCorner<3, 3>() - nearest).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(TicketLog, KeepsSixteenOutcomes) {
  TicketLog log;
  EXPECT_EQ(GripperOutcome::kFailed, log.outcome(0));
  EXPECT_EQ(GripperOutcome::kFailed, log.outcome(1));
  log.close(GripperOutcome::kSucceeded);  // nothing runs
  const TicketLog::Ticket first = log.open();
  EXPECT_EQ(1u, first);
  EXPECT_EQ(GripperOutcome::kRunning, log.outcome(first));
  const TicketLog::Ticket second = log.open();
  EXPECT_EQ(GripperOutcome::kInterrupted, log.outcome(first));
  log.close(GripperOutcome::kSucceeded);
  log.close(GripperOutcome::kFailed);  // has already ended
  EXPECT_EQ(GripperOutcome::kSucceeded, log.outcome(second));
  for (std::size_t i = 0; i < TicketLog::kRemembered - 1; i++) {
    log.open();
  }
  EXPECT_EQ(GripperOutcome::kSucceeded, log.outcome(second));
  log.open();
  EXPECT_EQ(GripperOutcome::kInterrupted, log.outcome(second)) << "forgotten";
  EXPECT_EQ(GripperOutcome::kFailed, log.outcome(100));
}

}  // namespace

}  // namespace franka_sim::test
