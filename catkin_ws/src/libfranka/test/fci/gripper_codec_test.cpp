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

/// The requests of one gripper.
template <typename AnyRequest, typename AnyRequestMessage>
struct Codec {
  using Request = AnyRequest;
  static std::vector<std::uint8_t> encode(const Request& request) {
    AnyRequestMessage message;
    encodeRequest(0x0a0b0c0d, request, message);
    return toVector(message);
  }
  static CodecError decode(const std::vector<std::uint8_t>& bytes) {
    gripper::Header header;
    Request request;
    const CodecError error = decodeRequest(view(bytes), header, request);
    if (error == CodecError::kNone) {
      EXPECT_EQ(encode(request), bytes);
      EXPECT_EQ(header.command_id, 0x0a0b0c0dU);
    }
    return error;
  }
};
using GripperCodec = Codec<gripper::Request, gripper::RequestMessage>;
using VacuumCodec = Codec<vacuum::Request, vacuum::RequestMessage>;

// A request of its size, and shortened or lengthened by any number of bytes.
template <typename OneCodec>
void expectRoundTripOnlyAtItsSize(const typename OneCodec::Request& request, std::size_t due) {
  const std::vector<std::uint8_t> message = OneCodec::encode(request);
  EXPECT_EQ(message.size(), due);
  EXPECT_EQ(requestSize(commandOf(request)), due);
  franka_test::forEverySize(message, 6, [due](const auto& bytes, bool) {
    EXPECT_EQ(OneCodec::decode(bytes),
              bytes.size() == due ? CodecError::kNone : CodecError::kWrongSize);
  });
}

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
  expectRoundTripOnlyAtItsSize<GripperCodec>(gripper::ConnectRequest{3, 4711}, 14);
  expectRoundTripOnlyAtItsSize<GripperCodec>(gripper::HomingRequest{}, 10);
  expectRoundTripOnlyAtItsSize<GripperCodec>(gripper::GraspRequest{0.02, 0.01, 0.03, 0.1, 40.0},
                                             50);
  expectRoundTripOnlyAtItsSize<GripperCodec>(gripper::MoveRequest{0.08, 0.05}, 26);
  expectRoundTripOnlyAtItsSize<GripperCodec>(gripper::StopRequest{}, 10);
  expectRoundTripOnlyAtItsSize<VacuumCodec>(vacuum::ConnectRequest{1, 4711}, 14);
  expectRoundTripOnlyAtItsSize<VacuumCodec>(vacuum::VacuumRequest{100, vacuum::Profile::kP2, -5},
                                            20);
  expectRoundTripOnlyAtItsSize<VacuumCodec>(
      vacuum::DropOffRequest{std::numeric_limits<std::int64_t>::max()}, 18);
  expectRoundTripOnlyAtItsSize<VacuumCodec>(vacuum::StopRequest{}, 10);
}

TEST(GripperCodec, RefusesUnknownCommandsAndProfiles) {
  EXPECT_EQ(GripperCodec::decode(fromHex("0500 00000000 0a000000")), CodecError::kUnknownCommand);
  EXPECT_EQ(VacuumCodec::decode(fromHex("0400 00000000 0a000000")), CodecError::kUnknownCommand);
  EXPECT_EQ(VacuumCodec::decode(fromHex("0100 0d0c0b0a 14000000 64 04 b80b000000000000")),
            CodecError::kUnknownEnum);
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

template <typename State>
void expectRefusedAtEveryOtherSize(State state, std::size_t due) {
  for (std::size_t size = 0; size < 40; size++) {
    const std::vector<std::uint8_t> bytes(size, 0);
    EXPECT_EQ(decodeState(view(bytes), state),
              size == due ? CodecError::kNone : CodecError::kWrongSize);
  }
}

template <typename State>
CodecError errorOfStateWith(std::size_t size, std::size_t place, std::uint8_t value) {
  std::vector<std::uint8_t> bytes(size, 0);
  bytes[0] = 1;
  bytes[place] = value;
  State state;
  const CodecError error = decodeState(view(bytes), state);
  EXPECT_EQ(state.message_id, 0U);
  return error;
}

TEST(GripperCodec, RefusesInvalidStates) {
  expectRefusedAtEveryOtherSize(gripper::State{}, 23);
  expectRefusedAtEveryOtherSize(vacuum::State{}, 16);
  EXPECT_EQ(errorOfStateWith<gripper::State>(23, 20, 2), CodecError::kBadBoolean);
  for (const std::size_t place : {4, 5, 6}) {
    EXPECT_EQ(errorOfStateWith<vacuum::State>(16, place, 255), CodecError::kBadBoolean);
  }
  EXPECT_EQ(errorOfStateWith<vacuum::State>(16, 7, 4), CodecError::kUnknownEnum);
}

TEST(VacuumCodec, WritesARequestInOrder) {
  EXPECT_EQ(VacuumCodec::encode(vacuum::VacuumRequest{100, vacuum::Profile::kP2, 3000}),
            fromHex("0100 0d0c0b0a 14000000 64 02 b80b000000000000"));
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

}  // namespace
