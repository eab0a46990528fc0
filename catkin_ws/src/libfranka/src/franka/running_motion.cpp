// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/running_motion.h"

#include <franka/errors.h>
#include <franka_core/fci/texts.h>

#include <chrono>
#include <locale>
#include <sstream>

namespace franka {

namespace {

namespace fci = franka_core::fci;

/// The text about a motion that ended by reflex: the genuine client's text word for word
/// (protocol 3.4), followed by separate lines with the cause found in the log.
/// @param text the event. @param state the newest one, with its reflex_reason.
/// @param log the last states and commands, oldest first. @param version the robot's protocol.
std::string reflexText(const std::string& text, const franka_core::RobotState& state,
                       const std::vector<MotionLog::Entry>& log, std::uint16_t version) {
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message << text << " " << Errors(state.reflex_reason);
  if (log.size() >= 2) {
    // The last state shows the abort; its own rate is 0.
    const franka_core::RobotState& before = log[log.size() - 2].state;
    const std::uint64_t lost = log.back().state.message_id - before.message_id - 1;
    message << "\ncontrol_command_success_rate: "
            << before.control_command_success_rate * (1.0 - static_cast<double>(lost) / 100.0);
    if (lost > 0) {
      message << " packets lost in a row in the last sample: " << lost;
    }
  }
  for (const std::string& sentence : franka_core::diagnoseAbort(log, version)) {
    message << "\n" << sentence;
  }
  return message.str();
}

}  // namespace

RunningMotion::RunningMotion(Robot::Impl& robot, const fci::MoveRequest& request)
    : robot_(robot), request_(request), log_(robot.logSize()) {
  robot_.takeStates();
  if (robot_.isMoving()) {
    throw ControlException(fci::kMultipleMotions);
  }
  id_ = robot_.send(request_);
  robot_.keepModeChanges();
  try {
    start();
    received_at_ = Robot::Impl::Clock::now();
  } catch (const NetworkException&) {
    connection_lost_ = true;
    cancelStart();
    throw;
  } catch (...) {
    cancelStart();
    throw;
  }
}

void RunningMotion::cancelStart() noexcept {
  // Unless the robot itself reports that there is no motion, it may already be moving.
  if (!end_) {
    cancel();
  }
  robot_.endMotion();
  robot_.discardReplies(id_);
}

RunningMotion::~RunningMotion() {
  robot_.endMotion();
  robot_.discardReplies(id_);
}

void RunningMotion::requireRunning() const {
  if (end_) {
    std::rethrow_exception(end_);
  }
}

/// The robot reports the end of a motion once: later calls throw the same again.
template <typename Function>
void RunningMotion::finishWith(Function function) {
  try {
    function();
  } catch (...) {
    end_ = std::current_exception();
    throw;
  }
}

void RunningMotion::start() {
  const Reply reply =
      robot_.receive(fci::Command::kMove, id_, robot_.bounds().command, /*owns_states=*/true);
  robot_.beginMotion();
  if (fci::meaning(reply.status) != fci::Meaning::kGood) {
    finishWith([&] {
      throw CommandException(fci::statusText(fci::Command::kMove, reply.status, robot_.mode()));
    });
  }
  awaitStart();
}

void RunningMotion::awaitStart() {
  const auto deadline = Robot::Impl::Clock::now() + robot_.bounds().command;
  while (!isShown()) {
    const std::optional<Reply> reply = robot_.tryReceive(fci::Command::kMove, id_);
    if (reply && reply->status == fci::Status::kSuccess) {
      early_end_ = reply;
      return;
    }
    if (reply && reply->status != fci::Status::kMotionStarted) {
      finishWith([&] { throwEnd(*reply, robot_.state(), nullptr); });
    }
    if (Robot::Impl::Clock::now() > deadline) {
      throw NetworkException(std::string(fci::kConnectionTimeout) +
                             " The robot has accepted the motion, but its states do not show it.");
    }
    robot_.receiveState();
  }
}

bool RunningMotion::isShown() const noexcept {
  return robot_.state().motion_generator_mode == request_.motion_generator_mode &&
         robot_.state().controller_mode == request_.controller_mode;
}

void RunningMotion::send(const franka_core::RobotCommand& command) {
  requireRunning();
  sent_ = command;
  answer_time_ = Robot::Impl::Clock::now() - received_at_;
  robot_.sendCommand(sent_);
}

void RunningMotion::receiveState() {
  try {
    robot_.receiveState();
  } catch (const NetworkException&) {
    connection_lost_ = true;
    throw;
  }
  log_.add(robot_.state(), sent_, std::chrono::duration<double>(answer_time_).count());
  received_at_ = Robot::Impl::Clock::now();
}

const franka_core::RobotState& RunningMotion::receive() {
  requireRunning();
  receiveState();
  if (robot_.state().robot_mode != franka_core::RobotMode::kMove || !isShown()) {
    finishWith([this] {
      const franka_core::RobotState end = robot_.state();  // newer ones arrive with the reply
      const Reply reply = lastReply();
      if (reply.status == fci::Status::kSuccess) {
        throw ProtocolException(fci::unexpectedResponse(fci::Command::kMove) +
                                " The robot ended the motion unasked, and calls that a success.");
      }
      throwEnd(reply, end, nullptr);
    });
  }
  return robot_.state();
}

void RunningMotion::finish(franka_core::RobotCommand command) {
  (isTorqueOnly() ? command.torque_command_finished : command.motion_generation_finished) = true;
  const auto deadline = Robot::Impl::Clock::now() + robot_.bounds().long_command;
  do {
    send(command);
    receiveState();
    if (Robot::Impl::Clock::now() > deadline) {
      throw NetworkException(std::string(fci::kConnectionTimeout) +
                             " The robot does not end the motion, although its end is commanded.");
    }
  } while (robot_.isMoving());
  finishWith([this] {
    const franka_core::RobotState end = robot_.state();
    const Reply reply = lastReply();
    if (reply.status != fci::Status::kSuccess) {
      throwEnd(reply, end, fci::kStillMoving);
    }
  });
}

RunningMotion::Reply RunningMotion::lastReply() {
  if (early_end_) {
    return *early_end_;
  }
  const auto bound = robot_.bounds().long_command;
  Reply reply = robot_.receive(fci::Command::kMove, id_, bound, /*owns_states=*/true);
  if (reply.status == fci::Status::kMotionStarted) {
    // A repetition of the first reply.
    reply = robot_.receive(fci::Command::kMove, id_, bound, /*owns_states=*/true);
  }
  if (reply.status == fci::Status::kMotionStarted) {
    throw ProtocolException(fci::unexpectedResponse(fci::Command::kMove));
  }
  return reply;
}

void RunningMotion::throwEnd(const Reply& reply, const franka_core::RobotState& end,
                             const char* reflex_text) {
  const std::vector<MotionLog::Entry> entries = log_.entries();
  std::string text = fci::statusText(fci::Command::kMove, reply.status, end.robot_mode);
  if (reply.status == fci::Status::kReflexAborted) {
    text = reflexText(reflex_text != nullptr ? reflex_text : text, end, entries, robot_.version());
  }
  throw ControlException(text, toRecords(entries));
}

void RunningMotion::cancel() noexcept {
  std::optional<std::uint32_t> id;
  try {
    id = robot_.send(fci::StopMoveRequest{});
    if (!connection_lost_) {
      const auto bound = robot_.bounds().long_command;
      const auto deadline = Robot::Impl::Clock::now() + bound;
      const Reply reply = robot_.receive(fci::Command::kStopMove, *id, bound, /*owns_states=*/true);
      bool is_there = true;
      while (is_there && reply.status == fci::Status::kSuccess && robot_.isMoving() &&
             Robot::Impl::Clock::now() < deadline) {
        is_there = robot_.waitForState(robot_.bounds().state);
      }
    }
  } catch (...) {
    // The first failure is reported; a missing reply to the stop follows from it.
  }
  if (id) {
    robot_.discardReplies(*id);
  }
}

}  // namespace franka
