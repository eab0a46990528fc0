// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The simulation as a ROS node. Parameters: ~world, ~real_time_factor, ~paused,
/// ~pub_clock_frequency (see SimulationOptions and findWorldFile), ~gui (a window, if there is a
/// display); services: see SimServices and PictureService; topics: see ContactPublisher,
/// CameraPublisher and GazeboTopics. Requires use_sim_time.

#include <franka_hw/usage.h>
#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/package.h>
#include <ros/spinner.h>

#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "camera_publisher.h"
#include "contact_publisher.h"
#include "gazebo_models.h"
#include "marker_publisher.h"
#include "param_reader.h"
#include "picture_service.h"
#include "resources.h"
#include "service_handlers.h"
#include "shutdown_request.h"
#include "sim_services.h"
#include "simulation.h"
#include "window_view.h"

namespace {

namespace sim = franka_sim_mujoco;
using franka_sim_mujoco::kLog;

constexpr char kUsage[] =
    "usage: rosrun franka_sim_mujoco franka_sim_mujoco_node [NAME:=VALUE]...\n\n"
    "The simulation: a world with robots under ros_control, and the clock of ROS. Parameters: "
    "~world,"
    "\n~real_time_factor, ~paused, ~gui; /use_sim_time must be true. Launch files set them all:\n"
    "  roslaunch franka_gazebo panda.launch (or fr3.launch)";
/// Threads for controllers' and robots' services and topics; a controller switch may block one for
/// long.
constexpr std::uint32_t kThreads = 4;

sim::SimulationOptions readOptions(const ros::NodeHandle& node) {
  sim::SimulationOptions options;
  const std::string world = sim::readString(node, "world").value_or("");
  std::vector<std::string> folders{ros::package::getPath("franka_sim") + "/worlds"};
  for (const std::string& folder : sim::gazeboResourceFolders()) {
    folders.push_back(folder);
  }
  options.world_file = sim::findWorldFile(world, folders);
  if (!options.world_file.empty() && options.world_file != world) {
    ROS_INFO_NAMED(kLog, "World '%s': taking %s", world.c_str(), options.world_file.c_str());
  }
  options.real_time_factor = sim::readNumber(node, "real_time_factor").value_or(1.0);
  options.clock_rate = sim::readNumber(node, "pub_clock_frequency").value_or(0.0);
  options.paused = sim::readBool(node, "paused").value_or(false);
  return options;
}

void checkSimTime() {
  bool use_sim_time = false;
  ros::param::param("/use_sim_time", use_sim_time, false);
  if (!use_sim_time) {
    throw std::runtime_error(
        "The parameter /use_sim_time is not true, so no node would follow the simulation's clock. "
        "Set it "
        "before the nodes start: <param name=\"/use_sim_time\" value=\"true\"/> in the launch "
        "file.");
  }
}

void reportPlugins() {
  for (const std::string& folder : sim::gazeboPluginFolders()) {
    ROS_INFO_NAMED(kLog,
                   "A package exports %s as plugin_path for Gazebo: such plugins are not loaded.",
                   folder.c_str());
  }
}

void run(ros::NodeHandle& node) {
  ros::NodeHandle private_node("~");
  checkSimTime();
  reportPlugins();
  sim::ShutdownRequest shutdown;
  sim::Simulation simulation(readOptions(private_node), node);
  std::optional<sim::SimServices> services(std::in_place, private_node, simulation);
  std::optional<sim::PictureService> pictures(std::in_place, private_node, simulation);
  std::optional<sim::ContactPublisher> contacts(std::in_place, private_node, simulation);
  std::optional<sim::MarkerPublisher> markers(std::in_place, private_node, simulation);
  std::optional<sim::CameraPublisher> cameras(std::in_place, private_node, simulation);
  std::optional<sim::GazeboTopics> gazebo(std::in_place, private_node, simulation);
  ros::AsyncSpinner spinner(kThreads);
  spinner.start();
  simulation.start();
  ROS_INFO_NAMED(kLog, "The simulation is ready.");
  std::optional<sim::WindowView> window;
  if (sim::readBool(private_node, "gui").value_or(false)) {
    if (std::getenv("DISPLAY") != nullptr) {
      window.emplace(simulation);
    } else {
      ROS_INFO_NAMED(kLog,
                     "There is no display (DISPLAY is not set): the simulation opens no window.");
    }
  }
  shutdown.wait();
  window.reset();
  // In this order: no more ticks, which refuses requests; then no more callbacks.
  simulation.stop();
  gazebo.reset();
  cameras.reset();
  markers.reset();
  contacts.reset();
  pictures.reset();
  services.reset();
  spinner.stop();
  if (simulation.failed()) {
    throw std::runtime_error("The simulation ended by itself; the lines above say why.");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (franka_hw::printsUsage(argc, argv, kUsage)) {
    return EXIT_SUCCESS;
  }
  ros::init(argc, argv, "gazebo");
  // Outlives the catch: logging ends with the last node handle.
  ros::NodeHandle node;
  try {
    run(node);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    ROS_FATAL_NAMED(kLog, "%s", error.what());
    return EXIT_FAILURE;
  }
}
