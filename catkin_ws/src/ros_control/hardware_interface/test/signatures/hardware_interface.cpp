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
EXPECT_TYPE(const char*, HardwareInterfaceException(std::string()).what());
EXPECT_TYPE(std::string, internal::demangleSymbol(""));
EXPECT_TYPE(std::string, internal::demangledTypeName<int>());
EXPECT_TYPE(std::string, internal::demangledTypeName(of<HardwareInterface>()));

// Managers.
EXPECT_BASE(ResourceManagerBase, ResourceManager<JointHandle>);
EXPECT_TYPE(std::vector<std::string>, of<const JointStateInterface>().getNames());
EXPECT_TYPE(void, of<JointStateInterface>().registerHandle(JointStateHandle()));
EXPECT_TYPE(JointStateHandle, of<JointStateInterface>().getHandle(std::string()));
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
EXPECT_TYPE(void, of<InterfaceManager>().registerInterface(static_cast<JointStateInterface*>(0)));
EXPECT_TYPE(void,
            of<InterfaceManager>().registerInterfaceManager(static_cast<InterfaceManager*>(0)));
EXPECT_TYPE(JointStateInterface*, of<InterfaceManager>().get<JointStateInterface>());
EXPECT_TYPE(std::vector<std::string>, of<const InterfaceManager>().getNames());
EXPECT_TYPE(std::vector<std::string>,
            of<const InterfaceManager>().getInterfaceResources(std::string()));
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
EXPECT_TYPE(std::string&, (of<ControllerInfo>().name));
EXPECT_TYPE(std::string&, (of<ControllerInfo>().type));
EXPECT_TYPE(std::vector<InterfaceResources>&, (of<ControllerInfo>().claimed_resources));
EXPECT_TYPE(std::string&, (InterfaceResources(std::string(), std::set<std::string>()),
                           InterfaceResources(), of<InterfaceResources>().hardware_interface));
EXPECT_TYPE(std::set<std::string>&, (of<InterfaceResources>().resources));

// States of joints and of actuators look the same.
template <class Handle>
void useState(const Handle& handle, const double* p, double (*double_of)(double),
              const double* (*pointer_of)(const double*)) {
  Handle();
  Handle(std::string(), p, p, p);
  Handle(std::string(), p, p, p, p);
  Handle(std::string(), p, p, p, p, p);
  Handle(std::string(), p, p, p, p, true);
  const std::string name = handle.getName();
  static_cast<void>(name);
  double_of(handle.getPosition() + handle.getVelocity() + handle.getEffort());
  double_of(handle.getAbsolutePosition() + handle.getTorqueSensor());
  pointer_of(handle.getPositionPtr());
  pointer_of(handle.getVelocityPtr());
  pointer_of(handle.getEffortPtr());
  pointer_of(handle.getAbsolutePositionPtr());
  pointer_of(handle.getTorqueSensorPtr());
  const bool has = handle.hasAbsolutePosition() && handle.hasTorqueSensor();
  static_cast<void>(has);
}
template void useState(const JointStateHandle&, const double*, double (*)(double),
                       const double* (*)(const double*));
template void useState(const ActuatorStateHandle&, const double*, double (*)(double),
                       const double* (*)(const double*));
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
EXPECT_TYPE(void, JointHandle(JointStateHandle(), nullptr).setCommand(1.0));
EXPECT_TYPE(double, of<const JointHandle>().getCommand());
EXPECT_TYPE(const double*, of<const JointHandle>().getCommandPtr());
EXPECT_BASE(ActuatorStateHandle, ActuatorHandle);
static_assert(kIs<ActuatorCommandInterface, ActuatorHandle, DontClaimResources>, "");
EXPECT_BASE(ActuatorCommandInterface, EffortActuatorInterface);
EXPECT_BASE(ActuatorCommandInterface, VelocityActuatorInterface);
EXPECT_BASE(ActuatorCommandInterface, PositionActuatorInterface);
EXPECT_TYPE(void, ActuatorHandle(ActuatorStateHandle(), nullptr).setCommand(1.0));
EXPECT_TYPE(double, of<const ActuatorHandle>().getCommand());
EXPECT_TYPE(double*, of<ActuatorHandle>().getCommandPtr());

EXPECT_BASE(JointStateHandle, PosVelJointHandle);
static_assert(kIs<PosVelJointInterface, PosVelJointHandle, ClaimResources>, "");
EXPECT_TYPE(void, PosVelJointHandle(JointStateHandle(), nullptr, nullptr).setCommand(1.0, 2.0));
EXPECT_TYPE(void, of<PosVelJointHandle>().setCommandPosition(1.0));
EXPECT_TYPE(void, of<PosVelJointHandle>().setCommandVelocity(1.0));
EXPECT_TYPE(double, of<const PosVelJointHandle>().getCommandPosition());
EXPECT_TYPE(double, of<const PosVelJointHandle>().getCommandVelocity());
EXPECT_BASE(PosVelJointHandle, PosVelAccJointHandle);
static_assert(kIs<PosVelAccJointInterface, PosVelAccJointHandle, ClaimResources>, "");
EXPECT_TYPE(void, PosVelAccJointHandle(JointStateHandle(), nullptr, nullptr, nullptr)
                      .setCommand(1.0, 2.0, 3.0));
EXPECT_TYPE(void, of<PosVelAccJointHandle>().setCommandAcceleration(1.0));
EXPECT_TYPE(double, of<const PosVelAccJointHandle>().getCommandAcceleration());
typedef PositionVelocityTorqueGainsJointHandle GainsHandle;
EXPECT_BASE(PosVelJointHandle, GainsHandle);
static_assert(kIs<PositionVelocityTorqueGainsJointInterface, GainsHandle, ClaimResources>, "");
EXPECT_TYPE(void, (GainsHandle(JointStateHandle(), nullptr, nullptr, nullptr, nullptr, nullptr)
                       .setCommandEffort(1.0)));
EXPECT_TYPE(void, of<GainsHandle>().setCommandKp(1.0));
EXPECT_TYPE(void, of<GainsHandle>().setCommandKd(1.0));
EXPECT_TYPE(double, of<const GainsHandle>().getCommandEffort());
EXPECT_TYPE(double, of<const GainsHandle>().getCommandKp());
EXPECT_TYPE(double, of<const GainsHandle>().getCommandKd());

// Modes.
static_assert(static_cast<int>(JointCommandModes::BEGIN) == -1, "");
static_assert(static_cast<int>(JointCommandModes::MODE_POSITION) == 0, "");
static_assert(static_cast<int>(JointCommandModes::MODE_VELOCITY) == 1, "");
static_assert(static_cast<int>(JointCommandModes::MODE_EFFORT) == 2, "");
static_assert(static_cast<int>(JointCommandModes::NOMODE) == 3, "");
static_assert(static_cast<int>(JointCommandModes::EMERGENCY_STOP) == 4, "");
static_assert(static_cast<int>(JointCommandModes::SWITCHING) == 5, "");
static_assert(static_cast<int>(JointCommandModes::ERROR) == 6, "");
static_assert(kIs<JointModeInterface, JointModeHandle, DontClaimResources>, "");
EXPECT_TYPE(std::string, JointModeHandle(std::string(), nullptr).getName());
EXPECT_TYPE(void, of<JointModeHandle>().setMode(JointCommandModes::NOMODE));
EXPECT_TYPE(JointCommandModes, of<const JointModeHandle>().getMode());
EXPECT_TYPE(const JointCommandModes*, of<const JointModeHandle>().getModePtr());
EXPECT_TYPE(std::string, of<JointModeHandle>().getModeName(JointCommandModes::NOMODE));

// Sensors.
static_assert(kIs<ForceTorqueSensorInterface, ForceTorqueSensorHandle, DontClaimResources>, "");
EXPECT_TYPE(std::string,
            ForceTorqueSensorHandle(std::string(), std::string(), nullptr, nullptr).getName());
EXPECT_TYPE(std::string, ForceTorqueSensorHandle().getFrameId());
EXPECT_TYPE(const double*, of<const ForceTorqueSensorHandle>().getForce());
EXPECT_TYPE(const double*, of<const ForceTorqueSensorHandle>().getTorque());
static_assert(kIs<ImuSensorInterface, ImuSensorHandle, DontClaimResources>, "");
EXPECT_TYPE(std::string, ImuSensorHandle(std::string(), std::string(), nullptr, nullptr, nullptr,
                                         nullptr, nullptr, nullptr)
                             .getName());
EXPECT_TYPE(std::string, ImuSensorHandle(ImuSensorHandle::Data()).getFrameId());
EXPECT_TYPE(const double*, ImuSensorHandle().getOrientation());
EXPECT_TYPE(const double*, ImuSensorHandle().getOrientationCovariance());
EXPECT_TYPE(const double*, ImuSensorHandle().getAngularVelocity());
EXPECT_TYPE(const double*, ImuSensorHandle().getAngularVelocityCovariance());
EXPECT_TYPE(const double*, ImuSensorHandle().getLinearAcceleration());
EXPECT_TYPE(const double*, ImuSensorHandle().getLinearAccelerationCovariance());
