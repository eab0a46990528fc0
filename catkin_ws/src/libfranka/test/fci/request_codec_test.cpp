// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/request_codec.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "fci_random.h"
#include "hex.h"

namespace {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using namespace franka_core::fci;  // NOLINT: the whole vocabulary of requests
using franka_test::fromHex;
using franka_test::toVector;
using franka_test::view;

// Typed from the description of the protocol, independent of the codec; -1: not in that version.
struct RequestRow {
  Command command;
  int number_3_to_5, number_6_and_7, number_8_and_9, number_10;
  std::size_t size;
};
constexpr RequestRow kRequestRows[] = {
    {Command::kConnect, 0, 0, 0, 0, 16},
    {Command::kMove, 1, 1, 1, 1, 68},
    {Command::kStopMove, 2, 2, 2, 2, 12},
    {Command::kGetCartesianLimit, 3, -1, -1, -1, 16},
    {Command::kSetCollisionBehavior, 4, 3, 3, 3, 428},
    {Command::kSetJointImpedance, 5, 4, 4, 4, 68},
    {Command::kSetCartesianImpedance, 6, 5, 5, 5, 60},
    {Command::kSetGuidingMode, 7, 6, 6, 6, 19},
    {Command::kSetEEToK, 8, 7, 7, 7, 140},
    {Command::kSetNEToEE, 9, 8, 8, 8, 140},
    {Command::kSetLoad, 10, 9, 9, 9, 116},
    {Command::kSetFilters, 11, -1, -1, -1, 52},
    {Command::kAutomaticErrorRecovery, 12, 10, 10, 10, 12},
    {Command::kLoadModelLibrary, 13, 11, 11, -1, 14},
    {Command::kGetRobotModel, -1, -1, 12, 11, 12},
};

int numberIn(const RequestRow& row, std::uint16_t version) {
  return version <= 5   ? row.number_3_to_5
         : version <= 7 ? row.number_6_and_7
         : version <= 9 ? row.number_8_and_9
                        : row.number_10;
}

std::size_t sizeIn(const RequestRow& row, std::uint16_t version) {
  return row.command == Command::kMove && version == 10 ? 125 : row.size;
}

// One request of each command, in the order of Command.
std::vector<Request> requestsOf(std::uint16_t version) {
  MoveRequest move;
  move.controller_mode = ControllerMode::kExternalController;
  move.motion_generator_mode = MotionGeneratorMode::kCartesianVelocity;
  move.max_path_deviation = {1.0, 2.0, 3.0};
  move.max_goal_deviation = {4.0, 5.0, 6.0};
  if (version >= 10) {
    move.use_async_motion_generator = true;
    move.maximum_velocity = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  }
  SetGuidingModeRequest guiding;
  guiding.guiding_mode = {true, false, false, true, true, false};
  guiding.nullspace = true;
  return {ConnectRequest{0x0102, 0x0304},
          move,
          StopMoveRequest{},
          GetCartesianLimitRequest{-7},
          SetCollisionBehaviorRequest{},
          SetJointImpedanceRequest{},
          SetCartesianImpedanceRequest{},
          guiding,
          SetEEToKRequest{},
          SetNEToEERequest{},
          SetLoadRequest{},
          SetFiltersRequest{},
          AutomaticErrorRecoveryRequest{},
          LoadModelLibraryRequest{Architecture::kArm64, OperatingSystem::kWindows},
          GetRobotModelRequest{}};
}

class RequestOfVersion : public ::testing::TestWithParam<std::uint16_t> {};

INSTANTIATE_TEST_SUITE_P(Versions, RequestOfVersion, ::testing::Range<std::uint16_t>(3, 11));

TEST_P(RequestOfVersion, HasItsNumberAndSize) {
  for (const RequestRow& row : kRequestRows) {
    const int number = numberIn(row, GetParam());
    const auto name = static_cast<int>(row.command);
    if (number < 0) {
      EXPECT_FALSE(commandNumber(GetParam(), row.command)) << name;
      EXPECT_EQ(requestSize(GetParam(), row.command), 0U) << name;
    } else {
      EXPECT_EQ(commandNumber(GetParam(), row.command), static_cast<std::uint32_t>(number)) << name;
      EXPECT_EQ(commandFromNumber(GetParam(), static_cast<std::uint32_t>(number)), row.command);
      EXPECT_EQ(requestSize(GetParam(), row.command), sizeIn(row, GetParam())) << name;
    }
  }
  EXPECT_FALSE(commandFromNumber(GetParam(), 14));
  EXPECT_FALSE(commandFromNumber(GetParam(), 0xffffffff));
}

// Read and written again: the same bytes, so every number of the payload has an effect.
TEST_P(RequestOfVersion, RoundTripsUnchanged) {
  franka_test::FciRandom random(GetParam());
  for (const RequestRow& row : kRequestRows) {
    const Request sent = requestsOf(GetParam())[static_cast<std::size_t>(row.command)];
    RequestMessage message;
    const bool exists = numberIn(row, GetParam()) >= 0;
    ASSERT_EQ(encodeRequest(GetParam(), 0x01020304, sent, message),
              exists ? CodecError::kNone : CodecError::kNotInThisVersion);
    ASSERT_EQ(message.size, exists ? sizeIn(row, GetParam()) : 0);
    if (!exists) {
      continue;
    }
    if ((message.size - 12) % 8 == 0 && row.command != Command::kMove) {
      for (std::size_t at = 12; at < message.size; at += 8) {
        const double number = random.real();
        std::memcpy(message.data + at, &number, sizeof(number));
      }
    }
    Header header;
    Request received;
    ASSERT_EQ(decodeRequest(GetParam(), message.bytes(), header, received), CodecError::kNone);
    EXPECT_EQ(header.command, static_cast<std::uint32_t>(numberIn(row, GetParam())));
    EXPECT_EQ(header.command_id, 0x01020304U);
    EXPECT_EQ(header.size, message.size);
    EXPECT_EQ(commandOf(received), row.command);
    RequestMessage again;
    ASSERT_EQ(encodeRequest(GetParam(), 0x01020304, received, again), CodecError::kNone);
    ASSERT_EQ(toVector(message), toVector(again));
  }
}

TEST_P(RequestOfVersion, IsRefusedAtAnotherSize) {
  const std::vector<Request> requests = requestsOf(GetParam());
  for (const RequestRow& row : kRequestRows) {
    RequestMessage message;
    if (encodeRequest(GetParam(), 1, requests[static_cast<std::size_t>(row.command)], message) !=
        CodecError::kNone) {
      continue;
    }
    franka_test::forEverySize(toVector(message), 8, [&](const auto& bytes, bool) {
      Header header;
      Request received;
      EXPECT_EQ(decodeRequest(GetParam(), view(bytes), header, received),
                bytes.size() == message.size ? CodecError::kNone : CodecError::kWrongSize);
    });
  }
}

TEST_P(RequestOfVersion, WithAnUnknownCommandKeepsItsId) {
  std::vector<std::uint8_t> bytes = fromHex("40000000 07000000 0c000000");
  Header header;
  Request request;
  EXPECT_EQ(decodeRequest(GetParam(), view(bytes), header, request), CodecError::kUnknownCommand);
  EXPECT_EQ(header.command_id, 7U);
}

// Recorded from panda-python 1.1.1: command 0, id 0, 16 bytes, version 5, a port.
TEST(RequestCodec, WritesTheGenuineConnect) {
  RequestMessage message;
  ASSERT_EQ(encodeRequest(5, 0, ConnectRequest{5, 0x1234}, message), CodecError::kNone);
  EXPECT_EQ(toVector(message), fromHex("00000000 00000000 10000000 0500 3412"));
}

// The genuine client's Move: joint impedance and joint positions, deviations 10, 3.12, 2 pi.
TEST(RequestCodec, WritesTheGenuineMove) {
  RequestMessage message;
  ASSERT_EQ(encodeRequest(5, 3, MoveRequest{}, message), CodecError::kNone);
  const std::string deviation = "0000000000002440 f6285c8fc2f50840 182d4454fb211940";
  EXPECT_EQ(toVector(message),
            fromHex("01000000 03000000 44000000 00000000 00000000" + deviation + deviation));
}

// From protocol 7 on torque alone is generator 4 with controller 2; the state then contains 5 and
// 2.
TEST(RequestCodec, NumbersMotionGeneratorsOneBelowTheState) {
  MoveRequest move;
  move.controller_mode = ControllerMode::kExternalController;
  move.motion_generator_mode = MotionGeneratorMode::kNone;
  RequestMessage message;
  ASSERT_EQ(encodeRequest(10, 0, move, message), CodecError::kNone);
  EXPECT_EQ(message.data[12], 2);
  EXPECT_EQ(message.data[16], 4);
  EXPECT_EQ(encodeRequest(6, 0, move, message), CodecError::kNotInThisVersion);
  EXPECT_EQ(message.size, 0U);
}

TEST(RequestCodec, PlacesTheAsynchronousGeneratorAfterTheDeviations) {
  MoveRequest move;
  move.use_async_motion_generator = true;
  move.maximum_velocity = {1, 0, 0, 0, 0, 0, 0};
  RequestMessage message;
  ASSERT_EQ(encodeRequest(10, 0, move, message), CodecError::kNone);
  EXPECT_EQ(message.data[12 + 56], 1);
  EXPECT_EQ(message.data[12 + 57 + 7], 0x3f);
  EXPECT_EQ(encodeRequest(9, 0, move, message), CodecError::kNotInThisVersion);
}

TEST(RequestCodec, RefusesModesThatCannotBeRequested) {
  RequestMessage message;
  MoveRequest move;
  move.motion_generator_mode = MotionGeneratorMode::kIdle;
  EXPECT_EQ(encodeRequest(5, 0, move, message), CodecError::kUnknownEnum);
  move.motion_generator_mode = MotionGeneratorMode::kJointVelocity;
  move.controller_mode = ControllerMode::kOther;
  EXPECT_EQ(encodeRequest(5, 0, move, message), CodecError::kUnknownEnum);
}

TEST(RequestCodec, RefusesUnknownEnumerators) {
  struct Case {
    std::uint16_t version;
    Request request;
    std::size_t place;
    std::uint8_t first_bad;
    CodecError error;
  };
  const Case cases[] = {
      {10, MoveRequest{}, 12, 3, CodecError::kUnknownEnum},
      {10, MoveRequest{}, 15, 1, CodecError::kUnknownEnum},
      {10, MoveRequest{}, 16, 5, CodecError::kUnknownEnum},
      {6, MoveRequest{}, 16, 5, CodecError::kUnknownEnum},
      {10, MoveRequest{}, 68, 2, CodecError::kBadBoolean},
      {5, SetGuidingModeRequest{}, 12, 2, CodecError::kBadBoolean},
      {5, SetGuidingModeRequest{}, 18, 2, CodecError::kBadBoolean},
      {5, LoadModelLibraryRequest{}, 12, 4, CodecError::kUnknownEnum},
      {9, LoadModelLibraryRequest{}, 13, 2, CodecError::kUnknownEnum},
  };
  for (const Case& test : cases) {
    RequestMessage message;
    ASSERT_EQ(encodeRequest(test.version, 9, test.request, message), CodecError::kNone);
    message.data[test.place] = test.first_bad;
    Header header;
    Request request = StopMoveRequest{};
    EXPECT_EQ(decodeRequest(test.version, message.bytes(), header, request), test.error)
        << test.place;
    EXPECT_EQ(header.command_id, 9U);
    EXPECT_EQ(commandOf(request), Command::kStopMove);
  }
  // Torque alone exists, but not before version 7.
  RequestMessage message;
  ASSERT_EQ(encodeRequest(6, 9, MoveRequest{}, message), CodecError::kNone);
  message.data[16] = 4;
  Header header;
  Request request;
  EXPECT_EQ(decodeRequest(6, message.bytes(), header, request), CodecError::kNotInThisVersion);
}

TEST(RequestCodec, FindsMessagesInAStream) {
  const auto stream = fromHex("02000000 05000000 0d000000 07 ffff");
  Header header;
  for (std::size_t size = 0; size <= stream.size(); size++) {
    const CodecError error = nextMessage({stream.data(), size}, 428, header);
    EXPECT_EQ(error, size < 13 ? CodecError::kIncomplete : CodecError::kNone) << size;
  }
  EXPECT_EQ(header.size, 13U);
  EXPECT_EQ(header.command, 2U);
  EXPECT_EQ(header.command_id, 5U);
  EXPECT_EQ(nextMessage(view(fromHex("02000000 05000000 0b000000")), 428, header),
            CodecError::kWrongSize);
  EXPECT_EQ(nextMessage(view(fromHex("02000000 05000000 ad010000")), 428, header),
            CodecError::kTooLong);
  EXPECT_EQ(nextMessage(view(fromHex("02000000 05000000 ffffffff")), 428, header),
            CodecError::kTooLong);
}

TEST(RequestCodec, RefusesUnknownVersions) {
  RequestMessage message;
  Header header;
  Request request;
  for (const std::uint16_t version : {0, 2, 11, 65535}) {
    EXPECT_EQ(encodeRequest(version, 0, StopMoveRequest{}, message), CodecError::kUnknownVersion);
    EXPECT_EQ(decodeRequest(version, message.bytes(), header, request),
              CodecError::kUnknownVersion);
    EXPECT_FALSE(commandNumber(version, Command::kConnect));
  }
}

}  // namespace
