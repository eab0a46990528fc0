// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>

namespace franka_sim::fci {

/// Writes one JSON value as text without line ends, in the order of the calls:
///
///     JsonWriter json;
///     json.beginObject().member("name", "panda").member("q", state.q);
///     json.key("hand").beginObject().member("homed", true).endObject();
///     json.endObject();
///     return json.text();  // {"name":"panda","q":[0,...],"hand":{"homed":true}}
///
/// Values: bool, numbers, texts, lists of values (array, vector, C array) and std::map with texts
/// as keys. A number has the fewest digits that read back as the same number; one that is not
/// finite is null. Bytes of a text that are not UTF-8 become U+FFFD. The caller closes what it
/// begins. Not real-time safe.
class JsonWriter {
 public:
  JsonWriter& beginObject() { return begin('{'); }
  JsonWriter& endObject() { return end('}'); }
  JsonWriter& beginArray() { return begin('['); }
  JsonWriter& endArray() { return end(']'); }
  /// Name of the next value, within an object.
  JsonWriter& key(std::string_view name);
  template <typename Value>
  JsonWriter& value(const Value& value);
  JsonWriter& null();
  template <typename Value>
  JsonWriter& member(std::string_view name, const Value& value) {
    return key(name).value(value);
  }

  const std::string& text() const noexcept { return text_; }

 private:
  JsonWriter& begin(char bracket);
  JsonWriter& end(char bracket);
  void separate();
  void append(std::string_view word);
  void appendText(std::string_view text);
  template <typename Number>
  void appendNumber(Number number);
  template <typename Value>
  void appendEach(const std::map<std::string, Value>& values);
  template <typename List>
  void appendEach(const List& values);

  std::string text_;
  bool separated_{true};  // the next value needs no comma before it
};

template <typename Number>
void JsonWriter::appendNumber(Number number) {
  char digits[32];
  append({digits, static_cast<std::size_t>(
                      std::to_chars(digits, digits + sizeof(digits), number).ptr - digits)});
}

template <typename Value>
void JsonWriter::appendEach(const std::map<std::string, Value>& values) {
  beginObject();
  for (const auto& [name, value] : values) {
    member(name, value);
  }
  endObject();
}

template <typename List>
void JsonWriter::appendEach(const List& values) {
  beginArray();
  for (const auto& value : values) {
    this->value(value);
  }
  endArray();
}

template <typename Value>
JsonWriter& JsonWriter::value(const Value& value) {
  if constexpr (std::is_convertible_v<const Value&, std::string_view>) {
    appendText(value);
  } else if constexpr (std::is_same_v<Value, bool>) {
    append(value ? "true" : "false");
  } else if constexpr (std::is_floating_point_v<Value>) {
    std::isfinite(value) ? appendNumber(value) : append("null");
  } else if constexpr (std::is_integral_v<Value>) {
    appendNumber(value);
  } else {
    appendEach(value);
  }
  return *this;
}

}  // namespace franka_sim::fci
