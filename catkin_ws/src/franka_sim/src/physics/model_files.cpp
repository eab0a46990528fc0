// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/model_files.h"

#include <franka_core/fnv_hash.h>
#include <tinyxml2.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "physics/xml_util.h"

namespace franka_sim::physics {
namespace {

/// An absolute path below which no real file can exist.
constexpr const char* kPlace = "/dev/null/";

/// Texts are passed between threads (stepping, drawing) and outlive their worlds, so the files must
/// too.
struct Store {
  std::mutex mutex;
  std::map<std::string, std::string> files;
};

Store& store() {
  static Store store;
  return store;
}

std::uint64_t hashOf(const std::string& content) {
  franka_core::FnvHash hash;
  for (const char c : content) {
    hash.addByte(static_cast<std::uint8_t>(c));
  }
  return hash.value();
}

std::set<std::string> namedIn(const std::string& text) {
  std::set<std::string> names;
  for (std::size_t at = text.find(kPlace); at != std::string::npos; at = text.find(kPlace, at)) {
    const std::size_t end = text.find_first_of("\"'", at);
    names.insert(text.substr(at, end - at));
    at = end;
  }
  return names;
}

}  // namespace

std::string registerFile(const std::string& content, const std::string& extension) {
  Store& kept = store();
  const std::lock_guard<std::mutex> lock(kept.mutex);
  for (std::uint64_t hash = hashOf(content);; ++hash) {
    char number[17];
    std::snprintf(number, sizeof number, "%016llx", static_cast<unsigned long long>(hash));
    const auto [entry, is_new] = kept.files.emplace(kPlace + (number + extension), content);
    if (is_new || entry->second == content) {
      return entry->first;
    }
  }
}

void addRegisteredFiles(const std::string& mjcf, mjVFS* files) {
  Store& kept = store();
  const std::lock_guard<std::mutex> lock(kept.mutex);
  for (const std::string& name : namedIn(mjcf)) {
    const auto found = kept.files.find(name);
    if (found == kept.files.end()) {
      continue;  // MuJoCo reports the missing file
    }
    const std::string& content = found->second;
    if (mj_makeEmptyFileVFS(files, name.c_str(), static_cast<int>(content.size())) != 0) {
      throw std::runtime_error("its meshes are more than " + std::to_string(mjMAXVFS - 1) +
                               " or there is not enough memory for them.");
    }
    std::memcpy(files->filedata[mj_findFileVFS(files, name.c_str())], content.data(),
                content.size());
  }
}

namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

constexpr const char* kSun = R"(<light name="sun" type="directional">
  <pose>1 -1.5 4 0 0 0</pose><direction>-0.3 0.45 -1</direction><cast_shadows>true</cast_shadows>
  <diffuse>0.5 0.5 0.48 1</diffuse><specular>0.15 0.15 0.15 1</specular></light>)";

constexpr const char* kGroundPlane = R"(<model name="ground_plane"><static>true</static>
  <link name="link">
    <collision name="collision">
      <geometry><plane><normal>0 0 1</normal><size>20 20</size></plane></geometry>
      <surface><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface>
    </collision>
    <visual name="visual">
      <geometry><plane><normal>0 0 1</normal><size>20 20</size></plane></geometry>
      <material><diffuse>0.79 0.8 0.81 1</diffuse></material>
    </visual>
  </link></model>)";

std::string ifThere(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) ? path.string() : std::string();
}

/// Text after a scheme, or empty if the URI has another scheme.
std::string after(const std::string& scheme, const std::string& uri) {
  return uri.compare(0, scheme.size(), scheme) == 0 ? uri.substr(scheme.size()) : std::string();
}

std::vector<std::string> searchedFolders() {
  std::vector<std::string> folders;
  for (const char* variable : {"GAZEBO_MODEL_PATH", "SDF_PATH", "GAZEBO_RESOURCE_PATH"}) {
    const char* value = std::getenv(variable);
    std::istringstream list(value != nullptr ? value : "");
    for (std::string folder; std::getline(list, folder, ':');) {
      if (!folder.empty()) {
        folders.push_back(folder);
      }
    }
  }
  return folders;
}

/// As Gazebo does, reads also a text that lacks its last end tag, and a model or world without
/// <sdf>.
void parse(const std::string& text, const std::string& title, tinyxml2::XMLDocument* document) {
  const auto reads = [document](const std::string& xml) {
    return document->Parse(xml.c_str(), xml.size()) == tinyxml2::XML_SUCCESS &&
           document->RootElement() != nullptr;
  };
  if (!reads(text)) {
    const std::string error = document->ErrorStr();
    if (!reads(text + "</" + rootName(text) + ">")) {
      throw std::runtime_error(title + ": it is not well-formed XML: " + error);
    }
  }
  XMLElement* root = document->RootElement();
  if (std::string(root->Name()) == "model" || std::string(root->Name()) == "world") {
    XMLElement* sdf = append(document, "sdf");
    sdf->SetAttribute("version", "1.6");
    sdf->InsertEndChild(root);
  }
}

}  // namespace

std::string SdfFiles::find(const std::string& uri, const std::string& folder) const {
  const fs::path here = folder.empty() ? folder_ : folder;
  std::string name = after("model://", uri);
  if (name.empty()) {
    std::string file = after("file://", uri);
    if (!file.empty() && !ifThere(file).empty()) {
      return file;
    }
    if (uri.find("://") != std::string::npos && file.empty()) {
      const std::string found = resolve_ ? resolve_(uri) : std::string();
      return found.empty() ? found : ifThere(found);
    }
    name = file.empty() ? uri : file;
    const std::string beside = ifThere(fs::path(name).is_absolute() ? fs::path(name) : here / name);
    if (!beside.empty()) {
      return beside;
    }
  }
  // A model is beside the world, beside the model that includes it, or where Gazebo looks.
  for (const fs::path& base : {here, here / "models", here.parent_path(), here / "..",
                               here / ".." / "models", fs::path(folder_) / ".." / "models"}) {
    const std::string found = ifThere(base / name);
    if (!found.empty()) {
      return found;
    }
  }
  for (const std::string& base : searchedFolders()) {
    const std::string found = ifThere(fs::path(base) / name);
    if (!found.empty()) {
      return found;
    }
  }
  // Packages export model folders, and offer their meshes as model://<package>/...
  for (const char* scheme : {"model://", "package://"}) {
    const std::string found = resolve_ ? resolve_(scheme + name) : std::string();
    if (!found.empty() && !ifThere(found).empty()) {
      return found;
    }
  }
  return "";
}

void takeOver(const XMLElement& include, XMLElement* model) {
  if (!childText(include, "name").empty()) {
    model->SetAttribute("name", childText(include, "name").c_str());
  }
  if (!childText(include, "placement_frame").empty()) {
    model->SetAttribute("placement_frame", childText(include, "placement_frame").c_str());
  }
  for (const char* name : {"pose", "static"}) {
    if (const XMLElement* override_element = include.FirstChildElement(name)) {
      if (XMLElement* own = model->FirstChildElement(name)) {
        model->DeleteChild(own);
      }
      model->InsertFirstChild(override_element->DeepClone(model->GetDocument()));
    }
  }
  for (auto* plugin = include.FirstChildElement("plugin"); plugin != nullptr;
       plugin = plugin->NextSiblingElement("plugin")) {
    model->InsertEndChild(plugin->DeepClone(model->GetDocument()));
  }
}

std::string withStandardModels(const std::string& text, const SdfFiles& files,
                               const std::string& title, const std::string& model_name) {
  tinyxml2::XMLDocument document;
  parse(text, title, &document);
  XMLElement* model = document.RootElement()->FirstChildElement("model");
  if (model != nullptr && !model_name.empty()) {
    model->SetAttribute("name", model_name.c_str());
  }
  for (auto* world = document.RootElement()->FirstChildElement("world"); world != nullptr;
       world = world->NextSiblingElement("world")) {
    XMLElement* next = nullptr;
    for (auto* include = world->FirstChildElement("include"); include != nullptr; include = next) {
      next = include->NextSiblingElement("include");
      const std::string uri = childText(*include, "uri");
      const bool sun = uri == "model://sun";
      if ((!sun && uri != "model://ground_plane") || !files.find(uri).empty()) {
        continue;
      }
      tinyxml2::XMLDocument standard;
      standard.Parse(sun ? kSun : kGroundPlane);
      takeOver(*include, standard.RootElement());
      world->InsertAfterChild(include, standard.RootElement()->DeepClone(&document));
      world->DeleteChild(include);
    }
  }
  return toText(document);
}

}  // namespace franka_sim::physics
