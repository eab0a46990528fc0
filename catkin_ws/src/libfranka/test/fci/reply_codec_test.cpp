// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/reply_codec.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "hex.h"

namespace {

using namespace franka_core::fci;  // NOLINT: the whole vocabulary of replies
using franka_test::fromHex;
using franka_test::toVector;
using franka_test::view;
using S = Status;

// Typed from the description of the protocol, independent of the codec: statuses by number.
std::vector<Status> statusesOf(Command command, std::uint16_t version) {
  const S unsafe = S::kRejectedDueToActivatedSafetyFunctions;  // from version 6 on
  const S preempted_by_safety = S::kPreemptedDueToActivatedSafetyFunctions;
  const S not_possible = S::kCommandNotPossibleRejected;
  std::vector<Status> statuses;
  switch (command) {
    case Command::kConnect:
      return {S::kSuccess, S::kIncompatibleLibraryVersion};
    case Command::kLoadModelLibrary:
      return {S::kSuccess, S::kError};
    case Command::kMove:
      statuses = {S::kSuccess,
                  S::kMotionStarted,
                  S::kPreempted,
                  preempted_by_safety,
                  unsafe,
                  not_possible,
                  S::kStartAtSingularPoseRejected,
                  S::kInvalidArgumentRejected,
                  S::kReflexAborted,
                  S::kEmergencyAborted,
                  S::kInputErrorAborted,
                  S::kAborted};
      break;
    case Command::kStopMove:
      statuses = {S::kSuccess,          not_possible,      unsafe,
                  S::kEmergencyAborted, S::kReflexAborted, S::kAborted};
      break;
    case Command::kAutomaticErrorRecovery:
      statuses = {S::kSuccess,
                  not_possible,
                  unsafe,
                  S::kManualErrorRecoveryRequiredRejected,
                  S::kReflexAborted,
                  S::kEmergencyAborted,
                  S::kAborted};
      break;
    case Command::kGetRobotModel:
      statuses = {S::kSuccess, not_possible, unsafe};
      break;
    default:
      statuses = {S::kSuccess, not_possible, S::kInvalidArgumentRejected, unsafe};
  }
  if (version < 6) {
    statuses.erase(std::remove_if(statuses.begin(), statuses.end(),
                                  [=](S s) { return s == unsafe || s == preempted_by_safety; }),
                   statuses.end());
  }
  return statuses;
}

class ReplyOfVersion : public ::testing::TestWithParam<std::uint16_t> {
 protected:
  static std::vector<Command> commands() {
    std::vector<Command> result;
    for (std::size_t i = 0; i < kCommandCount; i++) {
      if (commandNumber(GetParam(), static_cast<Command>(i))) {
        result.push_back(static_cast<Command>(i));
      }
    }
    return result;
  }
};

INSTANTIATE_TEST_SUITE_P(Versions, ReplyOfVersion, ::testing::Range<std::uint16_t>(3, 11));

TEST_P(ReplyOfVersion, TransmitsOnlyTheStatusesOfItsCommand) {
  for (const Command command : commands()) {
    const std::vector<Status> due = statusesOf(command, GetParam());
    for (std::size_t i = 0; i < kStatusCount; i++) {
      Reply sent;
      sent.status = static_cast<Status>(i);
      ReplyMessage message;
      std::optional<std::size_t> number;
      for (std::size_t n = 0; n < due.size(); n++) {
        if (due[n] == sent.status) {
          number = n;
        }
      }
      ASSERT_EQ(encodeReply(GetParam(), command, 77, sent, message),
                number ? CodecError::kNone : CodecError::kUnknownStatus);
      if (!number) {
        EXPECT_EQ(message.size, 0U);
        continue;
      }
      EXPECT_EQ(message.data[12], *number);
      Header header;
      Reply received;
      Bytes model;
      ASSERT_EQ(decodeReply(GetParam(), command, message.bytes(), header, received, model),
                CodecError::kNone);
      EXPECT_EQ(received.status, sent.status);
      EXPECT_EQ(header.command_id, 77U);
      EXPECT_EQ(header.command, commandNumber(GetParam(), command));
    }
  }
}

TEST_P(ReplyOfVersion, IsRefusedWithAnUnknownStatus) {
  for (const Command command : commands()) {
    ReplyMessage message;
    ASSERT_EQ(encodeReply(GetParam(), command, 1, Reply{}, message), CodecError::kNone);
    const std::size_t known = statusesOf(command, GetParam()).size();
    for (std::size_t status = 0; status < 256; status++) {
      message.data[12] = static_cast<std::uint8_t>(status);
      Header header;
      Reply reply;
      Bytes model;
      EXPECT_EQ(decodeReply(GetParam(), command, message.bytes(), header, reply, model),
                status < known ? CodecError::kNone : CodecError::kUnknownStatus);
    }
  }
}

TEST_P(ReplyOfVersion, IsRefusedAtAnotherSize) {
  for (const Command command : commands()) {
    ReplyMessage message;
    ASSERT_EQ(encodeReply(GetParam(), command, 1, Reply{}, message), CodecError::kNone);
    const std::size_t due = command == Command::kConnect             ? 15
                            : command == Command::kGetCartesianLimit ? 166
                                                                     : 13;
    ASSERT_EQ(message.size, due);
    ASSERT_EQ(replySize(GetParam(), command), due);
    const bool open_ended = command == Command::kLoadModelLibrary ||
                            command == Command::kGetRobotModel || command == Command::kConnect;
    franka_test::forEverySize(toVector(message), 8, [&](const auto& bytes, bool honest) {
      Header header;
      Reply reply;
      Bytes model;
      const bool good = bytes.size() == due || (open_ended && honest && bytes.size() > due);
      EXPECT_EQ(decodeReply(GetParam(), command, view(bytes), header, reply, model),
                good ? CodecError::kNone : CodecError::kWrongSize);
    });
  }
}

TEST(ReplyCodec, WritesTheRobotsVersion) {
  Reply reply;
  reply.status = S::kIncompatibleLibraryVersion;
  reply.server_version = 10;
  ReplyMessage message;
  ASSERT_EQ(encodeReply(10, Command::kConnect, 0, reply, message), CodecError::kNone);
  EXPECT_EQ(toVector(message), fromHex("00000000 00000000 0f000000 01 0a00"));
  // A client of any version reads it.
  for (std::uint16_t version = 3; version <= 10; version++) {
    Header header;
    Reply received;
    Bytes model;
    ASSERT_EQ(decodeReply(version, Command::kConnect, message.bytes(), header, received, model),
              CodecError::kNone);
    EXPECT_EQ(received.server_version, 10);
    EXPECT_EQ(received.status, S::kIncompatibleLibraryVersion);
  }
}

TEST(ReplyCodec, TransmitsAVirtualWall) {
  Reply sent;
  sent.cartesian_limit.object_world_size = {1.0, 2.0, 3.0};
  for (std::size_t i = 0; i < 16; i++) {
    sent.cartesian_limit.object_frame[i] = static_cast<double>(i) + 0.5;
  }
  sent.cartesian_limit.active = true;
  ReplyMessage message;
  ASSERT_EQ(encodeReply(5, Command::kGetCartesianLimit, 2, sent, message), CodecError::kNone);
  EXPECT_EQ(message.data[165], 1);
  Header header;
  Reply received;
  Bytes model;
  ASSERT_EQ(decodeReply(5, Command::kGetCartesianLimit, message.bytes(), header, received, model),
            CodecError::kNone);
  EXPECT_EQ(received.cartesian_limit.object_world_size, sent.cartesian_limit.object_world_size);
  EXPECT_EQ(received.cartesian_limit.object_frame, sent.cartesian_limit.object_frame);
  EXPECT_TRUE(received.cartesian_limit.active);
  message.data[165] = 3;
  EXPECT_EQ(decodeReply(5, Command::kGetCartesianLimit, message.bytes(), header, received, model),
            CodecError::kBadBoolean);
  EXPECT_EQ(encodeReply(6, Command::kGetCartesianLimit, 2, sent, message),
            CodecError::kNotInThisVersion);
}

TEST(ReplyCodec, TransmitsModels) {
  const std::vector<std::uint8_t> library = fromHex("7f 45 4c 46 00 01");
  std::vector<std::uint8_t> message;
  ASSERT_EQ(encodeModelReply(5, Command::kLoadModelLibrary, 4, view(library), message),
            CodecError::kNone);
  EXPECT_EQ(message, fromHex("0d000000 04000000 13000000 00 7f454c460001"));
  Header header;
  Reply reply;
  Bytes model;
  ASSERT_EQ(decodeReply(5, Command::kLoadModelLibrary, view(message), header, reply, model),
            CodecError::kNone);
  EXPECT_EQ(model.data, message.data() + 13);
  EXPECT_EQ(model.size, 6U);
  ASSERT_EQ(encodeModelReply(10, Command::kGetRobotModel, 4, Bytes{}, message), CodecError::kNone);
  EXPECT_EQ(message, fromHex("0b000000 04000000 0d000000 00"));
}

TEST(ReplyCodec, TransmitsNoModelForOtherVersions) {
  std::vector<std::uint8_t> message;
  const Bytes nothing;
  EXPECT_EQ(encodeModelReply(5, Command::kGetRobotModel, 4, nothing, message),
            CodecError::kNotInThisVersion);
  EXPECT_EQ(encodeModelReply(10, Command::kLoadModelLibrary, 4, nothing, message),
            CodecError::kNotInThisVersion);
  EXPECT_EQ(encodeModelReply(5, Command::kMove, 4, nothing, message),
            CodecError::kNotInThisVersion);
  EXPECT_EQ(encodeModelReply(11, Command::kGetRobotModel, 4, nothing, message),
            CodecError::kUnknownVersion);
  const std::uint8_t byte = 0;
  EXPECT_EQ(encodeModelReply(10, Command::kGetRobotModel, 4, Bytes{&byte, kMaxReplySize}, message),
            CodecError::kTooLong);
  EXPECT_TRUE(message.empty());
}

}  // namespace
