// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Simulated robots on the network, without ROS.
#include <franka_sim/physics/window.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/serve/host.h>
#include <franka_sim/serve/line_server.h>
#include <franka_sim/serve/operator_commands.h>
#include <franka_sim/serve/sim_robot.h>
#include <franka_sim/simulation/robot_setup.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "desk_process.h"
#include "fci/sockets.h"
#include "options.h"
#include "serve/robot_report.h"

namespace franka_sim {
namespace {

std::atomic<bool> end_requested{false};  // set by a signal

/// Robots without clients run ten ticks at a time, and a client that connects waits for that at
/// most. Chosen here: it needs a tenth of the wake-ups, and a client's own start takes longer.
constexpr std::chrono::milliseconds kIdleInterval{10};

void requestEnd(int /*signal*/) { end_requested = true; }

constexpr std::chrono::milliseconds kFrame{33};

/// A window with the world, in its own thread. If it is closed, the simulation continues. As a
/// service of the host it copies what the window shows, and pushes what the mouse pulls at, in the
/// thread that runs the world.
class Viewer final : public fci::Service {
 public:
  /// One line per robot for the user: its mode and errors.
  using Lines = std::function<std::vector<std::string>()>;

  /// Returns when the window is open.
  /// @param world, lines used by the host's thread
  /// @throws std::runtime_error if there is no display
  Viewer(World& world, Lines lines);
  ~Viewer() override;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void serve() override;
  bool idle() const override { return closed_; }
  void addDescriptors(std::vector<pollfd>&) const override {}

 private:
  /// What a frame shows.
  struct View {
    Scene scene;
    std::vector<std::string> texts;
  };

  void loop(std::promise<void> opened);

  World& world_;
  Lines lines_;
  PushByMouse push_;
  std::chrono::steady_clock::time_point next_view_;
  std::mutex mutex_;          ///< of the next two
  std::optional<View> view_;  ///< not drawn yet
  std::optional<BodyPush> pull_;
  std::atomic<bool> stop_{false}, closed_{false};
  std::thread thread_;
};

Viewer::Viewer(World& world, Lines lines) : world_(world), lines_(std::move(lines)) {
  std::promise<void> opened;
  std::future<void> open = opened.get_future();
  thread_ =
      std::thread([this, promise = std::move(opened)]() mutable { loop(std::move(promise)); });
  try {
    open.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

Viewer::~Viewer() {
  stop_ = true;
  thread_.join();
}

void Viewer::serve() {
  const auto now = std::chrono::steady_clock::now();
  if (closed_ || now < next_view_) {
    return;
  }
  next_view_ = now + kFrame;
  std::optional<BodyPush> pull;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pull = pull_;
  }
  push_.act(world_, pull);
  View view{captureScene(world_), lines_()};
  const std::lock_guard<std::mutex> lock(mutex_);
  view_ = std::move(view);
}

void Viewer::loop(std::promise<void> opened) {
  std::optional<Window> window;
  try {
    window.emplace("franka_sim");
  } catch (...) {
    opened.set_exception(std::current_exception());
    return;
  }
  opened.set_value();
  try {
    bool open = true;
    std::optional<View> shown;
    while (open && !stop_) {
      const auto next = std::chrono::steady_clock::now() + kFrame;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (view_) {
          shown = std::exchange(view_, std::nullopt);
        }
        pull_ = window->push();
      }
      if (shown) {
        open = window->draw(shown->scene, shown->texts);
      }
      std::this_thread::sleep_until(next);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "franka_sim runs without its window: %s\n", error.what());
  }
  closed_ = true;
}

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

/// Delays the end of the program until its clients have disconnected. roslaunch ends a robot and
/// its clients at the same time; without the delay the clients would report a lost robot.
class Shutdown : public fci::Service {
 public:
  /// @param requested true once the end was requested
  /// @param ended is set when no client is left, or `patience` after the request
  Shutdown(const std::atomic<bool>& requested, std::atomic<bool>& ended,
           std::chrono::duration<double> patience, const std::vector<fci::SimRobot*>& robots)
      : requested_(requested), ended_(ended), patience_(patience), robots_(robots) {}

  void serve() override {
    if (!requested_) {
      return;
    }
    const Clock::time_point now = Clock::now();
    requested_at_ = requested_at_.value_or(now);
    ended_ = !hasClients() || now - *requested_at_ >= patience_;
  }
  bool idle() const override { return !requested_; }
  void addDescriptors(std::vector<pollfd>& /*fds*/) const override {}

 private:
  using Clock = std::chrono::steady_clock;

  bool hasClients() const {
    return std::any_of(robots_.begin(), robots_.end(),
                       [](const fci::SimRobot* robot) { return robot->hasClients(); });
  }

  const std::atomic<bool>& requested_;
  std::atomic<bool>& ended_;
  std::chrono::duration<double> patience_;
  const std::vector<fci::SimRobot*>& robots_;
  std::optional<Clock::time_point> requested_at_;
};

std::vector<SceneRobot> sceneRobots(const std::vector<ArmOptions>& arms) {
  std::vector<SceneRobot> robots;
  for (const ArmOptions& arm : arms) {
    robots.push_back({arm.arm_id, arm.robot});
  }
  return robots;
}

ProtocolRange servedProtocols(const ArmOptions& options) {
  return options.protocol != 0 ? ProtocolRange{options.protocol, options.protocol}
                               : protocolsOf(options.robot);
}

/// Protocol versions for the user, for example "3 to 5".
std::string protocolText(const ArmOptions& options) {
  const ProtocolRange range = servedProtocols(options);
  const std::string newest = std::to_string(range.newest);
  return range.oldest == range.newest ? newest : std::to_string(range.oldest) + " to " + newest;
}

// Adds the arm to the world.
fci::SimRobot makeRobot(const ArmOptions& options, World& world) {
  const RobotInWorld robot = addRobot(options, kServedProfile, world);
  std::optional<fci::SimRobot::Vacuum> vacuum;
  if (options.tool == Tool::kVacuum) {
    vacuum.emplace();
  }
  std::optional<fci::SimRobot::Hand> hand;
  if (robot.hand != nullptr && options.tool == Tool::kGripper) {
    hand = fci::makeHand(*robot.hand, robot.physics.gripper);
  }
  return fci::makeSimRobot(options.ip, servedProtocols(options), robot.unit, *robot.arm, hand,
                           vacuum, robot.physics.command_delay);
}

/// An arm of the command line, in the world and on the network.
struct Arm {
  const ArmOptions& options;
  fci::SimRobot robot;
};

std::unique_ptr<Arm> addArm(const ArmOptions& options, bool locked, World& world) {
  std::unique_ptr<Arm> arm(new Arm{options, makeRobot(options, world)});
  const auto report = [name = options.arm_id + " at " + options.ip](const std::string& what) {
    std::fprintf(stderr, "franka_sim: %s: %s\n", name.c_str(), what.c_str());
  };
  arm->robot.onCollision(report);
  arm->robot.onRefusal(report);
  arm->robot.onSilence(report);
  if (locked) {
    arm->robot.whole().start(SafetyRules::kDesk);
    arm->robot.serve(true);  // closes its ports before a client can connect
  }
  return arm;
}

// Writes the line of --ready-fd, if there is a descriptor, and closes it.
void writeReady(fci::Descriptor& ready, const fci::JsonWriter& json) {
  if (!ready) {
    return;
  }
  const std::string line = json.text() + "\n";
  const auto handler = std::signal(SIGPIPE, SIG_IGN);
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t count = ::write(ready.get(), line.data() + done, line.size() - done);
    if (count < 0) {
      std::fprintf(stderr, "franka_sim: nothing can be written to descriptor %d: %s.\n",
                   ready.get(), std::strerror(errno));
      break;
    }
    done += static_cast<std::size_t>(count);
  }
  std::signal(SIGPIPE, handler);
  ready.close();
}

// @param desks addresses of their Desks, in the same order; or none
void reportReady(Options& options, const std::vector<std::string>& desks) {
  using namespace franka_core::fci;
  fci::JsonWriter json;
  json.beginObject().key("robots").beginArray();
  for (std::size_t i = 0; i < options.arms.size(); i++) {
    const ArmOptions& arm = options.arms[i];
    const ProtocolRange range = servedProtocols(arm);
    json.beginObject().member("robot", arm.robot).member("arm_id", arm.arm_id);
    json.member("address", arm.ip).member("protocols", std::array{range.oldest, range.newest});
    std::map<std::string, std::uint16_t> ports{{"robot", kRobotPort}};
    if (arm.tool == Tool::kGripper) {
      ports["gripper"] = kGripperPort;
    } else if (arm.tool == Tool::kVacuum) {
      ports["vacuum_gripper"] = kVacuumGripperPort;
    }
    if (arm.control_port != 0) {
      ports["control"] = arm.control_port;
    }
    json.member("ports", ports);
    if (i < desks.size()) {
      json.member("desk", desks[i]);
    }
    json.endObject();
  }
  json.endArray().endObject();
  writeReady(options.ready, json);
}

void serve(Options& options) {
  World world(worldFile(options.world), resolveUri);
  std::vector<std::unique_ptr<Arm>> arms;
  std::vector<fci::SimRobot*> robots;
  for (const ArmOptions& arm : options.arms) {
    arms.push_back(addArm(arm, options.locked, world));
    robots.push_back(&arms.back()->robot);
  }
  WorldWatch watch(world, robots);
  fci::Host host([&watch] { watch.step(); }, options.pace, [&world] { world.prepareStep(); });
  host.setIdleInterval(kIdleInterval);
  std::atomic<bool> ended{false};
  Shutdown shutdown(end_requested, ended, std::chrono::duration<double>(options.linger), robots);
  host.add(shutdown);
  SceneText scene(world, [&options] { return sceneRobots(options.arms); });
  std::deque<fci::CommandTable> commands;
  std::deque<fci::LineServer> lines;
  for (const auto& arm : arms) {
    host.add(arm->robot);
    if (arm->options.control_port != 0) {
      addOperatorCommands(commands.emplace_back(),
                          {arm->robot, arm->options.arm_id, host, world, scene,
                           [&] { resetWorld(world, robots, host); }, [&ended] { ended = true; }});
      lines.emplace_back(arm->options.ip, arm->options.control_port, commands.back());
      if (options.desk.served) {
        lines.back().serveOwnUserOnly();
      }
      host.add(lines.back());
    }
  }
  std::optional<DeskProcess> desk;
  if (options.desk.served) {
    host.add(desk.emplace(options,
                          [&options](const auto& addresses) { reportReady(options, addresses); }));
  }
  std::optional<Viewer> viewer;
  if (options.viewer) {
    host.add(viewer.emplace(world, [&arms] {
      std::vector<std::string> lines;
      for (const auto& arm : arms) {
        lines.push_back(conditionText(arm->options.arm_id, arm->robot.unit().state()));
      }
      return lines;
    }));
  }

  if (!options.pace.standsStill()) {
    preferThisThread();
  }
  for (const ArmOptions& arm : options.arms) {
    std::printf("A simulated %s waits for clients at %s (protocol %s).\n", arm.robot.c_str(),
                arm.ip.c_str(), protocolText(arm).c_str());
  }
  std::fflush(stdout);
  for (const ArmOptions& arm : options.arms) {
    const std::string overlaps = describeOverlaps(world, arm.arm_id);
    if (!overlaps.empty()) {
      std::fprintf(stderr, "franka_sim: %s Put it elsewhere with --base.\n", overlaps.c_str());
    }
  }
  malloc_trim(0);  // what the compilation of the world has freed
  if (!desk) {
    reportReady(options, {});
  }
  host.run(ended);
}

}  // namespace
}  // namespace franka_sim

int main(int argc, char** argv) {
  using namespace franka_sim;  // NOLINT: the program's own
  Options options;
  const auto fail = [&options](const std::exception& error, int status) {
    std::fprintf(stderr, "franka_sim: %s\n", error.what());
    fci::JsonWriter json;
    json.beginObject().member("error", error.what()).member("status", status);
    json.member("address_in_use", dynamic_cast<const fci::AddressInUse*>(&error) != nullptr);
    writeReady(options.ready, json.endObject());
    return status;
  };
  try {
    readOptions(argc, argv, options);
    if (!options.help.empty()) {
      std::fputs(options.help.c_str(), stdout);
      return 0;
    }
    std::signal(SIGINT, requestEnd);
    std::signal(SIGTERM, requestEnd);
    serve(options);
    return 0;
  } catch (const std::invalid_argument& error) {
    return fail(error, 2);
  } catch (const std::exception& error) {
    return fail(error, 1);
  }
}
