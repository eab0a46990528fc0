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

namespace {

/// Ticks of all worlds together between two checks whether a step continues, some 80 ms of a core,
/// and the bounds of those of one world (chosen here).
constexpr std::uint64_t kTicksOfAll = 4000;
constexpr std::uint64_t kMinTicks = 50;
constexpr std::uint64_t kMaxTicks = 1000;

}  // namespace

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
  if (threads < 1 || threads > kMaxThreads) {
    throw std::invalid_argument("A batch runs on 1 to " + std::to_string(kMaxThreads) +
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
void SimulationBatch::forEach(Faults& faults, const Function& function) {
  if (getpid() != process_) {
    throw std::runtime_error(
        "This batch was made before the process was forked and has no threads here; make one in "
        "the new process.");
  }
  threads_->run(simulations_.size(), [&](std::size_t i) {
    if (!faults[i].empty()) {
      return;
    }
    try {
      function(i);
    } catch (const std::exception& error) {
      faults[i] = error.what();
    }
  });
}

void SimulationBatch::report(const Faults& faults) {
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

void SimulationBatch::advance(std::size_t number, std::uint64_t ticks) {
  const auto see = [&] { observers_[number].read(&observations_[number * row_size_]); };
  try {
    simulations_[number]->step(ticks);
  } catch (...) {
    see();
    throw;
  }
  see();
}

void SimulationBatch::step(std::uint64_t ticks, const std::function<bool()>& keep_stepping) {
  const std::uint64_t part =
      std::clamp<std::uint64_t>(kTicksOfAll / simulations_.size(), kMinTicks, kMaxTicks);
  Faults faults(simulations_.size());
  do {
    const std::uint64_t next = std::min(ticks, part);
    forEach(faults, [&](std::size_t i) { advance(i, next); });
    ticks -= next;
  } while (ticks > 0 && (!keep_stepping || keep_stepping()));
  report(faults);
}

void SimulationBatch::observe() {
  Faults faults(simulations_.size());
  forEach(faults, [this](std::size_t i) { observers_[i].read(&observations_[i * row_size_]); });
  report(faults);
}

void SimulationBatch::replace(std::size_t number, Simulation& simulation) {
  if (number >= simulations_.size()) {
    throw std::invalid_argument("There is no world " + std::to_string(number) + "; the batch has " +
                                std::to_string(simulations_.size()) + ".");
  }
  const auto present = std::find(simulations_.begin(), simulations_.end(), &simulation);
  if (present != simulations_.end()) {
    throw std::invalid_argument("This simulation is already world " +
                                std::to_string(present - simulations_.begin()) + " of the batch.");
  }
  observers_[number] = Observer(simulation, observers_[number].names());
  simulations_[number] = &simulation;
  observers_[number].read(&observations_[number * row_size_]);
}

}  // namespace franka_sim
