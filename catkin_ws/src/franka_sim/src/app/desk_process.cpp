// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "desk_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

extern char** environ;

namespace franka_sim {

namespace {

constexpr const char* kProgram = "franka_desk";
constexpr std::chrono::seconds kTimeToEnd{5};

// The program beside this one, otherwise the one on PATH.
std::string programFile() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path beside = self.parent_path() / kProgram;
  return !error && ::access(beside.c_str(), X_OK) == 0 ? beside.string() : kProgram;
}

std::vector<std::string> commandLine(const Options& options, const fci::Descriptor& addresses) {
  std::vector<std::string> words{programFile(), "--child=" + std::to_string(addresses.get())};
  for (const ArmOptions& arm : options.arms) {
    words.push_back("--robot=" + arm.ip + ":" + std::to_string(arm.control_port));
  }
  if (!options.desk.address.empty()) {
    words.push_back("--listen=" + options.desk.address);
  }
  if (!options.desk.user.empty()) {
    words.push_back("--user=" + options.desk.user);
  }
  return words;
}

// The password is not on the command line, which other users can read.
std::vector<std::string> environmentOf(const Options& options) {
  const std::string name = "FRANKA_DESK_PASSWORD=";
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; variable++) {
    // Of two with this name the program would read the first one.
    if (options.desk.password.empty() || std::string(*variable).rfind(name, 0) != 0) {
      variables.emplace_back(*variable);
    }
  }
  if (!options.desk.password.empty()) {
    variables.push_back(name + options.desk.password);
  }
  return variables;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

// Its end for reading, then that for writing.
std::pair<fci::Descriptor, fci::Descriptor> makePipe() {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("Desk cannot be started: ") + std::strerror(errno) + ".");
  }
  return {fci::Descriptor(ends[0]), fci::Descriptor(ends[1])};
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

DeskProcess::DeskProcess(const Options& options, Ready ready) : ready_(std::move(ready)) {
  fci::Descriptor child_input, child_output;
  std::tie(child_input, input_) = makePipe();
  std::tie(output_, child_output) = makePipe();
  ::fcntl(output_.get(), F_SETFL, O_NONBLOCK);
  std::vector<std::string> words = commandLine(options, child_output);
  std::vector<std::string> variables = environmentOf(options);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, child_input.get(), STDIN_FILENO);
  // The same number: the child inherits it.
  posix_spawn_file_actions_adddup2(&actions, child_output.get(), child_output.get());
  const int error = ::posix_spawnp(&process_, words.front().c_str(), &actions, nullptr,
                                   pointersTo(words).data(), pointersTo(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    process_ = -1;
    throw std::runtime_error(
        "Desk cannot be started: the program franka_desk of pyfranka is not "
        "found beside franka_sim or on PATH (" +
        std::string(std::strerror(error)) + ").");
  }
}

bool DeskProcess::hasEnded(int& status) noexcept {
  if (process_ > 0 && ::waitpid(process_, &status, WNOHANG) == process_) {
    process_ = -1;
    return true;
  }
  return process_ <= 0;
}

void DeskProcess::readAddresses() {
  std::array<char, 4096> part{};
  ssize_t count = 0;
  while (output_ && (count = ::read(output_.get(), part.data(), part.size())) > 0) {
    addresses_.append(part.data(), static_cast<std::size_t>(count));
  }
  if (output_ && count == 0) {
    output_.close();
    if (!addresses_.empty()) {
      std::exchange(ready_, nullptr)(linesOf(addresses_));
    }
  }
}

void DeskProcess::serve() {
  constexpr std::chrono::milliseconds kPause{200};
  const Clock::time_point now = Clock::now();
  if (process_ <= 0 || now - checked_at_ < kPause) {
    return;
  }
  checked_at_ = now;
  int status = 0;
  const bool ended = hasEnded(status);
  readAddresses();
  if (!ended) {
    return;
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  // A request to end, such as Ctrl-C, reaches both programs.
  const bool requested = code == 0 || code == 128 + SIGINT || code == 128 + SIGTERM;
  if (ready_ && !requested) {
    throw std::runtime_error("Desk has ended before it was ready (status " + std::to_string(code) +
                             "); its messages stand above. The robots would stay locked.");
  }
  std::fprintf(stderr,
               "franka_sim: Desk has ended by itself (status %d); its messages stand above. The "
               "robots go on without it.\n",
               code);
}

DeskProcess::~DeskProcess() {
  input_ = fci::Descriptor();
  int status = 0;
  for (const Clock::time_point until = Clock::now() + kTimeToEnd; Clock::now() < until;) {
    if (hasEnded(status)) {
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::kill(process_, SIGKILL);
  ::waitpid(process_, &status, 0);
}

}  // namespace franka_sim
