// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Declares boost::bind and its placeholders _1, _2, ... in the global namespace, like the ROS
// headers of ROS 1's own systems. Debian's headers no longer do.
//
// A package that does not need the placeholders there compiles with BOOST_BIND_NO_PLACEHOLDERS.

// The macro disables boost/bind.hpp's deprecation warning for this use. It is undefined afterwards,
// so that code which defines it later gets no redefinition warning.
#ifdef BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/bind.hpp>
#else
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/bind.hpp>
#undef BOOST_BIND_GLOBAL_PLACEHOLDERS
#endif
