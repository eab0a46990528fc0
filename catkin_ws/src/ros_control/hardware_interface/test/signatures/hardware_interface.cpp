// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <hardware_interface/actuator_command_interface.h>
#include <hardware_interface/actuator_state_interface.h>
#include <hardware_interface/force_torque_sensor_interface.h>
#include <hardware_interface/imu_sensor_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_mode_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/position_velocity_torque_gains_command_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/posvelacc_command_interface.h>
#include <hardware_interface/robot_hw.h>

#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "signature.h"

using namespace hardware_interface;
typedef std::list<ControllerInfo> Infos;

// Base classes and exceptions.
static_assert(std::has_virtual_destructor<HardwareInterface>::value, "");
EXPECT_TYPE(void, of<HardwareInterface>().claim(std::string()));
EXPECT_TYPE(void, of<HardwareInterface>().clearClaims());
EXPECT_TYPE(std::set<std::string>, of<const HardwareInterface>().getClaims());
EXPECT_BASE(std::exception, HardwareInterfaceException);

// Managers.
EXPECT_BASE(ResourceManagerBase, ResourceManager<JointHandle>);
EXPECT_TYPE(void, ResourceManager<JointHandle>::concatManagers(
                      of<std::vector<ResourceManager<JointHandle>::ResourceManagerType*>>(),
                      static_cast<ResourceManager<JointHandle>*>(nullptr)));
static_assert(std::is_same<EffortJointInterface::ResourceHandleType, JointHandle>::value, "");
struct Reach : ResourceManager<JointHandle> {
  static_assert(std::is_same<ResourceMap, std::map<std::string, JointHandle>>::value, "");
  ResourceMap& map() { return resource_map_; }
};
struct ReachInterfaces : InterfaceManager {
  void use() {
    interfaces_.clear();
    interfaces_combo_.clear();
    interface_managers_.clear();
    num_ifaces_registered_.clear();
    interface_destruction_list_.clear();
    resources_.clear();
  }
};
EXPECT_TYPE(void, ClaimResources::claim(static_cast<HardwareInterface*>(0), std::string()));
EXPECT_TYPE(void, DontClaimResources::claim(static_cast<HardwareInterface*>(0), std::string()));

// The robot.
EXPECT_BASE(InterfaceManager, RobotHW);
struct Robot : RobotHW {
  bool init(ros::NodeHandle&, ros::NodeHandle&) override { return true; }
  bool checkForConflict(const Infos&) const override { return false; }
  bool prepareSwitch(const Infos&, const Infos&) override { return true; }
  void doSwitch(const Infos&, const Infos&) override {}
  SwitchState switchResult() const override { return SwitchState::ONGOING; }
  SwitchState switchResult(const ControllerInfo&) const override { return SwitchState::ERROR; }
  void read(const ros::Time&, const ros::Duration&) override {}
  void write(const ros::Time&, const ros::Duration&) override {}
};
EXPECT_TYPE(RobotHWSharedPtr, std::shared_ptr<RobotHW>());

// Base classes that users' templates rely on.
template <class Interface, class Handle, class Policy>
constexpr bool kIs = std::is_base_of<HardwareResourceManager<Handle, Policy>, Interface>::value;
static_assert(kIs<JointStateInterface, JointStateHandle, DontClaimResources>, "");
static_assert(kIs<ActuatorStateInterface, ActuatorStateHandle, DontClaimResources>, "");

// Commands.
EXPECT_BASE(JointStateHandle, JointHandle);
static_assert(kIs<JointCommandInterface, JointHandle, ClaimResources>, "");
EXPECT_BASE(JointCommandInterface, EffortJointInterface);
EXPECT_BASE(JointCommandInterface, VelocityJointInterface);
EXPECT_BASE(JointCommandInterface, PositionJointInterface);
EXPECT_BASE(ActuatorStateHandle, ActuatorHandle);
static_assert(kIs<ActuatorCommandInterface, ActuatorHandle, DontClaimResources>, "");
EXPECT_BASE(ActuatorCommandInterface, EffortActuatorInterface);
EXPECT_BASE(ActuatorCommandInterface, VelocityActuatorInterface);
EXPECT_BASE(ActuatorCommandInterface, PositionActuatorInterface);
EXPECT_BASE(JointStateHandle, PosVelJointHandle);
static_assert(kIs<PosVelJointInterface, PosVelJointHandle, ClaimResources>, "");
EXPECT_BASE(PosVelJointHandle, PosVelAccJointHandle);
static_assert(kIs<PosVelAccJointInterface, PosVelAccJointHandle, ClaimResources>, "");
typedef PositionVelocityTorqueGainsJointHandle GainsHandle;
EXPECT_BASE(PosVelJointHandle, GainsHandle);
static_assert(kIs<PositionVelocityTorqueGainsJointInterface, GainsHandle, ClaimResources>, "");
EXPECT_TYPE(void, of<GainsHandle>().setCommandEffort(1.0));
EXPECT_TYPE(void, of<GainsHandle>().setCommandKp(1.0));
EXPECT_TYPE(void, of<GainsHandle>().setCommandKd(1.0));

// Modes and sensors.
static_assert(kIs<JointModeInterface, JointModeHandle, DontClaimResources>, "");
static_assert(kIs<ForceTorqueSensorInterface, ForceTorqueSensorHandle, DontClaimResources>, "");
static_assert(kIs<ImuSensorInterface, ImuSensorHandle, DontClaimResources>, "");
EXPECT_TYPE(std::string, ForceTorqueSensorHandle().getFrameId());
