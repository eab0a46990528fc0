// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/sdf/sdf_text.h"

#include <franka_core/numbers.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XML_SUCCESS;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

/// Limit for models that include each other.
constexpr int kMaxElementDepth = 32;

constexpr const char* kSun = R"(<sdf version="1.6"><light name="sun" type="directional">
  <pose>1 -1.5 4 0 0 0</pose><direction>-0.3 0.45 -1</direction><cast_shadows>true</cast_shadows>
  <diffuse>0.5 0.5 0.48 1</diffuse><specular>0.15 0.15 0.15 1</specular></light></sdf>)";

constexpr const char* kGroundPlane =
    R"(<sdf version="1.6"><model name="ground_plane"><static>true</static>
  <link name="link">
    <collision name="collision">
      <geometry><plane><normal>0 0 1</normal><size>20 20</size></plane></geometry>
      <surface><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface>
    </collision>
    <visual name="visual">
      <geometry><plane><normal>0 0 1</normal><size>20 20</size></plane></geometry>
      <material><diffuse>0.79 0.8 0.81 1</diffuse></material>
    </visual>
  </link></model></sdf>)";

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
void parse(const std::string& text, const std::string& title, XMLDocument* document) {
  const auto reads = [document](const std::string& xml) {
    return document->Parse(xml.c_str(), xml.size()) == XML_SUCCESS &&
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

/// Applies the children of an <include> to the included model.
void takeOver(const XMLElement& include, XMLElement* model) {
  if (!childText(include, "name").empty()) {
    model->SetAttribute("name", childText(include, "name").c_str());
  }
  if (include.BoolAttribute("merge")) {
    model->SetAttribute("merge", true);
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

/// N of the version "1.N".
std::optional<std::int64_t> minorVersion(const std::string& version) {
  const std::optional<double> minor = franka_core::readNumber(after("1.", version));
  return minor ? franka_core::wholeNumber(*minor, 0, 99) : std::nullopt;
}

class Expander {
 public:
  Expander(const SdfFiles& files, const std::string& title, std::set<std::string>* notes)
      : files_(files), title_(title), notes_(notes) {}

  /// @param folder of the text, for relative names in it; empty: the main text's.
  void expand(XMLDocument* document, const std::string& folder, int depth) {
    XMLElement* root = document->RootElement();
    if (root == nullptr) {
      throw std::runtime_error(title_ + ": an included text is empty.");
    }
    translate(root, versionOf(*root), folder);
    include(root, folder, depth);
  }

 private:
  std::int64_t versionOf(const XMLElement& root) const {
    const std::string text = optional(root, "version");
    const std::optional<std::int64_t> version = minorVersion(text);
    if (version.value_or(0) < 2) {
      throw std::runtime_error(title_ + ": the version of <" + root.Name() + "> is '" + text +
                               "'; it must be 1.2 or newer, for example '1.6'.");
    }
    return *version;
  }

  /// Translates into the terms of SDF 1.9, and files into absolute paths. Checks
  /// truth values.
  void translate(XMLElement* element, std::int64_t version, const std::string& folder) const {
    const std::string name = element->Name();
    if (name == "pose" && version < 7 && !optional(*element, "frame").empty()) {
      element->SetAttribute("relative_to", optional(*element, "frame").c_str());
    } else if ((name == "axis" || name == "axis2") && version < 7) {
      XMLElement* xyz = element->FirstChildElement("xyz");
      if (xyz != nullptr && (version < 5 || isTrue(*element, "use_parent_model_frame"))) {
        xyz->SetAttribute("expressed_in", "__model__");
      }
    } else if (name == "mesh" && element->FirstChildElement("uri") != nullptr) {
      const std::string found = files_.find(childText(*element, "uri"), folder);
      if (!found.empty()) {
        element->FirstChildElement("uri")->SetText(found.c_str());
      }
    } else if (name == "world" && version < 6) {
      XMLElement* physics = element->FirstChildElement("physics");
      XMLElement* gravity = physics == nullptr ? nullptr : physics->FirstChildElement("gravity");
      if (gravity != nullptr) {
        element->InsertFirstChild(gravity);
      }
    } else if (name == "static" || name == "self_collide" || name == "kinematic" ||
               name == "enable_wind" || name == "use_parent_model_frame") {
      bool is_true = false;
      if (element->GetText() != nullptr && element->QueryBoolText(&is_true) != XML_SUCCESS) {
        throw std::runtime_error(title_ + ": <" + name + "> is '" + element->GetText() +
                                 "'; it must be true or false.");
      }
      element->SetText(is_true);
    } else if (name == "plugin") {
      return;
    }
    for (auto* child = element->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      translate(child, version, folder);
    }
  }

  void include(XMLElement* parent, const std::string& folder, int depth) {
    XMLElement* next = nullptr;
    for (auto* child = parent->FirstChildElement(); child != nullptr; child = next) {
      next = child->NextSiblingElement();
      if (std::string(child->Name()) == "include") {
        if (XMLElement* content = included(*child, parent->GetDocument(), folder, depth)) {
          parent->InsertAfterChild(child, content);
        }
        parent->DeleteChild(child);
      } else if (std::string(child->Name()) == "world" || std::string(child->Name()) == "model") {
        include(child, folder, depth);
      }
    }
  }

  /// The model (or light, or actor) that replaces an <include>; none for a URDF.
  XMLElement* included(const XMLElement& include, XMLDocument* into, const std::string& folder,
                       int depth) {
    const std::string uri = childText(include, "uri");
    const std::string what = "the <include> of '" + uri + "'";
    if (depth >= kMaxElementDepth) {
      throw std::runtime_error(title_ + ": models include each other without end, at '" + uri +
                               "'.");
    }
    noteUnknown(include, what, {"uri", "name", "pose", "static", "placement_frame", "plugin"},
                notes_);
    if (include.BoolAttribute("merge") && include.Parent()->Value() != std::string("model")) {
      notes_->insert("merge='true' of " + what);
    }
    const char* const standard = uri == "model://sun"            ? kSun
                                 : uri == "model://ground_plane" ? kGroundPlane
                                                                 : nullptr;
    const bool is_standard = standard != nullptr && files_.find(uri, folder).empty();
    const std::string file = is_standard ? std::string() : fileOf(uri, folder);
    XMLDocument document(true, tinyxml2::COLLAPSE_WHITESPACE);
    if (is_standard) {
      document.Parse(standard);
    } else if (document.LoadFile(file.c_str()) != XML_SUCCESS) {
      throw std::runtime_error(title_ + ": the included file " + file +
                               " cannot be read: " + document.ErrorStr());
    }
    if (document.FirstChildElement("robot") != nullptr) {
      notes_->insert(what + " (" + file + " is a URDF)");
      return nullptr;
    }
    expand(&document, folderOf(file), depth + 1);
    XMLElement* content = nullptr;
    for (const char* kind : {"model", "light", "actor"}) {
      content = content == nullptr ? document.RootElement()->FirstChildElement(kind) : content;
    }
    if (content == nullptr) {
      throw std::runtime_error(title_ + ": there is no <model> in the included file " + file + ".");
    }
    takeOver(include, content);
    return content->DeepClone(into)->ToElement();
  }

  std::string fileOf(const std::string& uri, const std::string& folder) const {
    const std::string found = uri.empty() ? uri : files_.find(uri, folder);
    if (found.empty()) {
      throw std::runtime_error(
          title_ + ": the included model '" + uri +
          "' was not found. Its folder must be beside the world or in GAZEBO_MODEL_PATH.");
    }
    return fs::is_directory(found) ? fileOfModel(found) : found;
  }

  /// The file of the newest SDF version in model.config.
  std::string fileOfModel(const fs::path& folder) const {
    XMLDocument config(true, tinyxml2::COLLAPSE_WHITESPACE);
    std::string file = "model.sdf";
    std::int64_t newest = 0;
    if (config.LoadFile((folder / "model.config").c_str()) == XML_SUCCESS &&
        config.RootElement() != nullptr) {
      for (auto* sdf = config.RootElement()->FirstChildElement("sdf"); sdf != nullptr;
           sdf = sdf->NextSiblingElement("sdf")) {
        const std::int64_t version = minorVersion(optional(*sdf, "version")).value_or(0);
        if (version >= newest && sdf->GetText() != nullptr) {
          newest = version;
          file = sdf->GetText();
        }
      }
    }
    if (!fs::exists(folder / file)) {
      throw std::runtime_error(title_ + ": the model's folder " + folder.string() + " holds no " +
                               file + ".");
    }
    return (folder / file).string();
  }

  const SdfFiles& files_;
  const std::string& title_;
  std::set<std::string>* notes_;
};

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

void expandSdf(const std::string& text, const SdfFiles& files, const std::string& title,
               const std::string& model_name, XMLDocument* document, std::set<std::string>* notes) {
  parse(text, title, document);
  XMLElement* model = document->RootElement()->FirstChildElement("model");
  if (model != nullptr && !model_name.empty()) {
    model->SetAttribute("name", model_name.c_str());
  }
  Expander(files, title, notes).expand(document, "", 0);
}

}  // namespace franka_sim::physics
