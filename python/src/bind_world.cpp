// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Bodies, contacts and cameras of a world; pyfranka/sim gives them their Python interface.
#include <franka_core/numbers.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_cameras.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/physics/world_pushes.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "arguments.h"
#include "bindings.h"
#include "shared_simulation.h"

namespace pyfranka {

namespace {

franka_sim::Pose poseOf(const py::object& position, const py::object& orientation) {
  return {finite<3>(position, "position"), finite<4>(orientation, "orientation")};
}

/// Larger ones are other units, or mistakes: an arm withstands about 100 N (chosen here).
constexpr double kMaxPush = 1000.0;  // [N] or [Nm] along an axis

std::array<double, 3> pushOf(const py::object& values, const char* name, const char* unit) {
  const auto push = finite<3>(values, name);
  for (const double value : push) {
    if (std::abs(value) > kMaxPush) {
      throw std::invalid_argument(
          std::string(name) + " must be at most " + franka_core::numberText(kMaxPush) + " " + unit +
          " along each axis, not " + franka_core::numberText(value) + " " + unit + ".");
    }
  }
  return push;
}

int pixels(const py::object& side, const char* name) {
  const std::int64_t number = wholeNumber(side, name);
  if (number < 1 || number > franka_sim::Renderer::kMaxPictureSide) {
    throw std::invalid_argument(std::string(name) + " must be 1 to " +
                                std::to_string(franka_sim::Renderer::kMaxPictureSide) +
                                " pixels, not " + std::to_string(number) + ".");
  }
  return static_cast<int>(number);
}

py::array pictureArray(const franka_sim::Picture& picture) {
  return py::array_t<std::uint8_t>({picture.height, picture.width, 3}, picture.rgb.data());
}

py::object depthArray(const franka_sim::Picture& picture) {
  if (picture.depth.empty()) {
    return py::none();
  }
  return py::array_t<float>({picture.height, picture.width}, picture.depth.data());
}

}  // namespace

void bindWorld(py::class_<Shared, std::shared_ptr<Shared>>& simulation) {
  using franka_sim::Simulation;
  simulation
      .def("bodies",
           [](Shared& self) { return self.use([](Simulation& s) { return s.world().bodies(); }); })
      .def("body_pose",
           [](Shared& self, const py::object& body) {
             const std::string name = text(body, "body");
             const franka_sim::Pose pose =
                 self.use([&](Simulation& s) { return bodyPose(s.world(), name); });
             return py::make_tuple(copy(pose.position, Shape::kVector),
                                   copy(pose.orientation, Shape::kVector));
           })
      .def("check_body_pose",  // whether place_body would take it
           [](Shared& self, const py::object& body, const py::object& position,
              const py::object& orientation) {
             const std::string name = text(body, "body");
             const franka_sim::Pose pose = poseOf(position, orientation);
             self.use([&](Simulation& s) { checkBodyPose(s.world(), name, pose); });
           })
      .def("place_body",
           [](Shared& self, const py::object& body, const py::object& position,
              const py::object& orientation) {
             const std::string name = text(body, "body");
             const franka_sim::Pose pose = poseOf(position, orientation);
             self.use([&](Simulation& s) { setBodyPose(s.world(), name, pose); });
           })
      .def("push",
           [](Shared& self, const py::object& body, const py::object& force,
              const py::object& torque, const py::object& ticks) {
             const std::string name = text(body, "body");
             const auto f = pushOf(force, "force", "N");
             const auto t = pushOf(torque, "torque", "Nm");
             const std::uint64_t duration = ticksOf(ticks);
             if (duration == 0) {
               throw std::invalid_argument("ticks of a push must be 1 or more, not 0.");
             }
             self.use([&](Simulation& s) { pushBody(s.world(), name, f, t, duration); });
           })
      .def("contacts",
           [](Shared& self) {
             py::list list;
             for (const franka_sim::Contact& contact :
                  self.use([](Simulation& s) { return contacts(s.world()); })) {
               list.append(py::make_tuple(contact.body1, contact.body2,
                                          copy(contact.position, Shape::kVector),
                                          copy(contact.force, Shape::kVector)));
             }
             return list;
           })
      .def("overlaps",
           [](Shared& self, const std::string& robot) {
             return self.use([&](Simulation& s) { return describeOverlaps(s.world(), robot); });
           })
      .def("cameras",
           [](Shared& self) {
             std::vector<std::string> names;
             for (const franka_sim::WorldCamera& camera :
                  self.use([](Simulation& s) { return cameras(s.world()); })) {
               names.push_back(camera.name);
             }
             return names;
           })
      .def("render", [](Shared& self, const py::object& camera, const py::object& width,
                        const py::object& height) {
        const std::string name = text(camera, "camera");
        const int w = pixels(width, "width");
        const int h = pixels(height, "height");
        franka_sim::Picture picture;
        {
          const py::gil_scoped_release free;
          picture = self.render(name, w, h);
        }
        return py::make_tuple(pictureArray(picture), depthArray(picture));
      });
}

}  // namespace pyfranka
