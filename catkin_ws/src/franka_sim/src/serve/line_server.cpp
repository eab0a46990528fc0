// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/serve/line_server.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <list>
#include <optional>
#include <string_view>
#include <utility>

#include "fci/peer_user.h"
#include "fci/sockets.h"
#include "serve/line_client.h"

namespace franka_sim::fci {

namespace {

/// Time for a refused client to read the reason; and how many such clients are kept at most.
constexpr std::chrono::seconds kTimeToReadRefusal{1};
constexpr std::size_t kMaxRefused = 8;

/// Connections accepted per call; others wait for the next call.
constexpr int kAcceptedAtOnce = 16;

/// Between two states, no further line is begun after this time (chosen here: robots in real time
/// need most of each millisecond).
constexpr std::chrono::microseconds kMaxBusyTime{200};

// Its last word is the protocol (RFC 9112, section 3).
bool isHttpRequest(const std::string& line) {
  constexpr std::string_view kProtocol = "HTTP/";
  constexpr const char* kBlanks = " \t\r";
  const std::size_t last = line.find_last_of(kBlanks, line.find_last_not_of(kBlanks));
  return last != std::string::npos && line.find_first_not_of(kBlanks) < last &&
         line.find(kProtocol, last + 1) == last + 1;
}

}  // namespace

class LineServer::Impl {
 public:
  Impl(const std::string& address, std::uint16_t port, const CommandTable& commands,
       std::chrono::seconds first_line)
      : listener_(address, port), commands_(commands), first_line_(first_line) {}

  std::uint16_t port() const noexcept { return listener_.port(); }
  void serveOwnUserOnly(UserOf user_of) { user_of_ = std::move(user_of); }
  void serve();
  bool idle() const;
  void published();
  void addDescriptors(std::vector<pollfd>& fds) const;

 private:
  using Clock = LineClient::Clock;
  /// A refused connection: it is closed once its peer has read the reason.
  struct Refused {
    std::unique_ptr<Connection> connection;
    Clock::time_point until;
  };

  void receiveAll();
  /// @returns whether a client is new.
  bool accept();
  void freeSlot();
  bool serves(int connection) const;
  void executeLines();
  void dismiss(std::unique_ptr<Connection> connection, const std::string& sentence);
  void closeRefused();

  Listener listener_;
  const CommandTable& commands_;
  Clock::duration first_line_;
  std::list<LineClient> clients_;
  std::uint64_t arrivals_{0};  ///< lines until now
  Clock::duration busy_{};     ///< with lines and new clients, since states were sent
  UserOf user_of_;             ///< empty: everyone is served
  std::vector<Refused> refused_;
};

void LineServer::Impl::serve() {
  receiveAll();
  if (accept()) {
    receiveAll();
  }
  executeLines();
  closeRefused();
}

bool LineServer::Impl::idle() const {
  return refused_.empty() && std::all_of(clients_.begin(), clients_.end(),
                                         [](const LineClient& client) { return client.isQuiet(); });
}

void LineServer::Impl::receiveAll() {
  for (LineClient& client : clients_) {
    const bool has_line = client.receive(arrivals_ + 1);
    arrivals_ += has_line ? 1 : 0;
    if (client.lineIsTooLong()) {
      dismiss(client.releaseConnection(), "error: A line is longer than 4000 characters.");
    } else if (has_line && isHttpRequest(*client.line())) {
      dismiss(client.releaseConnection(),
              "error: This is a robot's control interface, not a web server; Desk's address is "
              "another one.");
    }
  }
  clients_.remove_if([](const LineClient& client) { return client.isGone(); });
}

bool LineServer::Impl::accept() {
  bool any = false;
  for (int accepted = 0; accepted < kAcceptedAtOnce && busy_ <= kMaxBusyTime; ++accepted) {
    const Clock::time_point begin = Clock::now();
    sockaddr_in peer{};
    Descriptor socket = listener_.accept(peer);
    if (!socket) {
      break;
    }
    auto connection = std::make_unique<Connection>(std::move(socket));
    connection->watchPeer();
    const bool served = serves(connection->descriptor());
    busy_ += Clock::now() - begin;
    if (!served) {
      dismiss(std::move(connection),
              "error: Behind Desk, the control interface serves programs on this machine of the "
              "user who runs the robot: use Desk, or that user's account.");
      continue;
    }
    freeSlot();
    if (clients_.size() < kMaxClients) {
      clients_.emplace_back(std::move(connection));
      any = true;
    } else {
      dismiss(std::move(connection),
              "error: " + std::to_string(kMaxClients) +
                  " clients use this control interface, which takes no more: end one of them, then "
                  "connect again.");
    }
  }
  return any;
}

bool LineServer::Impl::serves(int connection) const {
  const std::optional<uid_t> user = user_of_ ? user_of_(connection) : ::geteuid();
  return user == ::geteuid() || user == uid_t{0};
}

// Closes a connection for the newest one, if there are too many: first clients that have just left,
// or have ended and wait for an answer, then the one that has been silent for longest.
void LineServer::Impl::freeSlot() {
  if (clients_.size() < kMaxClients) {
    return;
  }
  receiveAll();
  if (clients_.size() < kMaxClients) {
    return;
  }
  const auto ended = std::find_if(clients_.begin(), clients_.end(),
                                  [](const LineClient& client) { return client.hasEnded(); });
  if (ended != clients_.end()) {
    ended->sendAnswer();
    clients_.erase(ended);
    return;
  }
  const auto latest = Clock::now() - first_line_;
  const auto silent =
      std::find_if(clients_.begin(), clients_.end(),
                   [latest](const LineClient& client) { return client.isSilentSince(latest); });
  if (silent != clients_.end()) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(first_line_).count();
    dismiss(silent->releaseConnection(),
            "error: No line has come from here within " + std::to_string(seconds) +
                " s, and another client waits: connect again when you need to.");
    clients_.erase(silent);
  }
}

void LineServer::Impl::executeLines() {
  clients_.sort([](const LineClient& a, const LineClient& b) { return a.arrival() < b.arrival(); });
  for (LineClient& client : clients_) {
    if (!client.line() || busy_ > kMaxBusyTime || !commands_.isReady(*client.line())) {
      continue;
    }
    const Clock::time_point begin = Clock::now();
    client.answerWith(commands_.execute(*client.line()));
    busy_ += Clock::now() - begin;
  }
}

void LineServer::Impl::published() {
  busy_ = {};
  for (LineClient& client : clients_) {
    client.sendAnswer();
  }
}

void LineServer::Impl::dismiss(std::unique_ptr<Connection> connection,
                               const std::string& sentence) {
  sendLine(*connection, sentence);
  // Closing at once, with unread lines of the peer, would discard the sentence.
  ::shutdown(connection->descriptor(), SHUT_WR);
  if (refused_.size() < kMaxRefused) {
    refused_.push_back({std::move(connection), Clock::now() + kTimeToReadRefusal});
  }
}

void LineServer::Impl::closeRefused() {
  const auto gone = [](Refused& leaving) {
    const bool open = leaving.connection->receive();
    leaving.connection->consume(leaving.connection->received().size);
    return !open || Clock::now() > leaving.until;
  };
  refused_.erase(std::remove_if(refused_.begin(), refused_.end(), gone), refused_.end());
}

void LineServer::Impl::addDescriptors(std::vector<pollfd>& fds) const {
  fds.push_back({listener_.descriptor(), POLLIN, 0});
  for (const LineClient& client : clients_) {
    client.addDescriptor(fds);
  }
}

LineServer::LineServer(const std::string& address, std::uint16_t port, const CommandTable& commands,
                       std::chrono::seconds first_line)
    : impl_(std::make_unique<Impl>(address, port, commands, first_line)) {}

LineServer::~LineServer() {
  try {
    impl_->published();
  } catch (const std::exception&) {
    // The end of the server is the answer then.
  }
}

std::uint16_t LineServer::port() const noexcept { return impl_->port(); }

void LineServer::serveOwnUserOnly(UserOf user_of) {
  impl_->serveOwnUserOnly(user_of ? std::move(user_of) : UserOf(peerUser));
}

void LineServer::serve() { impl_->serve(); }

bool LineServer::idle() const { return impl_->idle(); }

void LineServer::published() { impl_->published(); }

void LineServer::addDescriptors(std::vector<pollfd>& fds) const { impl_->addDescriptors(fds); }

}  // namespace franka_sim::fci
