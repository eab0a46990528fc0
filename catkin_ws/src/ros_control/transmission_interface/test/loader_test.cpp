// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <hardware_interface/actuator_command_interface.h>
#include <hardware_interface/actuator_state_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <transmission_interface/differential_transmission.h>
#include <transmission_interface/four_bar_linkage_transmission.h>
#include <transmission_interface/simple_transmission.h>
#include <transmission_interface/transmission_interface_loader.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

using namespace transmission_interface;
using hardware_interface::EffortJointInterface;
using hardware_interface::JointStateInterface;
using hardware_interface::PositionJointInterface;
using hardware_interface::VelocityJointInterface;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

const char* const kEffort = "hardware_interface/EffortJointInterface";

/// Four motors; the first one has an absolute encoder and a torque sensor.
class Motors : public hardware_interface::RobotHW {
 public:
  Motors() {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string name = "m" + std::to_string(i + 1);
      double* const s = state[i];
      const hardware_interface::ActuatorStateHandle handle =
          i == 0 ? hardware_interface::ActuatorStateHandle(name, s, s + 1, s + 2, s + 3, s + 4)
                 : hardware_interface::ActuatorStateHandle(name, s, s + 1, s + 2);
      states.registerHandle(handle);
      efforts.registerHandle({handle, &effort[i]});
      velocities.registerHandle({handle, &velocity[i]});
      positions.registerHandle({handle, &position[i]});
    }
    registerInterface(&states);
    registerInterface(&efforts);
    registerInterface(&velocities);
    registerInterface(&positions);
  }

  double state[4][5]{};
  double effort[4]{}, velocity[4]{}, position[4]{};

 private:
  hardware_interface::ActuatorStateInterface states;
  hardware_interface::EffortActuatorInterface efforts;
  hardware_interface::VelocityActuatorInterface velocities;
  hardware_interface::PositionActuatorInterface positions;
};

std::string interfaces(const std::vector<std::string>& names) {
  std::string xml;
  for (const std::string& name : names) {
    xml += "<hardwareInterface>" + name + "</hardwareInterface>";
  }
  return xml;
}

std::string joint(const std::string& name, const std::string& content = "",
                  const std::vector<std::string>& names = {kEffort}) {
  return "<joint name='" + name + "'>" + interfaces(names) + content + "</joint>";
}

std::string actuator(const std::string& name, const std::string& content) {
  return "<actuator name='" + name + "'>" + content + "</actuator>";
}

std::string reduction(const std::string& ratio) {
  return "<mechanicalReduction>" + ratio + "</mechanicalReduction>";
}

std::string role(const std::string& name) { return "<role>" + name + "</role>"; }

std::string transmission(const std::string& name, const std::string& type,
                         const std::string& content) {
  return "<transmission name='" + name + "'><type>" + type + "</type>" + content +
         "</transmission>";
}

std::string robot(const std::string& content) { return "<robot name='r'>" + content + "</robot>"; }

/// A gear of ratio 10 and offset 0.5 on motor m1.
std::string simple(const std::vector<std::string>& names = {kEffort},
                   const std::string& ratio = reduction("10"),
                   const std::string& offset = "<offset>0.5</offset>") {
  return transmission("gear", "transmission_interface/SimpleTransmission",
                      joint("j1", offset, names) + actuator("m1", ratio));
}

std::string pair(const std::string& type, const std::string& joints, const std::string& actuators) {
  return transmission("pair", "transmission_interface/" + type, joints + actuators);
}

const std::string kJoints = joint("ja", role("joint1") + reduction("2") + "<offset>1</offset>") +
                            joint("jb", role("joint2") + reduction("4"));
const std::string kActuators = actuator("m2", role("actuator1") + reduction("10")) +
                               actuator("m3", role("actuator2") + reduction("-20"));

class Loading : public testing::Test {
 protected:
  bool load(const std::string& content) { return loader_.load(robot(content)); }

  /// Expects that nothing is loaded, not even in part.
  void expectRefusal(const std::string& content) {
    EXPECT_FALSE(load(content)) << content;
    EXPECT_THAT(transmissions_.getNames(), IsEmpty()) << content;
    EXPECT_EQ(nullptr, motors_.get<JointStateInterface>()) << content;
    EXPECT_THAT(loader_.getData()->transmission_data, IsEmpty());
    EXPECT_THAT(loader_.getData()->raw_joint_data_map, IsEmpty());
  }

  template <class T>
  T* loaded() {
    const auto& all = loader_.getData()->transmission_data;
    return all.empty() ? nullptr : dynamic_cast<T*>(all.back().get());
  }

  Motors motors_;
  RobotTransmissions transmissions_;
  TransmissionInterfaceLoader loader_{&motors_, &transmissions_};
};

}  // namespace

TEST(Loader, RequiresARobotAndItsTransmissions) {
  Motors motors;
  RobotTransmissions transmissions;
  EXPECT_THROW(TransmissionInterfaceLoader(nullptr, &transmissions), std::invalid_argument);
  EXPECT_THROW(TransmissionInterfaceLoader(&motors, nullptr), std::invalid_argument);
}

TEST_F(Loading, ASimpleTransmissionWorksFromMotorToController) {
  ASSERT_TRUE(load(simple()));
  const auto* made = loaded<SimpleTransmission>();
  ASSERT_NE(nullptr, made);
  EXPECT_EQ(10.0, made->getActuatorReduction());
  EXPECT_EQ(0.5, made->getJointOffset());

  auto* efforts = motors_.get<EffortJointInterface>();
  ASSERT_NE(nullptr, efforts);
  hardware_interface::JointHandle handle = efforts->getHandle("j1");
  EXPECT_TRUE(std::isnan(handle.getPosition())) << "nothing has been read yet";
  EXPECT_TRUE(std::isnan(handle.getCommand()));
  EXPECT_EQ(nullptr, motors_.get<PositionJointInterface>());

  for (int i = 0; i < 5; ++i) {
    motors_.state[0][i] = i + 1.0;
  }
  ASSERT_NE(nullptr, transmissions_.get<ActuatorToJointStateInterface>());
  transmissions_.get<ActuatorToJointStateInterface>()->propagate();
  EXPECT_DOUBLE_EQ(0.6, handle.getPosition());
  EXPECT_DOUBLE_EQ(0.2, handle.getVelocity());
  EXPECT_DOUBLE_EQ(30.0, handle.getEffort());
  EXPECT_DOUBLE_EQ(0.9, handle.getAbsolutePosition());
  EXPECT_DOUBLE_EQ(50.0, handle.getTorqueSensor());
  EXPECT_DOUBLE_EQ(0.6, motors_.get<JointStateInterface>()->getHandle("j1").getPosition());

  handle.setCommand(20.0);
  ASSERT_NE(nullptr, transmissions_.get<JointToActuatorEffortInterface>());
  transmissions_.get<JointToActuatorEffortInterface>()->propagate();
  EXPECT_DOUBLE_EQ(2.0, motors_.effort[0]);
  EXPECT_EQ(nullptr, transmissions_.get<JointToActuatorPositionInterface>());
  EXPECT_EQ(nullptr, transmissions_.get<ActuatorToJointEffortInterface>());
}

TEST_F(Loading, RegistersResourcesWithTheRobot) {
  ASSERT_TRUE(load(simple() + pair("DifferentialTransmission", kJoints, kActuators)));
  EXPECT_THAT(motors_.getInterfaceResources("hardware_interface::EffortJointInterface"),
              ElementsAre("j1", "ja", "jb"));
  EXPECT_THAT(motors_.getInterfaceResources("hardware_interface::JointStateInterface"),
              ElementsAre("j1", "ja", "jb"));
}

TEST_F(Loading, EveryKindOfCommandReachesItsMotor) {
  ASSERT_TRUE(load(simple({"hardware_interface/PositionJointInterface",
                           "hardware_interface/VelocityJointInterface", kEffort,
                           "hardware_interface/JointStateInterface"})));
  motors_.get<PositionJointInterface>()->getHandle("j1").setCommand(1.5);
  motors_.get<VelocityJointInterface>()->getHandle("j1").setCommand(2.0);
  motors_.get<EffortJointInterface>()->getHandle("j1").setCommand(30.0);
  transmissions_.get<JointToActuatorPositionInterface>()->propagate();
  transmissions_.get<JointToActuatorVelocityInterface>()->propagate();
  transmissions_.get<JointToActuatorEffortInterface>()->propagate();
  EXPECT_DOUBLE_EQ(10.0, motors_.position[0]);
  EXPECT_DOUBLE_EQ(20.0, motors_.velocity[0]);
  EXPECT_DOUBLE_EQ(3.0, motors_.effort[0]);
  EXPECT_THAT(transmissions_.get<ActuatorToJointStateInterface>()->getNames(), ElementsAre("gear"));
}

TEST_F(Loading, StatesAloneNeedNoCommands) {
  ASSERT_TRUE(load(simple({"hardware_interface/JointStateInterface"})));
  EXPECT_NE(nullptr, motors_.get<JointStateInterface>());
  EXPECT_EQ(nullptr, motors_.get<EffortJointInterface>());
}

TEST_F(Loading, BidirectionalInterfacesMapBackToo) {
  ASSERT_TRUE(load(simple({"hardware_interface/BiDirectionalPositionJointInterface",
                           "hardware_interface/BiDirectionalVelocityJointInterface",
                           "hardware_interface/BiDirectionalEffortJointInterface"})));
  RawJointData& raw = loader_.getData()->raw_joint_data_map.at("j1");
  raw.position = 1.5;
  raw.velocity = 2.0;
  raw.effort = 30.0;
  transmissions_.get<JointToActuatorStateInterface>()->propagate();
  EXPECT_DOUBLE_EQ(10.0, motors_.state[0][0]);
  EXPECT_DOUBLE_EQ(20.0, motors_.state[0][1]);
  EXPECT_DOUBLE_EQ(3.0, motors_.state[0][2]);
  motors_.position[0] = 10.0;
  motors_.velocity[0] = 20.0;
  motors_.effort[0] = 3.0;
  transmissions_.get<ActuatorToJointPositionInterface>()->propagate();
  transmissions_.get<ActuatorToJointVelocityInterface>()->propagate();
  transmissions_.get<ActuatorToJointEffortInterface>()->propagate();
  EXPECT_DOUBLE_EQ(1.5, motors_.get<PositionJointInterface>()->getHandle("j1").getCommand());
  EXPECT_DOUBLE_EQ(2.0, motors_.get<VelocityJointInterface>()->getHandle("j1").getCommand());
  EXPECT_DOUBLE_EQ(30.0, motors_.get<EffortJointInterface>()->getHandle("j1").getCommand());
}

TEST_F(Loading, DifferentialUsesItsRoles) {
  ASSERT_TRUE(load(pair("DifferentialTransmission", kJoints, kActuators)));
  const auto* made = loaded<DifferentialTransmission>();
  ASSERT_NE(nullptr, made);
  EXPECT_THAT(made->getActuatorReduction(), ElementsAre(10.0, -20.0));
  EXPECT_THAT(made->getJointReduction(), ElementsAre(2.0, 4.0));
  EXPECT_THAT(made->getJointOffset(), ElementsAre(1.0, 0.0));
}

// The order of the description must not matter: values follow the roles.
TEST_F(Loading, OrderOfTheDescriptionHasNoEffect) {
  const std::string turned_joints =
      joint("jb", role("joint2") + reduction("4")) +
      joint("ja", role("joint1") + reduction("2") + "<offset>1</offset>");
  const std::string turned_actuators = actuator("m3", role("actuator2") + reduction("-20")) +
                                       actuator("m2", role("actuator1") + reduction("10"));
  Motors same_motors;
  RobotTransmissions same_transmissions;
  TransmissionInterfaceLoader same_loader(&same_motors, &same_transmissions);
  ASSERT_TRUE(load(pair("FourBarLinkageTransmission", kJoints, kActuators)));
  ASSERT_TRUE(
      same_loader.load(robot(pair("FourBarLinkageTransmission", turned_joints, turned_actuators))));
  EXPECT_NE(nullptr, loaded<FourBarLinkageTransmission>());
  for (Motors* motors : {&motors_, &same_motors}) {
    motors->state[1][0] = 5.0;
    motors->state[2][0] = 7.0;
  }
  transmissions_.get<ActuatorToJointStateInterface>()->propagate();
  same_transmissions.get<ActuatorToJointStateInterface>()->propagate();
  auto* states = motors_.get<JointStateInterface>();
  auto* same_states = same_motors.get<JointStateInterface>();
  EXPECT_DOUBLE_EQ(1.0 + 5.0 / 20.0, states->getHandle("ja").getPosition());
  for (const char* name : {"ja", "jb"}) {
    EXPECT_DOUBLE_EQ(states->getHandle(name).getPosition(),
                     same_states->getHandle(name).getPosition())
        << name;
  }
}

TEST_F(Loading, JointReductionDefaultsToOne) {
  ASSERT_TRUE(load(pair("FourBarLinkageTransmission",
                        joint("ja", role("joint1")) + joint("jb", role("joint2")), kActuators)));
  EXPECT_THAT(loaded<FourBarLinkageTransmission>()->getJointReduction(), ElementsAre(1.0, 1.0));
  EXPECT_THAT(loaded<FourBarLinkageTransmission>()->getJointOffset(), ElementsAre(0.0, 0.0));
}

TEST_F(Loading, JointHasASensorOnlyIfAllMotorsDo) {
  ASSERT_TRUE(load(pair("DifferentialTransmission", kJoints,
                        actuator("m1", role("actuator1") + reduction("1")) +
                            actuator("m2", role("actuator2") + reduction("1")))));
  EXPECT_FALSE(motors_.get<JointStateInterface>()->getHandle("ja").hasAbsolutePosition());
  EXPECT_FALSE(motors_.get<JointStateInterface>()->getHandle("ja").hasTorqueSensor());
}

TEST_F(Loading, IgnoredAbsoluteEncodersNeedBothJoints) {
  const std::string ignore = "<ignoreTransmissionAbsoluteEncoder/>";
  const auto absolute = [&](const std::string& first, const std::string& second) {
    Motors motors;
    RobotTransmissions transmissions;
    TransmissionInterfaceLoader loader(&motors, &transmissions);
    EXPECT_TRUE(loader.load(robot(pair(
        "DifferentialTransmission",
        joint("ja", role("joint1") + first) + joint("jb", role("joint2") + second), kActuators))));
    double actuators[2] = {5.0, 7.0}, joints[2] = {0.0, 0.0};
    ActuatorData a;
    JointData j;
    a.absolute_position = {&actuators[0], &actuators[1]};
    j.absolute_position = {&joints[0], &joints[1]};
    loader.getData()->transmission_data.back()->actuatorToJointAbsolutePosition(a, j);
    return joints[0];
  };
  EXPECT_EQ(7.0, absolute(ignore, ignore));
  EXPECT_DOUBLE_EQ((5.0 / 10.0 - 7.0 / 20.0) / 2.0, absolute(ignore, ""));
  EXPECT_DOUBLE_EQ((5.0 / 10.0 - 7.0 / 20.0) / 2.0, absolute("", ""));
}

TEST_F(Loading, AddsToInterfacesTheRobotHas) {
  double value = 0.0;
  JointStateInterface own;
  own.registerHandle(hardware_interface::JointStateHandle("own", &value, &value, &value));
  motors_.registerInterface(&own);
  ASSERT_TRUE(load(simple()));
  EXPECT_EQ(&own, motors_.get<JointStateInterface>());
  EXPECT_THAT(own.getNames(), ElementsAre("j1", "own"));
}

TEST_F(Loading, UnknownInterfacesAreIgnored) {
  ASSERT_TRUE(load(simple({"franka_hw/FrankaStateInterface", kEffort})));
  EXPECT_NE(nullptr, motors_.get<EffortJointInterface>());
}

TEST_F(Loading, JointsMayListTheirInterfacesInAnyOrder) {
  const std::string position = "hardware_interface/PositionJointInterface";
  ASSERT_TRUE(load(pair("DifferentialTransmission",
                        joint("ja", role("joint1"), {kEffort, position}) +
                            joint("jb", role("joint2"), {position, kEffort}),
                        kActuators)));
  EXPECT_THAT(motors_.get<PositionJointInterface>()->getNames(), ElementsAre("ja", "jb"));
}

TEST_F(Loading, RefusesInvalidReductions) {
  expectRefusal(simple({kEffort}, ""));
  expectRefusal(simple({kEffort}, "<mechanicalReduction/>"));
  expectRefusal(simple({kEffort}, reduction("ten")));
  expectRefusal(simple({kEffort}, reduction("10 mm")));
  expectRefusal(simple({kEffort}, reduction("nan")));
  expectRefusal(simple({kEffort}, reduction("1e999")));
  expectRefusal(simple({kEffort}, reduction("0")));
  expectRefusal(simple({kEffort}, reduction("10"), "<offset>far</offset>"));
  expectRefusal(simple({kEffort}, reduction("10"), "<offset/>"));
}

TEST_F(Loading, RefusesWrongNumbersOfParts) {
  const std::string two = joint("ja") + joint("jb");
  const std::string one_motor = actuator("m1", reduction("1"));
  expectRefusal(transmission("t", "transmission_interface/SimpleTransmission", two + one_motor));
  expectRefusal(transmission("t", "transmission_interface/SimpleTransmission",
                             joint("ja") + one_motor + actuator("m2", reduction("1"))));
  expectRefusal(pair("DifferentialTransmission", kJoints, one_motor));
  expectRefusal(pair("FourBarLinkageTransmission", joint("ja", role("joint1")), kActuators));
  TransmissionInfo empty;
  empty.name_ = "empty";
  empty.type_ = "transmission_interface/SimpleTransmission";
  EXPECT_FALSE(loader_.load(empty));
}

TEST_F(Loading, RefusesBadRoles) {
  for (const char* type : {"DifferentialTransmission", "FourBarLinkageTransmission"}) {
    const std::string second = joint("jb", role("joint2"));
    expectRefusal(pair(type, joint("ja") + second, kActuators));
    expectRefusal(pair(type, joint("ja", "<role/>") + second, kActuators));
    expectRefusal(pair(type, joint("ja", role("joint3")) + second, kActuators));
    expectRefusal(pair(type, joint("ja", role("joint2")) + second, kActuators));
    expectRefusal(pair(type, joint("ja", role("joint1") + reduction("0")) + second, kActuators));
    expectRefusal(pair(type, joint("ja", role("joint1") + reduction("x")) + second, kActuators));
    const std::string motor = actuator("m3", role("actuator2") + reduction("1"));
    expectRefusal(pair(type, kJoints, actuator("m2", reduction("1")) + motor));
    expectRefusal(pair(type, kJoints, actuator("m2", role("motor") + reduction("1")) + motor));
    expectRefusal(pair(type, kJoints, actuator("m2", role("actuator2") + reduction("1")) + motor));
    expectRefusal(pair(type, kJoints, actuator("m2", role("actuator1")) + motor));
  }
}

TEST_F(Loading, RefusesUnknownActuatorsAndTypes) {
  expectRefusal(transmission("t", "transmission_interface/SimpleTransmission",
                             joint("j") + actuator("m9", reduction("1"))));
  expectRefusal(transmission("t", "transmission_interface/Rope",
                             joint("j") + actuator("m1", reduction("1"))));
  expectRefusal(simple({"franka_hw/FrankaStateInterface"}));
  expectRefusal(pair("DifferentialTransmission",
                     joint("ja", role("joint1")) +
                         joint("jb", role("joint2"), {"hardware_interface/PositionJointInterface"}),
                     kActuators));

  hardware_interface::RobotHW bare;
  RobotTransmissions transmissions;
  TransmissionInterfaceLoader loader(&bare, &transmissions);
  EXPECT_FALSE(loader.load(robot(simple())));
  EXPECT_THAT(bare.getNames(), IsEmpty());
}

TEST_F(Loading, OneInvalidTransmissionRefusesAll) {
  expectRefusal(simple() + pair("DifferentialTransmission", kJoints, actuator("m1", "")));
  expectRefusal(simple() + pair("DifferentialTransmission", kJoints,
                                actuator("m1", role("actuator1") + reduction("1")) +
                                    actuator("m9", role("actuator2") + reduction("1"))));
}

TEST_F(Loading, SecondTransmissionOfANameReplacesTheFirst) {
  ASSERT_TRUE(load(simple() + simple({kEffort}, reduction("20"))));
  EXPECT_EQ(2u, loader_.getData()->transmission_data.size());
  auto* efforts = transmissions_.get<JointToActuatorEffortInterface>();
  ASSERT_NE(nullptr, efforts);
  EXPECT_THAT(efforts->getNames(), ElementsAre("gear"));
  const auto effort = [&] {
    motors_.get<EffortJointInterface>()->getHandle("j1").setCommand(80.0);
    efforts->propagate();
    return motors_.get<hardware_interface::EffortActuatorInterface>()->getHandle("m1").getCommand();
  };
  EXPECT_EQ(4.0, effort());
  ASSERT_TRUE(load(simple({kEffort}, reduction("40"))));
  EXPECT_EQ(2.0, effort());
}

TEST_F(Loading, RefusesDescriptionsWithoutTransmissions) {
  EXPECT_FALSE(loader_.load(std::string("no xml")));
  expectRefusal("");
}
