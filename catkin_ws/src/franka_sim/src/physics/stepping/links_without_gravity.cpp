// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/stepping/links_without_gravity.h"

#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {

namespace {

constexpr char kEnding[] = "/without_gravity";

}  // namespace

void LinksWithoutGravity::write(const std::string& link, double mass, const Eigen::Vector3d& com,
                                tinyxml2::XMLElement* body) {
  if (mass <= 0) {
    return;
  }
  tinyxml2::XMLElement* site = append(body, "site");
  site->SetAttribute("name", (link + kEnding).c_str());
  site->SetAttribute("type", "sphere");
  site->SetAttribute("pos", toText(com).c_str());
  site->SetAttribute("size", toText({mass}).c_str());
  site->SetAttribute("group", 5);  // never drawn
}

bool LinksWithoutGravity::has(const mjModel& model, int body) {
  const char* link = mj_id2name(&model, mjOBJ_BODY, body);
  return link != nullptr &&
         mj_name2id(&model, mjOBJ_SITE, (std::string(link) + kEnding).c_str()) >= 0;
}

LinksWithoutGravity::LinksWithoutGravity(const mjModel& model) {
  const std::string ending = kEnding;
  for (int site = 0; site < model.nsite; ++site) {
    const char* name = mj_id2name(&model, mjOBJ_SITE, site);
    const std::string text = name != nullptr ? name : "";
    if (text.size() > ending.size() &&
        text.compare(text.size() - ending.size(), ending.size(), ending) == 0) {
      sites_.push_back(site);
      bodies_.push_back(model.site_bodyid[site]);
    }
  }
}

void LinksWithoutGravity::push(const mjModel& model, mjData* data) const noexcept {
  const Eigen::Map<const Eigen::Vector3d> gravity(model.opt.gravity);
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const Eigen::Vector3d force = -model.site_size[3 * sites_[i]] * gravity;
    const Eigen::Map<const Eigen::Vector3d> point(data->site_xpos + 3 * sites_[i]);
    const Eigen::Map<const Eigen::Vector3d> com(data->xipos + 3 * bodies_[i]);
    double* wrench = data->xfrc_applied + 6 * bodies_[i];  // at the body's center of mass
    Eigen::Map<Eigen::Vector3d>(wrench) += force;
    Eigen::Map<Eigen::Vector3d>(wrench + 3) += (point - com).cross(force);
  }
}

}  // namespace franka_sim::physics
