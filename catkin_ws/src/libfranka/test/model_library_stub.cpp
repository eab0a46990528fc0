// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// A model library that does not compute: each function returns its own number first, then sums of
// its arguments, so that a test can check which one was called with what. A second library
// (FRANKA_TEST_FIRST_NUMBER 1000) has other numbers.
#include <cstddef>

#ifndef FRANKA_TEST_FIRST_NUMBER
#define FRANKA_TEST_FIRST_NUMBER 0
#endif

namespace {

double sum(const double* values, std::size_t size) {
  double result = 0.0;
  for (std::size_t i = 0; i < size; i++) {
    result += static_cast<double>(i + 1) * values[i];
  }
  return result;
}

void answer(double* out, double number, double first = 0.0, double second = 0.0, double third = 0.0,
            double fourth = 0.0) {
  out[0] = FRANKA_TEST_FIRST_NUMBER + number;
  out[1] = first;
  out[2] = second;
  out[3] = third;
  out[4] = fourth;
}

}  // namespace

extern "C" {
// NOLINTBEGIN(readability-identifier-naming, bugprone-macro-parentheses)  names of the interface

// clang-format off
#define FRANKA_TEST_FRAME(prefix, frame, number)                         \
  void prefix##frame(const double* q, double* out) {                     \
    answer(out, number + frame, sum(q, 7));                              \
  }
#define FRANKA_TEST_TIP(prefix, number)                                  \
  void prefix##9(const double* q, const double* F_T_EE, double* out) {   \
    answer(out, number + 9, sum(q, 7), sum(F_T_EE, 16));                 \
  }
#define FRANKA_TEST_MIDDLE(prefix, number)                               \
  FRANKA_TEST_FRAME(prefix, 2, number)                                   \
  FRANKA_TEST_FRAME(prefix, 3, number)                                   \
  FRANKA_TEST_FRAME(prefix, 4, number)                                   \
  FRANKA_TEST_FRAME(prefix, 5, number)                                   \
  FRANKA_TEST_FRAME(prefix, 6, number)                                   \
  FRANKA_TEST_FRAME(prefix, 7, number)                                   \
  FRANKA_TEST_FRAME(prefix, 8, number)                                   \
  FRANKA_TEST_TIP(prefix, number)
// clang-format on

FRANKA_TEST_FRAME(O_T_J, 1, 100)
FRANKA_TEST_MIDDLE(O_T_J, 100)
void O_J_J1(double* out) { answer(out, 201); }
FRANKA_TEST_MIDDLE(O_J_J, 200)
void Ji_J_J1(double* out) { answer(out, 301); }
FRANKA_TEST_MIDDLE(Ji_J_J, 300)

void M_NE(const double* q, const double* I_total, double m_total, const double* F_x_Ctotal,
          double* out) {
  answer(out, 401, sum(q, 7), sum(I_total, 9), m_total, sum(F_x_Ctotal, 3));
}
void c_NE(const double* q, const double* dq, const double* I_total, double m_total,
          const double* F_x_Ctotal, double* out) {
  answer(out, 402, sum(q, 7), sum(dq, 7), sum(I_total, 9), m_total + sum(F_x_Ctotal, 3));
}
void g_NE(const double* q, const double* g_earth, double m_total, const double* F_x_Ctotal,
          double* out) {
  answer(out, 403, sum(q, 7), sum(g_earth, 3), m_total, sum(F_x_Ctotal, 3));
}

// NOLINTEND(readability-identifier-naming, bugprone-macro-parentheses)
}  // extern "C"
