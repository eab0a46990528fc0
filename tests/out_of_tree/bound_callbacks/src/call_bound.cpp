// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Both kinds of bind in one program, with the placeholders of both in scope.
#include <franka_hw/trigger_rate.h>

#include <boost/bind/bind.hpp>
#include <boost/function.hpp>
#include <functional>
#include <iostream>

namespace {

int number(int tens, int ones) { return 10 * tens + ones; }

int global() { return boost::bind(number, _2, _1)(1, 2); }

int both() {
  using namespace std::placeholders;
  const std::function<int(int, int)> by_std = std::bind(number, _2, _1);
  const boost::function<int(int, int)> by_boost = boost::bind(number, _2, _1);
  return by_std(3, 4) == by_boost(3, 4) ? by_boost(3, 4) : 0;
}

int nested() {
  using namespace boost::placeholders;
  using namespace std::placeholders;
  return boost::bind(number, boost::bind(std::plus<int>(), _1, 1), _2)(4, 6) +
         (boost::bind(number, _1, _2) < _3)(1, 1, 12) +
         std::bind(number, _9, _1)(0, 0, 0, 0, 0, 0, 0, 0, 0);
}

}  // namespace

int main() {
  std::cout << global() << ' ' << both() << ' ' << nested() << '\n';
  return 0;
}
