// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Simulated robots on the network, without ROS.
#include <franka_sim/physics/world.h>
#include <franka_sim/robot/errors.h>
#include <franka_sim/serve/operator_commands.h>
#include <franka_sim/serve/scene_commands.h>
#include <franka_sim/simulation/files.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "desk_process.h"
#include "options.h"
#include "served_arm.h"
#include "shutdown.h"
#include "viewer.h"

namespace franka_sim {
namespace {

std::atomic<bool> end_requested{false};  // set by a signal

/// Robots without clients run ten ticks at a time, and a client that connects waits for that at
/// most. Chosen here: it needs a tenth of the wake-ups, and a client's own start takes longer.
constexpr std::chrono::milliseconds kIdleInterval{10};

void requestEnd(int /*signal*/) { end_requested = true; }

// Gives the ticks priority over other processes, or reports why the system does not allow it: their
// punctuality then depends on the load of the machine. Memory stays in place from its first use on:
// the ticks use the same pages again and again, and the rest of the libraries needs none.
void preferThisThread() {
  constexpr int kPriority = 70;
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) {
    std::fprintf(
        stderr,
        "franka_sim: runs without real-time priority (SCHED_FIFO: %s), and may be late on "
        "a busy machine. Allow your user one of %d (rtprio in /etc/security/limits.conf).\n",
        std::strerror(errno), kPriority);
  } else if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) {
    std::fprintf(
        stderr,
        "franka_sim: its memory can be swapped out (mlockall: %s), and it may then be late. "
        "Allow your user more (memlock in /etc/security/limits.conf).\n",
        std::strerror(errno));
  }
}

// Prints faults of the world on the terminal, and stops its robots.
class WorldWatch {
 public:
  WorldWatch(World& world, const std::vector<fci::SimRobot*>& robots)
      : world_(world), robots_(robots) {}

  void step() {
    world_.step();
    for (const std::string& warning : world_.takeWarnings()) {
      report(warning);
    }
    const bool before = std::exchange(stopped_, world_.stopped());
    if (stopped_ && !before) {
      report(world_.fault() + " Send the line reset to a control port.");
      for (fci::SimRobot* robot : robots_) {
        robot->halt();
      }
    }
  }

 private:
  static void report(const std::string& what) {
    std::fprintf(stderr, "franka_sim: %s\n", what.c_str());
  }

  World& world_;
  const std::vector<fci::SimRobot*>& robots_;
  bool stopped_{false};
};

std::vector<SceneRobot> sceneRobots(const std::vector<ArmOptions>& arms) {
  std::vector<SceneRobot> robots;
  for (const ArmOptions& arm : arms) {
    robots.push_back({arm.arm_id, arm.robot});
  }
  return robots;
}

void serve(const Options& options) {
  World world(worldFile(options.world), resolveUri);
  std::deque<ServedArm> arms;
  std::vector<fci::SimRobot*> robots;
  for (const ArmOptions& arm : options.arms) {
    robots.push_back(&arms.emplace_back(arm, world).robot());
    if (options.locked) {
      robots.back()->whole().start(SafetyRules::kDesk);
      robots.back()->serve(true);  // closes its ports before a client can connect
    }
  }
  WorldWatch watch(world, robots);
  fci::Host host([&watch] { watch.step(); }, options.pace, [&world] { world.prepareStep(); });
  host.setIdleInterval(kIdleInterval);
  std::atomic<bool> ended{false};
  Shutdown shutdown(end_requested, ended, std::chrono::duration<double>(options.linger), robots);
  host.add(shutdown);
  SceneText scene(world, [&options] { return sceneRobots(options.arms); });
  std::deque<fci::LineServer> lines;
  for (ServedArm& arm : arms) {
    host.add(arm.robot());
    if (arm.options().control_port != 0) {
      lines.emplace_back(arm.options().ip, arm.options().control_port);
      addOperatorCommands(lines.back(),
                          {arm.robot(), arm.options().arm_id, host, world,
                           [&] { resetWorld(world, robots, host); }, [&ended] { ended = true; }});
      addSceneCommands(lines.back(), world, scene);
      host.add(lines.back());
    }
  }
  std::optional<DeskProcess> desk;
  if (options.desk.served) {
    host.add(desk.emplace(options));
  }
  std::optional<Viewer> viewer;
  if (options.viewer) {
    host.add(viewer.emplace(world, [&arms] {
      std::vector<std::string> lines;
      for (ServedArm& arm : arms) {
        lines.push_back(conditionText(arm.options().arm_id, arm.robot().unit().state()));
      }
      return lines;
    }));
  }

  if (!options.pace.standsStill()) {
    preferThisThread();
  }
  for (const ServedArm& arm : arms) {
    std::printf("A simulated %s waits for clients at %s (protocol %s).\n",
                arm.options().robot.c_str(), arm.options().ip.c_str(), arm.protocols().c_str());
  }
  std::fflush(stdout);
  for (const ServedArm& arm : arms) {
    const std::string overlaps = world.describeOverlaps(arm.options().arm_id);
    if (!overlaps.empty()) {
      std::fprintf(stderr, "franka_sim: %s Put it elsewhere with --base.\n", overlaps.c_str());
    }
  }
  malloc_trim(0);  // what the compilation of the world has freed
  host.run(ended);
}

}  // namespace
}  // namespace franka_sim

int main(int argc, char** argv) {
  using namespace franka_sim;  // NOLINT: the program's own
  try {
    const Options options = readOptions(argc, argv);
    if (!options.help.empty()) {
      std::fputs(options.help.c_str(), stdout);
      return 0;
    }
    std::signal(SIGINT, requestEnd);
    std::signal(SIGTERM, requestEnd);
    serve(options);
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "franka_sim: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "franka_sim: %s\n", error.what());
    return 1;
  }
}
