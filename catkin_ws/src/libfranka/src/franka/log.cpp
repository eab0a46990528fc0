// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/log.h>

#include <limits>
#include <locale>
#include <sstream>

namespace franka {

namespace {

template <std::size_t kSize>
void writeNames(std::ostream& ostream, const char* name, const std::array<double, kSize>&) {
  for (std::size_t i = 0; i < kSize; i++) {
    ostream << "," << name << "[" << i << "]";
  }
}

template <std::size_t kSize>
void writeValues(std::ostream& ostream, const char*, const std::array<double, kSize>& values) {
  for (double value : values) {
    ostream << "," << value;
  }
}

// Defines the order of columns once, for header and lines.
template <typename Write>
void forEachColumn(const Record& record, Write write) {
  write("state.q", record.state.q);
  write("state.q_d", record.state.q_d);
  write("state.dq", record.state.dq);
  write("state.dq_d", record.state.dq_d);
  write("state.tau_J", record.state.tau_J);
  write("state.tau_ext_hat_filtered", record.state.tau_ext_hat_filtered);
  write("cmd.q_d", record.command.joint_positions.q);
  write("cmd.dq_d", record.command.joint_velocities.dq);
  write("cmd.O_T_EE_d", record.command.cartesian_pose.O_T_EE);
  write("cmd.O_dP_EE_d", record.command.cartesian_velocities.O_dP_EE);
  write("cmd.tau_J_d", record.command.torques.tau_J);
}

}  // namespace

std::string logToCSV(const std::vector<Record>& log) {
  if (log.empty()) {
    return "";
  }
  std::ostringstream csv;
  csv.imbue(std::locale::classic());
  // All digits: jerks can be computed from the positions.
  csv.precision(std::numeric_limits<double>::max_digits10);
  csv << "time,success_rate";
  forEachColumn(log.front(),
                [&csv](const char* name, const auto& values) { writeNames(csv, name, values); });
  csv << "\n";
  for (const Record& record : log) {
    csv << record.state.time.toMSec() << "," << record.state.control_command_success_rate;
    forEachColumn(record,
                  [&csv](const char* name, const auto& values) { writeValues(csv, name, values); });
    csv << "\n";
  }
  return csv.str();
}

}  // namespace franka
