// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <transmission_interface/differential_transmission.h>
#include <transmission_interface/four_bar_linkage_transmission.h>
#include <transmission_interface/simple_transmission.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

using namespace transmission_interface;
typedef std::vector<double> Values;

namespace {

constexpr double kTight = 1e-10;

std::vector<double*> pointersTo(Values& values) {
  std::vector<double*> pointers;
  for (double& value : values) {
    pointers.push_back(&value);
  }
  return pointers;
}

/// One map of a transmission, as a function of numbers.
typedef std::function<Values(const Values&)> Map;

struct Case {
  std::string name;
  std::shared_ptr<Transmission> transmission;
  bool conserves_power;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double n : {10.0, -10.0, 0.5}) {
    all.push_back(
        {"simple " + std::to_string(n), std::make_shared<SimpleTransmission>(n, 1.5), true});
  }
  for (const double sign : {1.0, -1.0}) {
    const Values ar{sign * 10.0, 20.0}, jr{2.0, sign * 4.0}, offset{-2.0, 4.0};
    all.push_back(
        {"differential", std::make_shared<DifferentialTransmission>(ar, jr, offset), true});
    all.push_back(
        {"four-bar", std::make_shared<FourBarLinkageTransmission>(ar, jr, offset), false});
  }
  return all;
}

class Transmissions : public testing::Test {
 protected:
  /// The map that reads one member of the actuators' data and writes that of the joints'.
  template <class Function>
  static Map toJoint(Transmission& t, std::vector<double*> ActuatorData::* from,
                     std::vector<double*> JointData::* to, Function function) {
    return [&t, from, to, function](const Values& input) {
      Values in = input, out(t.numJoints(), 99.0);
      ActuatorData actuators;
      JointData joints;
      actuators.*from = pointersTo(in);
      joints.*to = pointersTo(out);
      (t.*function)(actuators, joints);
      return out;
    };
  }
  template <class Function>
  static Map toActuator(Transmission& t, std::vector<double*> JointData::* from,
                        std::vector<double*> ActuatorData::* to, Function function) {
    return [&t, from, to, function](const Values& input) {
      Values in = input, out(t.numActuators(), 99.0);
      ActuatorData actuators;
      JointData joints;
      joints.*from = pointersTo(in);
      actuators.*to = pointersTo(out);
      (t.*function)(joints, actuators);
      return out;
    };
  }

  static Map jointPosition(Transmission& t) {
    return toJoint(t, &ActuatorData::position, &JointData::position,
                   &Transmission::actuatorToJointPosition);
  }
  static Map jointVelocity(Transmission& t) {
    return toJoint(t, &ActuatorData::velocity, &JointData::velocity,
                   &Transmission::actuatorToJointVelocity);
  }
  static Map jointEffort(Transmission& t) {
    return toJoint(t, &ActuatorData::effort, &JointData::effort,
                   &Transmission::actuatorToJointEffort);
  }
  static Map jointAbsolute(Transmission& t) {
    return toJoint(t, &ActuatorData::absolute_position, &JointData::absolute_position,
                   &Transmission::actuatorToJointAbsolutePosition);
  }
  static Map jointTorque(Transmission& t) {
    return toJoint(t, &ActuatorData::torque_sensor, &JointData::torque_sensor,
                   &Transmission::actuatorToJointTorqueSensor);
  }
  static Map actuatorPosition(Transmission& t) {
    return toActuator(t, &JointData::position, &ActuatorData::position,
                      &Transmission::jointToActuatorPosition);
  }
  static Map actuatorVelocity(Transmission& t) {
    return toActuator(t, &JointData::velocity, &ActuatorData::velocity,
                      &Transmission::jointToActuatorVelocity);
  }
  static Map actuatorEffort(Transmission& t) {
    return toActuator(t, &JointData::effort, &ActuatorData::effort,
                      &Transmission::jointToActuatorEffort);
  }

  Values random(std::size_t size) {
    Values values(size);
    for (double& value : values) {
      value = std::uniform_real_distribution<double>(-5.0, 5.0)(random_);
    }
    return values;
  }

  static void expectNear(const Values& expected, const Values& actual, double tolerance = kTight) {
    ASSERT_EQ(expected.size(), actual.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(expected[i], actual[i], tolerance) << i;
    }
  }

  std::mt19937 random_{1};
};

double power(const Values& efforts, const Values& velocities) {
  double sum = 0.0;
  for (std::size_t i = 0; i < efforts.size(); ++i) {
    sum += efforts[i] * velocities[i];
  }
  return sum;
}

}  // namespace

TEST_F(Transmissions, RoundTripChangesNothing) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Transmission& t = *c.transmission;
    for (int i = 0; i < 100; ++i) {
      const Values values = random(t.numActuators());
      expectNear(values, actuatorPosition(t)(jointPosition(t)(values)));
      expectNear(values, jointPosition(t)(actuatorPosition(t)(values)));
      expectNear(values, actuatorVelocity(t)(jointVelocity(t)(values)));
      expectNear(values, jointVelocity(t)(actuatorVelocity(t)(values)));
      expectNear(values, actuatorEffort(t)(jointEffort(t)(values)));
      expectNear(values, jointEffort(t)(actuatorEffort(t)(values)));
    }
  }
}

TEST_F(Transmissions, VelocitiesAreTheDerivativesOfPositions) {
  constexpr double kStep = 1e-3;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Transmission& t = *c.transmission;
    for (const auto& maps : {std::pair<Map, Map>(jointPosition(t), jointVelocity(t)),
                             std::pair<Map, Map>(actuatorPosition(t), actuatorVelocity(t))}) {
      const Values at = random(t.numJoints());
      const Values velocity = random(t.numJoints());
      Values ahead = at, behind = at;
      for (std::size_t i = 0; i < at.size(); ++i) {
        ahead[i] += kStep * velocity[i];
        behind[i] -= kStep * velocity[i];
      }
      const Values after = maps.first(ahead), before = maps.first(behind);
      Values differences(at.size());
      for (std::size_t i = 0; i < at.size(); ++i) {
        differences[i] = (after[i] - before[i]) / (2.0 * kStep);
      }
      expectNear(differences, maps.second(velocity), 1e-8);
    }
  }
}

TEST_F(Transmissions, PowerIsTheSameOnBothSides) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Transmission& t = *c.transmission;
    if (!c.conserves_power) {
      continue;
    }
    for (int i = 0; i < 100; ++i) {
      const Values efforts = random(t.numActuators()), velocities = random(t.numActuators());
      EXPECT_NEAR(power(efforts, velocities),
                  power(jointEffort(t)(efforts), jointVelocity(t)(velocities)), kTight);
    }
  }
}

// The only place where the original's formula is not the transpose of its velocities: this test
// prevents an accidental correction.
TEST_F(Transmissions, FourBarEffortsMatchTheOriginal) {
  FourBarLinkageTransmission t({10.0, -10.0}, {2.0, 4.0});
  expectNear({60.0, 4.0 * (-50.0 - 60.0)}, jointEffort(t)({3.0, 5.0}));
  expectNear({3.0, 5.0}, actuatorEffort(t)({60.0, -440.0}));
}

TEST_F(Transmissions, SimpleAtHandPickedPoints) {
  SimpleTransmission t = {10.0, 1.0};
  expectNear({30.0}, jointEffort(t)({3.0}));
  expectNear({0.3}, jointVelocity(t)({3.0}));
  expectNear({1.3}, jointPosition(t)({3.0}));
  expectNear({1.3}, jointAbsolute(t)({3.0}));
  expectNear({30.0}, jointTorque(t)({3.0}));
  expectNear({20.0}, actuatorPosition(t)({3.0}));
  EXPECT_EQ(0.0, SimpleTransmission(2.0).getJointOffset());
}

TEST_F(Transmissions, DifferentialAtHandPickedPoints) {
  DifferentialTransmission t({10.0, 10.0}, {2.0, 2.0}, {1.0, 3.0});
  expectNear({0.25, 0.0}, jointVelocity(t)({5.0, 5.0}));   // equal: the first joint
  expectNear({0.0, 0.25}, jointVelocity(t)({5.0, -5.0}));  // opposite: the second
  expectNear({1.25, 3.0}, jointPosition(t)({5.0, 5.0}));
  expectNear({1.25, 3.0}, jointAbsolute(t)({5.0, 5.0}));
  expectNear({200.0, 0.0}, jointEffort(t)({5.0, 5.0}));
  expectNear({0.0, 200.0}, jointTorque(t)({5.0, -5.0}));

  DifferentialTransmission behind({10.0, 10.0}, {2.0, 2.0}, true, {1.0, 3.0});
  expectNear({7.0, 5.0}, jointAbsolute(behind)({5.0, 7.0}));
  expectNear({1.25, 3.0}, jointPosition(behind)({5.0, 5.0}));
}

TEST_F(Transmissions, FourBarAtHandPickedPoints) {
  FourBarLinkageTransmission t({10.0, 10.0}, {2.0, 2.0}, {1.0, 3.0});
  expectNear({0.25, -0.125}, jointVelocity(t)({5.0, 0.0}));  // the second joint stays level
  expectNear({0.0, 0.25}, jointVelocity(t)({0.0, 5.0}));
  expectNear({1.25, 2.875}, jointPosition(t)({5.0, 0.0}));
}

TEST_F(Transmissions, FourBarThrowsForSensors) {
  FourBarLinkageTransmission t({1.0, 1.0}, {1.0, 1.0});
  EXPECT_FALSE(t.hasActuatorToJointAbsolutePosition());
  EXPECT_FALSE(t.hasActuatorToJointTorqueSensor());
  EXPECT_THROW(jointAbsolute(t)({1.0, 2.0}), std::runtime_error);
  EXPECT_THROW(jointTorque(t)({1.0, 2.0}), std::runtime_error);
  EXPECT_TRUE(SimpleTransmission(1.0).hasActuatorToJointAbsolutePosition());
  EXPECT_TRUE(DifferentialTransmission({1.0, 1.0}, {1.0, 1.0}).hasActuatorToJointTorqueSensor());
}

template <class Pair>
void expectInvalidOnesAreRefused() {
  using Error = TransmissionInterfaceException;
  const Values two{1.0, 1.0};
  for (const Values& wrong : {Values(), Values{1.0}, Values{1.0, 1.0, 1.0}}) {
    EXPECT_THROW(Pair(two, two, wrong), Error);
    EXPECT_THROW(Pair(wrong, two), Error);
    EXPECT_THROW(Pair(two, wrong), Error);
  }
  for (const Values& zero : {Values{0.0, 1.0}, Values{1.0, 0.0}}) {
    EXPECT_THROW(Pair(zero, two), Error);
    EXPECT_THROW(Pair(two, zero), Error);
  }
}

TEST_F(Transmissions, InvalidOnesAreRefused) {
  EXPECT_THROW(SimpleTransmission(0.0), TransmissionInterfaceException);
  expectInvalidOnesAreRefused<DifferentialTransmission>();
  expectInvalidOnesAreRefused<FourBarLinkageTransmission>();
}

TEST(TransmissionsDeathTest, DataMustHaveTheRightSize) {
  double value = 0.0;
  ActuatorData no_actuator, actuator, null_actuator;
  JointData no_joint, joint, null_joint;
  for (auto member : {&ActuatorData::position, &ActuatorData::velocity, &ActuatorData::effort,
                      &ActuatorData::absolute_position, &ActuatorData::torque_sensor}) {
    actuator.*member = {&value, &value};
    null_actuator.*member = {&value, nullptr};
  }
  for (auto member : {&JointData::position, &JointData::velocity, &JointData::effort,
                      &JointData::absolute_position, &JointData::torque_sensor}) {
    joint.*member = {&value, &value};
    null_joint.*member = {nullptr, &value};
  }
  DifferentialTransmission t({1.0, 1.0}, {1.0, 1.0});
  SimpleTransmission simple(1.0);
  EXPECT_DEATH(t.actuatorToJointEffort(no_actuator, joint), "size");
  EXPECT_DEATH(t.actuatorToJointVelocity(actuator, no_joint), "size");
  EXPECT_DEATH(t.actuatorToJointPosition(null_actuator, joint), "nullptr");
  EXPECT_DEATH(t.actuatorToJointAbsolutePosition(actuator, null_joint), "nullptr");
  EXPECT_DEATH(t.jointToActuatorPosition(no_joint, actuator), "size");
  EXPECT_DEATH(t.jointToActuatorEffort(joint, null_actuator), "nullptr");
  EXPECT_DEATH(simple.actuatorToJointEffort(actuator, joint), "size");
  EXPECT_DEATH(simple.jointToActuatorVelocity(no_joint, actuator), "size");
}
