// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The FCI server over real sockets, with a fake request handler in place of the control unit.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../physics/test_support.h"
#include "robot_server_fixture.h"

namespace franka_sim::fci {
namespace {

TEST_F(RobotServerTest, AnswersItsVersionAndAcceptsAnImmediateReconnect) {
  RobotServerParameters panda = anyVersion({});
  panda.newest_version = 5;
  RobotServer server(panda, handler_);
  for (const std::uint16_t version : {0, 2, 6, 10, 65535}) {
    TestClient other(server.port());
    other.connect(version);
    const auto answer = answerOf(server, other, Command::kConnect);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->reply.status, Status::kIncompatibleLibraryVersion);
    EXPECT_EQ(answer->reply.server_version, 5);
    EXPECT_FALSE(server.hasClient());
    other.close();
    // The server may receive both events in one call.
    TestClient again(server.port());
    again.connect(5);
    const auto second = answerOf(server, again, Command::kConnect);
    ASSERT_TRUE(second) << version;
    EXPECT_EQ(second->reply.status, Status::kSuccess);
    again.close();
    server.serve();
  }
}

TEST_F(RobotServerTest, RefusesASecondClient) {
  TestClient first(server_.port());
  connect(first, 5);
  TestClient second(server_.port());
  second.connect(5);
  serve();
  EXPECT_TRUE(second.ended());
  server_.publish();
  EXPECT_TRUE(first.state());
  first.close();
  TestClient third(server_.port());
  connect(third, 5);
}

TEST_F(RobotServerTest, NumbersStatesContinuously) {
  std::uint64_t last = 0;
  for (int client_number = 0; client_number < 3; client_number++) {
    TestClient client(server_.port());
    connect(client, 5);
    for (std::uint64_t ticks : {1, 1, 7}) {
      server_.publish(ticks);
      const auto state = client.state();
      ASSERT_TRUE(state);
      EXPECT_GE(state->message_id, last + ticks);
      last = state->message_id;
    }
    disconnect(client);
  }
}

TEST_F(RobotServerTest, RunsAMotionFromStartToEnd) {
  for (std::uint16_t version = 3; version <= 10; version++) {
    TestClient client(server_.port());
    connect(client, version);
    EXPECT_EQ(server_.version(), version);
    EXPECT_EQ(handler_.last_version, version);
    handler_.startMotion();
    const std::uint32_t id = client.request(codec::MoveRequest{});
    serve();
    const auto started = client.answer(Command::kMove);
    ASSERT_TRUE(started);
    EXPECT_EQ(started->reply.status, Status::kMotionStarted);
    EXPECT_EQ(started->header.command_id, id);
    EXPECT_TRUE(server_.expectsCommands());
    EXPECT_FALSE(server_.motionHasBegun());
    server_.publish();
    const auto state = client.state();
    ASSERT_TRUE(state);
    EXPECT_EQ(state->robot_mode, RobotMode::kMove);
    EXPECT_EQ(server_.takeCommand(), nullptr);
    franka_core::RobotCommand command;
    command.message_id = state->message_id;
    command.q_c[2] = 0.25;
    client.command(command);
    EXPECT_TRUE(server_.receiveCommand());
    const franka_core::RobotCommand* taken = server_.takeCommand();
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(taken->q_c[2], 0.25);
    EXPECT_EQ(server_.takeCommand(), nullptr);
    EXPECT_TRUE(server_.motionHasBegun());
    // The state shows the end first, then the reply follows.
    handler_.endMotion(Status::kReflexAborted, RobotMode::kReflex);
    serve();
    EXPECT_FALSE(client.answer(Command::kMove, 0));
    EXPECT_TRUE(server_.hasPendingState());
    server_.publish();
    EXPECT_EQ(client.state()->robot_mode, RobotMode::kReflex);
    const auto end = client.answer(Command::kMove);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->reply.status, Status::kReflexAborted);
    EXPECT_EQ(end->header.command_id, id);
    EXPECT_FALSE(server_.expectsCommands());
    handler_.shown.robot_mode = RobotMode::kIdle;
    EXPECT_EQ(handler_.disconnections, version - 3);
    disconnect(client);
    serve();
    EXPECT_EQ(handler_.disconnections, version - 2) << "each is reported once";
  }
}

TEST_F(RobotServerTest, AcceptsOnlyTheAnswerToTheLastState) {
  TestClient client(server_.port());
  connect(client, 5);
  startMotion(client);
  server_.publish();
  const std::uint64_t id = client.state()->message_id;
  EXPECT_FALSE(isTaken(client, 0));
  EXPECT_FALSE(isTaken(client, id - 1));
  EXPECT_FALSE(isTaken(client, id + 1));
  EXPECT_TRUE(isTaken(client, id));
  server_.publish();
  EXPECT_FALSE(isTaken(client, id));
  // Time does not advance: an answer to either state of this moment is accepted.
  server_.publish(1, true);
  EXPECT_TRUE(isTaken(client, id + 1));
}

codec::MoveRequest asynchronousMotion() {
  codec::MoveRequest request;
  request.use_async_motion_generator = true;
  request.maximum_velocity.fill(0.5);
  return request;
}

TEST_F(RobotServerTest, AcceptsTargetsOfAnAsynchronousMotionAtAnyTime) {
  TestClient client(server_.port());
  connect(client, 10);
  server_.publish();
  const std::uint64_t before = client.state()->message_id;
  startMotion(client, asynchronousMotion());
  EXPECT_TRUE(server_.asynchronous());
  server_.publish();
  const std::uint64_t first = client.state()->message_id;
  for (int i = 0; i < 49; i++) {
    server_.publish();
    EXPECT_FALSE(server_.receiveCommand());
    EXPECT_EQ(server_.takeCommand(), nullptr);
  }
  EXPECT_TRUE(isTaken(client, first)) << "its client has received no later state";
  EXPECT_FALSE(isTaken(client, before)) << "that state is from before the motion";
  EXPECT_FALSE(isTaken(client, first + 50)) << "that state has not been sent yet";
  EXPECT_TRUE(isTaken(client, first + 49));
  // The next motion is not asynchronous.
  handler_.endMotion(Status::kSuccess, RobotMode::kIdle);
  server_.publish();
  client.answer(Command::kMove);
  startMotion(client);
  EXPECT_TRUE(server_.expectsCommands());
  EXPECT_FALSE(server_.asynchronous());
}

TEST_F(RobotServerTest, ACommandThatArrivesAsTheMotionEndsIsNotTaken) {
  TestClient client(server_.port());
  connect(client, 5);
  startMotion(client);
  server_.publish();
  franka_core::RobotCommand command;
  command.message_id = client.state()->message_id;
  client.command(command);
  ASSERT_TRUE(server_.receiveCommand());
  handler_.endMotion(Status::kEmergencyAborted, RobotMode::kUserStopped);
  EXPECT_EQ(server_.takeCommand(), nullptr);
}

TEST_F(RobotServerTest, TheNewestTargetOfAnAsynchronousMotionCounts) {
  constexpr int kSent = 100;
  TestClient client(server_.port());
  connect(client, 10);
  startMotion(client, asynchronousMotion());
  franka_core::RobotCommand command;
  server_.publish();
  command.message_id = client.state()->message_id;
  const auto send = [&](double position, bool finished) {
    command.q_c.fill(position);
    command.motion_generation_finished = finished;
    client.command(command);
  };
  for (int i = 1; i <= kSent; i++) {
    send(1e-3 * i, false);
  }
  EXPECT_TRUE(server_.receiveCommand());
  const franka_core::RobotCommand* taken = server_.takeCommand();
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->q_c[0], 1e-3 * kSent);
  server_.publish();
  EXPECT_FALSE(server_.receiveCommand()) << "older targets wait for later ticks";
  send(0.2, true);
  send(0.3, false);
  EXPECT_TRUE(server_.receiveCommand());
  taken = server_.takeCommand();
  ASSERT_NE(taken, nullptr);
  EXPECT_TRUE(taken->motion_generation_finished) << "a target hides the end of the motion";
}

TEST_F(RobotServerTest, SwitchedOffEndsTheMotionAndRefusesConnections) {
  TestClient client(server_.port());
  connect(client, 5);
  startMotion(client);
  TestClient waiting(server_.port());  // not yet accepted
  handler_.on = false;
  handler_.endMotion(Status::kAborted, RobotMode::kIdle);
  serve();
  EXPECT_TRUE(waiting.ended());
  server_.publish();
  EXPECT_EQ(client.answer(Command::kMove)->reply.status, Status::kAborted);
  EXPECT_TRUE(client.ended());
  EXPECT_FALSE(server_.hasClient());
  EXPECT_FALSE(TestClient(server_.port()).connected());
  std::vector<pollfd> fds;
  server_.addDescriptors(fds);
  EXPECT_TRUE(fds.empty()) << "a closed port has nothing to poll";
  for (int i = 0; i < 2; i++) {
    handler_.on = true;
    serve();
    TestClient next(server_.port());
    ASSERT_TRUE(next.connected());
    connect(next, 5);
    handler_.on = false;
    serve();
    server_.publish();
    EXPECT_TRUE(next.ended());
  }
}

TEST_F(RobotServerTest, SwitchedOffDropsUnconfirmedConnections) {
  TestClient client(server_.port());
  serve();
  handler_.on = false;
  serve();
  EXPECT_TRUE(client.ended());
}

TEST_F(RobotServerTest, RefusesAConnectDuringAMotionAndContinuesIt) {
  for (const std::uint16_t other : {5, 6, 10}) {
    TestClient client(server_.port());
    connect(client, 5);
    startMotion(client);
    client.request(codec::ConnectRequest{other, 1});
    serve();
    const auto refused = client.answer(Command::kConnect);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->reply.status, Status::kIncompatibleLibraryVersion) << other;
    EXPECT_EQ(refused->reply.server_version, 5);
    EXPECT_EQ(server_.version(), 5);
    EXPECT_EQ(handler_.last_version, 5);
    server_.publish();
    const auto state = client.state();  // of this version, at this port
    ASSERT_TRUE(state) << other;
    franka_core::RobotCommand command;
    command.message_id = state->message_id;
    client.command(command);
    EXPECT_TRUE(server_.receiveCommand());
    EXPECT_TRUE(server_.expectsCommands());
    handler_.endMotion(Status::kSuccess, RobotMode::kIdle);
    server_.publish();
    EXPECT_EQ(client.answer(Command::kMove)->reply.status, Status::kSuccess);
    disconnect(client);
  }
}

TEST_F(RobotServerTest, RepeatsAStateByteForByte) {
  TestClient client(server_.port());
  connect(client, 5);
  server_.publish();
  const auto first = client.state();
  handler_.shown.q[0] = 1.0;
  server_.repeat();
  const auto second = client.state();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->message_id, second->message_id);
  EXPECT_EQ(first->q, second->q);
}

TEST_F(RobotServerTest, KnowsWhetherItsClientHasReadAllStates) {
  TestClient client(server_.port());
  connect(client, 10);
  server_.publish();
  server_.publish();
  EXPECT_EQ(false, server_.clientHasReadStates());
  ASSERT_TRUE(client.state());
  EXPECT_EQ(false, server_.clientHasReadStates());
  ASSERT_TRUE(client.state());
  EXPECT_EQ(true, server_.clientHasReadStates());
  client.close();
  EXPECT_EQ(std::nullopt, server_.clientHasReadStates());
}

TEST_F(RobotServerTest, DropsInvalidDatagrams) {
  TestClient client(server_.port());
  connect(client, 5);
  startMotion(client);
  server_.publish();
  const auto state = client.state();
  franka_core::RobotCommand command;
  command.message_id = state->message_id;
  codec::CommandBuffer bytes{};
  codec::encodeCommand(5, command, bytes);
  for (std::size_t size = 0; size < 420; size++) {
    std::vector<std::uint8_t> cut(420, 0);
    std::copy(bytes.begin(), bytes.end(), cut.begin());
    if (size != codec::commandSize(5)) {
      client.sendDatagram(cut.data(), size);
      server_.serve();  // resets the limit of datagrams per call of serve
      EXPECT_FALSE(server_.receiveCommand()) << size;
    }
  }
  bytes[312] = 7;
  client.sendDatagram(bytes.data(), codec::commandSize(5));
  EXPECT_FALSE(server_.receiveCommand());
  // The control unit checks for values that are not finite.
  command.q_c[0] = std::nan("");
  client.command(command);
  ASSERT_TRUE(server_.receiveCommand());
  EXPECT_TRUE(std::isnan(server_.takeCommand()->q_c[0]));
}

TEST_F(RobotServerTest, AnswersASetterWithItsStatusAfterTheStateThatContainsIt) {
  TestClient client(server_.port());
  connect(client, 5);
  for (const Status status :
       {Status::kSuccess, Status::kCommandNotPossibleRejected, Status::kInvalidArgumentRejected}) {
    handler_.answer = status;
    client.request(codec::SetLoadRequest{1.5, {}, {}});
    serve();
    EXPECT_EQ(std::get<codec::SetLoadRequest>(handler_.last).mass, 1.5);
    EXPECT_FALSE(client.answer(Command::kSetLoad, 0));
    server_.publish();
    EXPECT_EQ(client.answer(Command::kSetLoad)->reply.status, status);
  }
}

TEST_F(RobotServerTest, AnswersStopAndRecoveryWhenTheyEnd) {
  TestClient client(server_.port());
  connect(client, 5);
  handler_.answer = std::nullopt;
  const auto answerAfter = [&](const codec::Request& request, std::optional<Status>& end,
                               Status status) {
    EXPECT_FALSE(ask(client, request, 0));
    end = status;
    server_.publish();
    return client.answer(codec::commandOf(request))->reply.status;
  };
  EXPECT_EQ(answerAfter(codec::StopMoveRequest{}, handler_.stop_end, Status::kSuccess),
            Status::kSuccess);
  EXPECT_EQ(
      answerAfter(codec::AutomaticErrorRecoveryRequest{}, handler_.recovery_end, Status::kAborted),
      Status::kAborted);
}

TEST_F(RobotServerTest, DefersAllRequestsExceptStops) {
  TestClient client(server_.port());
  connect(client, 5);
  const int before = handler_.handled;
  client.request(codec::SetLoadRequest{});
  serve(true);
  EXPECT_EQ(handler_.handled, before);
  serve();
  EXPECT_EQ(handler_.handled, before + 1);
  client.request(codec::StopMoveRequest{});
  serve(true);
  EXPECT_EQ(handler_.handled, before + 1) << "there is nothing to stop";
  serve();
  EXPECT_EQ(handler_.handled, before + 2);
  handler_.startMotion();
  client.request(codec::StopMoveRequest{});
  serve(true);
  EXPECT_EQ(handler_.handled, before + 3);
}

TEST_F(RobotServerTest, HoldsAMotionUntilTheFirstTickUnlessItsModeRefusesIt) {
  TestClient client(server_.port());
  connect(client, 5);
  handler_.ticked = false;
  const int before = handler_.handled;
  client.request(codec::MoveRequest{});
  serve();
  EXPECT_EQ(handler_.handled, before);
  handler_.ticked = true;
  serve();
  EXPECT_EQ(handler_.handled, before + 1);
  handler_.ticked = false;
  client.request(codec::SetLoadRequest{});
  handler_.shown.robot_mode = RobotMode::kUserStopped;
  client.request(codec::MoveRequest{});
  serve();
  EXPECT_EQ(handler_.handled, before + 3);
}

TEST_F(RobotServerTest, KeepsTheStateThatShowsAnAbortUntilTheClientsNextRequest) {
  TestClient client(server_.port());
  connect(client, 5);
  std::uint64_t last = 0;
  const auto states = [&] {  // new ones
    int count = 0;
    while (const auto state = client.state(0)) {
      count += state->message_id > last ? 1 : 0;
      last = std::max(last, state->message_id);
    }
    return count;
  };
  const auto publish = [this](int times) {
    for (int i = 0; i < times; i++) {
      server_.publish(1, false, true);
    }
  };
  const auto move = [&] {
    startMotion(client);
    publish(3);
    EXPECT_EQ(3, states()) << "states of a motion are not kept back";
  };
  move();
  EXPECT_FALSE(server_.hasPendingState());
  handler_.endMotion(Status::kReflexAborted, RobotMode::kReflex);
  EXPECT_TRUE(server_.hasPendingState());
  publish(5);
  EXPECT_FALSE(server_.hasPendingState());
  const auto end = client.state(0);
  ASSERT_TRUE(end);
  EXPECT_EQ(RobotMode::kReflex, end->robot_mode);
  last = end->message_id;
  EXPECT_EQ(Status::kReflexAborted, client.answer(Command::kMove)->reply.status);
  EXPECT_EQ(0, states());
  server_.publish();  // the host's time for it is over
  EXPECT_EQ(1, states());
  publish(2);
  EXPECT_EQ(2, states());
  move();
  handler_.endMotion(Status::kReflexAborted, RobotMode::kReflex);
  publish(5);
  EXPECT_EQ(1, states());
  EXPECT_TRUE(client.answer(Command::kMove));
  handler_.answer = Status::kCommandNotPossibleRejected;
  client.request(codec::StopMoveRequest{});
  serve(true);  // the answer has to wait, but the client has read the abort
  publish(2);
  EXPECT_EQ(2, states());
  serve();
  publish(1);
  EXPECT_TRUE(client.answer(Command::kStopMove));
  states();
  move();
  handler_.endMotion(Status::kSuccess, RobotMode::kIdle);
  publish(5);
  EXPECT_EQ(5, states()) << "a motion that its client has finished";
}

TEST_F(RobotServerTest, ServesModelsToVersionsThatHaveThem) {
  TestClient client(server_.port());
  connect(client, 9);
  const auto library = ask(client, codec::LoadModelLibraryRequest{});
  ASSERT_TRUE(library);
#if defined(__x86_64__)
  EXPECT_EQ(library->model, (std::vector<std::uint8_t>{1, 2, 3}));
  const codec::LoadModelLibraryRequest other{codec::Architecture::kArm,
                                             codec::OperatingSystem::kLinux};
#else
  const codec::LoadModelLibraryRequest other{codec::Architecture::kX64,
                                             codec::OperatingSystem::kLinux};
#endif
  EXPECT_EQ(ask(client, other)->reply.status, Status::kError);
}

TEST_F(RobotServerTest, ReportsVirtualWalls) {
  TestClient client(server_.port());
  connect(client, 5);
  EXPECT_EQ(
      ask(client, codec::GetCartesianLimitRequest{1})->reply.cartesian_limit.object_world_size[0],
      2.0);
  EXPECT_EQ(ask(client, codec::GetCartesianLimitRequest{99})->reply.status,
            Status::kInvalidArgumentRejected);
}

TEST_F(RobotServerTest, ReadsRequestsThatComeInPieces) {
  TestClient client(server_.port());
  connect(client, 5);
  codec::RequestMessage message;
  codec::encodeRequest(5, 77, codec::SetLoadRequest{2.5, {}, {}}, message);
  for (std::size_t i = 0; i < message.size; i++) {
    ASSERT_TRUE(client.sendBytes(message.data + i, 1));
    serve();
  }
  server_.publish();
  EXPECT_EQ(client.answer(Command::kSetLoad)->header.command_id, 77U);
  EXPECT_EQ(std::get<codec::SetLoadRequest>(handler_.last).mass, 2.5);
}

TEST_F(RobotServerTest, RefusesInvalidRequests) {
  TestClient client(server_.port());
  connect(client, 5);
  codec::RequestMessage message;
  codec::encodeRequest(5, 3, codec::MoveRequest{}, message);
  message.data[12] = 9;  // no valid controller
  client.sendBytes(message.data, message.size);
  serve();
  EXPECT_EQ(client.answer(Command::kMove)->reply.status, Status::kInvalidArgumentRejected);
  // An unknown command and an invalid length: the rest of the stream is undefined.
  const std::uint32_t unknown[3] = {77, 4, 12};
  client.sendBytes(unknown, sizeof(unknown));
  serve();
  EXPECT_TRUE(client.ended());
}

TEST_F(RobotServerTest, ClosesConnectionsThatDoNotStartWithConnect) {
  TestClient client(server_.port());
  client.request(codec::StopMoveRequest{});
  serve();
  EXPECT_TRUE(client.ended());
  EXPECT_EQ(handler_.handled, 0);
}

// The server neither crashes nor stops accepting clients.
TEST_F(RobotServerTest, SurvivesRandomBytes) {
  std::mt19937 engine(5);
  for (int round = 0; round < 200; round++) {
    TestClient client(server_.port());
    if (round % 2 == 0) {
      connect(client, static_cast<std::uint16_t>(3 + round % 8));
    }
    std::vector<std::uint8_t> noise(engine() % 600);
    for (std::uint8_t& byte : noise) {
      byte = static_cast<std::uint8_t>(engine() % 4 == 0 ? engine() : 0);
    }
    client.sendBytes(noise.data(), noise.size());
    serve();
    server_.publish();
    disconnect(client);
    serve();
  }
  TestClient client(server_.port());
  connect(client, 5);
}

TEST_F(RobotServerTest, AcceptsAThousandClientsInSequence) {
  for (int i = 0; i < 1000; i++) {
    TestClient client(server_.port());
    ASSERT_TRUE(client.connected());
    client.connect(5);
    ASSERT_TRUE(answerOf(server_, client, Command::kConnect)) << i;
  }
}

TEST(RobotServerPort, LocalhostIsAnAddress) {
  FakeRequestHandler handler;
  RobotServerParameters parameters;
  parameters.port = 0;
  parameters.address = "localhost";
  EXPECT_NE(0, RobotServer(parameters, handler).port());
}

TEST(RobotServerPort, ReportsAPortInUse) {
  FakeRequestHandler handler;
  RobotServerParameters parameters;
  parameters.port = 0;
  RobotServer first(parameters, handler);
  parameters.port = first.port();
  test::expectSentence([&] { RobotServer(parameters, handler); }, {"Another simulated robot"});
  parameters.address = "robot.local";
  EXPECT_THROW(RobotServer(parameters, handler), std::runtime_error);
  parameters.address = "192.0.2.1";
  EXPECT_THROW(RobotServer(parameters, handler), std::runtime_error);
}

}  // namespace
}  // namespace franka_sim::fci
