// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/arm_model.h>
#include <franka_core/fci/state_codec.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "fci_random.h"

namespace {

using franka_core::RobotState;
using franka_core::fci::CodecError;
using franka_core::fci::StateBuffer;
using franka_core::fci::StateField;
using franka_core::fci::StateLayout;
namespace fci = franka_core::fci;

// Typed from the description of the datagrams, independent of the codec; -1: not in that version.
struct FieldRow {
  const char* name;
  std::size_t count;  // numbers, from version 5 on
  int offset3, offset4, offset5, offset10;
};
constexpr FieldRow kFieldRows[] = {
    {"message_id", 1, 0, 0, 0, 0},
    {"O_T_EE", 16, 8, 8, 8, 8},
    {"O_T_EE_d", 16, 136, 136, 136, 72},
    {"F_T_EE", 16, 264, 264, 264, 136},
    {"EE_T_K", 16, 392, 392, 392, 200},
    {"F_T_NE", 16, -1, 520, 520, 264},
    {"NE_T_EE", 16, -1, 648, 648, 328},
    {"m_ee", 1, 520, 776, 776, 392},
    {"I_ee", 9, 528, 784, 784, 396},
    {"F_x_Cee", 3, 600, 856, 856, 432},
    {"m_load", 1, 624, 880, 880, 444},
    {"I_load", 9, 632, 888, 888, 448},
    {"F_x_Cload", 3, 704, 960, 960, 484},
    {"elbow", 2, 728, 984, 984, 496},
    {"elbow_d", 2, 744, 1000, 1000, 504},
    {"tau_J", 7, 760, 1016, 1016, 512},
    {"tau_J_d", 7, 816, 1072, 1072, 540},
    {"dtau_J", 7, 872, 1128, 1128, 568},
    {"q", 7, 928, 1184, 1184, 596},
    {"q_d", 7, 984, 1240, 1240, 624},
    {"dq", 7, 1040, 1296, 1296, 652},
    {"dq_d", 7, 1096, 1352, 1352, 680},
    {"ddq_d", 7, 1152, 1408, 1408, 708},
    {"joint_contact", 7, 1208, 1464, 1464, 736},
    {"cartesian_contact", 6, 1264, 1520, 1520, 764},
    {"joint_collision", 7, 1312, 1568, 1568, 788},
    {"cartesian_collision", 6, 1368, 1624, 1624, 816},
    {"tau_ext_hat_filtered", 7, 1416, 1672, 1672, 840},
    {"O_F_ext_hat_K", 6, 1472, 1728, 1728, 868},
    {"K_F_ext_hat_K", 6, 1520, 1776, 1776, 892},
    {"O_dP_EE_d", 6, 1568, 1824, 1824, 916},
    {"O_ddP_O", 3, -1, -1, 1872, 940},
    {"elbow_c", 2, 1616, 1872, 1896, 952},
    {"delbow_c", 2, 1632, 1888, 1912, 960},
    {"ddelbow_c", 2, 1648, 1904, 1928, 968},
    {"O_T_EE_c", 16, 1664, 1920, 1944, 976},
    {"O_dP_EE_c", 6, 1792, 2048, 2072, 1040},
    {"O_ddP_EE_c", 6, 1840, 2096, 2120, 1064},
    {"theta", 7, 1888, 2144, 2168, 1088},
    {"dtheta", 7, 1944, 2200, 2224, 1116},
    {"accelerometer_top", 18, -1, -1, -1, 1144},
    {"accelerometer_bottom", 18, -1, -1, -1, 1216},
    {"motion_generator_mode", 1, 2000, 2256, 2280, 1288},
    {"controller_mode", 1, 2001, 2257, 2281, 1289},
    {"errors", 41, 2002, 2258, 2282, 1290},
    {"reflex_reason", 41, 2039, 2295, 2323, 1331},
    {"robot_mode", 1, 2076, 2332, 2364, 1372},
    {"control_command_success_rate", 1, 2077, 2333, 2365, 1373},
};

int offsetIn(const FieldRow& row, std::uint16_t version) {
  switch (version) {
    case 3:
      return row.offset3;
    case 4:
      return row.offset4;
    case 10:
      return row.offset10;
    default:
      return row.offset5;
  }
}

std::size_t countIn(const FieldRow& row, std::uint16_t version) {
  return row.count == 41 && version <= 4 ? 37 : row.count;
}

class StateOfVersion : public ::testing::TestWithParam<std::uint16_t> {};

INSTANTIATE_TEST_SUITE_P(Versions, StateOfVersion, ::testing::Range<std::uint16_t>(3, 11));

TEST_P(StateOfVersion, HasItsSize) {
  const std::size_t sizes[] = {2085, 2341, 2373, 2373, 2373, 2373, 2373, 1377};
  EXPECT_EQ(fci::stateSize(GetParam()), sizes[GetParam() - 3]);
}

TEST_P(StateOfVersion, HasEachFieldAtItsOffset) {
  const StateLayout* layout = fci::stateLayout(GetParam());
  ASSERT_NE(layout, nullptr);
  std::size_t index = 0;
  for (const FieldRow& row : kFieldRows) {
    const int offset = offsetIn(row, GetParam());
    if (offset < 0) {
      continue;
    }
    ASSERT_LT(index, layout->count) << row.name;
    const StateField& field = layout->fields[index++];
    EXPECT_STREQ(field.name, row.name);
    EXPECT_EQ(field.offset, static_cast<std::size_t>(offset)) << row.name;
    EXPECT_EQ(field.count, countIn(row, GetParam())) << row.name;
  }
  EXPECT_EQ(index, layout->count);
}

/// The fields of forEachSentField, in its order.
std::vector<FieldRow> numberRows() {
  const std::set<std::string> others{"message_id",           "accelerometer_top",
                                     "accelerometer_bottom", "motion_generator_mode",
                                     "controller_mode",      "errors",
                                     "reflex_reason",        "robot_mode"};
  std::vector<FieldRow> rows;
  for (const FieldRow& row : kFieldRows) {
    if (others.count(row.name) == 0) {
      rows.push_back(row);
    }
  }
  return rows;
}

// Each number has another value, so that a missing or mixed-up member is detected.
TEST_P(StateOfVersion, ReadsBytesAtTheTablesOffsets) {
  const std::uint16_t version = GetParam();
  StateBuffer buffer{};
  double next = 1.0;
  std::vector<std::vector<double>> expected;
  for (const FieldRow& row : numberRows()) {
    std::vector<double>& values = expected.emplace_back();
    for (std::size_t i = 0; i < row.count; i++, next++) {
      values.push_back(next);
      const auto narrow = static_cast<float>(next);
      if (offsetIn(row, version) >= 0 && version == 10) {
        std::memcpy(buffer.data() + offsetIn(row, version) + 4 * i, &narrow, 4);
      } else if (offsetIn(row, version) >= 0) {
        std::memcpy(buffer.data() + offsetIn(row, version) + 8 * i, &next, 8);
      }
    }
  }
  const std::uint8_t id[]{0x15, 0xcd, 0x5b, 0x07};
  std::copy(std::begin(id), std::end(id), buffer.begin());
  const int modes = version == 10 ? 1288 : version >= 5 ? 2280 : version == 4 ? 2256 : 2000;
  const int errors = version <= 4 ? 37 : 41;
  buffer[modes] = 3;
  buffer[modes + 1] = 1;
  buffer[modes + 2 + 6] = 1;
  buffer[modes + 2 + errors + 14] = 1;
  buffer[modes + 2 + 2 * errors] = 4;
  RobotState state;
  ASSERT_EQ(fci::decodeState(version, {buffer.data(), fci::stateSize(version)}, state),
            CodecError::kNone);
  const auto received = franka_test::sentValues(state);
  ASSERT_EQ(expected.size(), received.size());
  for (std::size_t i = 0; i < expected.size(); i++) {
    if (offsetIn(numberRows()[i], version) >= 0) {
      EXPECT_EQ(expected[i], received[i]) << numberRows()[i].name;
    }
  }
  EXPECT_EQ(state.message_id, 123456789U);
  EXPECT_EQ(state.motion_generator_mode, franka_core::MotionGeneratorMode::kCartesianPosition);
  EXPECT_EQ(state.controller_mode, franka_core::ControllerMode::kCartesianImpedance);
  EXPECT_TRUE(state.errors[6]);
  EXPECT_TRUE(state.reflex_reason[14]);
  EXPECT_FALSE(state.errors[14]);
  EXPECT_EQ(state.robot_mode, franka_core::RobotMode::kReflex);
}

// Each byte of the datagram affects only its own field: written again it is the same.
TEST_P(StateOfVersion, RoundTripsUnchanged) {
  franka_test::FciRandom random(GetParam());
  for (int i = 0; i < 200; i++) {
    const RobotState sent = random.state(GetParam());
    StateBuffer buffer{};
    ASSERT_EQ(fci::encodeState(GetParam(), sent, buffer), CodecError::kNone);
    RobotState received;
    ASSERT_EQ(fci::decodeState(GetParam(), {buffer.data(), fci::stateSize(GetParam())}, received),
              CodecError::kNone);
    franka_test::expectSame(sent, received);
    StateBuffer again{};
    ASSERT_EQ(fci::encodeState(GetParam(), received, again), CodecError::kNone);
    ASSERT_EQ(buffer, again);
  }
}

TEST_P(StateOfVersion, IsRefusedAtEveryOtherSize) {
  const std::vector<std::uint8_t> bytes(fci::kMaxStateSize + 10, 0);
  RobotState state;
  for (std::size_t size = 0; size <= bytes.size(); size++) {
    // A copy of exactly that size, so that the sanitizer detects access beyond it.
    const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<long>(size));
    EXPECT_EQ(fci::decodeState(GetParam(), {cut.data(), size}, state),
              size == fci::stateSize(GetParam()) ? CodecError::kNone : CodecError::kWrongSize);
  }
}

TEST_P(StateOfVersion, IsRefusedWithUnknownModesAndKeepsTheOldState) {
  const StateLayout& layout = *fci::stateLayout(GetParam());
  const auto offsetOf = [&](const std::string& name) {
    for (std::size_t i = 0; i < layout.count; i++) {
      if (name == layout.fields[i].name) {
        return layout.fields[i].offset;
      }
    }
    throw std::runtime_error(name);
  };
  struct Case {
    const char* field;
    int first_bad;
    CodecError error;
  };
  const Case cases[] = {
      {"motion_generator_mode", GetParam() >= 7 ? 6 : 5, CodecError::kUnknownEnum},
      {"controller_mode", 4, CodecError::kUnknownEnum},
      {"robot_mode", 7, CodecError::kUnknownEnum},
      {"errors", 2, CodecError::kBadBoolean},
      {"reflex_reason", 2, CodecError::kBadBoolean}};
  for (const Case& test : cases) {
    for (int value = 0; value < 256; value++) {
      StateBuffer buffer{};
      buffer[0] = 9;
      buffer[offsetOf(test.field)] = static_cast<std::uint8_t>(value);
      RobotState state;
      state.message_id = 77;
      const bool good = value < test.first_bad;
      ASSERT_EQ(fci::decodeState(GetParam(), {buffer.data(), layout.size}, state),
                good ? CodecError::kNone : test.error)
          << test.field << " " << value;
      ASSERT_EQ(state.message_id, good ? 9U : 77U);
    }
  }
}

TEST(StateCodec, RefusesUnknownVersions) {
  StateBuffer buffer{};
  RobotState state;
  for (const std::uint16_t version : {0, 1, 2, 11, 65535}) {
    EXPECT_EQ(fci::stateSize(version), 0U);
    EXPECT_EQ(fci::stateLayout(version), nullptr);
    EXPECT_EQ(fci::encodeState(version, state, buffer), CodecError::kUnknownVersion);
    EXPECT_EQ(fci::decodeState(version, {buffer.data(), 0}, state), CodecError::kUnknownVersion);
  }
}

TEST(StateCodec, DoesNotSendAGeneratorThatTheVersionLacks) {
  StateBuffer buffer{};
  RobotState state;
  state.motion_generator_mode = franka_core::MotionGeneratorMode::kNone;
  EXPECT_EQ(fci::encodeState(6, state, buffer), CodecError::kNotInThisVersion);
  EXPECT_EQ(fci::encodeState(7, state, buffer), CodecError::kNone);
}

TEST(StateCodec, FillsFieldsThatOldVersionsLack) {
  franka_test::FciRandom random(1);
  RobotState sent = random.state(10);
  StateBuffer buffer{};
  sent.motion_generator_mode = franka_core::MotionGeneratorMode::kIdle;
  ASSERT_EQ(fci::encodeState(3, sent, buffer), CodecError::kNone);
  RobotState received;
  received.errors.fill(true);
  received.accelerometer_top[2][1] = 5.0;
  ASSERT_EQ(fci::decodeState(3, {buffer.data(), fci::stateSize(3)}, received), CodecError::kNone);
  EXPECT_EQ(received.NE_T_EE, sent.F_T_EE);
  const std::array<double, 16> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(received.F_T_NE, identity);
  EXPECT_EQ(received.O_ddP_O, (std::array<double, 3>{0.0, 0.0, -9.81}));
  EXPECT_FALSE(received.errors[37] || received.errors[40]);
  EXPECT_EQ(received.accelerometer_top[2][1], 0.0);
}

TEST(StateCodec, ComposesTheTotalPayload) {
  RobotState sent;
  sent.m_ee = 1.0;
  sent.F_x_Cee = {0.0, 0.0, 0.1};
  sent.m_load = 3.0;
  sent.F_x_Cload = {0.0, 0.0, 0.2};
  StateBuffer buffer{};
  ASSERT_EQ(fci::encodeState(5, sent, buffer), CodecError::kNone);
  RobotState received;
  ASSERT_EQ(fci::decodeState(5, {buffer.data(), fci::stateSize(5)}, received), CodecError::kNone);
  EXPECT_DOUBLE_EQ(received.m_total, 4.0);
  EXPECT_DOUBLE_EQ(received.F_x_Ctotal[2], 0.175);
  // Two points 0.1 m apart: reduced mass 0.75 kg.
  EXPECT_NEAR(received.I_total[0], 0.0075, 1e-15);
}

}  // namespace
