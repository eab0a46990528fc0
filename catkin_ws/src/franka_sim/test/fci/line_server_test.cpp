// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <franka_sim/serve/line_server.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "fci/sockets.h"

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
    table.add(line("count"), "", kNotOnPage, [this] { return std::to_string(++count); });
    table.add(line("wait"), "", kNotOnPage, [] { return "done"; }).ready = [this] { return ready; };
  }
  /// Serves pending lines, then publishes states.
  void tick() {
    server.serve();
    server.published();
  }

  int count{0};
  bool ready{false};
  CommandTable table;
  LineServer server{kAddress, 0, table, std::chrono::seconds(5)};
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

TEST_F(LineServerTest, AnswersOnceTheEffectHasComeAbout) {
  bool effect = false;
  table.add(line("act", text("WORD")), "", kNotOnPage, [&effect](const std::string& word) {
    return Reply(
        [&effect, word] { return effect ? std::optional<std::string>(word) : std::nullopt; });
  });
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
  EXPECT_EQ("error: This line is written: act WORD.\n", user.sees()) << "and has no effect";
}

TEST_F(LineServerTest, AnswersWhateverACommandThrows) {
  table.add(line("robot"), "", kNotOnPage, [] { throw std::out_of_range("There is no robot."); });
  table.add(line("fall"), "", kNotOnPage, [] { throw 7; });
  bool failed = false;
  table.add(line("grasp"), "", kNotOnPage, [&failed] {
    return Reply([&failed]() -> std::optional<std::string> {
      return failed ? throw std::runtime_error("Nothing was grasped.") : std::nullopt;
    });
  });
  Operator user(server);
  user.type("grasp\nrobot\nfall\ncount\n");
  tick();
  EXPECT_EQ("(nothing)", user.sees());
  failed = true;
  tick();
  EXPECT_EQ("error: Nothing was grasped.\n", user.sees());
  tick();
  EXPECT_EQ("error: There is no robot.\n", user.sees());
  tick();
  EXPECT_EQ("error: The command failed with an unknown error.\n", user.sees());
  tick();
  EXPECT_EQ("ok 1\n", user.sees());
}

TEST(LineServer, GivesNoAnswerWhenItEndsBeforeTheEffect) {
  for (const bool effect : {true, false}) {
    CommandTable table;
    table.add(line("act"), "", kNotOnPage,
              [effect] { return Reply::when([effect] { return effect; }); });
    std::optional<LineServer> server;
    server.emplace(kAddress, 0, table);
    Operator user(*server);
    user.type("act\n");
    server->serve();
    server.reset();
    EXPECT_EQ(effect ? "ok\n" : "(end)", user.sees());
  }
}

TEST_F(LineServerTest, ExecutesTheLinesOfSeveralClientsInOrderOfArrival) {
  std::string words;
  table.add(line("say", text("WORD")), "", kNotOnPage, [&words](const std::string& word) {
    words += word;
    return word;
  });
  Operator first(server);
  Operator second(server);
  second.type("say a\nsay c\n");
  tick();
  first.type("say b\n");
  tick();
  tick();
  EXPECT_EQ("ok a\nok c\n", second.sees());
  EXPECT_EQ("ok b\n", first.sees());
  EXPECT_EQ("abc", words) << "a client's next line arrives when the last one has been answered";
}

TEST_F(LineServerTest, ALineThatIsNotReadyDelaysNoOtherClient) {
  Operator first(server);
  Operator second(server);
  first.type("wait\ncount\n");
  tick();
  second.type("count\ncount\n");
  tick();
  tick();
  EXPECT_EQ("ok 1\nok 2\n", second.sees());
  EXPECT_EQ("(nothing)", first.sees());
  ready = true;
  tick();
  EXPECT_EQ("ok done\n", first.sees());
  tick();
  EXPECT_EQ("ok 3\n", first.sees()) << "its next line has waited, too";
}

TEST_F(LineServerTest, EachClientGetsTheAnswerOfItsOwnLine) {
  int now = 0;
  table.add(line("until", number("TIME", "s")), "", kNotOnPage,
            [&now](double end) { return Reply::when([&now, end] { return now >= end; }); });
  Operator first(server);
  Operator second(server);
  first.type("until 1\n");
  tick();
  second.type("until 2\n");
  tick();
  now = 1;
  tick();
  EXPECT_EQ("ok\n", first.sees());
  EXPECT_EQ("(nothing)", second.sees());
  now = 2;
  tick();
  EXPECT_EQ("ok\n", second.sees());
}

TEST_F(LineServerTest, BeginsNoFurtherLineInATickAfterLongOnes) {
  table.add(line("toil"), "", kNotOnPage, [] {
    std::this_thread::sleep_for(std::chrono::microseconds(300));  // the fault itself
  });
  Operator first(server);
  Operator second(server);
  first.type("toil\n");
  second.type("toil\n");
  server.serve();
  server.serve();
  server.published();
  EXPECT_EQ("ok\n(nothing)", first.sees() + second.sees());
  tick();
  EXPECT_EQ("ok\n", second.sees());
}

/// As many clients as are served at a time; each has sent a line.
class FullLineServerTest : public LineServerTest {
 protected:
  FullLineServerTest() {
    for (std::size_t i = 0; i < LineServer::kMaxClients; i++) {
      users.push_back(std::make_unique<Operator>(server));
      users.back()->type("count\n");
      tick();
      EXPECT_EQ("ok " + std::to_string(i + 1) + "\n", users.back()->sees());
    }
  }

  std::vector<std::unique_ptr<Operator>> users;
};

TEST_F(FullLineServerTest, RefusesAnotherClientWithASentence) {
  Operator other(server);
  other.type("count\n");
  tick();
  const std::string reply = other.sees();
  EXPECT_EQ(0u, reply.find("error: 8 clients use this control interface")) << reply;
  EXPECT_EQ("(end)", other.sees());
  EXPECT_EQ(8, count) << "and executes no line of it";
  users[3]->leave();
  Operator next(server);
  next.type("count\n");
  tick();
  EXPECT_EQ("ok 9\n", next.sees());
}

TEST_F(FullLineServerTest, ClientThatLeavesBeforeTheEffectFreesASlot) {
  table.add(line("never"), "", kNotOnPage, [] { return Reply::when([] { return false; }); });
  users[5]->type("never\n");
  tick();
  users[5]->leave();
  Operator next(server);
  next.type("count\n");
  tick();
  EXPECT_EQ("ok 9\n", next.sees());
}

TEST(LineServer, HasNoTimeLimitUntilItIsFull) {
  CommandTable table;
  table.add(line("count"), "", kNotOnPage, [] { return "1"; });
  LineServer server(kAddress, 0, table, std::chrono::seconds(0));
  const auto tick = [&server] {
    server.serve();
    server.published();
  };
  std::vector<std::unique_ptr<Operator>> users;
  for (std::size_t i = 0; i < LineServer::kMaxClients; i++) {
    users.push_back(std::make_unique<Operator>(server));
    tick();
  }
  users[0]->type("cou");
  tick();
  users[0]->type("nt\n");
  tick();
  EXPECT_EQ("ok 1\n", users[0]->sees());
  Operator other(server);
  other.type("count\n");
  tick();
  const std::string reply = users[1]->sees();
  EXPECT_EQ(0u, reply.find("error: No line has come from here within")) << reply;
  EXPECT_EQ("(end)", users[1]->sees());
  EXPECT_EQ("ok 1\n", other.sees());
  EXPECT_EQ("(nothing)", users[2]->sees());
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

// Such as a page in a browser sends without asking the server; its body may hold lines.
TEST_F(LineServerTest, ClosesAConnectionThatSendsAnHttpRequest) {
  for (const std::string request :
       {"POST / HTTP/1.1\r\nHost: 127.0.0.1:1340\r\n\r\ncount\n", "GET /count HTTP/1.0\n",
        "count http://127.0.0.1 HTTP/2\ncount\n"}) {
    Operator page(server);
    page.type(request);
    tick();
    const std::string reply = page.sees();
    EXPECT_EQ(0u, reply.find("error: ")) << reply;
    EXPECT_EQ(std::string::npos, reply.find("ok")) << reply;
    EXPECT_EQ("(end)", page.sees());
    page.type("count\n");
    tick();
    EXPECT_EQ(0, count);
  }
  Operator user(server);
  user.type("count\n");
  tick();
  EXPECT_EQ("ok 1\n", user.sees());
}

TEST_F(LineServerTest, ServesItsOwnUserOnly) {
  server.serveOwnUserOnly();
  Operator user(server);
  user.type("count\n");
  tick();
  EXPECT_EQ("ok 1\n", user.sees());
  Operator vanished(server);
  vanished.type("count\n");
  vanished.leave();
  tick();
  EXPECT_EQ(1, count) << "whose it was is not known any more";
  for (const std::optional<uid_t> other :
       {std::optional<uid_t>(::geteuid() + 1), std::optional<uid_t>()}) {
    server.serveOwnUserOnly([other](int /*connection*/) { return other; });
    Operator stranger(server);
    stranger.type("count\n");
    tick();
    const std::string reply = stranger.sees();
    EXPECT_EQ(0u, reply.find("error: Behind Desk")) << reply;
    EXPECT_EQ("(end)", stranger.sees());
  }
  EXPECT_EQ(1, count);
  user.type("count\n");
  tick();
  EXPECT_EQ("ok 2\n", user.sees()) << "connections stay";
}

TEST_F(LineServerTest, RefusesALineThatIsTooLong) {
  Operator user(server);
  user.type(std::string(4500, 'x'));
  tick();
  EXPECT_EQ("error: A line is longer than 4000 characters.\n", user.sees());
}

}  // namespace
}  // namespace franka_sim::fci
