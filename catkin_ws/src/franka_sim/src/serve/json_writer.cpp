// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/json_writer.h"

#include <cstdint>

namespace franka_sim::fci {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

bool isContinuation(std::string_view text, std::size_t at) {
  return at < text.size() && (static_cast<std::uint8_t>(text[at]) & 0xC0) == 0x80;
}

// Length of the UTF-8 sequence at the start of a text [bytes]; 0 if there is no valid one (RFC
// 3629, section 4: the second byte excludes overlong forms, surrogates and values beyond U+10FFFF).
std::size_t sequenceLength(std::string_view text) {
  const auto first = static_cast<std::uint8_t>(text[0]);
  if (first < 0x80) {
    return 1;
  }
  if (first < 0xC2 || first > 0xF4 || !isContinuation(text, 1)) {
    return 0;
  }
  const auto second = static_cast<std::uint8_t>(text[1]);
  const bool excluded = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
                        (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
  const std::size_t length = first < 0xE0 ? 2 : (first < 0xF0 ? 3 : 4);
  for (std::size_t i = 2; i < length; i++) {
    if (!isContinuation(text, i)) {
      return 0;
    }
  }
  return excluded ? 0 : length;
}

std::string escaped(char character) {
  constexpr std::string_view kHex = "0123456789abcdef";
  if (character == '"' || character == '\\') {
    return std::string("\\") + character;
  }
  const auto code = static_cast<std::uint8_t>(character);
  return std::string("\\u00") + kHex[code >> 4] + kHex[code & 0xF];
}

bool needsEscape(char character) {
  return character == '"' || character == '\\' || static_cast<std::uint8_t>(character) < 0x20;
}

}  // namespace

JsonWriter& JsonWriter::key(std::string_view name) {
  appendText(name);
  text_ += ':';
  separated_ = true;
  return *this;
}

JsonWriter& JsonWriter::null() {
  append("null");
  return *this;
}

JsonWriter& JsonWriter::begin(char bracket) {
  separate();
  text_ += bracket;
  separated_ = true;
  return *this;
}

JsonWriter& JsonWriter::end(char bracket) {
  text_ += bracket;
  separated_ = false;
  return *this;
}

void JsonWriter::separate() {
  if (!separated_) {
    text_ += ',';
  }
  separated_ = false;
}

void JsonWriter::append(std::string_view word) {
  separate();
  text_ += word;
}

void JsonWriter::appendText(std::string_view text) {
  separate();
  text_ += '"';
  while (!text.empty()) {
    const std::size_t length = sequenceLength(text);
    if (length == 0) {
      text_ += kReplacement;
    } else if (needsEscape(text[0])) {
      text_ += escaped(text[0]);
    } else {
      text_ += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  text_ += '"';
}

}  // namespace franka_sim::fci
