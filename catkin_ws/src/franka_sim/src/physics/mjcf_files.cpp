// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf_files.h"

#include <cstdlib>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "physics/xml_util.h"

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

}  // namespace franka_sim::physics
