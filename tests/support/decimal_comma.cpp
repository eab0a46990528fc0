// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// A library to be preloaded: programs use the locale of their environment, as those of Qt do.
#include <clocale>

namespace {

[[gnu::constructor]] void useLocaleOfEnvironment() { std::setlocale(LC_ALL, ""); }

}  // namespace
