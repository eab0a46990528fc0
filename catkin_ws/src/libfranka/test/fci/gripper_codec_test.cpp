// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/gripper_codec.h>
#include <franka_core/fci/vacuum_codec.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "hex.h"

namespace {

using franka_core::fci::CodecError;
using franka_test::fromHex;
using franka_test::toVector;
using franka_test::view;
namespace gripper = franka_core::fci::gripper;
namespace vacuum = franka_core::fci::vacuum;

// Both codecs with a request shortened or lengthened by any number of bytes.
template <typename Codec, typename Request>
void expectRefusedAtEveryOtherSize(const Request& request, const Codec& codec) {
  const std::vector<std::uint8_t> whole = codec.encode(request);
  for (std::size_t size = 0; size < whole.size() + 12; size++) {
    for (const bool honest : {false, true}) {
      std::vector<std::uint8_t> bytes = whole;
      bytes.resize(size);
      if (honest && size >= 10) {
        bytes[6] = static_cast<std::uint8_t>(size);
      }
      EXPECT_EQ(codec.decode(bytes),
                size == whole.size() ? CodecError::kNone : CodecError::kWrongSize);
    }
  }
}

struct GripperCodec {
  static std::vector<std::uint8_t> encode(const gripper::Request& request) {
    gripper::RequestMessage message;
    gripper::encodeRequest(0x0a0b0c0d, request, message);
    return toVector(message);
  }
  static CodecError decode(const std::vector<std::uint8_t>& bytes) {
    gripper::Header header;
    gripper::Request request;
    const CodecError error = gripper::decodeRequest(view(bytes), header, request);
    if (error == CodecError::kNone) {
      EXPECT_EQ(encode(request), bytes);
      EXPECT_EQ(header.command_id, 0x0a0b0c0dU);
    }
    return error;
  }
};

struct VacuumCodec {
  static std::vector<std::uint8_t> encode(const vacuum::Request& request) {
    vacuum::RequestMessage message;
    vacuum::encodeRequest(0x0a0b0c0d, request, message);
    return toVector(message);
  }
  static CodecError decode(const std::vector<std::uint8_t>& bytes) {
    vacuum::Header header;
    vacuum::Request request;
    const CodecError error = vacuum::decodeRequest(view(bytes), header, request);
    if (error == CodecError::kNone) {
      EXPECT_EQ(encode(request), bytes);
    }
    return error;
  }
};

// Recorded from panda-python 1.1.1: command 0, id 0, 14 bytes, version 3, a port.
TEST(GripperCodec, WritesTheGenuineConnect) {
  gripper::RequestMessage message;
  gripper::encodeRequest(0, gripper::ConnectRequest{3, 0x1234}, message);
  EXPECT_EQ(toVector(message), fromHex("0000 00000000 0e000000 0300 3412"));
}

TEST(GripperCodec, WritesTheFieldsOfGraspInOrder) {
  gripper::GraspRequest grasp;
  grasp.width = 1.0;
  grasp.epsilon_inner = 2.0;
  grasp.epsilon_outer = -2.0;
  grasp.speed = 0.5;
  grasp.force = 32.0;
  EXPECT_EQ(GripperCodec::encode(grasp),
            fromHex("0200 0d0c0b0a 32000000 000000000000f03f 0000000000000040 00000000000000c0"
                    "000000000000e03f 0000000000004040"));
}

TEST(GripperCodec, RoundTripsUnchangedOnlyAtItsSize) {
  const gripper::Request requests[] = {gripper::ConnectRequest{3, 4711}, gripper::HomingRequest{},
                                       gripper::GraspRequest{0.02, 0.01, 0.03, 0.1, 40.0},
                                       gripper::MoveRequest{0.08, 0.05}, gripper::StopRequest{}};
  const std::size_t sizes[] = {14, 10, 50, 26, 10};
  for (std::size_t i = 0; i < 5; i++) {
    EXPECT_EQ(gripper::requestSize(static_cast<gripper::Command>(i)), sizes[i]);
    EXPECT_EQ(GripperCodec::encode(requests[i]).size(), sizes[i]);
    expectRefusedAtEveryOtherSize(requests[i], GripperCodec{});
  }
}

TEST(GripperCodec, RefusesUnknownCommands) {
  EXPECT_EQ(GripperCodec::decode(fromHex("0500 00000000 0a000000")), CodecError::kUnknownCommand);
  EXPECT_EQ(VacuumCodec::decode(fromHex("0400 00000000 0a000000")), CodecError::kUnknownCommand);
}

TEST(GripperCodec, FindsMessagesInAStream) {
  const auto stream = fromHex("0100 05000000 0c000000 0000 ff");
  gripper::Header header;
  for (std::size_t size = 0; size <= stream.size(); size++) {
    EXPECT_EQ(gripper::nextMessage({stream.data(), size}, 50, header),
              size < 12 ? CodecError::kIncomplete : CodecError::kNone);
  }
  EXPECT_EQ(header.command, 1);
  EXPECT_EQ(header.command_id, 5U);
  EXPECT_EQ(gripper::nextMessage(view(fromHex("0100 05000000 09000000")), 50, header),
            CodecError::kWrongSize);
  EXPECT_EQ(gripper::nextMessage(view(fromHex("0100 05000000 33000000")), 50, header),
            CodecError::kTooLong);
}

TEST(GripperCodec, TransmitsEachStatus) {
  for (int c = 0; c < 5; c++) {
    const auto command = static_cast<gripper::Command>(c);
    const int last = command == gripper::Command::kConnect ? 1 : 3;
    for (int s = 0; s <= 3; s++) {
      gripper::Reply sent;
      sent.status = static_cast<gripper::Status>(s);
      sent.server_version = command == gripper::Command::kConnect ? 3 : 0;
      gripper::ReplyMessage message;
      ASSERT_EQ(gripper::encodeReply(command, 6, sent, message),
                s <= last ? CodecError::kNone : CodecError::kUnknownStatus);
      if (s > last) {
        continue;
      }
      EXPECT_EQ(message.size, command == gripper::Command::kConnect ? 14U : 12U);
      gripper::Header header;
      gripper::Reply received;
      ASSERT_EQ(gripper::decodeReply(command, message.bytes(), header, received),
                CodecError::kNone);
      EXPECT_EQ(received.status, sent.status);
      EXPECT_EQ(received.server_version, sent.server_version);
      message.data[11] = 1;
      EXPECT_EQ(gripper::decodeReply(command, message.bytes(), header, received),
                CodecError::kUnknownStatus);
      message.data[11] = 0;
      for (std::size_t size = 0; size < message.size; size++) {
        const std::vector<std::uint8_t> cut(message.data, message.data + size);
        EXPECT_EQ(gripper::decodeReply(command, view(cut), header, received),
                  CodecError::kWrongSize);
      }
      std::vector<std::uint8_t> longer(message.data, message.data + message.size);
      longer.push_back(0);
      longer[6]++;  // the header's size
      EXPECT_EQ(gripper::decodeReply(command, view(longer), header, received),
                command == gripper::Command::kConnect ? CodecError::kNone : CodecError::kWrongSize);
    }
  }
}

TEST(GripperCodec, ReadsAStateWrittenByHand) {
  const auto bytes =
      fromHex("07000000 7b14ae47e17aa43f 7b14ae47e17ab43f 01 2300");  // 0.04 and 0.08 m, 35 deg C
  gripper::State state;
  ASSERT_EQ(gripper::decodeState(view(bytes), state), CodecError::kNone);
  EXPECT_EQ(state.message_id, 7U);
  EXPECT_EQ(state.width, 0.04);
  EXPECT_EQ(state.max_width, 0.08);
  EXPECT_TRUE(state.is_grasped);
  EXPECT_EQ(state.temperature, 35);
  gripper::StateBuffer again{};
  gripper::encodeState(state, again);
  EXPECT_EQ(std::vector<std::uint8_t>(again.begin(), again.end()), bytes);
}

TEST(GripperCodec, RefusesInvalidStates) {
  gripper::State state;
  for (std::size_t size = 0; size < 40; size++) {
    const std::vector<std::uint8_t> bytes(size, 0);
    EXPECT_EQ(gripper::decodeState(view(bytes), state),
              size == 23 ? CodecError::kNone : CodecError::kWrongSize);
  }
  std::vector<std::uint8_t> bytes(23, 0);
  bytes[0] = 1;
  bytes[20] = 2;
  EXPECT_EQ(gripper::decodeState(view(bytes), state), CodecError::kBadBoolean);
  EXPECT_EQ(state.message_id, 0U);
}

TEST(VacuumCodec, RoundTripsUnchangedOnlyAtItsSize) {
  const vacuum::Request requests[] = {
      vacuum::ConnectRequest{1, 4711}, vacuum::VacuumRequest{100, vacuum::Profile::kP2, -5},
      vacuum::DropOffRequest{std::numeric_limits<std::int64_t>::max()}, vacuum::StopRequest{}};
  const std::size_t sizes[] = {14, 20, 18, 10};
  for (std::size_t i = 0; i < 4; i++) {
    EXPECT_EQ(vacuum::requestSize(static_cast<vacuum::Command>(i)), sizes[i]);
    EXPECT_EQ(VacuumCodec::encode(requests[i]).size(), sizes[i]);
    expectRefusedAtEveryOtherSize(requests[i], VacuumCodec{});
  }
}

TEST(VacuumCodec, WritesARequestInOrder) {
  EXPECT_EQ(VacuumCodec::encode(vacuum::VacuumRequest{100, vacuum::Profile::kP2, 3000}),
            fromHex("0100 0d0c0b0a 14000000 64 02 b80b000000000000"));
}

TEST(VacuumCodec, RefusesUnknownProfiles) {
  EXPECT_EQ(VacuumCodec::decode(fromHex("0100 0d0c0b0a 14000000 64 04 b80b000000000000")),
            CodecError::kUnknownEnum);
}

TEST(VacuumCodec, TransmitsReplies) {
  vacuum::Reply sent;
  sent.status = vacuum::Status::kUnsuccessful;
  vacuum::ReplyMessage message;
  ASSERT_EQ(vacuum::encodeReply(vacuum::Command::kDropOff, 3, sent, message), CodecError::kNone);
  EXPECT_EQ(toVector(message), fromHex("0200 03000000 0c000000 0200"));
  vacuum::Header header;
  vacuum::Reply received;
  ASSERT_EQ(vacuum::decodeReply(vacuum::Command::kDropOff, message.bytes(), header, received),
            CodecError::kNone);
  EXPECT_EQ(received.status, sent.status);
  ASSERT_EQ(vacuum::encodeReply(vacuum::Command::kConnect, 3, vacuum::Reply{}, message),
            CodecError::kNone);
  EXPECT_EQ(message.size, 14U);
}

TEST(VacuumCodec, ReadsAStateWrittenByHand) {
  const auto bytes = fromHex("07000000 01 00 01 02 50000000 9cffffff");
  vacuum::State state;
  ASSERT_EQ(vacuum::decodeState(view(bytes), state), CodecError::kNone);
  EXPECT_EQ(state.message_id, 7U);
  EXPECT_TRUE(state.in_control_range);
  EXPECT_FALSE(state.part_detached);
  EXPECT_TRUE(state.part_present);
  EXPECT_EQ(state.device_status, vacuum::DeviceStatus::kOrange);
  EXPECT_EQ(state.actual_power, 80);
  EXPECT_EQ(state.vacuum, -100);
  vacuum::StateBuffer again{};
  vacuum::encodeState(state, again);
  EXPECT_EQ(std::vector<std::uint8_t>(again.begin(), again.end()), bytes);
}

TEST(VacuumCodec, RefusesInvalidStates) {
  vacuum::State state;
  for (std::size_t size = 0; size < 30; size++) {
    const std::vector<std::uint8_t> bytes(size, 0);
    EXPECT_EQ(vacuum::decodeState(view(bytes), state),
              size == 16 ? CodecError::kNone : CodecError::kWrongSize);
  }
  for (const std::size_t place : {4, 5, 6}) {
    std::vector<std::uint8_t> bytes(16, 0);
    bytes[place] = 255;
    EXPECT_EQ(vacuum::decodeState(view(bytes), state), CodecError::kBadBoolean);
  }
  std::vector<std::uint8_t> bytes(16, 0);
  bytes[7] = 4;
  EXPECT_EQ(vacuum::decodeState(view(bytes), state), CodecError::kUnknownEnum);
}

}  // namespace
