// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/xml_util.h"

#include <franka_core/numbers.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace franka_sim::physics {

std::string toText(const double* values, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    char buffer[40];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, values[i]);
    if (i > 0) {
      text += ' ';
    }
    text.append(buffer, end.ptr);
  }
  return text;
}

std::string toText(std::initializer_list<double> values) {
  return toText(values.begin(), values.size());
}

std::string toText(const Eigen::Vector3d& vector) { return toText(vector.data(), 3); }

std::string toText(const Eigen::Quaterniond& quaternion) {
  return toText({quaternion.w(), quaternion.x(), quaternion.y(), quaternion.z()});
}

std::vector<double> toNumbers(const std::string& text, const std::string& where) {
  constexpr const char* kBlanks = " \t\r\n";
  std::vector<double> values;
  std::size_t begin = text.find_first_not_of(kBlanks);
  while (begin != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::optional<double> value = franka_core::readNumber(word);
    if (!value) {
      throw std::runtime_error(where + ": '" + word + "' is not a finite number.");
    }
    values.push_back(*value);
    begin = text.find_first_not_of(kBlanks, end);
  }
  return values;
}

std::vector<double> numbers(const tinyxml2::XMLElement& element, const char* attribute,
                            const std::vector<double>& fallback, const std::string& where) {
  const char* text = element.Attribute(attribute);
  if (text == nullptr) {
    return fallback;
  }
  std::vector<double> values = toNumbers(text, where + ", attribute '" + attribute + "'");
  if (values.size() != fallback.size()) {
    throw std::runtime_error(where + ": attribute '" + attribute + "' of <" + element.Name() +
                             "> needs " + std::to_string(fallback.size()) + " numbers and has " +
                             std::to_string(values.size()) + ".");
  }
  return values;
}

double number(const tinyxml2::XMLElement& element, const char* attribute,
              const std::string& where) {
  required(element, attribute, where);
  return numbers(element, attribute, {0.0}, where)[0];
}

std::string required(const tinyxml2::XMLElement& element, const char* attribute,
                     const std::string& where) {
  std::string text = optional(element, attribute);
  if (text.empty()) {
    const int line = element.GetLineNum();  // 0 for a copied element
    throw std::runtime_error(where + ": <" + element.Name() + ">" +
                             (line > 0 ? " in line " + std::to_string(line) : "") +
                             " needs the attribute '" + attribute + "'.");
  }
  return text;
}

std::string optional(const tinyxml2::XMLElement& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  return text == nullptr ? std::string() : std::string(text);
}

std::string childText(const tinyxml2::XMLElement& element, const char* name) {
  const tinyxml2::XMLElement* child = element.FirstChildElement(name);
  return child != nullptr && child->GetText() != nullptr ? child->GetText() : "";
}

bool isTrue(const tinyxml2::XMLElement& element, const char* name, bool fallback) {
  const std::string text = childText(element, name);
  return text.empty() ? fallback : text == "true" || text == "True" || text == "1";
}

std::vector<double> childNumbers(const tinyxml2::XMLElement& element, const char* name,
                                 const std::vector<double>& fallback, const std::string& where) {
  const std::string text = childText(element, name);
  if (text.empty()) {
    return fallback;
  }
  std::vector<double> values = toNumbers(text, where + ", <" + name + ">");
  if (values.size() != fallback.size()) {
    throw std::runtime_error(where + ": <" + name + "> needs " + std::to_string(fallback.size()) +
                             " numbers and has " + std::to_string(values.size()) + ".");
  }
  return values;
}

void noteUnknown(const tinyxml2::XMLElement& element, const std::string& what,
                 std::initializer_list<const char*> known, std::set<std::string>* notes) {
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string name = child->Name();
    const bool is_foreign = name.find(':') != std::string::npos && name != "experimental:params";
    if (!is_foreign && std::find(known.begin(), known.end(), name) == known.end()) {
      notes->insert("<" + name + "> of " + what);
    }
  }
}

tinyxml2::XMLElement* append(tinyxml2::XMLNode* parent, const char* name) {
  tinyxml2::XMLElement* element = parent->GetDocument()->NewElement(name);
  parent->InsertEndChild(element);
  return element;
}

void setPose(tinyxml2::XMLElement* element, const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d position = pose.translation();
  if (position != Eigen::Vector3d::Zero()) {
    element->SetAttribute("pos", toText(position).c_str());
  }
  if (pose.linear() != Eigen::Matrix3d::Identity()) {
    element->SetAttribute("quat", toText(Eigen::Quaterniond(pose.linear()).normalized()).c_str());
  }
}

std::string rootName(const std::string& text) {
  std::size_t at = 0;
  while ((at = text.find('<', at)) != std::string::npos) {
    if (text.compare(at, 4, "<!--") == 0) {
      at = text.find("-->", at);
    } else if (text[at + 1] != '?' && text[at + 1] != '!') {
      const std::size_t end = text.find_first_of(" \t\r\n/>", at);
      return text.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    }
    at = at == std::string::npos ? at : at + 1;
  }
  return "";
}

std::string toText(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace franka_sim::physics
