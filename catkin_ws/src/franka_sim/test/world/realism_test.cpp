// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The profiles of realism against the figures of recordings and publications (docs/fidelity.md).
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>
#include <franka_sim/robot/control_unit.h>
#include <source_file.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../physics/test_support.h"
#include "../robot/sine_driver.h"
#include "temporary_folder.h"

namespace franka_sim::test {
namespace {

using franka_core::RobotState;
using Array7 = std::array<double, 7>;

RobotPhysics physicsOf(const std::string& robot, const std::string& realism) {
  return readRobotPhysics(franka_test::sourceFile("franka_description/config/physics.yaml"), robot,
                          readRealism(realism, "ideal"));
}

class RealismTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::string id() const { return GetParam(); }
  bool isPanda() const { return id() == "panda"; }

  void start(const std::string& realism) {
    physics_ = physicsOf(id(), realism);
    RobotDescription description = robot(id());
    setInitialPositions(kReadyPose, id(), description);
    applyPhysics(physics_, id(), description);
    world_ = std::make_unique<World>();
    world_->addRobot(description);
    arm_ = &world_->arm(id(), id());
    parameters_.emplace(ControlUnitParameters{franka_core::ArmModel::fromUrdf(urdfOf(id()), id())});
    parameters_->end_effector = handPayload(id());
    parameters_->F_T_NE = kHandF_T_NE;
    applyPhysics(physics_, *parameters_);
    unit_ = std::make_unique<ControlUnit>(*parameters_);
  }

  const RobotState& tick(const franka_core::RobotCommand* command = nullptr) {
    const RobotState& state = unit_->observe(arm_->measure());
    arm_->applyTorques(unit_->actuate(command));
    arm_->setBrakes(unit_->status().brakes_closed);
    world_->step();
    return state;
  }

  const RobotState& run(int ticks, const franka_core::RobotCommand* command = nullptr) {
    for (int i = 0; i < ticks; i++) {
      tick(command);
    }
    return unit_->state();
  }

  void startTorqueControl() {
    tick();
    ASSERT_EQ(Status::kMotionStarted, unit_->request(torqueControl()));
  }

  std::string joint(int number) const { return id() + "_joint" + std::to_string(number); }

  RobotPhysics physics_;
  std::optional<ControlUnitParameters> parameters_;
  std::unique_ptr<World> world_;
  ArmPlant* arm_{nullptr};
  std::unique_ptr<ControlUnit> unit_;
};

// --- motors and friction -------------------------------------------------------------------------

/// The published law, at both sides of the sensor [Nm].
double frictionOf(const JointFriction& law, double dq) {
  return law.amplitude / (1.0 + std::exp(-law.slope * (dq + law.offset))) -
         law.amplitude / (1.0 + std::exp(-law.slope * law.offset)) +
         (law.viscous + law.damping) * dq + std::copysign(law.coulomb, dq);
}

/// Time until a joint alone, slowed down by its friction, falls below a speed [s]: the integral of
/// inertia / friction over the speed, by Simpson's rule.
double coastingTime(const JointFriction& law, double inertia, double from, double to) {
  constexpr int kSteps = 2000;
  const double h = (from - to) / kSteps;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; i++) {
    const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight * inertia / frictionOf(law, to + h * i);
  }
  return sum * h / 3.0;
}

TEST_P(RealismTest, JointSevenCoastsToRestAccordingToItsPublishedFriction) {
  start("real");
  startTorqueControl();
  const franka_core::RobotCommand zero;
  run(5, &zero);
  setJointVelocity(*world_, joint(7), 0.52);
  const double below = 0.01;
  const double tenth = 0.052;
  double time = 0.0;
  double time_to_tenth = 0.0;
  for (; time < 1.0 && tick(&zero).dq[6] > below; time += 1e-3) {
    time_to_tenth = unit_->state().dq[6] > tenth ? time : time_to_tenth;
  }
  const RobotState& state = unit_->state();
  const franka_core::Payload payload = handPayload(id());
  const double inertia =
      parameters_->model.mass(state.q, payload)[48] + physics_.joints.rotor_inertia[6];
  EXPECT_NEAR(coastingTime(physics_.joints.friction[6], inertia, 0.52, tenth), time_to_tenth, 5e-3);
  EXPECT_NEAR(coastingTime(physics_.joints.friction[6], inertia, 0.52, below), time, 5e-3);
  EXPECT_NEAR(0.1, time_to_tenth, 0.03);
  run(200, &zero);
  EXPECT_NEAR(0.0, unit_->state().dq[6], 1e-6);
}

TEST_P(RealismTest, FrictionIsSeenInTheTorqueOfEachJoint) {
  // Panda: half the amplitude of the published law. FR3: hysteresis in the recording.
  const Array7 expected = isPanda() ? Array7{{0.273, 0.436, 0.3205, 0.6395, 0.4195, 0.1515, 0.2825}}
                                    : Array7{{0.50, 0.35, 0.27, 0.22, 0.28, 0.30, 0.14}};
  for (int i = 0; i < 7; i++) {
    start("real,bandwidth=off");
    startTorqueControl();
    double seen[2] = {0.0, 0.0};
    for (const bool back : {false, true}) {
      const double speed = back ? -0.9 : 0.9;
      for (int k = 0; k < 400; k++) {
        const RobotState& state = unit_->state();
        franka_core::RobotCommand command;
        for (int j = 0; j < 7; j++) {
          command.tau_J_d[j] = j == i ? 30.0 * (speed - state.dq[j])
                                      : 600.0 * (kReadyPose[j] - state.q[j]) - 40.0 * state.dq[j];
        }
        tick(&command);
      }
      seen[back ? 1 : 0] = unit_->state().tau_ext_hat_filtered[i];
    }
    const double hysteresis = 0.5 * (seen[0] - seen[1]);
    EXPECT_NEAR(expected[i], hysteresis, 0.2 * expected[i]) << "joint " << i + 1;
  }
}

// --- what the robot reports ----------------------------------------------------------------------

TEST_P(RealismTest, PushReadingHasTheDelayAndAccuracyOfARealRobot) {
  for (std::size_t axis = 0; axis < 3; axis++) {
    start("real");
    run(1000);
    const double before = unit_->state().O_F_ext_hat_K[axis];
    std::array<double, 3> force{};
    force[axis] = 10;
    pushBody(*world_, id() + "_hand_tcp", force, {{0, 0, 0}}, 3000);
    int ticks = 0;
    while (ticks < 1000 && std::abs(tick().O_F_ext_hat_K[axis] - before) < 6.32) {
      ticks++;
    }
    EXPECT_GE(ticks, 45) << axis;
    EXPECT_LE(ticks, 66) << axis;
    run(500 - ticks);
    const double read = unit_->state().O_F_ext_hat_K[axis] - before;
    EXPECT_NEAR(-10.0, read, 0.5) << axis;
    EXPECT_NEAR(0.0, before, 0.5) << axis;
  }
}

TEST_P(RealismTest, FreeMotionReadsTheForceOfARealRobot) {
  // In addition to its friction, the recorded FR3 reads the errors of its own model.
  const franka_test::TemporaryFolder folder;
  const std::string bias = folder.write(
      "bias.yaml", "torque_offset: [-0.34, -0.39, -0.06, -0.23, -0.05, 0.14, -0.25]\n");
  start(isPanda() ? "real" : "real,file=" + bias);
  startTorqueControl();
  SineDriver driver(*parameters_, handPayload(id()), 1.5, 0.9, {{1, 1, 1, 1, 1, 1, 1}});
  double sum = 0.0;
  double largest = 0.0;
  double fastest = 0.0;
  const int ticks = 20000;
  for (int i = 0; i < ticks; i++) {
    const franka_core::RobotCommand command = driver.command(unit_->state());
    const RobotState& state = tick(&command);
    ASSERT_EQ(franka_core::RobotMode::kMove, state.robot_mode) << i;
    const auto& F = state.O_F_ext_hat_K;
    const double force = std::hypot(F[0], F[1], F[2]);
    sum += force;
    largest = std::max(largest, force);
    for (const double dq : state.dq) {
      fastest = std::max(fastest, std::abs(dq));
    }
  }
  EXPECT_LT(fastest, 1.0);
  EXPECT_GE(sum / ticks, 2.0);
  EXPECT_LE(sum / ticks, 4.0);
  EXPECT_LT(largest, 9.0);
}

// --- noise ---------------------------------------------------------------------------------------

struct Recorded {
  Array7 tau_J_second_difference, tau_J_resolution;
  double dq_noise;
};
constexpr Recorded kPandaRecording{{{.09, .09, .085, .08, .017, .019, .06}},
                                   {{.0357, .0357, .0357, .0357, .006, .006, .006}},
                                   3e-3};
constexpr Recorded kFr3Recording{{{.059, .053, .053, .057, .026, .017, .052}},
                                 {{.0238, .0238, .0238, .0238, .00641, .00641, .00641}},
                                 1e-3};

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) {
    sum += v * v;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST_P(RealismTest, ReadingsHaveTheNoiseAndTheResolutionOfTheRecordings) {
  const Recorded& recorded = isPanda() ? kPandaRecording : kFr3Recording;
  start("recorded");
  run(1000);
  std::array<std::vector<double>, 7> tau, dq;
  for (int k = 0; k < 4000; k++) {
    const RobotState& state = tick();
    for (int i = 0; i < 7; i++) {
      tau[i].push_back(state.tau_J[i]);
      dq[i].push_back(state.dq[i]);
    }
  }
  for (int i = 0; i < 7; i++) {
    std::vector<double> second;
    double step = 1.0;
    for (std::size_t k = 2; k < tau[i].size(); k++) {
      second.push_back(tau[i][k] - 2.0 * tau[i][k - 1] + tau[i][k - 2]);
      const double change = std::abs(tau[i][k] - tau[i][k - 1]);
      step = change > 1e-9 ? std::min(step, change) : step;
    }
    EXPECT_NEAR(recorded.tau_J_second_difference[i], rms(second),
                0.3 * recorded.tau_J_second_difference[i]);
    EXPECT_NEAR(recorded.tau_J_resolution[i], step, 1e-9);
    EXPECT_NEAR(recorded.dq_noise, rms(dq[i]), 0.3 * recorded.dq_noise);
  }
}

/// RMS of the part between two frequencies [Hz] of samples that are 1 ms apart, without their mean,
/// by a discrete Fourier transform with Hann's window.
double bandRms(const std::vector<double>& samples, double from, double to) {
  const double n = static_cast<double>(samples.size());
  double mean = 0.0;
  for (const double sample : samples) {
    mean += sample / n;
  }
  double power = 0.0;
  for (double bin = std::ceil(from * 1e-3 * n); bin <= to * 1e-3 * n; bin++) {
    double real = 0.0, imaginary = 0.0;
    for (std::size_t k = 0; k < samples.size(); k++) {
      const double angle = 2.0 * M_PI * static_cast<double>(k) / n;
      const double value = (samples[k] - mean) * 0.5 * (1.0 - std::cos(angle));
      real += value * std::cos(bin * angle);
      imaginary += value * std::sin(bin * angle);
    }
    power += real * real + imaginary * imaginary;
  }
  return std::sqrt(power * 2.0 / (n * n) / 0.375);  // 0.375: the window's mean square
}

TEST_P(RealismTest, TorquesRippleInMotionAsInTheRecording) {
  const Array7 recorded =
      isPanda() ? Array7{{0.117, 0.174, 0.096, 0.171, 0.041, 0.044, 0}} : Array7{};  // 30 to 100 Hz
  start("recorded");
  tick();
  franka_core::fci::MoveRequest motion;
  motion.motion_generator_mode = franka_core::MotionGeneratorMode::kJointVelocity;
  ASSERT_EQ(Status::kMotionStarted, unit_->request(motion));
  std::array<std::vector<double>, 7> tau;
  for (int k = 0; k < 3000; k++) {
    franka_core::RobotCommand command;
    command.dq_c.fill(0.3 * std::sin(0.5 * M_PI * 1e-3 * k));
    const RobotState& state = tick(&command);
    ASSERT_EQ(franka_core::RobotMode::kMove, state.robot_mode) << k;
    for (std::size_t i = 0; i < 7 && k >= 1000; i++) {
      tau[i].push_back(state.tau_J[i]);
    }
  }
  for (std::size_t i = 0; i < 7; i++) {
    const double rms = bandRms(tau[i], 30.0, 100.0);
    if (recorded[i] > 0.0) {
      EXPECT_NEAR(recorded[i], rms, 0.2 * recorded[i]) << "joint " << i + 1;
    } else {
      // The noise alone, white up to 500 Hz; the motion may add as much.
      const Recorded& noise = isPanda() ? kPandaRecording : kFr3Recording;
      const double reading = noise.tau_J_second_difference[i] / std::sqrt(6.0);
      EXPECT_LT(rms, 2.0 * reading * std::sqrt(70.0 / 500.0)) << "joint " << i + 1;
    }
  }
}

TEST_P(RealismTest, TheSeedDecidesTheRobot) {
  const auto runOf = [this](const std::string& realism) {
    start(realism);
    std::vector<double> seen;
    for (int k = 0; k < 500; k++) {
      const RobotState& state = tick();
      seen.insert(seen.end(), state.tau_J.begin(), state.tau_J.end());
      seen.insert(seen.end(), state.dq.begin(), state.dq.end());
      seen.insert(seen.end(), state.q.begin(), state.q.end());
    }
    return seen;
  };
  EXPECT_NE(runOf("recorded,seed=7"), runOf("recorded,seed=8"));
  EXPECT_NE(runOf("recorded,seed=7,noise=off"), runOf("recorded,seed=8,noise=off"))
      << "the model error does not depend on the seed";
}

/// Errors of links and sensors act as on a real robot: its own model does not explain its torques,
/// and an arm without commands stays where it is.
TEST_P(RealismTest, ModelErrorReadsAsATorqueAndLetsNoArmDrift) {
  for (const char* seed : {"1", "2", "3", "4", "5", "6"}) {
    start(std::string("recorded,noise=off,seed=") + seed);
    startTorqueControl();
    const franka_core::RobotCommand zero;
    run(3000, &zero);
    const Array7 there = unit_->state().q;
    const Array7 bias = unit_->state().tau_ext_hat_filtered;
    run(5000, &zero);
    double worst = 0.0;
    for (int i = 0; i < 7; i++) {
      EXPECT_NEAR(there[i], unit_->state().q[i], 1e-4) << "joint " << i + 1 << ", seed " << seed;
      worst = std::max(worst, std::abs(bias[i]));
    }
    EXPECT_GT(worst, 0.05);
    EXPECT_LT(worst, 0.8);
  }
}

// --- ideal ---------------------------------------------------------------------------------------

TEST_P(RealismTest, IdealIsTheRobotWithoutParts) {
  const RobotPhysics ideal = physicsOf(id(), "ideal");
  EXPECT_EQ(JointPhysics{}.rotor_inertia, ideal.joints.rotor_inertia);
  EXPECT_EQ(SensorPhysics{}.tau_ext_cutoff, ideal.sensors.tau_ext_cutoff);
  EXPECT_EQ(Array7{}, ideal.sensors.tau_J_noise);
  EXPECT_EQ(Array7{}, ideal.torque_offset);
  EXPECT_EQ(0.0, ideal.gripper.shortest);
  ASSERT_TRUE(ideal.joints.stops);
  EXPECT_LT(ideal.joints.stops->lower[6], -2.8973);
  EXPECT_GT(ideal.joints.stops->upper[6], 2.8973);
  for (int i = 0; i < 7; i++) {
    EXPECT_FALSE(ideal.joints.friction[i].acts());
    EXPECT_FALSE(ideal.link_errors[i].exists());
  }
}

TEST_P(RealismTest, EachPartCanBeChosenAlone) {
  EXPECT_EQ(0.195, physicsOf(id(), "motors=on").joints.rotor_inertia[0]);
  EXPECT_TRUE(physicsOf(id(), "ideal,friction=on").joints.friction[6].acts());
  EXPECT_FALSE(physicsOf(id(), "real,friction=off").joints.friction[6].acts());
  EXPECT_EQ(2.4, physicsOf(id(), "bandwidth=on").sensors.tau_ext_cutoff[1]);
  EXPECT_GT(physicsOf(id(), "noise=on").sensors.dq_noise[0], 0.0);
  EXPECT_NE(0.0, physicsOf(id(), "model_error=on").torque_offset[0]);
  EXPECT_EQ(1.0, physicsOf(id(), "gripper=on").gripper.shortest);
  EXPECT_EQ(20u, physicsOf(id(), "real,delay=20").command_delay);
}

TEST(Realism, WithoutAProfileTheDefaultIsChanged) {
  EXPECT_FALSE(readRealism("", kInProcessProfile).friction);
  EXPECT_TRUE(readRealism("", kServedProfile).friction);
  const Realism late = readRealism("motors=off,delay=2", kServedProfile);
  EXPECT_TRUE(late.friction && !late.motors && !late.noise);
  EXPECT_EQ(2u, late.delay);
  EXPECT_FALSE(readRealism("ideal,delay=2", kServedProfile).friction);
}

TEST(Realism, WrongTextsAreRefusedWithASentence) {
  for (const char* text : {",", "reel", "real,", "real,friction", "real,friction=yes", "delay=21",
                           "delay=-1", "seed=x", "file=", "real,real", "real;seed=2"}) {
    try {
      readRealism(text, "ideal");
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string::npos, std::string(error.what()).find("Give ideal, real or recorded"));
    }
  }
}

class OwnRobotFile : public testing::Test {
 protected:
  RobotPhysics read(const std::string& text) {
    folder_.write("robot.yaml", text);
    return physicsOf("fr3", "real,file=" + path_);
  }
  franka_test::TemporaryFolder folder_;
  const std::string path_ = folder_ / "robot.yaml";
};

TEST_F(OwnRobotFile, ReplacesTheFiguresOfTheRobot) {
  const RobotPhysics own = read(
      "friction: {coulomb: [.1, .2, .3, .4, .5, .6, .7]}\n"
      "torque_offset: [0, 0.3, 0, 0, 0, 0, 0]\npayload: {mass: 0.4, centre: [0, 0, 0.1]}\n");
  EXPECT_EQ(0.7, own.joints.friction[6].coulomb);
  EXPECT_EQ(0.28, own.joints.friction[6].amplitude) << "figures that the file does not have stay";
  EXPECT_EQ(0.3, own.torque_offset[1]);
  EXPECT_EQ(0.4, own.link_errors[7].added_mass);
  RobotDescription description = robot("fr3");
  applyPhysics(own, "fr3", description);
  World world;
  world.addRobot(description);
}

TEST_F(OwnRobotFile, ErrorsNameTheFileAndTheEntry) {
  expectSentence([&] { read("frction: {}"); }, {path_.c_str(), "frction"});
  expectSentence([&] { read("friction: {coulomb: [1, 2]}"); }, {"coulomb", "list of 7"});
  expectSentence([&] { read("payload: {mass: -1}"); }, {"mass", "from 0 to 10"});
  expectSentence([&] { read("[1, 2]"); }, {path_.c_str(), "must be a map"});
  expectSentence([&] { read("torque_offset: ["); }, {path_.c_str(), "cannot be read"});
  std::remove(path_.c_str());
  expectSentence([&] { physicsOf("fr3", "real,file=" + path_); }, {path_.c_str()});
}

TEST(PhysicsFile, ErrorsNameTheFileAndTheEntry) {
  const franka_test::TemporaryFolder folder;
  const auto refuses = [&](const std::string& text, const std::string& realism, const char* part) {
    const std::string file = folder.write("physics.yaml", text);
    expectSentence([&] { readRobotPhysics(file, "panda", readRealism(realism, "ideal")); },
                   {file.c_str(), part});
  };
  refuses("fr3: {}", "ideal", "no section 'panda'");
  refuses("panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, x]}", "ideal", "finite numbers");
  refuses("panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, .nan]}", "ideal", "finite numbers");
  refuses("panda: {}", "motors=on", "no section 'motors'");
  refuses("panda: {bandwidth: {tau_ext_hat_filtered: [0, 1, 1, 1, 1, 1, 1]}}", "bandwidth=on",
          "must be positive");
}

INSTANTIATE_TEST_SUITE_P(Robots, RealismTest, ::testing::Values("panda", "fr3"));

}  // namespace
}  // namespace franka_sim::test
