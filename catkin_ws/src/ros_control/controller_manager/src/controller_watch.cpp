// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/controller_watch.h>

#include <chrono>
#include <iomanip>
#include <locale>
#include <sstream>
#include <utility>

namespace controller_manager {
namespace internal {

using controller_interface::ControllerBase;

ControllerWatch::ControllerWatch(ControllerBase& controller,
                                 const hardware_interface::ControllerInfo& info,
                                 hardware_interface::RobotHW& robot, const Supervision& supervision,
                                 std::vector<std::string> fallbacks)
    : controller_(controller),
      abort_faulty_(supervision.abort_faulty),
      max_update_time_(supervision.max_update_time),
      fallbacks_(std::move(fallbacks)),
      commands_(info, robot) {}

void ControllerWatch::update(const ros::Time& time, const ros::Duration& period,
                             std::size_t window) {
  if (!controller_.isRunning()) {
    return;
  }
  const auto begin = std::chrono::steady_clock::now();
  Fault fault = run(time, period);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;

  TimeStatistics& statistics = statistics_[window];
  statistics.add(elapsed.count());
  const bool too_slow = max_update_time_ > 0.0 && elapsed.count() > max_update_time_;
  if (too_slow || (period > ros::Duration(0.0) && elapsed.count() > period.toSec())) {
    statistics.addOverrun(time.toSec());
  }
  if (fault == Fault::kNone && too_slow) {
    fault = Fault::kTooSlow;
  }
  if (fault != Fault::kNone) {
    abort(fault, time, elapsed.count());
  }
}

ControllerWatch::Fault ControllerWatch::run(const ros::Time& time, const ros::Duration& period) {
  if (!abort_faulty_) {
    controller_.updateRequest(time, period);
    return Fault::kNone;
  }
  // These are the robot's last commands, from this controller's last update, its starting() or
  // another writer.
  commands_.remember();
  ExceptionText thrown;
  if (!runsThrough([&] { controller_.updateRequest(time, period); }, thrown)) {
    note(thrown.data());
    return Fault::kException;
  }
  const char* const offender = commands_.offender();
  if (offender == nullptr) {
    return Fault::kNone;
  }
  note(offender);
  return Fault::kNotFinite;
}

void ControllerWatch::restart(const ros::Time& time) {
  if (!controller_.isRunning()) {
    return;
  }
  const auto stop_and_start = [&] {
    controller_.stopRequest(time);
    controller_.startRequest(time);
  };
  if (!abort_faulty_) {
    stop_and_start();
    return;
  }
  commands_.remember();
  ExceptionText thrown;
  if (!runsThrough(stop_and_start, thrown)) {
    note(thrown.data());
    abort(Fault::kRestart, time, 0.0);
  }
}

void ControllerWatch::note(const char* text) {
  // The text of a fault that is not handled yet may be read now.
  if (fault() == Fault::kNone) {
    copyText(text, text_);
  }
}

void ControllerWatch::abort(Fault fault, const ros::Time& time, double elapsed) {
  if (fault != Fault::kTooSlow) {
    commands_.restore();
  }
  ExceptionText thrown;
  if (!runsThrough([&] { controller_.abortRequest(time); }, thrown)) {
    controller_.state_ = ControllerBase::ControllerState::ABORTED;
  }
  if (this->fault() == Fault::kNone) {
    elapsed_ = elapsed;
    fault_.store(fault, std::memory_order_release);
  }
}

std::string ControllerWatch::reason() const {
  switch (fault()) {
    case Fault::kException:
      return std::string("its update threw: ") + text_.data();
    case Fault::kRestart:
      return std::string("its restart threw: ") + text_.data();
    case Fault::kNotFinite:
      return std::string("it commanded joint '") + text_.data() + "' a value that is not a number";
    case Fault::kTooSlow: {
      std::ostringstream text;
      text.imbue(std::locale::classic());
      text << std::fixed << std::setprecision(3) << "its update took " << 1e3 * elapsed_
           << " ms, and controller_manager/max_update_time allows " << 1e3 * max_update_time_;
      return text.str();
    }
    case Fault::kNone:
      break;
  }
  return "nothing is wrong with it";
}

}  // namespace internal
}  // namespace controller_manager
