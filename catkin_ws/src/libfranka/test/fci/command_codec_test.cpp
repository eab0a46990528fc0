// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/command_codec.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "fci_random.h"

namespace {

using franka_core::RobotCommand;
using franka_core::fci::CodecError;
using franka_core::fci::CommandBuffer;
namespace fci = franka_core::fci;

class CommandOfVersion : public ::testing::TestWithParam<std::uint16_t> {
 protected:
  static std::size_t dueSize() { return GetParam() >= 7 ? 371 : 370; }
};

INSTANTIATE_TEST_SUITE_P(Versions, CommandOfVersion, ::testing::Range<std::uint16_t>(3, 11));

RobotCommand randomCommand(franka_test::FciRandom& random, std::uint16_t version) {
  RobotCommand command;
  command.message_id = random.upTo(std::numeric_limits<std::uint64_t>::max());
  random.fillAll(command.q_c, command.dq_c, command.O_T_EE_c, command.O_dP_EE_c, command.elbow_c,
                 command.valid_elbow, command.motion_generation_finished, command.tau_J_d,
                 command.torque_command_finished);
  if (version < 7) {
    command.torque_command_finished = false;
  }
  return command;
}

// Offsets typed from the description of the datagram.
TEST_P(CommandOfVersion, HasEachFieldAtItsOffset) {
  RobotCommand command;
  command.message_id = 0x1122334455667788;
  command.q_c[6] = 1.25;
  command.dq_c[0] = 2.25;
  command.O_T_EE_c[15] = 3.25;
  command.O_dP_EE_c[5] = 4.25;
  command.elbow_c[1] = 5.25;
  command.valid_elbow = true;
  command.tau_J_d[0] = 6.25;
  command.torque_command_finished = true;
  CommandBuffer buffer{};
  ASSERT_EQ(fci::encodeCommand(GetParam(), command, buffer), CodecError::kNone);
  ASSERT_EQ(fci::commandSize(GetParam()), dueSize());
  const auto real = [&](std::size_t offset) {
    double value;
    std::memcpy(&value, buffer.data() + offset, sizeof(value));
    return value;
  };
  EXPECT_EQ(buffer[0], 0x88);
  EXPECT_EQ(buffer[7], 0x11);
  EXPECT_EQ(real(8 + 6 * 8), 1.25);
  EXPECT_EQ(real(64), 2.25);
  EXPECT_EQ(real(120 + 15 * 8), 3.25);
  EXPECT_EQ(real(248 + 5 * 8), 4.25);
  EXPECT_EQ(real(296 + 8), 5.25);
  EXPECT_EQ(buffer[312], 1);
  EXPECT_EQ(buffer[313], 0);
  EXPECT_EQ(real(314), 6.25);
  EXPECT_EQ(buffer[370], GetParam() >= 7 ? 1 : 0);
}

TEST_P(CommandOfVersion, RoundTripsUnchanged) {
  franka_test::FciRandom random(GetParam());
  for (int i = 0; i < 200; i++) {
    const RobotCommand sent = randomCommand(random, GetParam());
    CommandBuffer buffer{};
    ASSERT_EQ(fci::encodeCommand(GetParam(), sent, buffer), CodecError::kNone);
    RobotCommand received;
    ASSERT_EQ(fci::decodeCommand(GetParam(), {buffer.data(), dueSize()}, received),
              CodecError::kNone);
    CommandBuffer again{};
    ASSERT_EQ(fci::encodeCommand(GetParam(), received, again), CodecError::kNone);
    ASSERT_EQ(buffer, again);
  }
}

TEST_P(CommandOfVersion, IsRefusedAtEveryOtherSize) {
  RobotCommand command;
  command.message_id = 5;
  for (std::size_t size = 0; size < 400; size++) {
    const std::vector<std::uint8_t> bytes(size, 0);
    const bool fits = size == dueSize();
    EXPECT_EQ(fci::decodeCommand(GetParam(), {bytes.data(), size}, command),
              fits ? CodecError::kNone : CodecError::kWrongSize);
    EXPECT_EQ(command.message_id, size >= dueSize() ? 0U : 5U);
  }
}

// Every number in turn: read completely, and reported as not finite.
TEST_P(CommandOfVersion, ReportsNonFiniteNumbers) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (std::size_t at = 8; at + 8 <= 370; at += at == 304 ? 10 : 8) {
      CommandBuffer buffer{};
      buffer[0] = 42;
      std::memcpy(buffer.data() + at, &bad, sizeof(bad));
      RobotCommand command;
      EXPECT_EQ(fci::decodeCommand(GetParam(), {buffer.data(), dueSize()}, command),
                CodecError::kNotFinite)
          << at;
      EXPECT_EQ(command.message_id, 42U);
    }
  }
}

TEST_P(CommandOfVersion, IsRefusedWithInvalidBooleans) {
  std::vector<std::size_t> places{312, 313};
  if (GetParam() >= 7) {
    places.push_back(370);
  }
  for (const std::size_t place : places) {
    CommandBuffer buffer{};
    buffer[0] = 42;
    buffer[place] = 2;
    RobotCommand command;
    EXPECT_EQ(fci::decodeCommand(GetParam(), {buffer.data(), dueSize()}, command),
              CodecError::kBadBoolean);
    EXPECT_EQ(command.message_id, 0U);
  }
}

TEST(CommandCodec, RefusesUnknownVersions) {
  CommandBuffer buffer{};
  RobotCommand command;
  for (const std::uint16_t version : {0, 2, 11, 65535}) {
    EXPECT_EQ(fci::commandSize(version), 0U);
    EXPECT_EQ(fci::encodeCommand(version, command, buffer), CodecError::kUnknownVersion);
    EXPECT_EQ(fci::decodeCommand(version, {buffer.data(), 370}, command),
              CodecError::kUnknownVersion);
  }
}

}  // namespace
