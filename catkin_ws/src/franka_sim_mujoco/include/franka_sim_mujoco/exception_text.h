// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xmlrpcpp/XmlRpcException.h>

#include <exception>
#include <string>

namespace franka_sim_mujoco {

/// Text of the exception that is being handled: call it in `catch (...)`. Exceptions of XmlRpc, as
/// other people's hardware throws for a parameter of the wrong type, do not derive from
/// std::exception.
inline std::string exceptionText() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (const XmlRpc::XmlRpcException& error) {
    return "a parameter has the wrong type: " + error.getMessage();
  } catch (...) {
    return "an exception of unknown type";
  }
}

}  // namespace franka_sim_mujoco
