// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/simulation/batch.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace franka_sim {

class SimulationBatch::Threads {
 public:
  explicit Threads(int number) : arena_(std::min(number, tbb::info::default_concurrency())) {}

  /// Calls `function(i)` for each i below `count`.
  template <typename Function>
  void run(std::size_t count, const Function& function) {
    arena_.execute([&] { tbb::parallel_for(std::size_t{0}, count, function); });
  }

 private:
  tbb::task_arena arena_;
};

SimulationBatch::SimulationBatch(std::vector<Simulation*> simulations, int threads,
                                 const std::vector<std::string>& observe)
    : simulations_(std::move(simulations)), process_(getpid()) {
  if (simulations_.empty()) {
    throw std::invalid_argument("A batch needs at least one simulation.");
  }
  if (threads < 1 || threads > kMostThreads) {
    throw std::invalid_argument("A batch runs on 1 to " + std::to_string(kMostThreads) +
                                " threads, not on " + std::to_string(threads) + ".");
  }
  for (Simulation* simulation : simulations_) {
    observers_.emplace_back(*simulation, observe);
  }
  row_size_ = observers_[0].size();
  observations_.resize(simulations_.size() * row_size_);
  threads_ = std::make_unique<Threads>(threads);
  this->observe();
}

SimulationBatch::~SimulationBatch() = default;

template <typename Function>
void SimulationBatch::forEach(Function function) {
  if (getpid() != process_) {
    throw std::runtime_error(
        "This batch was made before the process was forked and has no threads here; make one in "
        "the new process.");
  }
  std::vector<std::string> faults(simulations_.size());
  threads_->run(simulations_.size(), [&](std::size_t i) {
    try {
      function(i);
    } catch (const std::exception& error) {
      faults[i] = error.what();
    }
  });
  std::string text;
  for (std::size_t i = 0; i < faults.size(); i++) {
    if (!faults[i].empty()) {
      text += (text.empty() ? "" : " ") + ("World " + std::to_string(i) + ": " + faults[i]);
    }
  }
  if (!text.empty()) {
    throw std::runtime_error(text);
  }
}

void SimulationBatch::step(std::uint64_t ticks) {
  forEach([this, ticks](std::size_t i) {
    const auto see = [&] { observers_[i].read(&observations_[i * row_size_]); };
    try {
      simulations_[i]->step(ticks);
    } catch (...) {
      see();
      throw;
    }
    see();
  });
}

void SimulationBatch::observe() {
  forEach([this](std::size_t i) { observers_[i].read(&observations_[i * row_size_]); });
}

}  // namespace franka_sim
