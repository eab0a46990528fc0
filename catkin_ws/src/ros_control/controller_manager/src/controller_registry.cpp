// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/controller_registry.h>

#include <utility>

namespace controller_manager {
namespace internal {

ControllerList::ControllerList(std::vector<ControllerSpec> specs) : specs_(std::move(specs)) {
  controllers_.reserve(specs_.size());
  for (const ControllerSpec& spec : specs_) {
    controllers_.push_back(spec.c.get());
  }
}

const ControllerSpec* ControllerList::find(const std::string& name) const {
  for (const ControllerSpec& spec : specs_) {
    if (spec.info.name == name) {
      return &spec;
    }
  }
  return nullptr;
}

ControllerRegistry::ControllerRegistry(LoopGate& gate)
    : gate_(gate),
      current_(std::make_shared<const ControllerList>(std::vector<ControllerSpec>())),
      for_loop_(current_.get()) {}

ControllerListPtr ControllerRegistry::snapshot() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return current_;
}

void ControllerRegistry::replace(std::vector<ControllerSpec> specs) {
  auto next = std::make_shared<const ControllerList>(std::move(specs));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    outdated_.push_back(std::move(current_));
    current_ = std::move(next);
    for_loop_.store(current_.get(), std::memory_order_seq_cst);
  }
  if (gate_.waitUntilLeft(LoopGate::kMaxCycleTime)) {
    outdated_.clear();
  }
}

}  // namespace internal
}  // namespace controller_manager
