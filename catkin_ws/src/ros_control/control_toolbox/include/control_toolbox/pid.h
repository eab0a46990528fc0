// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <control_msgs/PidState.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/duration.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <memory>
#include <string>

#include "control_toolbox/ParametersConfig.h"
#include "control_toolbox/detail/snapshot.h"

class TiXmlElement;

namespace control_toolbox {

/// A PID controller for one value:
///
///   command = p e + clamp(i I, i_min, i_max) + d de/dt,   I = integral of e over time.
///
/// Without `antiwindup` the integral itself keeps growing and only its term is limited; with it
/// the integral is limited to [i_min/i, i_max/i]. The command is not limited. Units are the
/// caller's: with e in [rad] and a command in [Nm], p is [Nm/rad], i [Nm/(rad s)], d [Nm s/rad].
///
/// Threads: one thread calls computeCommand(), reset(), setCurrentCmd() and the getters of errors
/// and command. Gains may be read and set by any thread. Functions without a note are for set-up
/// and other threads than the control loop.
class Pid {
 public:
  /// The gains, and the limits of the integral part of the command.
  struct Gains {
    Gains(double p, double i, double d, double i_max, double i_min)
        : Gains(p, i, d, i_max, i_min, false) {}
    Gains(double p, double i, double d, double i_max, double i_min, bool antiwindup)
        : p_gain_(p),
          i_gain_(i),
          d_gain_(d),
          i_max_(i_max),
          i_min_(i_min),
          antiwindup_(antiwindup) {}
    Gains() = default;

    double p_gain_{0.0};      ///< proportional
    double i_gain_{0.0};      ///< integral
    double d_gain_{0.0};      ///< derivative
    double i_max_{0.0};       ///< upper limit of the integral term
    double i_min_{0.0};       ///< lower limit of the integral term
    bool antiwindup_{false};  ///< the integral stops at its limits
  };

  // The original's default of i_min; it compares equal to 0.
  Pid(double p = 0.0, double i = 0.0, double d = 0.0, double i_max = 0.0, double i_min = -0.0,
      bool antiwindup = false);
  /// Copies have the same gains, with errors and command at zero; they have no reconfigure server
  /// and publish no state.
  Pid(const Pid& source) noexcept;
  Pid& operator=(const Pid& source);
  ~Pid();

  /// Sets the gains and resets errors and command.
  void initPid(double p, double i, double d, double i_max, double i_min, bool antiwindup = false);
  /// The same, and starts dynamic reconfigure in the namespace "pid" of this node.
  /// @param node not used, as in the original.
  void initPid(double p, double i, double d, double i_max, double i_min,
               const ros::NodeHandle& node);
  void initPid(double p, double i, double d, double i_max, double i_min, bool antiwindup,
               const ros::NodeHandle& node);

  /// init() with the parameters in the namespace `prefix`.
  bool initParam(const std::string& prefix, bool quiet = false);

  /// Reads the gains from parameters, resets, and starts dynamic reconfigure in that namespace.
  ///
  /// Parameters: `p` (required), `i`, `d`, `i_clamp` (limits of the integral term, + and -),
  /// `i_clamp_min`, `i_clamp_max` (each overrides its side), `antiwindup`, `publish_state`
  /// (control_msgs/PidState on the topic `state`; its time stamp takes a lock in simulated time).
  /// Signs of the limits are ignored.
  ///
  /// @param quiet do not log a missing `p`.
  /// @return false, with an error in the log, if `p` is missing or a value has the wrong type.
  bool init(const ros::NodeHandle& node, bool quiet = false);

  /// Reads the attributes p, i, d, iClamp and antiwindup, resets, and starts dynamic reconfigure in
  /// the namespace "pid".
  bool initXml(TiXmlElement* config);

  /// Starts a dynamic reconfigure server for the gains; it starts with the gains in use and ignores
  /// the parameter server.
  void initDynamicReconfig(ros::NodeHandle& node);

  /// Real-time safe. Sets errors and command to zero. The next derivative is taken from an error of
  /// zero.
  void reset() noexcept;
  /// Real-time safe. The same with starting values: the next computeCommand(error, dt) uses
  /// `d_error` as derivative, and the integral continues from `i_error`.
  void reset(double d_error, double i_error) noexcept;

  /// The gains in use. Real-time safe. Thread-safe.
  void getGains(double& p, double& i, double& d, double& i_max, double& i_min);
  void getGains(double& p, double& i, double& d, double& i_max, double& i_min, bool& antiwindup);
  Gains getGains();

  /// Sets the gains and updates dynamic reconfigure, which publishes. Thread-safe.
  /// Not real-time safe.
  void setGains(double p, double i, double d, double i_max, double i_min, bool antiwindup = false);
  void setGains(const Gains& gains);

  /// Sets the gains from the real-time thread; dynamic reconfigure is not updated. Not in the
  /// original. Real-time safe. Thread-safe. @return false if another thread is setting gains.
  bool trySetGains(const Gains& gains) noexcept { return gains_.trySet(gains); }

  /// Updates dynamic reconfigure with the gains in use, other gains, or a whole configuration.
  void updateDynamicReconfig();
  void updateDynamicReconfig(Gains gains_config);
  void updateDynamicReconfig(ParametersConfig config);

  /// Sets the gains of a configuration.
  void dynamicReconfigCallback(ParametersConfig& config, std::uint32_t level);

  /// One step with the derivative of the error taken from the previous step. Real-time safe.
  /// @param error target minus actual value.
  /// @param dt since the previous step.
  /// @return the command; 0 if dt is 0 or the error is not finite.
  double computeCommand(double error, ros::Duration dt);

  /// One step with a given derivative of the error. Real-time safe.
  /// @return the command; 0 if dt is 0 or an input is not finite.
  double computeCommand(double error, double error_dot, ros::Duration dt);

  /// As computeCommand with the opposite signs of the error and of the command. Real-time safe.
  [[deprecated("Use computeCommand(), which returns the opposite sign.")]] double updatePid(
      double p_error, ros::Duration dt);
  [[deprecated("Use computeCommand(), which returns the opposite sign.")]] double updatePid(
      double error, double error_dot, ros::Duration dt);

  /// The last command, and its correction to the command really sent. Real-time safe.
  void setCurrentCmd(double cmd);
  /// The last command. Real-time safe.
  double getCurrentCmd();

  /// The last error, its integral and its derivative. Real-time safe.
  void getCurrentPIDErrors(double* pe, double* ie, double* de);

  /// Writes gains, errors and command to the log.
  void printValues();

 private:
  class Reconfigure;

  double derivative(double error, ros::Duration dt);
  double integralTerm(const Gains& gains, double error, ros::Duration dt);
  void publishState(const Gains& gains, double i_term, ros::Duration dt);

  detail::Snapshot<Gains> gains_;

  double p_error_last_{0.0};
  double p_error_{0.0};
  double i_error_{0.0};
  double d_error_{0.0};
  double cmd_{0.0};
  /// Whether p_error_last_ is valid for a derivative.
  bool error_last_valid_{true};

  realtime_tools::RealtimePublisherSharedPtr<control_msgs::PidState> state_publisher_;
  std::unique_ptr<Reconfigure> reconfigure_;
};

}  // namespace control_toolbox
