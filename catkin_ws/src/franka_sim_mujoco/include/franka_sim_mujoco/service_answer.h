// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/exception_text.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>

namespace franka_sim_mujoco {

/// Sets a service's error message; some types have another field for it.
template <typename Response>
auto explain(Response& response, const std::string& text) -> decltype((void)response.error) {
  response.error = text;
}
template <typename Response>
auto explain(Response& response, const std::string& text)
    -> decltype((void)response.status_message) {
  response.status_message = text;
}
inline void explain(std_srvs::SetBool::Response& response, const std::string& text) {
  response.message = text;
}
inline void explain(std_srvs::Trigger::Response& response, const std::string& text) {
  response.message = text;
}

/// Runs a handler and sets the response: true, or only false and a sentence.
/// @param handler may throw an exception with a sentence for the user
/// @param report also receives that sentence, for the log
template <typename Response>
void answer(Response& response, const std::function<void()>& handler,
            const std::function<void(const char*)>& report) {
  try {
    handler();
    response.success = true;
  } catch (...) {
    const std::string sentence = exceptionText();
    report(sentence.c_str());
    response = Response();
    response.success = false;
    explain(response, sentence);
  }
}

}  // namespace franka_sim_mujoco
