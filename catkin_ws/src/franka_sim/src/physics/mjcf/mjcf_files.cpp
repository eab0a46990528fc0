// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/mjcf_files.h"

#include <franka_core/numbers.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;
using tinyxml2::XMLNode;

std::string inFolder(const std::string& folder, const std::string& path) {
  return path.empty() || path[0] == '/' ? path : folder + path;
}

std::string withSlash(std::string folder) {
  if (!folder.empty() && folder.back() != '/') {
    folder += '/';
  }
  return folder;
}

void loadFile(const std::string& file, const std::string& title, XMLDocument* document) {
  const tinyxml2::XMLError result = document->LoadFile(file.c_str());
  if (result == tinyxml2::XML_ERROR_FILE_NOT_FOUND ||
      result == tinyxml2::XML_ERROR_FILE_COULD_NOT_BE_OPENED) {
    throw std::runtime_error(title + ": the file " + file + " cannot be opened.");
  }
  if (result != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(title + ": " + file +
                             " is not well-formed XML: " + document->ErrorStr());
  }
}

/// Expands below `parent`. Like MuJoCo, reads each file once and relative to the main file.
void expand(XMLElement* parent, const std::string& folder, const std::string& title,
            std::set<std::string>* seen) {
  XMLElement* element = parent->FirstChildElement();
  while (element != nullptr) {
    XMLElement* const next = element->NextSiblingElement();
    if (std::string(element->Name()) != "include") {
      expand(element, folder, title, seen);
      element = next;
      continue;
    }
    const std::string file = inFolder(folder, required(*element, "file", title));
    if (!seen->insert(file).second) {
      throw std::runtime_error(title + ": " + file + " is included twice.");
    }
    XMLDocument included;
    loadFile(file, title, &included);
    if (included.RootElement() == nullptr) {
      throw std::runtime_error(title + ": the included file " + file + " is empty.");
    }
    expand(included.RootElement(), folder, title, seen);
    XMLNode* last = element;
    for (const XMLNode* child = included.RootElement()->FirstChild(); child != nullptr;
         child = child->NextSibling()) {
      last = parent->InsertAfterChild(last, child->DeepClone(parent->GetDocument()));
    }
    parent->DeleteChild(element);
    element = next;
  }
}

/// Returns the last value of a compiler attribute and removes the attribute.
std::string takeCompiler(XMLElement* root, const char* attribute) {
  std::string value;
  for (auto* e = root->FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler")) {
    if (e->Attribute(attribute) != nullptr) {
      value = optional(*e, attribute);
      e->DeleteAttribute(attribute);
    }
  }
  return value;
}

}  // namespace

std::string folderOf(const std::string& file) {
  const std::unique_ptr<char, decltype(&std::free)> absolute(::realpath(file.c_str(), nullptr),
                                                             &std::free);
  const std::string path = absolute ? absolute.get() : file;
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
}

void loadExpanded(const std::string& file, const std::string& title, XMLDocument* document) {
  loadFile(file, title, document);
  if (document->RootElement() != nullptr) {
    std::set<std::string> seen{file};
    expand(document->RootElement(), folderOf(file), title, &seen);
  }
}

void makeFilesAbsolute(XMLElement* root, const std::string& folder) {
  const std::string meshes = inFolder(folder, withSlash(takeCompiler(root, "meshdir")));
  const std::string textures = inFolder(folder, withSlash(takeCompiler(root, "texturedir")));
  for (auto* assets = root->FirstChildElement("asset"); assets != nullptr;
       assets = assets->NextSiblingElement("asset")) {
    for (auto* e = assets->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string base = std::string(e->Name()) == "texture" ? textures : meshes;
      for (const char* attribute :
           {"file", "fileright", "fileup", "fileleft", "filedown", "filefront", "fileback"}) {
        const std::string path = optional(*e, attribute);
        if (!path.empty()) {
          e->SetAttribute(attribute, inFolder(base.empty() ? folder : base, path).c_str());
        }
      }
    }
  }
}

namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

/// Excess of the largest moment that is not worth a note: the last digits of a text.
constexpr double kUnnoticed = 1e-6;

/// Share of the largest moment by which it exceeds the sum of the others. @param moments ascending
double excessOf(const Eigen::Vector3d& moments) {
  return moments.z() > 0 ? 1 - (moments.x() + moments.y()) / moments.z() : 1;
}

bool isPossible(const Eigen::Vector3d& moments) {
  return moments.x() >= 0 && moments.x() + moments.y() >= moments.z();
}

/// Takes whether the last <compiler> that decides about `balanceinertia` sets it.
bool takeBalance(XMLElement* root) {
  bool balance = false;
  for (auto* e = root->FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler")) {
    if (e->Attribute("balanceinertia") != nullptr) {
      balance = optional(*e, "balanceinertia") == "true";
      e->DeleteAttribute("balanceinertia");
    }
  }
  return balance;
}

Eigen::Matrix3d writtenInertia(const XMLElement& inertial, const std::string& where) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  if (inertial.Attribute("fullinertia") != nullptr) {
    const auto m = numbers(inertial, "fullinertia", {0, 0, 0, 0, 0, 0}, where);
    matrix << m[0], m[3], m[4], m[3], m[1], m[5], m[4], m[5], m[2];
  } else {
    const auto m = numbers(inertial, "diaginertia", {0, 0, 0}, where);
    matrix.diagonal() << m[0], m[1], m[2];
  }
  return matrix;
}

void repair(XMLElement* inertial, const std::string& where, bool balance,
            std::set<std::string>* notes) {
  const Eigen::Matrix3d written = writtenInertia(*inertial, where);
  const Eigen::Vector3d moments = Solver(written).eigenvalues();
  if (isPossible(moments)) {
    return;
  }
  const Eigen::Matrix3d m = balance && moments.x() >= 0
                                ? Eigen::Matrix3d(Eigen::Matrix3d::Identity() * moments.mean())
                                : possibleInertia(written, where, notes);
  if (inertial->Attribute("fullinertia") != nullptr) {
    inertial->SetAttribute("fullinertia",
                           toText({m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}).c_str());
  } else {
    inertial->SetAttribute("diaginertia", toText({m(0, 0), m(1, 1), m(2, 2)}).c_str());
  }
}

void repairBelow(XMLElement* parent, const std::string& title, bool balance,
                 std::set<std::string>* notes) {
  for (auto* body = parent->FirstChildElement("body"); body != nullptr;
       body = body->NextSiblingElement("body")) {
    XMLElement* inertial = body->FirstChildElement("inertial");
    if (inertial != nullptr && (inertial->Attribute("diaginertia") != nullptr ||
                                inertial->Attribute("fullinertia") != nullptr)) {
      repair(inertial,
             title + ", body '" + optional(*body, "name") + "' in line " +
                 std::to_string(body->GetLineNum()),
             balance, notes);
    }
    repairBelow(body, title, balance, notes);
  }
}

}  // namespace

Eigen::Matrix3d possibleInertia(const Eigen::Matrix3d& inertia, const std::string& where,
                                std::set<std::string>* notes) {
  const Solver solver(inertia);
  Eigen::Vector3d moments = solver.eigenvalues();
  if (isPossible(moments)) {
    return inertia;
  }
  const double excess = excessOf(moments);
  if (!(excess <= kRoundedInertia)) {
    throw std::runtime_error(where + ": no body has this inertia: the principal moments " +
                             toText(moments) +
                             " must be positive and the largest at most the sum of the others.");
  }
  if (excess > kUnnoticed) {
    notes->insert("the inertia of " + where + " (its principal moments " + toText(moments) +
                  " miss those of a body by " + franka_core::fixedText(100 * excess, 2) +
                  " % and are moved to the nearest possible ones)");
  }
  moments = moments.cwiseMax(0.0);
  // A little less than the sum, which rounding of the rotated matrix must not exceed again.
  moments.z() = std::min(moments.z(), (moments.x() + moments.y()) * (1 - 1e-12));
  const Eigen::Matrix3d& axes = solver.eigenvectors();
  return axes * moments.asDiagonal() * axes.transpose();
}

void writeInertial(const UrdfInertial& inertial, XMLElement* body) {
  if (inertial.mass == 0) {
    return;
  }
  // Principal axes are computed here: MuJoCo's diagonalisation is accurate to 1e-8 only.
  const Solver solver(inertial.inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  XMLElement* element = append(body, "inertial");
  element->SetAttribute("pos", toText(inertial.com).c_str());
  element->SetAttribute("quat", toText(Eigen::Quaterniond(axes).normalized()).c_str());
  element->SetAttribute("mass", toText({inertial.mass}).c_str());
  element->SetAttribute("diaginertia", toText(Eigen::Vector3d(solver.eigenvalues())).c_str());
}

void repairInertias(XMLElement* root, const std::string& title, std::set<std::string>* notes) {
  const bool balance = takeBalance(root);
  for (auto* e = root->FirstChildElement("worldbody"); e != nullptr;
       e = e->NextSiblingElement("worldbody")) {
    repairBelow(e, title, balance, notes);
  }
}

}  // namespace franka_sim::physics
