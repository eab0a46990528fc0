// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/command_arguments.h>
#include <franka_sim/serve/reply.h>

#include <cstddef>
#include <functional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace franka_sim::fci {

/// Which user of Desk's page may send a line. Programs on the control interface may send all lines.
struct Permission {
  bool page{false};     ///< the page may send it
  bool control{false};  ///< only the user who has control of the robot
  bool urgent{false};   ///< other lines do not delay it
};
constexpr Permission kNotOnPage{};
constexpr Permission kControl{true, true, false};
constexpr Permission kUrgentControl{true, true, true};
/// Inputs by the operator at the robot: stops, buttons, pushes, faults.
constexpr Permission kInput{true, false, false};
constexpr Permission kUrgentInput{true, false, true};

/// A line of the control interface: its words, what it does and who may send it.
struct OperatorCommand {
  using Handler = std::function<Reply(const ArgumentWords& words)>;

  std::string name;                 ///< one or two words, such as "push" and "hand move"
  std::vector<Argument> arguments;  ///< at most one is optional
  std::string help;                 ///< what it does, in the words of docs/franka_sim.md
  Permission permission;
  Handler handler;
  std::function<bool()> ready;  ///< whether it can be executed now; empty: always

  /// As a user types it, for example "hand move WIDTH SPEED".
  std::string usage() const;
  /// The help, with units and ranges of the arguments.
  std::string explanation() const;
};

/// Name and arguments of a line whose handler gets values of these types.
template <typename... Values>
struct Line {
  std::string name;
  std::vector<Argument> arguments;
};
template <typename... Values>
Line<Values...> line(std::string name, Parameter<Values>... parameters) {
  return {std::move(name), {std::move(parameters.argument)...}};
}

/// The operator's commands: one row for each line of the control interface. From this table are
/// made the answers to lines, `help`, services of ROS (franka_sim_mujoco), what Desk's page may
/// send, and the table in docs/franka_sim.md:
///
///     table.add(line("place", text("BODY"), numbers<3>("X Y Z", "m")), "puts a free body there",
///               kNotOnPage, [&](const std::string& body, const std::array<double, 3>& position) {
///                 setBodyPose(world, body, {position, {}});
///               });
///
/// A line `help` lists all rows, `help NAME` explains one, `help json` is the table for programs.
/// Used by one thread. Not real-time safe.
class CommandTable {
 public:
  /// Adds a row; the reference is valid until the next one is added. Lines with the same first word
  /// differ in a second word of the name, or in the number of words.
  /// @param handler called with the values of the arguments; returns void, a text or a Reply.
  /// @throws (the handler) std::exception whose text becomes the error
  template <typename... Values, typename Handler>
  OperatorCommand& add(Line<Values...> line, std::string help, Permission permission,
                       Handler handler) {
    OperatorCommand::Handler call = [arguments = line.arguments,
                                     handler = std::move(handler)](const ArgumentWords& words) {
      return callWith<Values...>(handler, arguments, words, std::index_sequence_for<Values...>());
    };
    return commands_.emplace_back(OperatorCommand{std::move(line.name),
                                                  std::move(line.arguments),
                                                  std::move(help),
                                                  permission,
                                                  std::move(call),
                                                  {}});
  }

  /// Executes a line. Nothing is thrown: the reply has the error.
  Reply execute(const std::string& line) const;
  /// Whether it can be executed now; true for a line that is refused.
  bool isReady(const std::string& line) const;

 private:
  template <typename... Values, typename Handler, std::size_t... kIndex>
  static Reply callWith(const Handler& handler, const std::vector<Argument>& arguments,
                        const ArgumentWords& words, std::index_sequence<kIndex...> /*indices*/) {
    // Braces: read from left to right, so that the first wrong word is reported.
    const std::tuple<Values...> values{readArgument<Values>(arguments[kIndex], words[kIndex])...};
    if constexpr (std::is_void_v<decltype(std::apply(handler, values))>) {
      std::apply(handler, values);
      return "";
    } else {
      return std::apply(handler, values);
    }
  }

  const OperatorCommand& find(const std::vector<std::string>& words) const;
  Reply help(const std::vector<std::string>& words) const;
  std::string json() const;

  std::vector<OperatorCommand> commands_;  ///< in the order in which they are listed
};

}  // namespace franka_sim::fci
