// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/fci/line_server.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace franka_sim_mujoco::fci {

namespace {

LineServer::Words split(const std::string& line) {
  std::istringstream stream(line);
  LineServer::Words words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

}  // namespace

void LineServer::add(const std::string& usage, Handler handler) {
  entries_[usage.substr(0, usage.find(' '))] = {usage, std::move(handler)};
}

std::string LineServer::help() const {
  std::string text;
  for (const auto& entry : entries_) {
    text += (text.empty() ? "" : "; ") + entry.second.usage;
  }
  return text;
}

std::string LineServer::answer(const std::string& line) const {
  Words words = split(line);
  if (words.empty() || words.front() == "help") {
    return "ok " + help();
  }
  const auto entry = entries_.find(words.front());
  if (entry == entries_.end()) {
    return "error: There is no command '" + words.front() + "'; help lists them.";
  }
  words.erase(words.begin());
  try {
    const std::string value = entry->second.handler(words);
    return value.empty() ? "ok" : "ok " + value;
  } catch (const std::out_of_range&) {
    return "error: Words are missing: " + entry->second.usage + ".";
  } catch (const std::exception& error) {
    return std::string("error: ") + error.what();
  }
}

void LineServer::serve() {
  slot_.serve([this](Connection& client) { return serveOne(client); }, [] {});
}

Served LineServer::serveOne(Connection& client) {
  constexpr std::size_t kLongestLine = 4000;
  const Bytes stream = client.received();
  const std::uint8_t* const end = stream.data + stream.size;
  const std::uint8_t* const line_end = std::find(stream.data, end, '\n');
  if (line_end == end) {
    return stream.size < kLongestLine ? Served::kIncomplete : Served::kBroken;
  }
  const std::string line(stream.data, line_end);
  client.consume(line.size() + 1);
  slot_.confirm();
  const std::string reply = answer(line) + "\n";
  return client.send({reinterpret_cast<const std::uint8_t*>(reply.data()), reply.size()})
             ? Served::kDone
             : Served::kBroken;
}

double toNumber(const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !std::isfinite(value)) {
    throw std::invalid_argument("'" + word + "' is not a finite number.");
  }
  return value;
}

std::uint64_t toSeed(const std::string& word) {
  std::uint64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end) {
    throw std::invalid_argument(
        "'" + word + "' is no seed: give a whole number from 0 to 18446744073709551615.");
  }
  return value;
}

bool toSwitch(const std::string& word) {
  if (word != "on" && word != "off") {
    throw std::invalid_argument("'" + word + "' is neither on nor off.");
  }
  return word == "on";
}

}  // namespace franka_sim_mujoco::fci
