// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <franka_sim/fci/line_server.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim::fci {
namespace {

constexpr char kAddress[] = "127.0.0.1";

/// The user's terminal. Loopback delivers immediately, so that nothing here waits.
class Operator {
 public:
  explicit Operator(const LineServer& server) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_port = htons(server.port());
    inet_pton(AF_INET, kAddress, &name.sin_addr);
    EXPECT_EQ(0, ::connect(socket_.get(), reinterpret_cast<sockaddr*>(&name), sizeof(name)));
    const timeval patience{5, 0};
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  }
  void type(const std::string& text) {
    EXPECT_EQ(static_cast<ssize_t>(text.size()),
              ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL));
  }
  void end() { ::shutdown(socket_.get(), SHUT_WR); }
  void leave() { socket_.close(); }
  /// Returns received text; "(nothing)", or "(end)" if the server has closed.
  std::string sees() {
    char text[1000];
    const ssize_t size = ::recv(socket_.get(), text, sizeof(text), MSG_DONTWAIT);
    return size > 0 ? std::string(text, static_cast<std::size_t>(size))
                    : (size == 0 ? "(end)" : "(nothing)");
  }

 private:
  Descriptor socket_;
};

class LineServerTest : public ::testing::Test {
 protected:
  LineServerTest() {
    server.add("count",
               [this](const LineServer::Words& /*words*/) { return std::to_string(++count); });
    server.add(
        "wait", [](const LineServer::Words& /*words*/) { return "done"; },
        [this] { return ready; });
  }
  /// Serves pending lines, then publishes states.
  void tick() {
    server.serve();
    server.published();
  }

  int count{0};
  bool ready{false};
  LineServer server{kAddress, 0, std::chrono::seconds(5)};
};

TEST_F(LineServerTest, AnswersAfterStatesWereSent) {
  Operator user(server);
  user.type("count\ncount\n");
  server.serve();
  EXPECT_EQ(1, count) << "the second line waits for the first answer";
  EXPECT_EQ("(nothing)", user.sees());
  server.published();
  EXPECT_EQ("ok 1\n", user.sees());
  tick();
  EXPECT_EQ("ok 2\n", user.sees());
}

TEST_F(LineServerTest, KeepsALineUntilItIsReady) {
  Operator user(server);
  user.type("wait\ncount\n");
  tick();
  tick();
  EXPECT_EQ("(nothing)", user.sees());
  EXPECT_EQ(0, count);
  ready = true;
  tick();
  EXPECT_EQ("ok done\n", user.sees());
  tick();
  EXPECT_EQ("ok 1\n", user.sees());
}

TEST_F(LineServerTest, AnswersOnceTheEffectHasComeAbout) {
  bool effect = false;
  server.add(
      "act", [](const LineServer::Words& words) { return words.at(0); }, [] { return true; },
      [&effect] { return effect; });
  Operator user(server);
  user.type("act now\ncount\n");
  tick();
  tick();
  EXPECT_EQ("(nothing)", user.sees());
  EXPECT_EQ(0, count) << "the next line waits, too";
  effect = true;
  tick();
  EXPECT_EQ("ok now\n", user.sees());
  tick();
  EXPECT_EQ("ok 1\n", user.sees());
  effect = false;
  user.type("act\n");
  tick();
  EXPECT_EQ("error: Words are missing: act.\n", user.sees()) << "a refused line has no effect";
}

TEST_F(LineServerTest, AClientThatLeavesBeforeTheEffectMakesRoom) {
  server.add(
      "never", [](const LineServer::Words& /*words*/) { return ""; }, [] { return true; },
      [] { return false; });
  Operator first(server);
  first.type("never\n");
  tick();
  first.leave();
  Operator second(server);
  second.type("count\n");
  tick();
  EXPECT_EQ("ok 1\n", second.sees());
}

TEST(LineServer, GivesNoAnswerWhenItEndsBeforeTheEffect) {
  for (const bool effect : {true, false}) {
    std::optional<LineServer> server;
    server.emplace(kAddress, 0);
    server->add(
        "act", [](const LineServer::Words& /*words*/) { return ""; }, [] { return true; },
        [effect] { return effect; });
    Operator user(*server);
    user.type("act\n");
    server->serve();
    server.reset();
    EXPECT_EQ(effect ? "ok\n" : "(end)", user.sees());
  }
}

TEST_F(LineServerTest, RefusesASecondClientWithASentence) {
  Operator first(server);
  first.type("count\n");
  tick();
  Operator second(server);
  second.type("count\n");
  tick();
  const std::string reply = second.sees();
  EXPECT_EQ(0u, reply.find("error: Another client holds this control interface")) << reply;
  EXPECT_EQ("(end)", second.sees());
  EXPECT_EQ(1, count) << "and runs no command of it";
  EXPECT_EQ("ok 1\n", first.sees());
  first.leave();
  Operator third(server);
  third.type("count\n");
  tick();
  EXPECT_EQ("ok 2\n", third.sees());
}

TEST(LineServer, HasNoTimeLimitUntilAnotherClientComes) {
  LineServer server(kAddress, 0, std::chrono::seconds(0));
  server.add("count", [](const LineServer::Words& /*words*/) { return "1"; });
  const auto tick = [&server] {
    server.serve();
    server.published();
  };
  Operator slow(server);
  for (int i = 0; i < 5; i++) {
    tick();
  }
  slow.type("cou");
  tick();
  slow.type("nt\n");
  tick();
  EXPECT_EQ("ok 1\n", slow.sees());
  slow.leave();
  Operator silent(server);
  tick();
  Operator other(server);
  other.type("count\n");
  tick();
  const std::string reply = silent.sees();
  EXPECT_EQ(0u, reply.find("error: No line has come from here within")) << reply;
  EXPECT_EQ("(end)", silent.sees());
  EXPECT_EQ("ok 1\n", other.sees());
}

TEST_F(LineServerTest, AnswersAllLinesOfAHalfClosedConnection) {
  Operator user(server);
  user.type("count\ncount\n");
  user.end();
  tick();
  tick();
  tick();
  EXPECT_EQ("ok 1\nok 2\n", user.sees());
  EXPECT_EQ("(end)", user.sees());
}

TEST_F(LineServerTest, RefusesALineThatIsTooLong) {
  Operator user(server);
  user.type(std::string(4500, 'x'));
  tick();
  EXPECT_EQ("error: A line is longer than 4000 characters.\n", user.sees());
}

TEST(LineServer, SendsTheLastAnswerWhenDestroyed) {
  auto server = std::make_unique<LineServer>(kAddress, 0);
  server->add("quit", [](const LineServer::Words& /*words*/) { return ""; });
  Operator user(*server);
  user.type("quit\n");
  server->serve();
  server.reset();
  EXPECT_EQ("ok\n", user.sees());
}

}  // namespace
}  // namespace franka_sim::fci
