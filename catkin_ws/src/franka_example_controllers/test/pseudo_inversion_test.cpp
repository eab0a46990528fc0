// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/pseudo_inversion.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace franka_example_controllers {
namespace {

template <int Rows, int Columns>
void expectSameAnswers() {
  using Matrix = Eigen::Matrix<double, Rows, Columns>;
  std::srand(42);
  for (int n = 0; n < 1000; ++n) {
    Matrix matrix = Matrix::Random();
    if (n % 4 == 0) {
      matrix.row(Rows - 1) = matrix.row(0);  // singular
      matrix.col(Columns - 1) = matrix.col(0);
    }
    Eigen::MatrixXd by_singular_values;
    pseudoInverse(matrix, by_singular_values);
    const Eigen::Matrix<double, Rows, 1> vector = Eigen::Matrix<double, Rows, 1>::Random();
    const Eigen::Matrix<double, Columns, 1> solution = dampedSolution(matrix, vector);
    ASSERT_LT((solution - by_singular_values * vector).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(PseudoInversion, FixedSizeMatchesSingularValues) {
  expectSameAnswers<7, 6>();
  expectSameAnswers<3, 3>();
}

TEST(PseudoInversion, InvertsSingularValuesWithDamping) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2, 3);
  matrix(0, 0) = 2.0;
  matrix(1, 2) = 0.1;
  Eigen::MatrixXd inverse;
  pseudoInverse(matrix, inverse);
  EXPECT_EQ(3, inverse.rows());
  EXPECT_EQ(2, inverse.cols());
  EXPECT_NEAR(2.0 / 4.04, inverse(0, 0), 1e-15);
  EXPECT_NEAR(0.1 / 0.05, inverse(2, 1), 1e-15);
}

TEST(PseudoInversion, WithoutDampingIsMooreAndPenrose) {
  Eigen::MatrixXd matrix(3, 2);
  matrix << 1, 2, 3, 4, 5, 6;
  Eigen::MatrixXd inverse;
  pseudoInverse(matrix, inverse, false);
  EXPECT_LT((inverse * matrix - Eigen::Matrix2d::Identity()).norm(), 1e-12);

  Eigen::MatrixXd singular = Eigen::MatrixXd::Ones(2, 2);
  pseudoInverse(singular, inverse, false);
  EXPECT_LT((inverse - Eigen::MatrixXd::Constant(2, 2, 0.25)).norm(), 1e-12);
}

}  // namespace
}  // namespace franka_example_controllers
