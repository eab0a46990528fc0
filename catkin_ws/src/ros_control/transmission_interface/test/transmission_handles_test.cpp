// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <rt_guard/rt_guard.h>
#include <transmission_interface/differential_transmission.h>
#include <transmission_interface/four_bar_linkage_transmission.h>
#include <transmission_interface/robot_transmissions.h>
#include <transmission_interface/simple_transmission.h>
#include <transmission_interface/transmission_interface.h>

#include <string>

using namespace transmission_interface;
using testing::HasSubstr;

namespace {

template <class Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const TransmissionInterfaceException& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

/// One actuator and one joint with all kinds of values.
struct Side {
  double position{1.0}, velocity{2.0}, effort{3.0}, absolute{4.0}, torque{5.0};

  template <class Data>
  Data data() {
    Data data;
    data.position = {&position};
    data.velocity = {&velocity};
    data.effort = {&effort};
    data.absolute_position = {&absolute};
    data.torque_sensor = {&torque};
    return data;
  }
};

class Handles : public testing::Test {
 protected:
  ActuatorData actuators() { return actuator_.data<ActuatorData>(); }
  JointData joints() { return joint_.data<JointData>(); }

  SimpleTransmission gear_{10.0, 0.5};
  Side actuator_;
  Side joint_;
};

}  // namespace

TEST_F(Handles, SensorsMissingOnOneSideAreIgnored) {
  ActuatorData without = actuators();
  without.absolute_position.clear();
  without.torque_sensor.clear();
  ActuatorToJointStateHandle("gear", &gear_, without, joints()).propagate();
  EXPECT_DOUBLE_EQ(0.6, joint_.position);
  EXPECT_EQ(4.0, joint_.absolute);
  EXPECT_EQ(5.0, joint_.torque);
}

TEST_F(Handles, SensorsThatTheTransmissionCannotMapAreIgnored) {
  Side a2, j2;
  FourBarLinkageTransmission four_bar({1.0, 1.0}, {1.0, 1.0});
  ActuatorData a;
  JointData j;
  a.position = {&actuator_.position, &a2.position};
  a.velocity = {&actuator_.velocity, &a2.velocity};
  a.effort = {&actuator_.effort, &a2.effort};
  a.absolute_position = {&actuator_.absolute, &a2.absolute};
  j.position = {&joint_.position, &j2.position};
  j.velocity = {&joint_.velocity, &j2.velocity};
  j.effort = {&joint_.effort, &j2.effort};
  j.absolute_position = {&joint_.absolute, &j2.absolute};
  ActuatorToJointStateHandle("bars", &four_bar, a, j).propagate();
  EXPECT_EQ(0.0, j2.position);
  EXPECT_EQ(4.0, j2.absolute);
}

TEST_F(Handles, EachCommandIsMappedAlone) {
  ActuatorToJointPositionHandle("gear", &gear_, actuators(), joints()).propagate();
  EXPECT_DOUBLE_EQ(0.6, joint_.position);
  EXPECT_EQ(2.0, joint_.velocity);
  ActuatorToJointVelocityHandle("gear", &gear_, actuators(), joints()).propagate();
  EXPECT_DOUBLE_EQ(0.2, joint_.velocity);
  EXPECT_EQ(3.0, joint_.effort);
  ActuatorToJointEffortHandle("gear", &gear_, actuators(), joints()).propagate();
  EXPECT_DOUBLE_EQ(30.0, joint_.effort);

  Side other;
  const JointData commands = other.data<JointData>();
  JointToActuatorPositionHandle("gear", &gear_, actuators(), commands).propagate();
  EXPECT_DOUBLE_EQ(5.0, actuator_.position);
  EXPECT_EQ(2.0, actuator_.velocity);
  JointToActuatorVelocityHandle("gear", &gear_, actuators(), commands).propagate();
  EXPECT_DOUBLE_EQ(20.0, actuator_.velocity);
  EXPECT_EQ(3.0, actuator_.effort);
  JointToActuatorEffortHandle("gear", &gear_, actuators(), commands).propagate();
  EXPECT_DOUBLE_EQ(0.3, actuator_.effort);
}

TEST_F(Handles, InvalidDataAreRefusedByName) {
  typedef ActuatorToJointPositionHandle Handle;
  const ActuatorData a = actuators();
  const JointData j = joints();
  EXPECT_EQ("Cannot create transmission handle 'h': there is no transmission.",
            refusal([&] { Handle("h", nullptr, a, j); }));
  EXPECT_THAT(refusal([&] { Handle("h", &gear_, ActuatorData(), JointData()); }),
              HasSubstr("all data vectors are empty"));
  EXPECT_THAT(refusal([&] { Handle("h", &gear_, a, JointData()); }),
              HasSubstr("it maps positions, but"));
  double value = 0.0;
  for (auto member : {&ActuatorData::position, &ActuatorData::velocity, &ActuatorData::effort,
                      &ActuatorData::absolute_position, &ActuatorData::torque_sensor}) {
    ActuatorData bad = a;
    bad.*member = {&value, &value};
    EXPECT_THAT(refusal([&] { Handle("h", &gear_, bad, j); }),
                testing::ContainsRegex("size of the actuator .* is 2, that of the transmission 1"));
    bad.*member = {nullptr};
    EXPECT_THAT(refusal([&] { Handle("h", &gear_, bad, j); }), HasSubstr("null pointer"));
  }
  for (auto member : {&JointData::position, &JointData::velocity, &JointData::effort,
                      &JointData::absolute_position, &JointData::torque_sensor}) {
    JointData bad = j;
    bad.*member = {&value, &value};
    EXPECT_THAT(refusal([&] { Handle("h", &gear_, a, bad); }),
                testing::ContainsRegex("size of the joint .* is 2, that of the transmission 1"));
    bad.*member = {nullptr};
    EXPECT_THAT(refusal([&] { Handle("h", &gear_, a, bad); }), HasSubstr("null pointer"));
  }
  ActuatorData only_position;
  only_position.position = a.position;
  EXPECT_THAT(refusal([&] { ActuatorToJointStateHandle("h", &gear_, only_position, j); }),
              HasSubstr("it maps velocities, but"));
}

TEST_F(Handles, AnInterfacePropagatesAllItsHandles) {
  Side actuator2, joint2;
  RobotTransmissions transmissions;
  ActuatorToJointStateInterface states;
  states.registerHandle({"one", &gear_, actuators(), joints()});
  states.registerHandle({"two", &gear_, actuator2.data<ActuatorData>(), joint2.data<JointData>()});
  transmissions.registerInterface(&states);
  ASSERT_EQ(&states, transmissions.get<ActuatorToJointStateInterface>());
  EXPECT_EQ(nullptr, transmissions.get<JointToActuatorEffortInterface>());
  states.propagate();
  EXPECT_DOUBLE_EQ(0.6, joint_.position);
  EXPECT_DOUBLE_EQ(0.6, joint2.position);
  EXPECT_EQ("two", states.getHandle("two").getName());
  EXPECT_EQ(
      "Could not find resource 'three' in "
      "'transmission_interface::ActuatorToJointStateInterface'.",
      refusal([&] { states.getHandle("three"); }));
}

TEST_F(Handles, PropagationNeitherAllocatesNorLocks) {
  Side actuator2, joint2;
  DifferentialTransmission differential({1.0, 2.0}, {3.0, 4.0});
  ActuatorData a;
  JointData j;
  a.position = a.velocity = a.effort =
      a.absolute_position = {&actuator_.position, &actuator2.position};
  j.position = j.velocity = j.effort = j.absolute_position = {&joint_.position, &joint2.position};
  ActuatorToJointStateInterface to_joints;
  JointToActuatorStateInterface to_actuators;
  to_joints.registerHandle({"differential", &differential, a, j});
  to_joints.registerHandle({"simple", &gear_, actuators(), joints()});
  to_actuators.registerHandle({"differential", &differential, a, j});
  rt_guard::Scope scope;
  for (int i = 0; i < 100; ++i) {
    to_joints.propagate();
    to_actuators.propagate();
  }
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}
