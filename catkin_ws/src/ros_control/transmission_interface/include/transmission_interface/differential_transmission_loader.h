// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/detail/pair_transmission_loader.h>
#include <transmission_interface/differential_transmission.h>

namespace transmission_interface {

/// Creates a DifferentialTransmission; see PairTransmissionLoader for its elements. Both joints may
/// have the element `<ignoreTransmissionAbsoluteEncoder/>`.
class DifferentialTransmissionLoader : public internal::PairTransmissionLoader {
 public:
  TransmissionSharedPtr load(const TransmissionInfo& transmission_info) override;
};

}  // namespace transmission_interface
