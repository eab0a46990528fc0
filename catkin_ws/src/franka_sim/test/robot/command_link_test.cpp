// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/command_link.h>
#include <gtest/gtest.h>

#include <vector>

#include "robot/safety/command_window.h"

namespace franka_sim {
namespace {

/// Sends commands 1 to `count`; returns the ids at the output, 0 for none.
std::vector<std::uint64_t> send(CommandLink& link, std::uint64_t count) {
  std::vector<std::uint64_t> out;
  for (std::uint64_t id = 1; id <= count; id++) {
    franka_core::RobotCommand command;
    command.message_id = id;
    const franka_core::RobotCommand* arrived = link.pass(&command);
    out.push_back(arrived == nullptr ? 0 : arrived->message_id);
  }
  return out;
}

TEST(CommandLink, DelaysByWholeTicksAndLosesOnDemand) {
  struct Row {
    unsigned delay, lost;
    std::vector<std::uint64_t> out;
  };
  for (const Row& row : {Row{0, 0, {1, 2, 3, 4}}, Row{1, 0, {0, 1, 2, 3}}, Row{2, 0, {0, 0, 1, 2}},
                         Row{0, 2, {0, 0, 3, 4}}}) {
    CommandLink link;
    link.setDelay(row.delay);
    link.loseNext(row.lost);
    EXPECT_EQ(row.out, send(link, 4));
    // Commands in transit arrive even if nothing follows.
    for (std::uint64_t id = 5 - row.delay; id <= 4; id++) {
      EXPECT_EQ(id, link.pass(nullptr)->message_id);
    }
    EXPECT_EQ(nullptr, link.pass(nullptr));
  }
}

TEST(CommandLink, ClearDropsCommandsInTransit) {
  CommandLink link;
  link.setDelay(2);
  send(link, 5);
  link.clear();
  EXPECT_EQ(link.pass(nullptr), nullptr);
  EXPECT_EQ(link.pass(nullptr), nullptr);
  EXPECT_EQ(send(link, 4), (std::vector<std::uint64_t>{0, 0, 1, 2})) << "the delay stays";
}

TEST(CommandLink, RepeatsItsLossesAfterARestart) {
  CommandLink link;
  link.setDelay(1);
  link.setLoss(0.5, 7);
  const std::vector<std::uint64_t> first = send(link, 100);
  link.loseNext(3);
  link.restart();
  EXPECT_EQ(send(link, 100), first);
}

TEST(CommandLink, LosesTheConfiguredShareRepeatably) {
  constexpr std::uint64_t kCount = 20000;
  std::vector<std::uint64_t> first;
  for (const std::uint64_t seed : {7U, 7U, 8U}) {
    CommandLink link;
    link.setLoss(0.1, seed);
    const std::vector<std::uint64_t> out = send(link, kCount);
    std::size_t lost = 0;
    for (const std::uint64_t id : out) {
      lost += id == 0 ? 1 : 0;
    }
    // Five standard deviations of the binomial distribution: 5 sqrt(n p (1 - p)) = 212.
    EXPECT_NEAR(static_cast<double>(lost), 2000.0, 212.0);
    if (first.empty()) {
      first = out;
    }
    EXPECT_EQ(out == first, seed == 7U);
  }
  CommandLink all;
  all.setLoss(1.0, 0);
  EXPECT_EQ(send(all, 3), (std::vector<std::uint64_t>{0, 0, 0}));
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

}  // namespace
}  // namespace franka_sim
