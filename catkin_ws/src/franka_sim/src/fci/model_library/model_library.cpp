// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The shared object that a simulated robot serves: the arm's model behind the C functions that
// clients of protocols 3 to 9 look up (protocol 8.1). Arrays are column-major; Jacobians are 6x7.
#include "parameters.h"

namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;
using franka_core::Payload;

// The server fills these in, in the file that it sends; volatile, so that the compiler cannot
// assume zeros.
__attribute__((used)) const volatile franka_sim::model_library::Parameters kParameters{
    franka_sim::model_library::kMark, {}};

ArmModel readModel() {
  const volatile double* next = &kParameters.numbers[0];
  const auto take = [&next](double& number) { number = *next++; };
  std::array<ArmModel::Link, 7> links;
  for (ArmModel::Link& link : links) {
    franka_sim::model_library::visitLink(link, take);
  }
  std::array<double, 16> flange;
  for (double& number : flange) {
    take(number);
  }
  return ArmModel(links, flange);
}

const ArmModel kArm = readModel();

template <std::size_t kSize>
std::array<double, kSize> read(const double* from) {
  std::array<double, kSize> result;
  for (std::size_t i = 0; i < kSize; i++) {
    result[i] = from[i];
  }
  return result;
}

template <std::size_t kSize>
void write(const std::array<double, kSize>& values, double* to) {
  for (std::size_t i = 0; i < kSize; i++) {
    to[i] = values[i];
  }
}

Payload payload(const double* I_total, double m_total, const double* F_x_Ctotal) {
  return {m_total, read<3>(F_x_Ctotal), read<9>(I_total)};
}

}  // namespace

extern "C" {
// NOLINTBEGIN(readability-identifier-naming)  names of the interface

#define FRANKA_EXPORT __attribute__((visibility("default")))

#define FRANKA_EXPORT_OF_JOINTS(name, function, frame)      \
  FRANKA_EXPORT void name(const double* q, double* out) {   \
    write(kArm.function(ArmFrame::frame, read<7>(q)), out); \
  }
// The functions of frames 2 to 9. The Jacobians of the first joint have no argument q.
#define FRANKA_EXPORT_FRAMES(prefix, function)                                       \
  FRANKA_EXPORT_OF_JOINTS(prefix##2, function, kJoint2)                              \
  FRANKA_EXPORT_OF_JOINTS(prefix##3, function, kJoint3)                              \
  FRANKA_EXPORT_OF_JOINTS(prefix##4, function, kJoint4)                              \
  FRANKA_EXPORT_OF_JOINTS(prefix##5, function, kJoint5)                              \
  FRANKA_EXPORT_OF_JOINTS(prefix##6, function, kJoint6)                              \
  FRANKA_EXPORT_OF_JOINTS(prefix##7, function, kJoint7)                              \
  FRANKA_EXPORT_OF_JOINTS(prefix##8, function, kFlange)                              \
  FRANKA_EXPORT void prefix##9(const double* q, const double* F_T_EE, double* out) { \
    write(kArm.function(ArmFrame::kEndEffector, read<7>(q), read<16>(F_T_EE)), out); \
  }

FRANKA_EXPORT_OF_JOINTS(O_T_J1, pose, kJoint1)
FRANKA_EXPORT_FRAMES(O_T_J, pose)
FRANKA_EXPORT void O_J_J1(double* out) { write(kArm.zeroJacobian(ArmFrame::kJoint1, {}), out); }
FRANKA_EXPORT_FRAMES(O_J_J, zeroJacobian)
FRANKA_EXPORT void Ji_J_J1(double* out) { write(kArm.bodyJacobian(ArmFrame::kJoint1, {}), out); }
FRANKA_EXPORT_FRAMES(Ji_J_J, bodyJacobian)

FRANKA_EXPORT void M_NE(const double* q, const double* I_total, double m_total,
                        const double* F_x_Ctotal, double* out) {
  write(kArm.mass(read<7>(q), payload(I_total, m_total, F_x_Ctotal)), out);
}
FRANKA_EXPORT void c_NE(const double* q, const double* dq, const double* I_total, double m_total,
                        const double* F_x_Ctotal, double* out) {
  write(kArm.coriolis(read<7>(q), read<7>(dq), payload(I_total, m_total, F_x_Ctotal)), out);
}
FRANKA_EXPORT void g_NE(const double* q, const double* g_earth, double m_total,
                        const double* F_x_Ctotal, double* out) {
  const Payload total{m_total, read<3>(F_x_Ctotal), {}};
  write(kArm.gravity(read<7>(q), total, read<3>(g_earth)), out);
}

// NOLINTEND(readability-identifier-naming)
}  // extern "C"
