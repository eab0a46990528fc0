// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

// Compares ModelKDL with the bare KDL solvers on the same chain in the same run: mass, Coriolis,
// gravity and zero Jacobian, at 1000 random states. The counter "ratio" of the last line is the
// result.

#include <benchmark/benchmark.h>
#include <franka_core/arm_model.h>
#include <franka_hw/model_kdl.h>
#include <source_file.h>
#include <urdf/model.h>

#include <Eigen/Dense>
#include <array>
#include <ctime>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <random>
#include <string>
#include <vector>

namespace {

using Array7 = std::array<double, 7>;

constexpr double kMass = 0.76;
constexpr std::array<double, 3> kCom{{-0.01, 0.0, 0.03}};
constexpr std::array<double, 9> kInertia{{0.001, 0, 0, 0, 0.0025, 0, 0, 0, 0.0017}};
constexpr std::array<double, 3> kGravity{{0.0, 0.0, -9.81}};
constexpr std::array<double, 16> kF_T_EE{
    {0.7071, -0.7071, 0, 0, 0.7071, 0.7071, 0, 0, 0, 0, 1, 0, 0, 0, 0.1034, 1}};

std::string urdfText() { return franka_test::readSource("libfranka/test/data/panda_hand.urdf"); }

urdf::Model urdfModel() {
  urdf::Model model;
  model.initString(urdfText());
  return model;
}

std::vector<Array7> states() {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> angle(-2.5, 2.5);
  std::vector<Array7> result(1000);
  for (Array7& q : result) {
    for (double& value : q) {
      value = angle(generator);
    }
  }
  return result;
}

/// Processor time, which other processes do not lengthen.
double secondsPerGo(const benchmark::State& state, std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC /
         static_cast<double>(state.iterations());
}

double bare_kdl_seconds = 0.0;

void bareKdlSolvers(benchmark::State& state) {
  KDL::Tree tree;
  kdl_parser::treeFromUrdfModel(urdfModel(), tree);
  KDL::Chain chain;
  tree.getChain("panda_link0", "panda_link8", chain);
  KDL::Chain end_effector_chain = chain;
  franka_hw::ModelKDL::augmentFrame("load", kCom, kMass, kInertia, chain);
  franka_hw::ModelKDL::augmentFrame("EE", kF_T_EE, end_effector_chain);
  KDL::ChainDynParam dynamics(chain, KDL::Vector(0, 0, -9.81));
  KDL::ChainJntToJacSolver jacobian_solver(end_effector_chain);
  KDL::JntArray q(7);
  KDL::JntArray dq(7);
  KDL::JntArray coriolis(7);
  KDL::JntArray gravity(7);
  KDL::JntSpaceInertiaMatrix mass(7);
  KDL::Jacobian jacobian(7);
  const std::vector<Array7> all = states();
  std::size_t n = 0;
  const std::clock_t start = std::clock();
  for (auto _ : state) {
    q.data = Eigen::Map<const Eigen::Matrix<double, 7, 1>>(all[n].data());
    dq.data = q.data;
    dynamics.JntToMass(q, mass);
    dynamics.JntToCoriolis(q, dq, coriolis);
    dynamics.JntToGravity(q, gravity);
    jacobian_solver.JntToJac(q, jacobian);
    benchmark::DoNotOptimize(mass.data.data());
    benchmark::DoNotOptimize(jacobian.data.data());
    benchmark::ClobberMemory();
    n = (n + 1) % all.size();
  }
  bare_kdl_seconds = secondsPerGo(state, start);
}
BENCHMARK(bareKdlSolvers)->Name("bare KDL solvers")->MinTime(1.0);

void armModel(benchmark::State& state) {
  const franka_core::ArmModel model = franka_core::ArmModel::fromUrdf(urdfText(), "panda");
  const franka_core::Payload payload{kMass, kCom, kInertia};
  franka_core::ArmDynamics result;
  const std::vector<Array7> all = states();
  std::size_t n = 0;
  const std::clock_t start = std::clock();
  for (auto _ : state) {
    model.computeDynamics(franka_core::ArmFrame::kEndEffector, all[n], all[n], kF_T_EE,
                          franka_core::kIdentityTransform, payload, kGravity, result);
    benchmark::DoNotOptimize(result);
    n = (n + 1) % all.size();
  }
  state.counters["ratio"] = secondsPerGo(state, start) / bare_kdl_seconds;
}
BENCHMARK(armModel)->Name("ArmModel")->MinTime(1.0);

void modelKdl(benchmark::State& state) {
  const franka_hw::ModelKDL model(urdfModel(), "panda_link0", "panda_link8", 1e-4);
  const std::vector<Array7> all = states();
  std::size_t n = 0;
  const std::clock_t start = std::clock();
  for (auto _ : state) {
    const Array7& q = all[n];
    benchmark::DoNotOptimize(model.mass(q, kInertia, kMass, kCom));
    benchmark::DoNotOptimize(model.coriolis(q, q, kInertia, kMass, kCom));
    benchmark::DoNotOptimize(model.gravity(q, kMass, kCom, kGravity));
    benchmark::DoNotOptimize(model.zeroJacobian(franka::Frame::kEndEffector, q, kF_T_EE,
                                                franka_core::kIdentityTransform));
    n = (n + 1) % all.size();
  }
  state.counters["ratio"] = secondsPerGo(state, start) / bare_kdl_seconds;
}
BENCHMARK(modelKdl)->Name("ModelKDL")->MinTime(1.0);

}  // namespace

BENCHMARK_MAIN();
