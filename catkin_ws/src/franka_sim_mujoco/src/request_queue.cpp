// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "request_queue.h"

#include <algorithm>
#include <stdexcept>

namespace franka_sim_mujoco {

constexpr std::chrono::milliseconds RequestQueue::kDefaultTimeout;

void RequestQueue::run(const std::function<void()>& work, std::chrono::milliseconds timeout) {
  if (std::this_thread::get_id() == server_.load()) {
    work();
    return;
  }
  auto job = std::make_shared<Job>();
  job->work = &work;
  std::unique_lock<std::mutex> lock(mutex_);
  if (closed_) {
    throw std::runtime_error("The simulation is shutting down.");
  }
  jobs_.push_back(job);
  has_jobs_.store(true, std::memory_order_release);
  work_arrived_.notify_one();
  work_done_.wait_for(lock, timeout, [&] { return job->phase != Phase::kWaiting; });
  if (job->phase == Phase::kWaiting) {
    jobs_.erase(std::find(jobs_.begin(), jobs_.end(), job));
    throw std::runtime_error("The simulation did not come to serve the request within " +
                             std::to_string(timeout.count()) +
                             " ms. It is busy, for example with an earlier request: try again.");
  }
  work_done_.wait(lock, [&] { return job->phase == Phase::kDone; });
  if (job->error) {
    std::rethrow_exception(job->error);
  }
}

void RequestQueue::adopt() { server_.store(std::this_thread::get_id()); }

void RequestQueue::serve() {
  if (!has_jobs_.load(std::memory_order_acquire)) {
    return;
  }
  const Clock::time_point end = now_() + kServingTime;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!jobs_.empty()) {
    auto job = jobs_.front();
    jobs_.pop_front();
    job->phase = Phase::kRunning;
    lock.unlock();
    std::exception_ptr error;
    try {
      (*job->work)();
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    job->error = error;
    job->phase = Phase::kDone;
    work_done_.notify_all();
    if (now_() >= end) {
      break;
    }
  }
  has_jobs_.store(!jobs_.empty(), std::memory_order_relaxed);
}

std::size_t RequestQueue::pending() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return jobs_.size();
}

void RequestQueue::waitForWork(std::chrono::milliseconds timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  work_arrived_.wait_for(lock, timeout, [this] { return closed_ || !jobs_.empty(); });
}

void RequestQueue::close() noexcept {
  std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  for (const auto& job : jobs_) {
    job->error = std::make_exception_ptr(std::runtime_error("The simulation is shutting down."));
    job->phase = Phase::kDone;
  }
  jobs_.clear();
  work_arrived_.notify_all();
  work_done_.notify_all();
}

}  // namespace franka_sim_mujoco
