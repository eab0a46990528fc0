// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros_test/eventually.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "fci/robot_server.h"
#include "test_client.h"

namespace franka_sim::fci {

namespace codec = franka_core::fci;
using codec::Command;
using codec::Status;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;
using franka_test::TestClient;

/// Returns values that the test sets.
class FakeRequestHandler final : public ArmRequestHandler {
 public:
  FakeRequestHandler() { shown.robot_mode = RobotMode::kIdle; }
  const franka_core::RobotState& state() const noexcept override { return shown; }
  void connected(std::uint16_t version) noexcept override { last_version = version; }
  void disconnected() noexcept override { disconnections++; }
  bool active() const noexcept override { return on; }
  bool measured() const noexcept override { return ticked; }
  std::optional<Status> handle(const codec::Request& request) noexcept override {
    last = request;
    handled++;
    return answer;
  }
  std::optional<codec::CartesianLimit> wall(std::int32_t id) const noexcept override {
    codec::CartesianLimit wall;
    wall.object_world_size[0] = 2.0;
    return id == 1 ? std::optional<codec::CartesianLimit>(wall) : std::nullopt;
  }
  std::optional<Status> takeAnswer(PendingAnswer which) noexcept override {
    switch (which) {
      case PendingAnswer::kMotion:
        return take(motion_end);
      case PendingAnswer::kStop:
        return take(stop_end);
      case PendingAnswer::kRecovery:
        return take(recovery_end);
    }
    return std::nullopt;
  }

  void startMotion() {
    answer = Status::kMotionStarted;
    shown.robot_mode = RobotMode::kMove;
    shown.motion_generator_mode = MotionGeneratorMode::kJointPosition;
    shown.controller_mode = ControllerMode::kJointImpedance;
  }
  void endMotion(Status status, RobotMode mode) {
    motion_end = status;
    shown.robot_mode = mode;
    shown.motion_generator_mode = MotionGeneratorMode::kIdle;
    shown.controller_mode = ControllerMode::kOther;
  }

  franka_core::RobotState shown;
  std::optional<Status> answer{Status::kSuccess};
  std::optional<Status> motion_end, stop_end, recovery_end;
  codec::Request last;
  int handled{0}, disconnections{0};
  bool on{true}, ticked{true};
  std::uint16_t last_version{0};

 private:
  static std::optional<Status> take(std::optional<Status>& from) {
    const std::optional<Status> result = from;
    from.reset();
    return result;
  }
};

/// Of a server at any port, for all versions.
inline RobotServerParameters anyVersion(const std::vector<std::uint8_t>& model_library) {
  RobotServerParameters parameters;
  parameters.port = 0;
  parameters.oldest_version = 3;
  parameters.newest_version = 10;
  parameters.model_library = model_library;
  return parameters;
}

class RobotServerTest : public ::testing::Test {
 protected:
  /// Serves until a condition holds, or a deadline has passed.
  bool until(const std::function<bool()>& condition) {
    return ros_test::eventually([&] {
      server_.serve();
      return condition();
    });
  }
  /// Loopback delivers within the sender's call; a few calls let the server receive everything.
  void serve(bool stops_only = false) {
    for (int i = 0; i < 3; i++) {
      server_.serve(stops_only);
    }
  }
  /// Serves until the answer arrives, or a deadline has passed. Connections beyond the server's
  /// limit per millisecond have to wait.
  static std::optional<TestClient::Answer> answerOf(RobotServer& server, TestClient& client,
                                                    Command command) {
    std::optional<TestClient::Answer> answer;
    ros_test::eventually(
        [&] {
          server.serve();
          answer = client.answer(command, 1);
          return answer.has_value();
        },
        std::chrono::microseconds(0));
    return answer;
  }
  void connect(TestClient& client, std::uint16_t version) {
    client.connect(version);
    const auto answer = answerOf(server_, client, Command::kConnect);
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->reply.status, Status::kSuccess);
    ASSERT_EQ(answer->reply.server_version, version);
  }
  void disconnect(TestClient& client) {
    client.close();
    ASSERT_TRUE(until([&] { return !server_.hasClient(); }));
  }
  void startMotion(TestClient& client, const codec::MoveRequest& request = {}) {
    handler_.startMotion();
    client.request(request);
    serve();
    const auto started = client.answer(Command::kMove);
    ASSERT_TRUE(started);
    ASSERT_EQ(started->reply.status, Status::kMotionStarted);
  }
  /// Sends a command that answers this state. @returns whether it is for the motion
  bool isTaken(TestClient& client, std::uint64_t message_id) {
    franka_core::RobotCommand command;
    command.message_id = message_id;
    client.command(command);
    server_.receiveCommand();
    return server_.takeCommand() != nullptr;
  }
  std::optional<TestClient::Answer> ask(TestClient& client, const codec::Request& request,
                                        int timeout_ms = franka_test::kDeadline) {
    client.request(request);
    serve();
    server_.publish();
    return client.answer(codec::commandOf(request), timeout_ms);
  }

  FakeRequestHandler handler_;
  RobotServer server_{anyVersion({1, 2, 3}), handler_};
};

}  // namespace franka_sim::fci
