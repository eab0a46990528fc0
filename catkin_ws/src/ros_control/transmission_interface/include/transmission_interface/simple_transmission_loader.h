// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/simple_transmission.h>
#include <transmission_interface/transmission_loader.h>

namespace transmission_interface {

/// Creates a SimpleTransmission. The actuator has a `<mechanicalReduction>`, the joint optionally
/// an `<offset>` [rad] or [m].
class SimpleTransmissionLoader : public TransmissionLoader {
 public:
  TransmissionSharedPtr load(const TransmissionInfo& transmission_info) override;
};

}  // namespace transmission_interface
