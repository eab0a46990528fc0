// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// ArmModel::computeDynamics compared with KDL's solvers for the same five results, in one run.
// KDL's solvers are built once with the payload in the chain, so that both only compute. Prints one
// line at the end: the time of one call and the ratio.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <vector>

#include "kdl_arm.h"
#include "random_state.h"

namespace {

using namespace franka_test;

constexpr std::size_t kDifferentStates = 64;

std::vector<State> makeStates() {
  StateSource source(franka_core::kFerLimits);
  std::vector<State> states;
  for (std::size_t i = 0; i < kDifferentStates; i++) {
    states.push_back(source.next());
  }
  return states;
}

void armModel(benchmark::State& loop) {
  const auto arm = franka_core::ArmModel::fromUrdf(readData("panda_hand.urdf"));
  const std::vector<State> states = makeStates();
  const franka_core::Payload payload = states[0].payload;
  franka_core::ArmDynamics dynamics;
  std::size_t n = 0;
  for (auto _ : loop) {
    const State& s = states[n++ % kDifferentStates];
    arm.computeDynamics(franka_core::ArmFrame::kEndEffector, s.q, s.dq, states[0].F_T_EE, s.EE_T_K,
                        payload, {0.0, 0.0, -9.81}, dynamics);
    benchmark::DoNotOptimize(dynamics);
  }
}

void kdlSolvers(benchmark::State& loop) {
  const std::vector<State> states = makeStates();
  KDL::Chain chain = kdlArm(readData("panda_hand.urdf"), "panda");
  KDL::Chain tip = chain;
  addPayload(chain, states[0].payload);
  tip.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), toKdl(states[0].F_T_EE)));
  KDL::ChainDynParam dynamics(chain, KDL::Vector(0, 0, -9.81));
  KDL::ChainFkSolverPos_recursive kinematics(tip);
  KDL::ChainJntToJacSolver jacobians(tip);
  KDL::JntSpaceInertiaMatrix mass(7);
  KDL::JntArray q(7), dq(7), coriolis(7), gravity(7);
  KDL::Jacobian zero_jacobian(7);
  KDL::Frame frame;
  std::size_t n = 0;
  for (auto _ : loop) {
    const State& s = states[n++ % kDifferentStates];
    q.data = vector(s.q);
    dq.data = vector(s.dq);
    dynamics.JntToMass(q, mass);
    dynamics.JntToCoriolis(q, dq, coriolis);
    dynamics.JntToGravity(q, gravity);
    kinematics.JntToCart(q, frame);
    jacobians.JntToJac(q, zero_jacobian);
    benchmark::DoNotOptimize(mass.data.data());
    benchmark::DoNotOptimize(coriolis.data.data());
    benchmark::DoNotOptimize(gravity.data.data());
    benchmark::DoNotOptimize(zero_jacobian.data.data());
    benchmark::DoNotOptimize(frame);
  }
}

BENCHMARK(armModel)->Repetitions(5)->ReportAggregatesOnly(true);
BENCHMARK(kdlSolvers)->Repetitions(5)->ReportAggregatesOnly(true);

// Keeps the medians that it passes to the console.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.aggregate_name == "median") {
        (run.run_name.function_name == "armModel" ? arm_ : kdl_) = run.GetAdjustedCPUTime();
      }
    }
  }

  void print() const {
    std::printf("ArmModel mass+Coriolis+gravity+pose+Jacobian: %.2f us, %.2f of KDL's %.2f us\n",
                arm_ / 1000.0, arm_ / kdl_, kdl_ / 1000.0);
  }

 private:
  double arm_{0.0};
  double kdl_{0.0};
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.print();
  return 0;
}
