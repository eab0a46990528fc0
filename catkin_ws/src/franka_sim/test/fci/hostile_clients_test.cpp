// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Effect of one client, or of a stranger, on the clients of another robot in the same process.
#include <fcntl.h>
#include <franka_sim/serve/host.h>
#include <franka_sim/serve/line_server.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <fstream>
#include <memory>
#include <thread>

#include "fci/hand_server.h"
#include "robot_server_fixture.h"

namespace franka_sim::fci {
namespace {

constexpr int kTicks = 300;
constexpr double kWorstDelay = 0.02;       // of a state, in processor time [s]
constexpr double kMaxMemoryGrowth = 30.0;  // [MB] more than before
constexpr std::size_t kModelSize = 100000;

double processorTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double residentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double size = 0.0;
  double resident = 0.0;
  file >> size >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// A robot without physics: a request handler, and hands at rest.
class BareRobot final : public HostedRobot {
 public:
  void observe() override {}
  void actuate() override { arm.takeCommand(); }
  void serve(bool stops_only) override {
    arm.serve(stops_only);
    hand.serve(stops_only);
    vacuum.serve(stops_only);
    most_unsent = std::max(most_unsent, arm.unsentBytes());
  }
  void publish(std::uint64_t ticks, bool same_tick, bool keep_end) override {
    const double now = processorTime();
    worst = published_at > 0.0 ? std::max(worst, now - published_at) : worst;
    published_at = now;
    arm.publish(ticks, same_tick, keep_end);
    hand.publish(ticks);
    vacuum.publish(ticks);
  }
  bool repeat() override {
    arm.repeat();
    return true;
  }
  bool hasPendingState() const override { return arm.hasPendingState(); }
  bool receiveCommand() override { return arm.receiveCommand(); }
  bool expectsCommand() const override { return arm.expectsCommands(); }
  bool asynchronous() const override { return arm.asynchronous(); }
  bool motionHasBegun() const override { return arm.motionHasBegun(); }
  bool settling() const override { return false; }
  bool handBusy() const override { return false; }
  void addCommandDescriptor(std::vector<pollfd>& fds) const override {
    arm.addCommandDescriptor(fds);
  }
  void addDescriptors(std::vector<pollfd>& fds) const override {
    arm.addDescriptors(fds);
    hand.addDescriptors(fds);
    vacuum.addDescriptors(fds);
  }

  FakeRequestHandler handler;
  RobotServer arm{anyVersion(std::vector<std::uint8_t>(kModelSize, 7)), handler};
  GripperUnit finger_unit{GripperParameters()};
  VacuumGripperUnit vacuum_unit;
  GripperServer hand{"127.0.0.1", 0, finger_unit};
  VacuumServer vacuum{"127.0.0.1", 0, vacuum_unit};
  double worst{0.0};  // processor time of the stepping thread between two states [s]
  double published_at{0.0};
  std::size_t most_unsent{0};
};

/// A TCP connection that never blocks.
class Raw {
 public:
  explicit Raw(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in server{};
    server.sin_family = AF_INET;
    server.sin_port = htons(port);
    inet_pton(AF_INET, "127.0.0.1", &server.sin_addr);
    ::fcntl(socket_.get(), F_SETFL, O_NONBLOCK);
    ::connect(socket_.get(), reinterpret_cast<sockaddr*>(&server), sizeof(server));
  }
  /// Sends as much as the system accepts.
  void send(const std::string& bytes) {
    const ssize_t size = ::send(socket_.get(), bytes.data() + sent_, bytes.size() - sent_,
                                MSG_NOSIGNAL | MSG_DONTWAIT);
    if (size > 0) {
      sent_ = (sent_ + static_cast<std::size_t>(size)) % bytes.size();
    }
  }
  void readAll() {
    char buffer[65536];
    while (::recv(socket_.get(), buffer, sizeof(buffer), MSG_DONTWAIT) > 0) {
    }
  }

 private:
  Descriptor socket_;
  std::size_t sent_{0};
};

std::string requestBytes(const codec::Request& request, std::uint16_t version = 5) {
  codec::RequestMessage message;
  codec::encodeRequest(version, 0, request, message);
  return std::string(reinterpret_cast<const char*>(message.data), message.size);
}

std::string handBytes(const franka_core::fci::gripper::Request& request) {
  franka_core::fci::gripper::RequestMessage message;
  franka_core::fci::gripper::encodeRequest(0, request, message);
  return std::string(reinterpret_cast<const char*>(message.data), message.size);
}

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; i++) {
    result += text;
  }
  return result;
}

/// Two robots and a control interface; a good client at one robot, an attacker in its own thread.
class HostileClients : public ::testing::Test {
 protected:
  HostileClients() {
    host_.add(attacked_);
    host_.add(other_);
    host_.add(lines_);
    commands_.add(line("echo", text("WORD")), "", kNotOnPage,
                  [](const std::string& word) { return word; });
    const ClientSlot::Report report = [this](const std::string& what) { reports_.push_back(what); };
    attacked_.arm.onRefusal(report);
    attacked_.hand.onRefusal(report);
    good_.connect(5);
    for (int i = 0; i < 1000 && other_.arm.version() == 0; i++) {
      host_.tick();
    }
    EXPECT_TRUE(good_.answer(Command::kConnect));
    while (good_.state(0)) {
    }
  }

  std::vector<std::uint16_t> ports() const {
    return {attacked_.arm.port(), attacked_.hand.port(), attacked_.vacuum.port(), lines_.port()};
  }

  /// Runs `ticks` ticks while another thread calls `attack` repeatedly.
  void under(const std::function<void()>& attack, int ticks = kTicks) {
    const double memory = residentMegabytes();
    std::atomic<bool> stop{false};
    std::thread attacker([&] {
      while (!stop) {
        attack();
      }
    });
    other_.published_at = 0.0;
    std::uint64_t last = 0;
    for (int i = 0; i < ticks; i++) {
      host_.tick();
      for (auto state = good_.state(0); state; state = good_.state(0)) {
        EXPECT_TRUE(last == 0 || state->message_id == last + 1)
            << state->message_id - last << " states at once";
        last = state->message_id;
      }
    }
    stop = true;
    attacker.join();
    EXPECT_NE(last, 0U) << "the good client has received nothing";
    EXPECT_LT(residentMegabytes() - memory, kMaxMemoryGrowth) << "[MB]";
    EXPECT_LE(attacked_.most_unsent, kModelSize + 1000);
    std::printf("  worst delay %.2f ms, memory %+.1f MB, at most %zu bytes unsent\n",
                1e3 * other_.worst, residentMegabytes() - memory, attacked_.most_unsent);
  }

  void requestModelsWithoutReadingThem() {
    Raw attacker(attacked_.arm.port());
    attacker.send(requestBytes(codec::ConnectRequest{5, 1}));
    const std::string flood = repeated(requestBytes(codec::LoadModelLibraryRequest{}), 500);
    under([&] { attacker.send(flood); });
  }

  void requestVirtualWallsInAnEndlessLoop() {
    Raw attacker(attacked_.arm.port());
    attacker.send(requestBytes(codec::ConnectRequest{5, 1}));
    const std::string flood = repeated(requestBytes(codec::GetCartesianLimitRequest{1}), 500);
    under([&] {
      attacker.send(flood);
      attacker.readAll();
    });
  }

  void floodTheHandAndTheControlInterface() {
    Raw gripper(attacked_.hand.port());
    std::vector<std::unique_ptr<Raw>> controls;
    for (std::size_t i = 0; i < LineServer::kMaxClients; i++) {
      controls.push_back(std::make_unique<Raw>(lines_.port()));
    }
    gripper.send(handBytes(franka_core::fci::gripper::ConnectRequest{3, 1}));
    const std::string stops = repeated(handBytes(franka_core::fci::gripper::StopRequest{}), 500);
    const std::string lines = repeated("echo something\n", 500);
    under([&] {
      gripper.send(stops);
      for (const auto& control : controls) {
        control->send(lines);
      }
      gripper.readAll();
    });
  }

  /// Whether the log has the reason why a connection to that port was closed.
  bool isReported(std::uint16_t port, const std::string& reason) const {
    const std::string sentence =
        "a connection from 127.0.0.1 to port " + std::to_string(port) + " was closed: " + reason;
    return std::find(reports_.begin(), reports_.end(), sentence) != reports_.end();
  }

  /// Ticks until a new client of the attacked robot is served; 1001 if never.
  int ticksUntilServed() {
    TestClient client(attacked_.arm.port());
    client.connect(5);
    int ticks = 0;
    while (ticks <= 1000 && !client.answer(Command::kConnect, 0)) {
      host_.tick();
      ticks++;
    }
    return ticks;
  }

  BareRobot attacked_, other_;
  CommandTable commands_;
  LineServer lines_{"127.0.0.1", 0, commands_};
  Host host_{[] {}, Pace{}};
  TestClient good_{other_.arm.port()};
  std::vector<std::string> reports_;
};

TEST_F(HostileClients, RequestModelsWithoutReadingThem) { requestModelsWithoutReadingThem(); }

TEST_F(HostileClients, RequestVirtualWallsInAnEndlessLoop) { requestVirtualWallsInAnEndlessLoop(); }

TEST_F(HostileClients, FloodTheHandAndTheControlInterface) { floodTheHandAndTheControlInterface(); }

using HostileClientsOnWallClock = HostileClients;

TEST_F(HostileClientsOnWallClock, DelayNoStateOfAnotherRobot) {
  requestModelsWithoutReadingThem();
  requestVirtualWallsInAnEndlessLoop();
  floodTheHandAndTheControlInterface();
  EXPECT_LT(other_.worst, kWorstDelay);
}

/// An ordinary user's processes begin with 1024 files, of which they may allow themselves more.
void allowFiles(rlim_t count) {
  rlimit files{};
  ASSERT_EQ(0, getrlimit(RLIMIT_NOFILE, &files));
  files.rlim_cur = std::max(files.rlim_cur, std::min(files.rlim_max, count));
  ASSERT_EQ(0, setrlimit(RLIMIT_NOFILE, &files));
}

TEST_F(HostileClients, StayHalfOpenOrSendOneByte) {
  allowFiles(4096);
  std::vector<std::unique_ptr<Raw>> connections;
  for (int i = 0; i < 200; i++) {
    for (const std::uint16_t port : ports()) {
      connections.push_back(std::make_unique<Raw>(port));
      if (i % 2 == 0) {
        connections.back()->send(std::string(1, '\0'));
      }
    }
  }
  under([] { std::this_thread::yield(); }, 50);
  EXPECT_LE(ticksUntilServed(), 1000);
  for (const std::uint16_t port : {attacked_.arm.port(), attacked_.hand.port()}) {
    EXPECT_TRUE(isReported(port, "too many connections have not sent a Connect request."));
  }
}

TEST_F(HostileClients, AreReportedWithTheReasonWhyTheirConnectionWasClosed) {
  Raw noisy(attacked_.arm.port());
  noisy.send(std::string(40, 'x'));
  Raw owner(attacked_.hand.port());
  owner.send(handBytes(franka_core::fci::gripper::ConnectRequest{3, 1}));
  for (int i = 0; i < 1000 && !attacked_.hand.hasClient(); i++) {
    host_.tick();
  }
  const Raw second(attacked_.hand.port());
  const auto all_reported = [this] {
    return isReported(attacked_.arm.port(), "it sent an invalid request.") &&
           isReported(attacked_.hand.port(),
                      "there is a client already, and one at a time is served.");
  };
  for (int i = 0; i < 1000 && !all_reported(); i++) {
    host_.tick();
  }
  EXPECT_TRUE(all_reported()) << ::testing::PrintToString(reports_);
}

TEST_F(HostileClients, ReconnectRepeatedlyAndSendNoise) {
  unsigned round = 0;
  under([&] {
    std::vector<std::unique_ptr<Raw>> connections;
    for (int i = 0; i < 50; i++) {
      for (const std::uint16_t port : ports()) {
        connections.push_back(std::make_unique<Raw>(port));
        connections.back()->send(std::string(40, static_cast<char>(round++ * 37)));
      }
    }
  });
  EXPECT_LE(ticksUntilServed(), 1000);
}

TEST_F(HostileClients, DisconnectWithRequestsUnanswered) {
  {
    Raw attacker(attacked_.arm.port());
    attacker.send(requestBytes(codec::ConnectRequest{5, 1}));
    for (int i = 0; i < 100 && attacked_.arm.version() == 0; i++) {
      host_.tick();
    }
    const std::string flood = repeated(requestBytes(codec::GetCartesianLimitRequest{1}), 500);
    for (int i = 0; i < 200; i++) {
      attacker.send(flood);  // more than is served in a second
      attacker.readAll();
    }
  }
  EXPECT_LE(ticksUntilServed(), 1000);
}

TEST_F(HostileClients, TimeOutWithinARequest) {
  SlotRules rules;
  rules.request = std::chrono::milliseconds(20);
  ClientSlot slot("127.0.0.1", 0, rules);
  std::vector<std::string> refusals;
  slot.onRefusal([&](const std::string& what) { refusals.push_back(what); });
  Raw client(slot.port());
  client.send("xy");
  bool gone = false;
  const auto serve_one = [&](Connection& connection) {
    slot.confirm();
    if (connection.received().size == 2) {
      connection.consume(1);
      return Served::kDone;
    }
    return Served::kIncomplete;
  };
  EXPECT_TRUE(ros_test::eventually([&] {
    slot.serve(serve_one, [&] { gone = true; });
    return gone;
  }));
  ASSERT_EQ(refusals.size(), 1U);
  EXPECT_NE(refusals[0].find("127.0.0.1"), std::string::npos) << refusals[0];
  EXPECT_NE(refusals[0].find("too slow"), std::string::npos) << refusals[0];
}

}  // namespace
}  // namespace franka_sim::fci
