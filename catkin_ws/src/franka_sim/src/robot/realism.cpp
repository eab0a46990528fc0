// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/realism.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <sstream>
#include <stdexcept>

namespace franka_sim {

namespace {

constexpr const char* kForm =
    "ideal, real or recorded, then changes such as real,friction=off,delay=2,seed=7";

struct Part {
  const char* name;
  bool Realism::* member;
};
constexpr std::array<Part, 6> kParts{{{"motors", &Realism::motors},
                                      {"friction", &Realism::friction},
                                      {"bandwidth", &Realism::bandwidth},
                                      {"gripper", &Realism::gripper},
                                      {"noise", &Realism::noise},
                                      {"model_error", &Realism::model_error}}};

[[noreturn]] void fail(const std::string& text, const std::string& why) {
  throw std::invalid_argument("realism '" + text + "': " + why + " Give " + kForm + ".");
}

bool applyProfile(const std::string& name, Realism& realism) {
  if (name != "ideal" && name != "real" && name != "recorded") {
    return false;
  }
  const bool real = name != "ideal";
  const bool recorded = name == "recorded";
  realism.motors = realism.friction = realism.bandwidth = realism.gripper = real;
  realism.noise = realism.model_error = recorded;
  return true;
}

bool readNumber(const std::string& value, std::uint64_t most, std::uint64_t& number) {
  const char* end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), end, number);
  return error == std::errc{} && stop == end && number <= most;
}

bool applyPart(const std::string& name, const std::string& value, Realism& realism) {
  for (const Part& part : kParts) {
    if (name == part.name && (value == "on" || value == "off")) {
      realism.*part.member = value == "on";
      return true;
    }
  }
  return false;
}

bool applyChange(const std::string& name, const std::string& value, Realism& realism) {
  std::uint64_t number = 0;
  if (name == "delay" && readNumber(value, kMaxCommandDelay, number)) {
    realism.delay = static_cast<unsigned>(number);
    return true;
  }
  if (name == "seed") {
    return readNumber(value, UINT64_MAX, realism.seed);
  }
  if (name == "file" && !value.empty()) {
    realism.file = value;
    return true;
  }
  return applyPart(name, value, realism);
}

}  // namespace

bool haveSameBehavior(const Realism& one, const Realism& other) {
  const bool same_parts = std::all_of(kParts.begin(), kParts.end(), [&](const Part& part) {
    return one.*part.member == other.*part.member;
  });
  const bool draws = one.noise || one.model_error;
  return same_parts && one.delay == other.delay && one.file == other.file &&
         (!draws || one.seed == other.seed);
}

Realism readRealism(const std::string& text, const char* profile) {
  Realism realism;
  applyProfile(profile, realism);
  std::istringstream words(text);
  std::string word;
  for (bool first = true; std::getline(words, word, ','); first = false) {
    if (first && applyProfile(word, realism)) {
      continue;
    }
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos ||
        !applyChange(word.substr(0, equals), word.substr(equals + 1), realism)) {
      fail(text, "'" + word + "' is not known there.");
    }
  }
  if (!text.empty() && text.back() == ',') {
    fail(text, "a word is missing.");
  }
  return realism;
}

}  // namespace franka_sim
