// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <sdf/Console.hh>
#include <sdf/Element.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/Root.hh>
#include <stdexcept>

#include "physics/mjcf_files.h"
#include "physics/sdf_text.h"

namespace franka_sim::physics {
namespace {

/// Only sdformat knows the source file of an element.
void makeUrisAbsolute(const sdf::ElementPtr& element, const SdfFiles& files) {
  if (element->GetName() == "mesh" && element->HasElement("uri")) {
    const sdf::ElementPtr uri = element->GetElement("uri");
    const std::string file = element->FilePath();
    const bool is_file = !file.empty() && file.front() == '/';  // the main text has no file
    const std::string folder = is_file ? folderOf(file) : std::string();
    const std::string found = files.find(uri->Get<std::string>(), folder);
    if (!found.empty()) {
      uri->Set(found);
    }
  }
  for (auto child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    makeUrisAbsolute(child, files);
  }
}

}  // namespace

std::string expandSdf(const std::string& text, const SdfFiles& files, const std::string& title) {
  sdf::Console::Instance()->SetQuiet(true);
  sdf::ParserConfig config;
  config.SetFindCallback([&files](const std::string& uri) { return files.find(uri); });
  sdf::Root root;
  const sdf::Errors errors = root.LoadSdfString(text, config);
  for (const sdf::Error& error : errors) {
    // The reader of the expanded text repairs inertias that are only rounded.
    if (error.Code() != sdf::ErrorCode::LINK_INERTIA_INVALID) {
      throw std::runtime_error(title + ": " + error.Message());
    }
  }
  makeUrisAbsolute(root.Element(), files);
  return root.Element()->ToString("");
}

}  // namespace franka_sim::physics
