// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/serve/line_server.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <list>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "fci/peer_user.h"
#include "fci/sockets.h"

namespace franka_sim::fci {

Reply Reply::when(std::function<bool()> done) {
  return Reply(
      [done = std::move(done)] { return done() ? std::optional<std::string>("") : std::nullopt; });
}

std::optional<std::string> Reply::line() {
  try {
    if (!value_) {
      value_ = later_();
    }
    if (!value_) {
      return {};
    }
    return value_->empty() ? "ok" : "ok " + *value_;
  } catch (const std::exception& error) {
    return std::string("error: ") + error.what();
  }
}

namespace {

constexpr std::size_t kMaxLineLength = 4000;

/// @returns false once the peer has vanished.
bool sendLine(Connection& connection, const std::string& text) {
  const std::string line = text + "\n";
  return connection.send({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
}

}  // namespace

/// One client of a LineServer: its connection, its line and the answer to it. One line is in
/// progress; the next one is read once the answer to it has been sent. Used by the server's thread.
class LineClient {
 public:
  using Clock = std::chrono::steady_clock;

  explicit LineClient(std::unique_ptr<Connection> connection);

  /// Reads and sends what the socket allows. @param arrival number of the line, if one is new
  /// @returns whether one is new.
  bool receive(std::uint64_t arrival);
  /// The line that waits to be executed.
  const std::optional<std::string>& line() const noexcept { return line_; }
  /// Number of that line, or of the one before it; 0 as long as none has come.
  std::uint64_t arrival() const noexcept { return arrival_; }
  /// That line has been executed.
  void answerWith(Reply reply);
  /// Sends the answer, if there is one that need not wait.
  void sendAnswer();

  /// Whether it has sent no line until now, since before this time.
  bool isSilentSince(Clock::time_point time) const noexcept {
    return arrival_ == 0 && accepted_at_ <= time;
  }
  bool lineIsTooLong() const noexcept;
  /// Whether there is nothing to do until its socket reports something.
  bool isQuiet() const noexcept;
  /// Whether it sends no more; it may still wait for answers.
  bool hasEnded() const noexcept { return has_ended_; }
  /// Whether it has been released or has vanished, or has ended and has all its answers.
  bool isGone() const noexcept;
  void addDescriptor(std::vector<pollfd>& fds) const;
  /// For a last sentence; the client is not used any more.
  std::unique_ptr<Connection> releaseConnection() noexcept { return std::move(connection_); }

 private:
  bool isIdle() const noexcept { return !line_ && !reply_; }
  /// Of the next line in the buffer, without its end.
  std::optional<std::size_t> lineSize() const noexcept;

  std::unique_ptr<Connection> connection_;
  Clock::time_point accepted_at_{Clock::now()};
  std::uint64_t arrival_{0};
  bool has_ended_{false};
  bool is_broken_{false};
  std::optional<std::string> line_;
  std::optional<Reply> reply_;  ///< to its last line; kept until states have been sent
};

LineClient::LineClient(std::unique_ptr<Connection> connection)
    : connection_(std::move(connection)) {}

bool LineClient::receive(std::uint64_t arrival) {
  has_ended_ = !connection_->receive() || has_ended_;
  is_broken_ = !connection_->flush() || is_broken_;
  if (!isIdle() || connection_->hasUnsent()) {
    return false;  // a client that does not read answers gets no more
  }
  const std::optional<std::size_t> size = lineSize();
  if (!size) {
    return false;
  }
  line_.emplace(connection_->received().data, connection_->received().data + *size);
  connection_->consume(*size + 1);
  arrival_ = arrival;
  return true;
}

std::optional<std::size_t> LineClient::lineSize() const noexcept {
  const Bytes stream = connection_->received();
  const std::uint8_t* const end = stream.data + stream.size;
  const std::uint8_t* const line_end = std::find(stream.data, end, '\n');
  return line_end == end ? std::nullopt : std::optional<std::size_t>(line_end - stream.data);
}

void LineClient::answerWith(Reply reply) {
  line_.reset();
  reply_ = std::move(reply);
}

void LineClient::sendAnswer() {
  const std::optional<std::string> answer = reply_ ? reply_->line() : std::nullopt;
  if (answer) {
    is_broken_ = !sendLine(*connection_, *answer) || is_broken_;
    reply_.reset();
  }
}

bool LineClient::lineIsTooLong() const noexcept {
  return isIdle() && connection_->received().size >= kMaxLineLength && !lineSize();
}

bool LineClient::isQuiet() const noexcept {
  return isIdle() && !has_ended_ && !is_broken_ && !connection_->hasUnsent() && !lineSize();
}

bool LineClient::isGone() const noexcept {
  return !connection_ || is_broken_ ||
         (has_ended_ && isIdle() && !connection_->hasUnsent() && !lineSize());
}

void LineClient::addDescriptor(std::vector<pollfd>& fds) const {
  if (isIdle() && !has_ended_) {
    const short events = connection_->hasUnsent() ? POLLIN | POLLOUT : POLLIN;
    fds.push_back({connection_->descriptor(), events, 0});
  }
}

namespace {

/// Time for a refused client to read the reason; and how many such clients are kept at most.
constexpr std::chrono::seconds kTimeToReadRefusal{1};
constexpr std::size_t kMaxRefused = 8;

/// Connections accepted per call; others wait for the next call.
constexpr int kAcceptedAtOnce = 16;

/// Between two states, no further line is begun after this time (chosen here: robots in real time
/// need most of each millisecond).
constexpr std::chrono::microseconds kMaxBusyTime{200};

std::vector<std::string> split(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

std::string nameIn(const std::string& line) {
  const std::vector<std::string> words = split(line);
  return words.empty() ? "" : words.front();
}

// Its last word is the protocol (RFC 9112, section 3).
bool isHttpRequest(const std::string& line) {
  constexpr std::string_view kProtocol = "HTTP/";
  const std::vector<std::string> words = split(line);
  return words.size() > 1 && words.back().compare(0, kProtocol.size(), kProtocol) == 0;
}

Reply error(const std::string& sentence) {
  return Reply([sentence]() -> std::optional<std::string> { throw std::runtime_error(sentence); });
}

}  // namespace

class LineServer::Impl {
 public:
  Impl(const std::string& address, std::uint16_t port, std::chrono::seconds first_line)
      : listener_(address, port), first_line_(first_line) {}

  std::uint16_t port() const noexcept { return listener_.port(); }
  void serveOwnUserOnly(UserOf user_of) { user_of_ = std::move(user_of); }
  void add(const std::string& usage, Handler handler, Ready ready);
  void serve();
  bool idle() const;
  void published();
  void addDescriptors(std::vector<pollfd>& fds) const;

 private:
  using Clock = LineClient::Clock;
  struct Entry {
    std::string usage;
    Handler handler;
    Ready ready;
  };
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
  Reply execute(const std::string& line) const;
  bool isReady(const std::string& line) const;
  std::string help() const;
  void dismiss(std::unique_ptr<Connection> connection, const std::string& sentence);
  void closeRefused();

  Listener listener_;
  Clock::duration first_line_;
  std::list<LineClient> clients_;
  std::uint64_t arrivals_{0};  ///< lines until now
  Clock::duration busy_{};     ///< with lines and new clients, since states were sent
  UserOf user_of_;             ///< empty: everyone is served
  std::vector<Refused> refused_;
  std::map<std::string, Entry> entries_;
};

void LineServer::Impl::add(const std::string& usage, Handler handler, Ready ready) {
  entries_[usage.substr(0, usage.find(' '))] = {usage, std::move(handler), std::move(ready)};
}

std::string LineServer::Impl::help() const {
  std::string text;
  for (const auto& entry : entries_) {
    text += (text.empty() ? "" : "; ") + entry.second.usage;
  }
  return text;
}

Reply LineServer::Impl::execute(const std::string& line) const {
  std::vector<std::string> words = split(line);
  if (words.empty() || words.front() == "help") {
    return help();
  }
  const auto entry = entries_.find(words.front());
  if (entry == entries_.end()) {
    return error("There is no command '" + words.front() + "'; help lists them.");
  }
  words.erase(words.begin());
  try {
    return entry->second.handler(Words(std::move(words)));
  } catch (const MissingWord&) {
    return error("Words are missing: " + entry->second.usage + ".");
  } catch (const std::exception& failure) {
    return error(failure.what());
  } catch (...) {
    return error("The command failed with an unknown error.");
  }
}

bool LineServer::Impl::isReady(const std::string& line) const {
  const auto entry = entries_.find(nameIn(line));
  return entry == entries_.end() || entry->second.ready();
}

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
    if (!client.line() || busy_ > kMaxBusyTime || !isReady(*client.line())) {
      continue;
    }
    const Clock::time_point begin = Clock::now();
    client.answerWith(execute(*client.line()));
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

LineServer::LineServer(const std::string& address, std::uint16_t port,
                       std::chrono::seconds first_line)
    : impl_(std::make_unique<Impl>(address, port, first_line)) {}

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

void LineServer::add(const std::string& usage, Handler handler, Ready ready) {
  impl_->add(usage, std::move(handler), std::move(ready));
}

void LineServer::serve() { impl_->serve(); }

bool LineServer::idle() const { return impl_->idle(); }

void LineServer::published() { impl_->published(); }

void LineServer::addDescriptors(std::vector<pollfd>& fds) const { impl_->addDescriptors(fds); }

double toNumber(const std::string& word) {
  if (const std::optional<double> value = franka_core::readNumber(word)) {
    return *value;
  }
  throw std::invalid_argument("'" + word + "' is not a finite number.");
}

std::uint64_t toSeed(const std::string& word) {
  std::uint64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end) {
    throw std::invalid_argument(
        "'" + word + "' is not a seed: give a whole number from 0 to 18446744073709551615.");
  }
  return value;
}

bool toSwitch(const std::string& word) {
  if (word != "on" && word != "off") {
    throw std::invalid_argument("'" + word + "' is neither on nor off.");
  }
  return word == "on";
}

}  // namespace franka_sim::fci
