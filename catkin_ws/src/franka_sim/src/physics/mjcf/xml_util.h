// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <initializer_list>
#include <set>
#include <string>
#include <vector>

namespace franka_sim::physics {

/// Shortest text of numbers that reads back to the same doubles, separated by blanks.
std::string toText(const double* values, std::size_t count);
std::string toText(std::initializer_list<double> values);
std::string toText(const Eigen::Vector3d& vector);
/// w x y z, MuJoCo's order.
std::string toText(const Eigen::Quaterniond& quaternion);

/// Reads numbers separated by white space. Independent of the locale.
/// @throws std::runtime_error "<where>: ..." if one is not a finite number.
std::vector<double> toNumbers(const std::string& text, const std::string& where);

/// The attribute's numbers; `fallback` if the attribute is missing.
/// @throws std::runtime_error unless it has exactly `fallback.size()` finite numbers.
std::vector<double> numbers(const tinyxml2::XMLElement& element, const char* attribute,
                            const std::vector<double>& fallback, const std::string& where);
/// The attribute's number. @throws std::runtime_error if missing or not finite.
double number(const tinyxml2::XMLElement& element, const char* attribute, const std::string& where);
/// The attribute's text. @throws std::runtime_error if missing or empty.
std::string required(const tinyxml2::XMLElement& element, const char* attribute,
                     const std::string& where);
/// The attribute's text, empty if missing.
std::string optional(const tinyxml2::XMLElement& element, const char* attribute);

/// The text of a child element, empty if there is none.
std::string childText(const tinyxml2::XMLElement& element, const char* name);
/// Whether a child element contains true or 1; `fallback` if there is none.
bool isTrue(const tinyxml2::XMLElement& element, const char* name, bool fallback = false);
/// The numbers in a child element; `fallback` if there is none.
/// @throws std::runtime_error unless it has exactly `fallback.size()` finite numbers.
std::vector<double> childNumbers(const tinyxml2::XMLElement& element, const char* name,
                                 const std::vector<double>& fallback, const std::string& where);

/// Notes "<name> of <what>" for every child that is not `known`. Names with a prefix ("gz:x") are
/// for other programs and not noted, except parameters of an <include>.
void noteUnknown(const tinyxml2::XMLElement& element, const std::string& what,
                 std::initializer_list<const char*> known, std::set<std::string>* notes);

/// Appends a child element and returns it.
tinyxml2::XMLElement* append(tinyxml2::XMLNode* parent, const char* name);
/// Sets position and quaternion attributes, except identity values.
void setPose(tinyxml2::XMLElement* element, const Eigen::Isometry3d& pose);

/// The name of a text's root element, found without reading the rest; empty if there is none.
std::string rootName(const std::string& text);

/// Printed document.
std::string toText(const tinyxml2::XMLDocument& document);

}  // namespace franka_sim::physics
