// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/serve/command_table.h>

#include <array>
#include <exception>
#include <sstream>
#include <stdexcept>

#include "serve/json_writer.h"

namespace franka_sim::fci {

namespace {

std::vector<std::string> split(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

std::string firstWord(const std::string& name) { return name.substr(0, name.find(' ')); }

// The second word of a name; empty without one.
std::string secondWord(const std::string& name) {
  const std::size_t blank = name.find(' ');
  return blank == std::string::npos ? "" : name.substr(blank + 1);
}

std::size_t wordsOfName(const OperatorCommand& command) {
  return secondWord(command.name).empty() ? 1 : 2;
}

// Number of words that follow the name, with or without the optional argument.
std::size_t wordsOfArguments(const OperatorCommand& command, bool with_optional) {
  std::size_t count = 0;
  for (const Argument& argument : command.arguments) {
    count += argument.optional && !with_optional ? 0 : argument.count;
  }
  return count;
}

bool hasCount(const OperatorCommand& command, std::size_t words) {
  return words == wordsOfName(command) + wordsOfArguments(command, false) ||
         words == wordsOfName(command) + wordsOfArguments(command, true);
}

std::string usageOf(const std::vector<const OperatorCommand*>& commands) {
  std::string text;
  for (const OperatorCommand* command : commands) {
    text += (text.empty() ? "" : "; ") + command->usage();
  }
  return text;
}

ArgumentWords wordsByArgument(const OperatorCommand& command,
                              const std::vector<std::string>& words) {
  std::size_t next = wordsOfName(command);
  const bool with_optional = words.size() - next == wordsOfArguments(command, true);
  ArgumentWords found;
  for (const Argument& argument : command.arguments) {
    const bool given = !argument.optional || with_optional;
    found.push_back(given ? &words[next] : nullptr);
    next += given ? argument.count : 0;
  }
  return found;
}

Reply error(const std::string& sentence) {
  return Reply([sentence]() -> std::optional<std::string> { throw std::runtime_error(sentence); });
}

void writeArgument(const Argument& argument, JsonWriter& json) {
  constexpr std::array<const char*, 4> kKinds{"choice", "number", "integer", "text"};
  json.beginObject().member("words", argument.words);
  json.member("kind", kKinds[static_cast<std::size_t>(argument.kind)]);
  json.member("count", argument.count).member("optional", argument.optional);
  if (argument.kind == Argument::Kind::kChoice) {
    json.member("choices", argument.choices);
  } else if (argument.kind == Argument::Kind::kInteger) {
    json.member("min", argument.first).member("max", argument.last);
  } else if (argument.kind == Argument::Kind::kNumber) {
    json.member("unit", argument.unit).member("min", argument.min).member("max", argument.max);
  }
  json.endObject();
}

}  // namespace

std::string OperatorCommand::usage() const {
  std::string text = name;
  for (const Argument& argument : arguments) {
    text += " " + argument.usage();
  }
  return text;
}

// The row of a line. @throws std::invalid_argument with a sentence
const OperatorCommand& CommandTable::find(const std::vector<std::string>& words) const {
  std::vector<const OperatorCommand*> all, named, plain;
  for (const OperatorCommand& command : commands_) {
    if (firstWord(command.name) != words.front()) {
      continue;
    }
    const std::string second = secondWord(command.name);
    all.push_back(&command);
    if (second.empty()) {
      plain.push_back(&command);
    } else if (words.size() > 1 && words[1] == second) {
      named.push_back(&command);
    }
  }
  if (all.empty()) {
    throw std::invalid_argument("There is no command '" + words.front() + "'; help lists them.");
  }
  for (const OperatorCommand* command : named.empty() ? plain : named) {
    if (hasCount(*command, words.size())) {
      return *command;
    }
  }
  throw std::invalid_argument("This line is written: " + usageOf(named.empty() ? all : named) +
                              ".");
}

std::string OperatorCommand::explanation() const {
  std::string ranges;
  for (const Argument& argument : arguments) {
    const std::string range = argument.range();
    ranges += (ranges.empty() || range.empty() ? "" : ", ") + range;
  }
  return help + (ranges.empty() ? "" : " (" + ranges + ")");
}

Reply CommandTable::execute(const std::string& line) const {
  try {
    const std::vector<std::string> words = split(line);
    if (words.empty() || words.front() == "help") {
      return help(words);
    }
    const OperatorCommand& command = find(words);
    return command.handler(wordsByArgument(command, words));
  } catch (const std::exception& failure) {
    return error(failure.what());
  } catch (...) {
    return error("The command failed with an unknown error.");
  }
}

bool CommandTable::isReady(const std::string& line) const {
  const std::vector<std::string> words = split(line);
  if (words.empty() || words.front() == "help") {
    return true;
  }
  try {
    const OperatorCommand& command = find(words);
    return !command.ready || command.ready();
  } catch (const std::invalid_argument&) {
    return true;
  }
}

Reply CommandTable::help(const std::vector<std::string>& words) const {
  if (words.size() > 1 && words[1] == "json") {
    return json();
  }
  std::string text;
  for (const OperatorCommand& command : commands_) {
    if (words.size() < 2) {
      text += (text.empty() ? "" : "; ") + command.usage();
    } else if (words[1] == firstWord(command.name)) {
      text += (text.empty() ? "" : "; ") + command.usage() + ": " + command.explanation();
    }
  }
  if (text.empty() && words.size() > 1) {
    return error("There is no command '" + words[1] + "'; help lists them.");
  }
  return text;
}

std::string CommandTable::json() const {
  JsonWriter json;
  json.beginArray();
  for (const OperatorCommand& command : commands_) {
    json.beginObject().member("name", command.name).key("arguments").beginArray();
    for (const Argument& argument : command.arguments) {
      writeArgument(argument, json);
    }
    json.endArray().member("page", command.permission.page);
    json.member("control", command.permission.control);
    json.member("urgent", command.permission.urgent);
    json.member("help", command.explanation()).member("usage", command.usage()).endObject();
  }
  return json.endArray().text();
}

}  // namespace franka_sim::fci
