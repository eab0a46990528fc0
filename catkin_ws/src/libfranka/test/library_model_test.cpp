// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The model that a robot of protocol 3 to 9 sends as a shared object: the function used for each
// frame, its arguments, and errors of invalid libraries. Results of a genuine one are compared with
// KDL and MuJoCo in the tests of the simulated robot.
#include <elf.h>
#include <franka/model.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "robot_fixture.h"

namespace franka_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using franka::Frame;

const std::vector<std::string>& functions() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result{"M_NE", "c_NE", "g_NE"};
    for (const char* prefix : {"O_T_J", "O_J_J", "Ji_J_J"}) {
      for (int i = 1; i <= 9; i++) {
        result.push_back(prefix + std::to_string(i));
      }
    }
    return result;
  }();
  return names;
}

Bytes stubLibrary(const char* path = LIBFRANKA_MODEL_STUB) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The library without a function: its name is replaced everywhere.
Bytes without(Bytes library, const std::string& name) {
  const std::string whole = '\0' + name + '\0';
  std::size_t found = 0;
  for (auto at = library.begin();
       (at = std::search(at, library.end(), whole.begin(), whole.end())) != library.end(); ++at) {
    at[1] = '#';
    found++;
  }
  EXPECT_GE(found, 1u) << name;
  return library;
}

double sum(const double* values, std::size_t size) {
  double result = 0.0;
  for (std::size_t i = 0; i < size; i++) {
    result += static_cast<double>(i + 1) * values[i];
  }
  return result;
}

class LibraryModel : public ::testing::Test {
 protected:
  franka::Model load(const Bytes& library) {
    fake_.script([&library](FakeRobot::Script& s) { s.library = library; });
    return connect(fake_)->loadModel();
  }

  std::string refusal(const Bytes& library) {
    return textOf<franka::ModelException>([&] { load(library); });
  }

  LibraryModel() {
    for (std::size_t i = 0; i < 7; i++) {
      q_[i] = 0.1 * static_cast<double>(i) - 0.3;
      dq_[i] = 0.7 - 0.2 * static_cast<double>(i);
    }
  }

  FakeRobot fake_{5};
  std::array<double, 7> q_{}, dq_{};
  // A quarter rotation about z and a shift; a shift along the rotated axes.
  const std::array<double, 16> F_T_EE_{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1};
  const std::array<double, 16> EE_T_K_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.01, 0.02, 0.03, 1};
  const std::array<double, 16> F_T_K_{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.08, 0.21, 0.33, 1};
  const std::array<double, 9> inertia_{0.1, 0.01, 0.02, 0.01, 0.2, 0.03, 0.02, 0.03, 0.3};
  const std::array<double, 3> com_{0.01, -0.02, 0.05};
};

TEST_F(LibraryModel, CallsTheFunctionOfEachFrame) {
  const franka::Model model = load(stubLibrary());
  for (int i = 0; i <= static_cast<int>(Frame::kStiffness); i++) {
    const Frame frame = static_cast<Frame>(i);
    const auto pose = model.pose(frame, q_, F_T_EE_, EE_T_K_);
    const auto zero = model.zeroJacobian(frame, q_, F_T_EE_, EE_T_K_);
    const auto body = model.bodyJacobian(frame, q_, F_T_EE_, EE_T_K_);
    const int number = std::min(i + 1, 9);
    EXPECT_EQ(100 + number, pose[0]);
    EXPECT_EQ(200 + number, zero[0]);
    EXPECT_EQ(300 + number, body[0]);
    EXPECT_EQ(sum(q_.data(), 7), pose[1]);
    EXPECT_EQ(frame == Frame::kJoint1 ? 0.0 : sum(q_.data(), 7), zero[1]);
    EXPECT_EQ(frame == Frame::kJoint1 ? 0.0 : sum(q_.data(), 7), body[1]);
    const double tip = frame == Frame::kEndEffector ? sum(F_T_EE_.data(), 16)
                       : frame == Frame::kStiffness ? sum(F_T_K_.data(), 16)
                                                    : 0.0;
    EXPECT_NEAR(tip, pose[2], 1e-15 * 100);
    EXPECT_NEAR(tip, zero[2], 1e-15 * 100);
    EXPECT_NEAR(tip, body[2], 1e-15 * 100);
  }
  EXPECT_THROW(model.pose(static_cast<Frame>(10), q_, F_T_EE_, EE_T_K_), std::invalid_argument);
}

TEST_F(LibraryModel, PassesTheLoadInOrder) {
  const franka::Model model = load(stubLibrary());
  const double m = 1.25;
  const double q = sum(q_.data(), 7), inertia = sum(inertia_.data(), 9), com = sum(com_.data(), 3);
  const auto mass = model.mass(q_, inertia_, m, com_);
  const auto coriolis = model.coriolis(q_, dq_, inertia_, m, com_);
  const std::array<double, 3> earth{0.3, -0.4, -9.7};
  const auto gravity = model.gravity(q_, m, com_, earth);
  const std::array<double, 5> expected_mass{401, q, inertia, m, com};
  const std::array<double, 5> expected_coriolis{402, q, sum(dq_.data(), 7), inertia, m + com};
  const std::array<double, 5> expected_gravity{403, q, sum(earth.data(), 3), m, com};
  for (std::size_t i = 0; i < 5; i++) {
    EXPECT_EQ(expected_mass[i], mass[i]);
    EXPECT_EQ(expected_coriolis[i], coriolis[i]);
    EXPECT_EQ(expected_gravity[i], gravity[i]);
  }
}

TEST_F(LibraryModel, NamesAMissingFunction) {
  const Bytes library = stubLibrary();
  ASSERT_EQ(30u, functions().size());
  for (const std::string& name : functions()) {
    EXPECT_NE(std::string::npos, refusal(without(library, name)).find(" " + name + ".")) << name;
  }
}

TEST_F(LibraryModel, RefusesALibraryForAnotherMachine) {
  Bytes library = stubLibrary();
  Bytes long_table = library;
  reinterpret_cast<Elf64_Ehdr*>(long_table.data())->e_phnum = 0xfff0;
  std::vector<Bytes> all_broken{Bytes(library.begin() + 1, library.end()), long_table};
  // Wherever it is truncated, nothing beyond the end is accessed.
  for (std::size_t size : {0u, 100u, 1000u, 5000u, 9000u, 12000u}) {
    ASSERT_LT(size, library.size());
    all_broken.emplace_back(library.begin(), library.begin() + size);
  }
  for (const Bytes& broken : all_broken) {
    EXPECT_NE(std::string::npos, refusal(broken).find("model library"));
  }
  auto& header = *reinterpret_cast<Elf64_Ehdr*>(library.data());
  header.e_machine = header.e_machine == EM_386 ? EM_ARM : EM_386;
  EXPECT_NE(std::string::npos, refusal(library).find("this machine's kind of processor"));
}

TEST_F(LibraryModel, TwoRobotsHaveTwoModels) {
  const auto flange = [this](const franka::Model& model) {
    return model.pose(Frame::kFlange, q_, F_T_EE_, EE_T_K_)[0];
  };
  const Bytes one = stubLibrary(), other = stubLibrary(LIBFRANKA_OTHER_MODEL_STUB);
  ASSERT_NE(one, other);
  {
    const franka::Model first = load(one), second = load(other), third = load(one);
    EXPECT_EQ(108, flange(first));
    EXPECT_EQ(1108, flange(second));
    EXPECT_EQ(108, flange(third));
  }
  // The other one is still loaded, and its file number is free.
  EXPECT_EQ(108, flange(load(one)));
  EXPECT_EQ(1108, flange(load(other)));
}

}  // namespace
}  // namespace franka_test
