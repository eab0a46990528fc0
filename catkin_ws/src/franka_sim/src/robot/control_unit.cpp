// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/texts.h>
#include <franka_core/robot_error.h>
#include <franka_sim/robot/control_unit.h>

#include <type_traits>

#include "robot/estimator/state_estimator.h"
#include "robot/laws/control_laws.h"
#include "robot/laws/control_task.h"
#include "robot/supervisor/motion_supervisor.h"

namespace franka_sim {

namespace codec = franka_core::fci;

namespace {

/// The setters that change frames or loads, on which the desired pose depends.
template <typename Setter>
constexpr bool kChangesFrames =
    std::is_same_v<Setter, codec::SetNEToEERequest> ||
    std::is_same_v<Setter, codec::SetEEToKRequest> ||
    std::is_same_v<Setter, codec::SetLoadRequest> || std::is_same_v<Setter, SetEndEffector>;

/// The setters that move the end effector's frame.
template <typename Setter>
constexpr bool kMovesEndEffector =
    std::is_same_v<Setter, codec::SetNEToEERequest> || std::is_same_v<Setter, SetEndEffector>;

/// The setters that Configuration applies.
template <typename Setter>
constexpr bool kConfigures =
    kChangesFrames<Setter> || std::is_same_v<Setter, codec::SetCollisionBehaviorRequest> ||
    std::is_same_v<Setter, codec::SetJointImpedanceRequest> ||
    std::is_same_v<Setter, codec::SetCartesianImpedanceRequest>;

}  // namespace

// The parts point to each other, so they must not move in memory; assigned to other parts, they
// keep what they point to (FixedPointer).
struct ControlUnit::Parts {
  explicit Parts(const ControlUnitParameters& parameters)
      : configuration(parameters),
        estimator(configuration, state),
        supervisor(configuration, estimator, state),
        laws(configuration) {
    configuration.writeTo(state);
  }

  template <typename Request>
  std::optional<Status> handle(const Request& request) noexcept {
    if constexpr (kConfigures<Request>) {
      return configure(request);
    } else {
      return supervisor.handle(request);
    }
  }

  std::optional<Status> handle(const SetProtocolVersion& request) noexcept {
    if (supervisor.isMoving()) {
      return Status::kCommandNotPossibleRejected;
    }
    const Status status = configuration.apply(request);
    if (status == Status::kSuccess) {
      supervisor.limitsChange();
    }
    return status;
  }

  template <typename Setter>
  Status configure(const Setter& setter) noexcept {
    // A generator computes its motion for the end effector at its start.
    const bool fixed = kMovesEndEffector<Setter> && supervisor.isMoving() && supervisor.generates();
    if (fixed || !supervisor.acceptsSetters()) {
      return Status::kCommandNotPossibleRejected;
    }
    const Status status = configuration.apply(setter);
    if (kChangesFrames<Setter> && status == Status::kSuccess) {
      configuration.writeTo(state);
      supervisor.framesChange();
    }
    return status;
  }

  Configuration configuration;
  franka_core::RobotState state;
  StateEstimator estimator;
  MotionSupervisor supervisor;
  ControlLaws laws;
};

ControlUnit::ControlUnit(const ControlUnitParameters& parameters)
    : parts_(std::make_unique<Parts>(parameters)) {}
ControlUnit::~ControlUnit() = default;
ControlUnit::ControlUnit(ControlUnit&& other) noexcept = default;
ControlUnit& ControlUnit::operator=(ControlUnit&& other) noexcept = default;

ControlUnit::ControlUnit(const ControlUnit& other) : ControlUnit(other.configuration()) {
  *parts_ = *other.parts_;
}

ControlUnit& ControlUnit::operator=(const ControlUnit& other) noexcept {
  if (this != &other) {
    *parts_ = *other.parts_;
  }
  return *this;
}

const franka_core::RobotState& ControlUnit::observe(const ArmMeasurement& measurement) noexcept {
  parts_->estimator.update(measurement, parts_->supervisor.beginTick());
  parts_->supervisor.checkState(parts_->laws.motorTorques());
  return parts_->state;
}

const std::array<double, 7>& ControlUnit::actuate(
    const franka_core::RobotCommand* command) noexcept {
  parts_->supervisor.advance(command);
  const ControlTask task = parts_->supervisor.takeTask();
  if (parts_->supervisor.brakesClosed() || !parts_->estimator.started()) {
    return parts_->laws.rest();
  }
  const std::array<double, 7>& torques =
      parts_->laws.torques(task, parts_->state, parts_->estimator.estimate());
  parts_->state.tau_J_d =
      parts_->supervisor.isMoving() ? parts_->laws.law() : std::array<double, 7>{};
  return torques;
}

const franka_core::RobotState& ControlUnit::state() const noexcept { return parts_->state; }

const franka_core::ArmDynamics& ControlUnit::dynamics() const noexcept {
  return parts_->estimator.estimate().dynamics;
}

std::optional<Status> ControlUnit::request(const UnitRequest& request) noexcept {
  return std::visit([this](const auto& what) { return parts_->handle(what); }, request);
}

std::optional<Status> ControlUnit::takeAnswer(PendingAnswer which) noexcept {
  return parts_->supervisor.take(which);
}

void ControlUnit::restart() noexcept {
  parts_->supervisor.restart();
  parts_->estimator.restart();
  parts_->laws.restart();
}

bool ControlUnit::stopsAtSingularPose() const noexcept {
  return parts_->supervisor.stopsAtSingularPose();
}

UnitStatus ControlUnit::status() const noexcept { return parts_->supervisor.status(); }

const ControlUnitParameters& ControlUnit::configuration() const noexcept {
  return parts_->configuration.parameters();
}

const franka_core::MotionLimits& ControlUnit::limits() const noexcept {
  return parts_->supervisor.limits();
}

const codec::CartesianLimit* ControlUnit::virtualWall(std::int32_t id) const noexcept {
  return parts_->supervisor.walls().get(id);
}

std::string conditionText(const std::string& name, const franka_core::RobotState& state) {
  std::string text = name + ": " + franka_core::fci::modeName(state.robot_mode);
  for (std::size_t i = 0; i < franka_core::kErrorCount; i++) {
    if (state.errors[i]) {
      text += ", " + std::string(franka_core::kErrorNames[i]);
    }
  }
  return text;
}

}  // namespace franka_sim
