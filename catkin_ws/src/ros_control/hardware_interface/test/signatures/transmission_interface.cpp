// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <transmission_interface/bidirectional_effort_joint_interface_provider.h>
#include <transmission_interface/bidirectional_position_joint_interface_provider.h>
#include <transmission_interface/bidirectional_velocity_joint_interface_provider.h>
#include <transmission_interface/differential_transmission.h>
#include <transmission_interface/differential_transmission_loader.h>
#include <transmission_interface/effort_joint_interface_provider.h>
#include <transmission_interface/four_bar_linkage_transmission.h>
#include <transmission_interface/four_bar_linkage_transmission_loader.h>
#include <transmission_interface/joint_state_interface_provider.h>
#include <transmission_interface/position_joint_interface_provider.h>
#include <transmission_interface/robot_transmissions.h>
#include <transmission_interface/simple_transmission.h>
#include <transmission_interface/simple_transmission_loader.h>
#include <transmission_interface/transmission_interface.h>
#include <transmission_interface/transmission_interface_loader.h>
#include <transmission_interface/velocity_joint_interface_provider.h>

#include <memory>
#include <string>
#include <vector>

#include "signature.h"

using namespace transmission_interface;

struct Own : Transmission {
  void actuatorToJointEffort(const ActuatorData&, JointData&) override {}
  void actuatorToJointVelocity(const ActuatorData&, JointData&) override {}
  void actuatorToJointPosition(const ActuatorData&, JointData&) override {}
  void actuatorToJointAbsolutePosition(const ActuatorData&, JointData&) override {}
  void actuatorToJointTorqueSensor(const ActuatorData&, JointData&) override {}
  void jointToActuatorEffort(const JointData&, ActuatorData&) override {}
  void jointToActuatorVelocity(const JointData&, ActuatorData&) override {}
  void jointToActuatorPosition(const JointData&, ActuatorData&) override {}
  std::size_t numActuators() const override { return 1; }
  std::size_t numJoints() const override { return 1; }
  bool hasActuatorToJointAbsolutePosition() const override { return true; }
  bool hasActuatorToJointTorqueSensor() const override { return true; }
};
EXPECT_TYPE(TransmissionSharedPtr, std::shared_ptr<Transmission>());
EXPECT_BASE(Transmission, SimpleTransmission);
EXPECT_BASE(Transmission, DifferentialTransmission);
EXPECT_BASE(Transmission, FourBarLinkageTransmission);
EXPECT_TYPE(DifferentialTransmission,
            DifferentialTransmission(std::vector<double>(), std::vector<double>(), true));
EXPECT_BASE(std::exception, TransmissionInterfaceException);

// Handles and their interfaces.
template <class Handle, class Interface>
constexpr bool isMap() {
  EXPECT_BASE(TransmissionHandle, Handle);
  EXPECT_BASE(TransmissionInterface<Handle>, Interface);
  EXPECT_BASE(hardware_interface::ResourceManager<Handle>, Interface);
  return true;
}
static_assert(isMap<ActuatorToJointStateHandle, ActuatorToJointStateInterface>(), "");
static_assert(isMap<ActuatorToJointPositionHandle, ActuatorToJointPositionInterface>(), "");
static_assert(isMap<ActuatorToJointVelocityHandle, ActuatorToJointVelocityInterface>(), "");
static_assert(isMap<ActuatorToJointEffortHandle, ActuatorToJointEffortInterface>(), "");
static_assert(isMap<JointToActuatorStateHandle, JointToActuatorStateInterface>(), "");
static_assert(isMap<JointToActuatorPositionHandle, JointToActuatorPositionInterface>(), "");
static_assert(isMap<JointToActuatorVelocityHandle, JointToActuatorVelocityInterface>(), "");
static_assert(isMap<JointToActuatorEffortHandle, JointToActuatorEffortInterface>(), "");
EXPECT_BASE(hardware_interface::InterfaceManager, RobotTransmissions);

// Loaders.
struct OwnLoader : TransmissionLoader {
  TransmissionSharedPtr load(const TransmissionInfo& info) override {
    double number = 0.0;
    std::string word;
    const TiXmlElement element = loadXmlElement(word);
    const bool good = checkActuatorDimension(info, 1u) && checkJointDimension(info, 1u) &&
                      getActuatorReduction(element, word, word, true, number) == SUCCESS &&
                      getJointReduction(element, word, word, true, number) != NO_DATA &&
                      getJointOffset(element, word, word, false, number) != BAD_TYPE &&
                      getActuatorRole(element, word, word, false, word) == SUCCESS &&
                      getJointRole(element, word, word, true, word) == SUCCESS;
    return good ? std::make_shared<Own>() : nullptr;
  }
};
EXPECT_BASE(TransmissionLoader, SimpleTransmissionLoader);
EXPECT_BASE(TransmissionLoader, DifferentialTransmissionLoader);
EXPECT_BASE(TransmissionLoader, FourBarLinkageTransmissionLoader);
EXPECT_BASE(RequisiteProvider, JointStateInterfaceProvider);
EXPECT_BASE(JointStateInterfaceProvider, PositionJointInterfaceProvider);
EXPECT_BASE(JointStateInterfaceProvider, VelocityJointInterfaceProvider);
EXPECT_BASE(JointStateInterfaceProvider, EffortJointInterfaceProvider);
EXPECT_BASE(RequisiteProvider, BiDirectionalPositionJointInterfaceProvider);
EXPECT_BASE(RequisiteProvider, BiDirectionalVelocityJointInterfaceProvider);
EXPECT_BASE(RequisiteProvider, BiDirectionalEffortJointInterfaceProvider);
EXPECT_TYPE(double&, (of<RawJointData>().position_cmd));
EXPECT_TYPE(double&, (of<RawJointData>().velocity_cmd));
EXPECT_TYPE(double&, (of<RawJointData>().effort_cmd));
