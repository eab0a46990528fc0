// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "physics/mjcf_files.h"
#include "physics/sdf_text.h"
#include "physics/xml_util.h"

namespace franka_sim::physics {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

/// Limit for models that include each other.
constexpr int kMaxElementDepth = 32;

class Expander {
 public:
  Expander(const SdfFiles& files, const std::string& title) : files_(files), title_(title) {}

  /// @param folder of the text, for relative names in it; empty: the main text's.
  void expand(XMLDocument* document, const std::string& folder, int depth) {
    XMLElement* root = document->RootElement();
    if (root == nullptr) {
      throw std::runtime_error(title_ + ": the SDF text is empty.");
    }
    translate(root, versionOf(*root), folder);
    root->SetAttribute("version", toText({kSdfVersion}).c_str());
    include(root, folder, depth);
  }

 private:
  double versionOf(const XMLElement& root) const {
    const std::string where = title_ + ": version of <" + root.Name() + ">";
    const std::vector<double> version = toNumbers(optional(root, "version"), where);
    if (version.size() != 1) {
      throw std::runtime_error(where + ": it must be given, for example version='1.6'.");
    }
    return version[0];
  }

  /// Translates into the terms of kSdfVersion, and files into absolute paths.
  void translate(XMLElement* element, double version, const std::string& folder) const {
    const std::string name = element->Name();
    if (name == "pose" && version < 1.7 && !optional(*element, "frame").empty()) {
      element->SetAttribute("relative_to", optional(*element, "frame").c_str());
    } else if ((name == "axis" || name == "axis2") && version < 1.7) {
      XMLElement* xyz = element->FirstChildElement("xyz");
      if (xyz != nullptr && (version < 1.5 || isTrue(*element, "use_parent_model_frame"))) {
        xyz->SetAttribute("expressed_in", "__model__");
      }
    } else if (name == "mesh" && element->FirstChildElement("uri") != nullptr) {
      const std::string found = files_.find(childText(*element, "uri"), folder);
      if (!found.empty()) {
        element->FirstChildElement("uri")->SetText(found.c_str());
      }
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
        parent->InsertAfterChild(child, included(*child, parent->GetDocument(), folder, depth));
        parent->DeleteChild(child);
      } else if (std::string(child->Name()) == "world" || std::string(child->Name()) == "model") {
        include(child, folder, depth);
      }
    }
  }

  /// The model (or light, or actor) that replaces an <include>.
  XMLElement* included(const XMLElement& include, XMLDocument* into, const std::string& folder,
                       int depth) {
    const std::string uri = childText(include, "uri");
    if (depth >= kMaxElementDepth) {
      throw std::runtime_error(title_ + ": models include each other without end, at '" + uri +
                               "'.");
    }
    const std::string file = fileOf(uri, folder);
    XMLDocument document;
    if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) {
      throw std::runtime_error(title_ + ": the included file " + file +
                               " cannot be read: " + document.ErrorStr());
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
    return static_cast<XMLElement*>(content->DeepClone(into));
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
    XMLDocument config;
    std::string file = "model.sdf";
    double newest = 0;
    if (config.LoadFile((folder / "model.config").c_str()) == tinyxml2::XML_SUCCESS) {
      for (auto* sdf = config.RootElement()->FirstChildElement("sdf"); sdf != nullptr;
           sdf = sdf->NextSiblingElement("sdf")) {
        const double version = franka_core::readNumber(optional(*sdf, "version")).value_or(0.0);
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
};

}  // namespace

std::string expandByTinyXml(const std::string& text, const SdfFiles& files,
                            const std::string& title) {
  XMLDocument document;
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(title + ": it is not well-formed XML: " + document.ErrorStr());
  }
  Expander(files, title).expand(&document, "", 0);
  return toText(document);
}

}  // namespace franka_sim::physics
