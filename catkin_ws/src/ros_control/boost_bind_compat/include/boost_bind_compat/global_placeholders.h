// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Declares boost::bind and its placeholders _1, _2, ... in the global namespace, as the ROS headers
// of ROS 1's own systems did. Debian's no longer do.
//
// A package that does not want the placeholders there compiles with BOOST_BIND_NO_PLACEHOLDERS.

// The macro keeps boost/bind.hpp from reporting that this use is deprecated. It is not left behind:
// code that defines it itself, later, gets no warning either.
#ifdef BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/bind.hpp>
#else
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/bind.hpp>
#undef BOOST_BIND_GLOBAL_PLACEHOLDERS
#endif
