// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/arm_model.h>
#include <franka_core/fci/state_codec.h>
#include <franka_core/robot_error.h>

#include "wire.h"

namespace franka_core::fci {

namespace {

constexpr std::uint16_t kSinglePrecisionVersion = 10;
constexpr std::array<double, 3> kGravity{{0.0, 0.0, -9.81}};
constexpr std::array<double, 16> kIdentity{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};

// Every field in the order of the wire (protocol 4.1) with the version that introduced it. Sizes,
// offsets, encoding and decoding derive from this one list.
template <typename Visitor>
constexpr void visitFields(Visitor&& visit) {
  using State = RobotState;
  visit("message_id", &State::message_id, 3);
  visit("O_T_EE", &State::O_T_EE, 3);
  visit("O_T_EE_d", &State::O_T_EE_d, 3);
  visit("F_T_EE", &State::F_T_EE, 3);
  visit("EE_T_K", &State::EE_T_K, 3);
  visit("F_T_NE", &State::F_T_NE, 4);
  visit("NE_T_EE", &State::NE_T_EE, 4);
  visit("m_ee", &State::m_ee, 3);
  visit("I_ee", &State::I_ee, 3);
  visit("F_x_Cee", &State::F_x_Cee, 3);
  visit("m_load", &State::m_load, 3);
  visit("I_load", &State::I_load, 3);
  visit("F_x_Cload", &State::F_x_Cload, 3);
  visit("elbow", &State::elbow, 3);
  visit("elbow_d", &State::elbow_d, 3);
  visit("tau_J", &State::tau_J, 3);
  visit("tau_J_d", &State::tau_J_d, 3);
  visit("dtau_J", &State::dtau_J, 3);
  visit("q", &State::q, 3);
  visit("q_d", &State::q_d, 3);
  visit("dq", &State::dq, 3);
  visit("dq_d", &State::dq_d, 3);
  visit("ddq_d", &State::ddq_d, 3);
  visit("joint_contact", &State::joint_contact, 3);
  visit("cartesian_contact", &State::cartesian_contact, 3);
  visit("joint_collision", &State::joint_collision, 3);
  visit("cartesian_collision", &State::cartesian_collision, 3);
  visit("tau_ext_hat_filtered", &State::tau_ext_hat_filtered, 3);
  visit("O_F_ext_hat_K", &State::O_F_ext_hat_K, 3);
  visit("K_F_ext_hat_K", &State::K_F_ext_hat_K, 3);
  visit("O_dP_EE_d", &State::O_dP_EE_d, 3);
  visit("O_ddP_O", &State::O_ddP_O, 5);
  visit("elbow_c", &State::elbow_c, 3);
  visit("delbow_c", &State::delbow_c, 3);
  visit("ddelbow_c", &State::ddelbow_c, 3);
  visit("O_T_EE_c", &State::O_T_EE_c, 3);
  visit("O_dP_EE_c", &State::O_dP_EE_c, 3);
  visit("O_ddP_EE_c", &State::O_ddP_EE_c, 3);
  visit("theta", &State::theta, 3);
  visit("dtheta", &State::dtheta, 3);
  visit("accelerometer_top", &State::accelerometer_top, 10);
  visit("accelerometer_bottom", &State::accelerometer_bottom, 10);
  visit("motion_generator_mode", &State::motion_generator_mode, 3);
  visit("controller_mode", &State::controller_mode, 3);
  visit("errors", &State::errors, 3);
  visit("reflex_reason", &State::reflex_reason, 3);
  visit("robot_mode", &State::robot_mode, 3);
  visit("control_command_success_rate", &State::control_command_success_rate, 3);
}

constexpr std::size_t errorsOf(std::uint16_t version) {
  return version <= 4 ? kErrorCountVersion4 : kErrorCount;
}
constexpr WireType realsOf(std::uint16_t version) {
  return version >= kSinglePrecisionVersion ? WireType::kF32 : WireType::kF64;
}

constexpr std::size_t sizeOf(WireType type) {
  switch (type) {
    case WireType::kU64:
    case WireType::kF64:
      return 8;
    case WireType::kF32:
      return 4;
    default:
      return 1;
  }
}

// Type and size of a member.
struct Shape {
  std::size_t count;
  WireType type;
};
constexpr Shape shapeOf(std::uint64_t RobotState::*, std::uint16_t) { return {1, WireType::kU64}; }
constexpr Shape shapeOf(double RobotState::*, std::uint16_t version) {
  return {1, realsOf(version)};
}
template <std::size_t kSize>
constexpr Shape shapeOf(std::array<double, kSize> RobotState::*, std::uint16_t version) {
  return {kSize, realsOf(version)};
}
template <std::size_t kRows, std::size_t kColumns>
constexpr Shape shapeOf(std::array<std::array<double, kColumns>, kRows> RobotState::*,
                        std::uint16_t version) {
  return {kRows * kColumns, realsOf(version)};
}
constexpr Shape shapeOf(std::array<bool, kErrorCount> RobotState::*, std::uint16_t version) {
  return {errorsOf(version), WireType::kBool};
}
template <typename Enum>
constexpr Shape shapeOf(Enum RobotState::*, std::uint16_t) {
  return {1, WireType::kU8};
}

constexpr StateLayout layoutOf(std::uint16_t version) {
  StateLayout layout{};
  visitFields([&](const char* name, auto member, std::uint16_t since) {
    if (version >= since) {
      const Shape shape = shapeOf(member, version);
      layout.fields[layout.count++] = {name, shape.count, shape.type, layout.size};
      layout.size += shape.count * sizeOf(shape.type);
    }
  });
  return layout;
}

// Versions 5 to 9 share a layout.
constexpr StateLayout kLayout3 = layoutOf(3);
constexpr StateLayout kLayout4 = layoutOf(4);
constexpr StateLayout kLayout5 = layoutOf(5);
constexpr StateLayout kLayout10 = layoutOf(10);
static_assert(kLayout5.size == kMaxStateSize && kLayout10.count == kStateFieldCount);

struct Real64 {
  static constexpr std::size_t kSize = 8;
  static double load(const std::uint8_t* from) noexcept { return wire::loadF64(from); }
  static void store(double value, std::uint8_t* to) noexcept { wire::storeF64(value, to); }
};
struct Real32 {
  static constexpr std::size_t kSize = 4;
  static double load(const std::uint8_t* from) noexcept { return wire::loadF32(from); }
  static void store(double value, std::uint8_t* to) noexcept { wire::storeF32(value, to); }
};

template <typename Real>
class StateWriter {
 public:
  StateWriter(std::uint16_t version, const RobotState& state, std::uint8_t* to) noexcept
      : version_(version), state_(state), to_(to) {}

  template <typename T>
  void operator()(const char* /*name*/, T RobotState::* member, std::uint16_t since) noexcept {
    if (version_ >= since) {
      put(state_.*member);
    }
  }

 private:
  void put(std::uint64_t value) noexcept {
    wire::store(value, to_);
    to_ += sizeof(value);
  }
  void put(double value) noexcept {
    Real::store(value, to_);
    to_ += Real::kSize;
  }
  template <typename T, std::size_t kSize>
  void put(const std::array<T, kSize>& values) noexcept {
    for (const T& value : values) {
      put(value);
    }
  }
  void put(const std::array<bool, kErrorCount>& flags) noexcept {
    for (std::size_t i = 0; i < errorsOf(version_); i++) {
      *to_++ = flags[i] ? 1 : 0;
    }
  }
  template <typename Enum, typename = std::enable_if_t<std::is_enum_v<Enum>>>
  void put(Enum value) noexcept {
    *to_++ = static_cast<std::uint8_t>(value);
  }

  std::uint16_t version_;
  const RobotState& state_;
  std::uint8_t* to_;
};

// The last value of each enumeration in this version.
constexpr std::uint8_t last(MotionGeneratorMode, std::uint16_t version) {
  return static_cast<std::uint8_t>(hasTorqueOnlyMove(version)
                                       ? MotionGeneratorMode::kNone
                                       : MotionGeneratorMode::kCartesianVelocity);
}
constexpr std::uint8_t last(ControllerMode, std::uint16_t) {
  return static_cast<std::uint8_t>(ControllerMode::kOther);
}
constexpr std::uint8_t last(RobotMode, std::uint16_t) {
  return static_cast<std::uint8_t>(RobotMode::kAutomaticErrorRecovery);
}

template <typename Enum>
constexpr bool isKnown(Enum value, std::uint16_t version) {
  return static_cast<std::uint8_t>(value) <= last(Enum{}, version);
}

template <typename Real>
class StateReader {
 public:
  StateReader(std::uint16_t version, const std::uint8_t* from, RobotState& state) noexcept
      : version_(version), from_(from), state_(state) {}

  template <typename T>
  void operator()(const char* /*name*/, T RobotState::* member, std::uint16_t since) noexcept {
    if (version_ >= since) {
      take(state_.*member);
    }
  }

 private:
  void take(std::uint64_t& value) noexcept {
    value = wire::load<std::uint64_t>(from_);
    from_ += sizeof(value);
  }
  void take(double& value) noexcept {
    value = Real::load(from_);
    from_ += Real::kSize;
  }
  template <typename T, std::size_t kSize>
  void take(std::array<T, kSize>& values) noexcept {
    for (T& value : values) {
      take(value);
    }
  }
  void take(std::array<bool, kErrorCount>& flags) noexcept {
    for (std::size_t i = 0; i < errorsOf(version_); i++) {
      flags[i] = *from_++ != 0;
    }
  }
  template <typename Enum, typename = std::enable_if_t<std::is_enum_v<Enum>>>
  void take(Enum& value) noexcept {
    value = static_cast<Enum>(*from_++);
  }

  std::uint16_t version_;
  const std::uint8_t* from_;
  RobotState& state_;
};

// Checks the few bytes that can be invalid before anything is read.
CodecError check(std::uint16_t version, const StateLayout& layout,
                 const std::uint8_t* data) noexcept {
  // From motion_generator_mode to robot_mode: the fields before the success rate.
  constexpr std::size_t kBytewiseFields = 5;
  const StateField* field = &layout.fields[layout.count - 1 - kBytewiseFields];
  const auto isValid = [&](const StateField& f, auto kind) {
    return data[f.offset] <= last(kind, version);
  };
  const bool known = isValid(field[0], MotionGeneratorMode{}) &&
                     isValid(field[1], ControllerMode{}) && isValid(field[4], RobotMode{});
  bool booleans = true;
  for (const StateField* flags = field + 2; flags != field + 4; flags++) {
    for (std::size_t i = 0; i < flags->count; i++) {
      booleans = booleans && data[flags->offset + i] <= 1;
    }
  }
  if (!known) {
    return CodecError::kUnknownEnum;
  }
  return booleans ? CodecError::kNone : CodecError::kBadBoolean;
}

void fillWhatTheVersionLacks(std::uint16_t version, RobotState& state) noexcept {
  if (version < 4) {
    state.F_T_NE = kIdentity;
    state.NE_T_EE = state.F_T_EE;
  }
  if (version < 5) {
    state.O_ddP_O = kGravity;
    for (std::size_t i = kErrorCountVersion4; i < kErrorCount; i++) {
      state.errors[i] = false;
      state.reflex_reason[i] = false;
    }
  }
  if (version < 10) {
    state.accelerometer_top = {};
    state.accelerometer_bottom = {};
  }
}

void composePayload(RobotState& state) noexcept {
  const Payload total = combine({state.m_ee, state.F_x_Cee, state.I_ee},
                                {state.m_load, state.F_x_Cload, state.I_load});
  state.m_total = total.mass;
  state.F_x_Ctotal = total.com;
  state.I_total = total.inertia;
}

}  // namespace

const StateLayout* stateLayout(std::uint16_t version) noexcept {
  if (!isRobotVersion(version)) {
    return nullptr;
  }
  switch (version) {
    case 3:
      return &kLayout3;
    case 4:
      return &kLayout4;
    case 10:
      return &kLayout10;
    default:
      return &kLayout5;
  }
}

std::size_t stateSize(std::uint16_t version) noexcept {
  const StateLayout* layout = stateLayout(version);
  return layout == nullptr ? 0 : layout->size;
}

CodecError encodeState(std::uint16_t version, const RobotState& state,
                       StateBuffer& buffer) noexcept {
  if (!isRobotVersion(version)) {
    return CodecError::kUnknownVersion;
  }
  if (!isKnown(state.motion_generator_mode, version) || !isKnown(state.controller_mode, version) ||
      !isKnown(state.robot_mode, version)) {
    return CodecError::kNotInThisVersion;
  }
  if (version >= kSinglePrecisionVersion) {
    visitFields(StateWriter<Real32>(version, state, buffer.data()));
  } else {
    visitFields(StateWriter<Real64>(version, state, buffer.data()));
  }
  return CodecError::kNone;
}

CodecError decodeState(std::uint16_t version, Bytes datagram, RobotState& state) noexcept {
  const StateLayout* layout = stateLayout(version);
  if (layout == nullptr) {
    return CodecError::kUnknownVersion;
  }
  if (datagram.size != layout->size) {
    return CodecError::kWrongSize;
  }
  const CodecError error = check(version, *layout, datagram.data);
  if (error != CodecError::kNone) {
    return error;
  }
  if (version >= kSinglePrecisionVersion) {
    visitFields(StateReader<Real32>(version, datagram.data, state));
  } else {
    visitFields(StateReader<Real64>(version, datagram.data, state));
  }
  fillWhatTheVersionLacks(version, state);
  composePayload(state);
  return CodecError::kNone;
}

}  // namespace franka_core::fci
