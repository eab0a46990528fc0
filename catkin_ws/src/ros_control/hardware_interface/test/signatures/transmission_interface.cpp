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
#include <transmission_interface/transmission_parser.h>
#include <transmission_interface/velocity_joint_interface_provider.h>

#include <string>
#include <vector>

#include "signature.h"

using namespace transmission_interface;
typedef std::vector<double> Doubles;

// Descriptions.
EXPECT_TYPE(std::string&, (of<JointInfo>().name_));
EXPECT_TYPE(std::string&, (of<JointInfo>().role_));
EXPECT_TYPE(std::string&, (of<JointInfo>().xml_element_));
EXPECT_TYPE(std::string&, (of<ActuatorInfo>().name_));
EXPECT_TYPE(std::string&, (of<ActuatorInfo>().xml_element_));
EXPECT_TYPE(std::string&, (of<TransmissionInfo>().name_));
EXPECT_TYPE(std::string&, (of<TransmissionInfo>().type_));
EXPECT_TYPE(std::vector<std::string>&, (of<JointInfo>().hardware_interfaces_));
EXPECT_TYPE(std::vector<std::string>&, (of<ActuatorInfo>().hardware_interfaces_));
EXPECT_TYPE(std::vector<JointInfo>&, (of<TransmissionInfo>().joints_));
EXPECT_TYPE(std::vector<ActuatorInfo>&, (of<TransmissionInfo>().actuators_));
EXPECT_TYPE(bool, TransmissionParser::parse(std::string(), of<std::vector<TransmissionInfo>>()));

// Transmissions.
template <class Data>
void useData(Data& data) {
  for (auto* member : {&data.position, &data.velocity, &data.effort, &data.absolute_position,
                       &data.torque_sensor}) {
    EXPECT_TYPE(std::vector<double*>*, member + 0);
  }
}
template void useData(ActuatorData&);
template void useData(JointData&);
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
SimpleTransmission made_from_a_list = {10.0, 1.0};
EXPECT_TYPE(double, SimpleTransmission(1.0).getActuatorReduction());
EXPECT_TYPE(double, SimpleTransmission(1.0, 0.0).getJointOffset());
template <class T>
constexpr bool isPair() {
  EXPECT_BASE(Transmission, T);
  EXPECT_TYPE(const Doubles&, T(Doubles(), Doubles()).getActuatorReduction());
  EXPECT_TYPE(const Doubles&, T(Doubles(), Doubles(), Doubles()).getJointReduction());
  EXPECT_TYPE(const Doubles&, of<const T>().getJointOffset());
  return true;
}
static_assert(isPair<DifferentialTransmission>(), "");
static_assert(isPair<FourBarLinkageTransmission>(), "");
EXPECT_TYPE(DifferentialTransmission, DifferentialTransmission(Doubles(), Doubles(), true));
EXPECT_TYPE(DifferentialTransmission,
            DifferentialTransmission(Doubles(), Doubles(), true, Doubles()));
EXPECT_BASE(std::exception, TransmissionInterfaceException);
EXPECT_TYPE(const char*, TransmissionInterfaceException(std::string()).what());

// Handles and their interfaces.
template <class Handle, class Interface>
constexpr bool isMap() {
  EXPECT_BASE(TransmissionHandle, Handle);
  EXPECT_BASE(TransmissionInterface<Handle>, Interface);
  EXPECT_BASE(hardware_interface::ResourceManager<Handle>, Interface);
  EXPECT_TYPE(std::string, Handle(std::string(), static_cast<Transmission*>(nullptr),
                                  of<const ActuatorData>(), of<const JointData>())
                               .getName());
  EXPECT_TYPE(void, of<Handle>().propagate());
  EXPECT_TYPE(void, of<Interface>().propagate());
  EXPECT_TYPE(Handle, of<Interface>().getHandle(std::string()));
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
typedef TransmissionInterfaceLoader Loader;
EXPECT_TYPE(bool, Loader(static_cast<hardware_interface::RobotHW*>(nullptr),
                         static_cast<RobotTransmissions*>(nullptr))
                      .load(std::string()));
EXPECT_TYPE(bool, of<Loader>().load(std::vector<TransmissionInfo>()));
EXPECT_TYPE(bool, of<Loader>().load(TransmissionInfo()));
EXPECT_TYPE(TransmissionLoaderData*, of<Loader>().getData());
EXPECT_TYPE(double&, (of<RawJointData>().position));
EXPECT_TYPE(double&, (of<RawJointData>().velocity));
EXPECT_TYPE(double&, (of<RawJointData>().effort));
EXPECT_TYPE(double&, (of<RawJointData>().position_cmd));
EXPECT_TYPE(double&, (of<RawJointData>().velocity_cmd));
EXPECT_TYPE(double&, (of<RawJointData>().effort_cmd));
