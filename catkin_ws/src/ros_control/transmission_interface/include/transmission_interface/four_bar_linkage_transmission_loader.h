// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/detail/pair_transmission_loader.h>
#include <transmission_interface/four_bar_linkage_transmission.h>

namespace transmission_interface {

/// Creates a FourBarLinkageTransmission; see PairTransmissionLoader for its elements.
class FourBarLinkageTransmissionLoader : public internal::PairTransmissionLoader {
 public:
  TransmissionSharedPtr load(const TransmissionInfo& transmission_info) override;
};

}  // namespace transmission_interface
