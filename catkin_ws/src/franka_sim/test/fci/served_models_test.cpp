// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The models that a robot serves, loaded as clients load them, compared with the control unit's own
// model and with numbers independent of KDL.
#include "fci/served_models.h"

#include <dlfcn.h>
#include <franka_core/arm_model.h>
#include <franka_core/limits.h>
#include <franka_core/numbers.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "../physics/test_support.h"

namespace franka_sim::fci {
namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;
using franka_core::Payload;
using Array7 = std::array<double, 7>;

/// The library as a client stores it: a file, opened with dlopen.
class Loaded {
 public:
  explicit Loaded(const std::vector<std::uint8_t>& bytes) {
    char name[] = "/tmp/franka_sim_model_XXXXXX";
    const int fd = mkstemp(name);
    std::FILE* file = fdopen(fd, "wb");
    std::fwrite(bytes.data(), 1, bytes.size(), file);
    std::fclose(file);
    path_ = name;
    handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  }
  ~Loaded() {
    if (handle_ != nullptr) {
      dlclose(handle_);
    }
    std::remove(path_.c_str());
  }
  bool good() const { return handle_ != nullptr; }
  const std::string& path() const { return path_; }
  template <typename Function>
  Function* get(const std::string& name) const {
    return reinterpret_cast<Function*>(dlsym(handle_, name.c_str()));
  }

 private:
  std::string path_;
  void* handle_;
};

using OfJoints = void(const double*, double*);
using OfEndEffector = void(const double*, const double*, double*);
using OfNothing = void(double*);
using Mass = void(const double*, const double*, double, const double*, double*);
using Coriolis = void(const double*, const double*, const double*, double, const double*, double*);
using Gravity = void(const double*, const double*, double, const double*, double*);

template <std::size_t kSize>
void expectNear(const std::array<double, kSize>& due, const double* got, const std::string& what) {
  for (std::size_t i = 0; i < kSize; i++) {
    EXPECT_NEAR(due[i], got[i], 1e-12 * (1.0 + std::abs(due[i]))) << what << "[" << i << "]";
  }
}

class ServedModel : public ::testing::TestWithParam<const char*> {
 protected:
  ServedModel() : arm_(ArmModel::fromUrdf(test::urdfOf(GetParam()))) {}

  Array7 joints() {
    Array7 result;
    for (double& value : result) {
      value = uniform(-2.5, 2.5);
    }
    return result;
  }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  ArmModel arm_;
  std::mt19937_64 engine_{7};
};

INSTANTIATE_TEST_SUITE_P(Robots, ServedModel, ::testing::Values("panda", "fr3"));

constexpr std::array<double, 16> kF_T_EE{0.6, 0.8, 0, 0, -0.8, 0.6,  0,   0,
                                         0,   0,   1, 0, 0.01, 0.02, 0.3, 1};

TEST_P(ServedModel, MatchesTheControlUnitsModel) {
  const Loaded library(servedLibrary(arm_));
  ASSERT_TRUE(library.good()) << dlerror();
  for (int round = 0; round < 100; round++) {
    const Array7 q = joints();
    for (int i = 1; i <= 9; i++) {
      const auto frame = static_cast<ArmFrame>(i - 1);
      std::array<double, 42> out{};
      const auto read = [&](const std::string& what) {
        const std::string name = what + std::to_string(i);
        if (i == 9) {
          library.get<OfEndEffector>(name)(q.data(), kF_T_EE.data(), out.data());
        } else if (i == 1 && what != "O_T_J") {
          library.get<OfNothing>(name)(out.data());  // these take no configuration
        } else {
          library.get<OfJoints>(name)(q.data(), out.data());
        }
        return out.data();
      };
      // Only the last frame depends on it.
      expectNear(arm_.pose(frame, q, kF_T_EE), read("O_T_J"), "O_T_J" + std::to_string(i));
      expectNear(arm_.zeroJacobian(frame, q, kF_T_EE), read("O_J_J"), "O_J_J" + std::to_string(i));
      expectNear(arm_.bodyJacobian(frame, q, kF_T_EE), read("Ji_J_J"),
                 "Ji_J_J" + std::to_string(i));
    }
  }
}

TEST_P(ServedModel, MatchesTheDynamicsWithAPayload) {
  const Loaded library(servedLibrary(arm_));
  ASSERT_TRUE(library.good()) << dlerror();
  for (int round = 0; round < 100; round++) {
    const Array7 q = joints(), dq = joints();
    const Payload load{uniform(0.0, 3.0),
                       {uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(0.0, 0.2)},
                       {0.01, 0.001, 0, 0.001, 0.02, 0, 0, 0, 0.03}};
    const std::array<double, 3> gravity{uniform(-3, 3), uniform(-3, 3), -9.0};
    std::array<double, 49> out{};
    library.get<Mass>("M_NE")(q.data(), load.inertia.data(), load.mass, load.com.data(),
                              out.data());
    expectNear(arm_.mass(q, load), out.data(), "M_NE");
    library.get<Coriolis>("c_NE")(q.data(), dq.data(), load.inertia.data(), load.mass,
                                  load.com.data(), out.data());
    expectNear(arm_.coriolis(q, dq, load), out.data(), "c_NE");
    library.get<Gravity>("g_NE")(q.data(), gravity.data(), load.mass, load.com.data(), out.data());
    expectNear(arm_.gravity(q, load, gravity), out.data(), "g_NE");
  }
}

// A client's machine may have only libc and libm.
TEST_P(ServedModel, NeedsOnlyLibcAndLibm) {
  const Loaded library(servedLibrary(arm_));
  std::FILE* pipe = popen(("readelf -d " + library.path()).c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  char line[512];
  int needed = 0, lines = 0;
  while (std::fgets(line, sizeof(line), pipe) != nullptr) {
    lines++;
    const std::string text = line;
    if (text.find("(NEEDED)") != std::string::npos) {
      needed++;
      EXPECT_TRUE(text.find("[libc.so.6]") != std::string::npos ||
                  text.find("[libm.so.6]") != std::string::npos)
          << text;
    }
  }
  pclose(pipe);
  EXPECT_GT(lines, 5);
  EXPECT_LE(needed, 2);
}

// The arm read back from the URDF is the same.
TEST_P(ServedModel, UrdfReadsBackTheSameArm) {
  const std::string text = servedUrdf(arm_, 10);
  const ArmModel again = ArmModel::fromUrdf(text);
  for (int round = 0; round < 20; round++) {
    const Array7 q = joints(), dq = joints();
    const auto due = arm_.pose(ArmFrame::kFlange, q), got = again.pose(ArmFrame::kFlange, q);
    test::expectNear(due, got, 1e-12);
    const auto tau = arm_.inverseDynamics(q, dq, dq, {}),
               read = again.inverseDynamics(q, dq, dq, {});
    test::expectNear(tau, read, 1e-10);
  }
}

TEST_P(ServedModel, UrdfHasAllElementsThatClientsNeed) {
  for (const unsigned version : {8U, 9U, 10U}) {
    tinyxml2::XMLDocument document;
    const std::string text = servedUrdf(arm_, version);
    ASSERT_EQ(document.Parse(text.c_str()), tinyxml2::XML_SUCCESS);
    const tinyxml2::XMLElement* robot = document.RootElement();
    EXPECT_NE(std::string(robot->Attribute("name")).substr(0, 3), "tmr");
    std::string last_link;
    for (const auto* link = robot->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      last_link = link->Attribute("name");
    }
    EXPECT_EQ(last_link, "link8");
    int joints = 0;
    for (const auto* joint = robot->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      if (std::string(joint->Attribute("type")) != "revolute") {
        continue;
      }
      const std::size_t i = static_cast<std::size_t>(joints++);
      EXPECT_EQ(joint->Attribute("name"), "joint" + std::to_string(joints));
      const auto* limit = joint->FirstChildElement("limit");
      const auto* velocity = joint->FirstChildElement("position_based_velocity_limits");
      ASSERT_TRUE(limit != nullptr && velocity != nullptr);
      // The tables of system 5.9 and of those before it, typed from the manual.
      const Array7 upper59{2.9007, 1.8361, 2.9007, -0.1169, 2.8763, 4.6216, 3.0508};
      const Array7 upper{2.7437, 1.7837, 2.9007, -0.1518, 2.8065, 4.5169, 3.0159};
      const Array7 offset59{0.6599, 0.2517, 0.2000, 0.3533, 0.5757, 0.4878, 0.4628};
      const Array7 offset{0.30, 0.20, 0.20, 0.30, 0.35, 0.35, 0.35};
      const Array7 deceleration{6, 2.585, 3.5, 4, 17, 5.5, 17};
      const auto limits = franka_core::limitsOfProtocol(version);
      EXPECT_EQ(franka_core::readNumber(limit->Attribute("lower")), limits.q_min[i]);
      EXPECT_EQ(franka_core::readNumber(limit->Attribute("velocity")), limits.dq[i]);
      EXPECT_EQ(franka_core::readNumber(limit->Attribute("effort")), limits.tau[i]);
      EXPECT_EQ(franka_core::readNumber(limit->Attribute("upper")),
                version == 10 ? upper59[i] : upper[i]);
      EXPECT_EQ(franka_core::readNumber(velocity->Attribute("velocity_offset")),
                version == 10 ? offset59[i] : offset[i]);
      EXPECT_EQ(franka_core::readNumber(velocity->Attribute("deceleration_limit")),
                deceleration[i]);
    }
    EXPECT_EQ(joints, 7);
  }
}

}  // namespace
}  // namespace franka_sim::fci
