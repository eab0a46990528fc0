// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/state_codec.h>
#include <franka_core/motion_limits.h>
#include <franka_core/numbers.h>
#include <franka_core/smooth_step.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/whole_robot.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace franka_sim {

using franka_core::RobotMode;

namespace {

// Of smoothStep: largest second derivative, 10 / sqrt(3), and third derivative.
constexpr double kStepAcceleration = 5.7735;
constexpr double kStepJerk = 60.0;
// Share of the joints' accelerations and jerks that a motion uses (chosen here).
constexpr double kGentle = 0.5;
// Velocity limits below this decide about the way's time only where they apply, not about the whole
// duration [rad/s] (chosen here: from such a speed to rest is a small step of the acceleration).
constexpr double kCreep = 0.05;
// Used share of a velocity limit, so that rounding never exceeds it.
constexpr double kShareOfLimit = 0.999;
// Of an interval of time: enough to find the last double in it.
constexpr int kHalvings = 60;

// First derivative of smoothStep.
double stepVelocity(double share) noexcept {
  return 30.0 * share * share * (1.0 - share) * (1.0 - share);
}

}  // namespace

// In the direction of the motion [rad/s].
double OperatorMotion::velocityLimit(std::size_t joint, double q) const noexcept {
  const franka_core::MotionLimits& limits = unit_->limits();
  return to_[joint] > from_[joint] ? limits.highestVelocity(joint, q)
                                   : -limits.lowestVelocity(joint, q);
}

// Joint velocity limits may depend on the position, so the way is sampled.
double OperatorMotion::shortestDuration(double speed) const noexcept {
  constexpr int kSamples = 200;
  const franka_core::MotionLimits& limits = unit_->limits();
  double duration = 0.1;
  for (std::size_t i = 0; i < to_.size(); i++) {
    const double way = to_[i] - from_[i];
    const double size = std::abs(way);
    duration =
        std::max({duration, std::sqrt(kStepAcceleration * size / (kGentle * limits.arm.ddq[i])),
                  std::cbrt(kStepJerk * size / (kGentle * limits.arm.dddq[i]))});
    for (int k = 1; k < kSamples; k++) {
      const double share = static_cast<double>(k) / kSamples;
      const double q = from_[i] + way * franka_core::smoothStep(share);
      if (size > 0.0) {
        const double limit = std::max(velocityLimit(i, q), kCreep);
        duration = std::max(duration, size * stepVelocity(share) / (speed * limit));
      }
    }
  }
  return duration;
}

// The largest share of the way at which this tick may end without exceeding a velocity limit.
double OperatorMotion::farthestShare() const noexcept {
  const double share = franka_core::smoothStep(time_ / duration_);
  double farthest = 1.0;
  for (std::size_t i = 0; i < to_.size(); i++) {
    const double size = std::abs(to_[i] - from_[i]);
    const double step = kShareOfLimit * velocityLimit(i, command_.q_c[i]) * kTick;
    if (step < (1.0 - share) * size) {
      farthest = std::min(farthest, share + step / size);
    }
  }
  return farthest;
}

// A tick later than now, or less where a velocity limit demands it.
double OperatorMotion::nextTime() const noexcept {
  const double farthest = farthestShare();
  double late = std::min(time_ + kTick, duration_);
  if (franka_core::smoothStep(late / duration_) <= farthest) {
    return late;
  }
  double early = time_;
  for (int i = 0; i < kHalvings; i++) {
    const double middle = 0.5 * (early + late);
    (franka_core::smoothStep(middle / duration_) <= farthest ? early : late) = middle;
  }
  return early;
}

std::optional<std::size_t> OperatorMotion::jointOutOfReach(
    const std::array<double, 7>& q) const noexcept {
  for (std::size_t i = 0; i < q.size(); i++) {
    const franka_core::JointRange reach = unit_->limits().reachFrom(i, unit_->state().q_d[i]);
    if (!(q[i] >= reach.lowest && q[i] <= reach.highest)) {
      return i;
    }
  }
  return std::nullopt;
}

Status OperatorMotion::start(const std::array<double, 7>& q, double speed) noexcept {
  if (jointOutOfReach(q) || !(speed > 0.0 && speed <= 1.0)) {
    return Status::kInvalidArgumentRejected;
  }
  OperatorMove request;
  request.move.max_path_deviation = {10.0, 3.14, 6.28};  // no limit
  request.move.max_goal_deviation = request.move.max_path_deviation;
  const Status answer = unit_->request(request).value_or(Status::kAborted);
  if (answer != Status::kMotionStarted) {
    return answer;
  }
  from_ = unit_->state().q_d;
  to_ = q;
  command_ = {};
  command_.q_c = from_;
  time_ = 0.0;
  duration_ = shortestDuration(speed);
  active_ = true;
  arrived_ = false;
  return answer;
}

void OperatorMotion::stop() noexcept {
  if (active_) {
    active_ = false;
    unit_->request(franka_core::fci::StopMoveRequest{});
  }
}

const franka_core::RobotCommand* OperatorMotion::command() noexcept {
  if (!active_) {
    return nullptr;
  }
  if (unit_->state().robot_mode != RobotMode::kMove) {
    active_ = false;
    arrived_ = command_.motion_generation_finished && unit_->state().robot_mode == RobotMode::kIdle;
    return nullptr;
  }
  time_ = nextTime();
  const double share = franka_core::smoothStep(time_ / duration_);
  for (std::size_t i = 0; i < to_.size(); i++) {
    command_.q_c[i] = share < 1.0 ? from_[i] + share * (to_[i] - from_[i]) : to_[i];
  }
  command_.motion_generation_finished = time_ >= duration_;
  return &command_;
}

void CommandLink::setLoss(double probability, std::uint64_t seed) {
  if (!(probability >= 0.0 && probability <= 1.0)) {
    throw std::invalid_argument("The probability of a loss is a number from 0 to 1.");
  }
  loss_ = probability;
  seed_ = seed;
  engine_.seed(seed);
}

void CommandLink::setDelay(double ticks) {
  const auto whole = franka_core::wholeNumber(ticks, 0, kMaxDelay);
  if (!whole) {
    throw std::invalid_argument("Commands are delayed by a whole number of ticks from 0 to " +
                                std::to_string(kMaxDelay) + ".");
  }
  delay_ = static_cast<unsigned>(*whole);
  clear();
}

void CommandLink::clear() noexcept {
  for (Slot& slot : slots_) {
    slot.full = false;
  }
}

void CommandLink::restart() noexcept {
  clear();
  lose_next_ = 0;
  engine_.seed(seed_);
}

bool CommandLink::loses() noexcept {
  if (lose_next_ > 0) {
    lose_next_--;
    return true;
  }
  constexpr double kSteps = 9007199254740992.0;  // 2^53
  return loss_ > 0.0 && static_cast<double>(engine_() >> 11U) < loss_ * kSteps;
}

const franka_core::RobotCommand* CommandLink::pass(
    const franka_core::RobotCommand* command) noexcept {
  now_ = (now_ + 1) % slots_.size();
  slots_[now_].full = command != nullptr && !loses();
  if (slots_[now_].full) {
    slots_[now_].command = *command;
  }
  const Slot& out = slots_[(now_ + slots_.size() - delay_) % slots_.size()];
  return out.full ? &out.command : nullptr;
}

namespace {

// Force laws of the fingers: gains of the original's FrankaGripperSim (decision 29).
constexpr FingerGains kFingerGains{100.0, 0.0, 1.0};

// A state's datagram begins with its id (protocol 4.1).
constexpr std::size_t kMessageIdSize = 8;

}  // namespace

WholeRobot::WholeRobot(const ControlUnitParameters& unit, ArmPlant& arm,
                       const std::optional<Hand>& hand,
                       const std::optional<VacuumGripperParameters>& vacuum, unsigned command_delay)
    : unit_(unit),
      arm_(&arm),
      safety_(unit_, unit.protocol_version >= protocolsOf("fr3").oldest),
      operator_motion_(unit_),
      hand_plant_(hand ? hand->plant : nullptr) {
  link_.setDelay(command_delay);
  if (hand) {
    hand_.emplace(hand->parameters);
  }
  if (vacuum) {
    vacuum_.emplace(*vacuum);
  }
}

WholeRobot::WholeRobot(const WholeRobot& other)
    : unit_(other.unit_),
      arm_(other.arm_.get()),
      safety_(unit_, other.safety_.isFr3()),
      operator_motion_(unit_),
      hand_plant_(other.hand_plant_.get()) {
  *this = other;
}

void WholeRobot::halt() noexcept {
  halted_ = !unit_.status().brakes_closed;
  unit_.request(Brakes{true});
}

void WholeRobot::restart() noexcept {
  unit_.restart();
  if (std::exchange(halted_, false)) {
    unit_.request(Brakes{false});
  }
  link_.restart();
  if (hand_) {
    hand_->restart();
  }
  if (vacuum_) {
    vacuum_->restart();
  }
  hashing_ = false;
  hash_ = {};
}

void WholeRobot::renew() {
  unit_ = ControlUnit(unit_.configuration());
  halted_ = false;
  start(safety_.rules());
  restart();
}

void WholeRobot::start(SafetyRules rules) noexcept {
  safety_.start(rules);
  if (hand_ && rules == SafetyRules::kDesk) {
    hand_->invalidateHoming();
  }
}

void WholeRobot::setPower(bool on) {
  if (on == safety_.state().power) {
    return;
  }
  if (on) {
    renew();
    return;
  }
  safety_.switchOff();
  if (hand_) {
    hand_->stop();
  }
}

void WholeRobot::observe() noexcept {
  unit_.observe(arm_->measure());
  if (hand_) {
    // The hand's state is shown even while time stands still.
    hand_->observe(hand_plant_->measure());
  }
}

void WholeRobot::actuate(const franka_core::RobotCommand* command) noexcept {
  safety_.step();
  const franka_core::RobotCommand* passed = link_.pass(command);
  hashing_ = hashing_ || passed != nullptr;
  if (operator_motion_.active()) {
    passed = operator_motion_.command();
  }
  if (hashing_) {
    updateHash();
  }
  const std::array<double, 7>& torque = unit_.actuate(passed);
  arm_->setBrakes(unit_.status().brakes_closed);
  arm_->applyTorques(torque);
  if (hand_) {
    hand_plant_->applyForces(hand_->step(hand_plant_->measure(), kTick));
  }
  if (vacuum_) {
    vacuum_->step(kTick);
  }
}

void WholeRobot::updateHash() noexcept {
  franka_core::fci::StateBuffer bytes;
  if (franka_core::fci::encodeState(9, unit_.state(), bytes) ==
      franka_core::fci::CodecError::kNone) {
    hash_.addBytes(bytes.data() + kMessageIdSize, bytes.size() - kMessageIdSize);
  }
}

GripperParameters handParameters(const GripperLatency& latency) {
  GripperParameters parameters;
  parameters.gains = {kFingerGains, kFingerGains};
  parameters.latency = latency;
  return parameters;
}

}  // namespace franka_sim
