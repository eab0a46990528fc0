// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>
#include <controller_manager/controller_loader_interface.h>
#include <controller_manager/controller_spec.h>
#include <controller_manager_msgs/ListControllerTypes.h>
#include <controller_manager_msgs/ListControllers.h>
#include <controller_manager_msgs/LoadController.h>
#include <controller_manager_msgs/ReloadControllerLibraries.h>
#include <controller_manager_msgs/SwitchController.h>
#include <controller_manager_msgs/UnloadController.h>
#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace controller_manager {

namespace internal {
class ControllerList;
class ControllerRegistry;
class LoopGate;
class ManagerServices;
class Supervisor;
struct SwitchRequest;
class SwitchHandover;
}  // namespace internal

/// Loads controllers, starts and stops them, and updates the running ones in the control loop.
///
/// Two kinds of threads use it. The *loop* calls update(), from one thread at a time, at any rate,
/// or not at all. All other functions are for threads *outside* the loop and may be called from any
/// number of them; the services of the same names call them. Both sides share atomics only:
/// update() takes no lock, allocates nothing and never waits.
///
/// While the loop stands still, controllers can be listed, loaded and unloaded; a switch waits for
/// the loop, allows other requests meanwhile, and fails after its timeout (decision 40).
///
/// Exceptions of a controller or the robot in the loop leave update(), as in the original, unless
/// abort_faulty_controllers catches them; but only after the other controllers were updated and a
/// switch was continued, so that a controller that throws in every cycle can be stopped. The
/// controller keeps the state before the callback, so one whose starting() threw does not run. An
/// exception ends a switch: its caller gets false, and controllers not yet started or stopped are
/// aborted, without another callback; the next update() works. The caller of update() must notify
/// the hardware itself.
///
/// Parameters in `<nh>/controller_manager/`, read once, enable functions that the original does not
/// have:
/// * `statistics_rate` [Hz]: publish `statistics` (controller_manager_msgs/ControllersStatistics).
/// * `abort_faulty_controllers` (bool): a controller that throws, or commands NaN to a joint, is
///   aborted alone; the robot keeps the commands of the cycle before until it has been notified.
/// * `max_update_time` [s]: likewise a controller whose update takes longer.
/// * `default_switch_timeout` [s]: for switches without a timeout.
/// A controller's own parameter `fallback_controllers` (names) lists the controllers to start in
/// its place after such an abort.
class ControllerManager {
 public:
  static constexpr bool WAIT_FOR_ALL_RESOURCES = false;  ///< of switchController
  static constexpr double INFINITE_TIMEOUT = 0.0;        ///< of switchController

  /// Offers the services list_controllers, list_controller_types, load_controller,
  /// unload_controller, switch_controller and reload_controller_libraries in
  /// `<nh>/controller_manager`. Loads plugins of controller_interface::ControllerBase.
  /// @param robot_hw must outlive the manager
  /// @param nh above the controllers' parameters; its queue serves the services, except the two
  /// that may wait for the loop, and list_controllers, which waits at most until a switch has been
  /// under way for a second: those have their own threads.
  /// @throws std::invalid_argument with a sentence if one of the parameters above is invalid
  ControllerManager(hardware_interface::RobotHW* robot_hw,
                    const ros::NodeHandle& nh = ros::NodeHandle());

  /// The loop must have ended.
  virtual ~ControllerManager();
  ControllerManager(const ControllerManager&) = delete;
  ControllerManager& operator=(const ControllerManager&) = delete;

  /// One cycle of the loop: updates all running controllers in the order of loading, then continues
  /// a switch. A controller stopped in this cycle was updated before, one started is updated from
  /// the next cycle on. Exceptions: see above. Real-time safe. The controllers' callbacks and the
  /// robot's switch must neither allocate nor lock.
  /// @param time of this cycle @param period since the one before
  /// @param reset_controllers restart the running controllers first
  void update(const ros::Time& time, const ros::Duration& period, bool reset_controllers = false);

  /// Chooses a controller by its name, its type and what it claims.
  typedef std::function<bool(const hardware_interface::ControllerInfo&)> ControllerFilter;

  /// The same, but first restarts those of the running controllers that the filter chooses; none
  /// without a filter. @param restarts called in this thread, with each controller
  void update(const ros::Time& time, const ros::Duration& period, const ControllerFilter& restarts);

  /// Loads the controller with the parameters in the namespace `name`.
  /// @returns false after logging the reason
  bool loadController(const std::string& name);

  /// Unloads a controller that is not running; it is destroyed in this thread.
  /// @returns false after logging the reason
  bool unloadController(const std::string& name);

  /// Stops and starts controllers in one cycle and waits until the loop has done it. A running
  /// controller in both lists is restarted.
  /// @param strictness controller_manager_msgs/SwitchController STRICT or BEST_EFFORT
  /// @param start_asap start each controller once the robot is ready for it, not all together
  /// @param timeout [s] for the start of the switch, and again for the robot to get ready; 0 waits
  /// for ever, or for the parameter default_switch_timeout
  /// @returns true if the loop has carried out the switch, also if the robot was not ready in time
  /// and controllers were aborted; false after logging the reason
  bool switchController(const std::vector<std::string>& start_controllers,
                        const std::vector<std::string>& stop_controllers, const int strictness,
                        bool start_asap = WAIT_FOR_ALL_RESOURCES,
                        double timeout = INFINITE_TIMEOUT);

  /// Destroys all controllers and reloads their libraries. @param force_kill stop and unload all
  /// controllers; otherwise none may be loaded
  /// @returns false after logging the reason
  bool reloadControllerLibraries(bool force_kill);

  /// The loaded controllers in the order of loading. Never waits for the loop.
  std::vector<ControllerSpec> getControllers() const;

  /// nullptr if there is no such controller; valid until it is unloaded.
  virtual controller_interface::ControllerBase* getControllerByName(const std::string& name);

  /// Adds a source of controllers; earlier ones are searched first.
  void registerControllerLoader(ControllerLoaderInterfaceSharedPtr controller_loader);

  /// A type of controllers and the loader it comes from.
  struct DeclaredType {
    std::string type;        ///< name for pluginlib
    std::string base_class;  ///< that the loader declares
  };
  /// The types of all loaders.
  std::vector<DeclaredType> getDeclaredTypes();

 private:
  /// Restarts the controller if it runs.
  static void restart(const ControllerSpec& spec, const ros::Time& time);
  bool refusedInLoop(const char* action) const;
  bool reloadLoaders();
  controller_interface::ControllerBaseSharedPtr createController(const std::string& name,
                                                                 const std::string& type);
  bool initController(ControllerSpec& spec, ros::NodeHandle& controller_nh);
  /// nullptr after logging why the switch is impossible.
  std::unique_ptr<internal::SwitchRequest> planSwitch(const std::vector<std::string>& start,
                                                      const std::vector<std::string>& stop,
                                                      bool strict);

  /// @param[out] thrown the controllers whose starting() threw
  bool carryOut(const std::vector<std::string>& start, const std::vector<std::string>& stop,
                int strictness, bool start_asap, double timeout, std::vector<std::string>& thrown);
  /// Starts the fallbacks of an aborted controller, and notifies the robot. @param first log it if
  /// that is not possible yet @returns false if it must be repeated
  bool handleFault(const std::string& name, bool first);
  std::unique_ptr<internal::SwitchRequest> planFallback(const ControllerSpec& aborted);
  bool watchController(ControllerSpec& spec, const ros::NodeHandle& controller_nh);
  void explainWithdrawal(double elapsed) const;

  hardware_interface::RobotHW* robot_hw_;
  ros::NodeHandle root_nh_;

  std::mutex loaders_mutex_;
  std::list<ControllerLoaderInterfaceSharedPtr> controller_loaders_;

  /// Guards changes of the list and calls of the robot. Never held while waiting for a switch.
  /// Taken before loaders_mutex_.
  std::mutex services_mutex_;

  // In this order: controllers are destroyed before the loaders of their libraries.
  std::unique_ptr<internal::LoopGate> gate_;
  std::unique_ptr<internal::ControllerRegistry> registry_;
  std::unique_ptr<internal::SwitchHandover> handover_;
  std::unique_ptr<internal::Supervisor> supervisor_;
  std::unique_ptr<internal::ManagerServices> services_;
  double default_switch_timeout_{INFINITE_TIMEOUT};
};

}  // namespace controller_manager
