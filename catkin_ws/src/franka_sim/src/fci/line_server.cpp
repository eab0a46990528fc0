// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/fci/line_server.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace franka_sim::fci {

namespace {

LineServer::Words split(const std::string& line) {
  std::istringstream stream(line);
  LineServer::Words words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

std::string nameIn(const std::string& line) {
  const LineServer::Words words = split(line);
  return words.empty() ? "" : words.front();
}

bool sendLine(Connection& connection, const std::string& text) {
  const std::string line = text + "\n";
  return connection.send({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
}

/// Time for a refused client to read the reason; and how many such clients are kept at most.
constexpr std::chrono::seconds kTimeToLeave{1};
constexpr std::size_t kMostLeaving = 8;

/// Connections accepted per call; others wait for the next call.
constexpr int kAcceptedAtOnce = 16;

}  // namespace

void LineServer::add(const std::string& usage, Handler handler, Ready ready, Ready done) {
  entries_[usage.substr(0, usage.find(' '))] = {usage, std::move(handler), std::move(ready),
                                                std::move(done)};
}

std::string LineServer::help() const {
  std::string text;
  for (const auto& entry : entries_) {
    text += (text.empty() ? "" : "; ") + entry.second.usage;
  }
  return text;
}

std::string LineServer::answer(const std::string& line) const {
  Words words = split(line);
  if (words.empty() || words.front() == "help") {
    return "ok " + help();
  }
  const auto entry = entries_.find(words.front());
  if (entry == entries_.end()) {
    return "error: There is no command '" + words.front() + "'; help lists them.";
  }
  words.erase(words.begin());
  try {
    const std::string value = entry->second.handler(words);
    return value.empty() ? "ok" : "ok " + value;
  } catch (const std::out_of_range&) {
    return "error: Words are missing: " + entry->second.usage + ".";
  } catch (const std::exception& error) {
    return std::string("error: ") + error.what();
  }
}

bool LineServer::isReady(const std::string& line) const {
  const auto entry = entries_.find(nameIn(line));
  return entry == entries_.end() || entry->second.ready();
}

bool LineServer::isDone() const { return !done_ || done_(); }

LineServer::~LineServer() {
  if (client_ && answer_ && isDone()) {
    sendLine(*client_, *answer_);
  }
}

void LineServer::serve() {
  serveClient();
  accept();
  serveClient();
  closeLeaving();
}

void LineServer::accept() {
  for (int accepted = 0; accepted < kAcceptedAtOnce; ++accepted) {
    sockaddr_in peer{};
    Descriptor socket = listener_.accept(peer);
    if (!socket) {
      return;
    }
    auto connection = std::make_unique<Connection>(std::move(socket));
    serveClient();  // a client that reconnects at once may still occupy the slot
    if (client_ && has_ended_) {
      published();
      client_.reset();
    }
    if (client_ && (has_spoken_ || Clock::now() - accepted_at_ < first_line_)) {
      dismiss(std::move(connection),
              "error: Another client holds this control interface, which takes one at a time: end "
              "that one, then connect again.");
      continue;
    }
    if (client_) {
      dismiss(std::move(client_),
              "error: No line has come from here within " +
                  std::to_string(
                      std::chrono::duration_cast<std::chrono::seconds>(first_line_).count()) +
                  " s, and another client waits: connect again when you need to.");
    }
    client_ = std::move(connection);
    accepted_at_ = Clock::now();
    has_spoken_ = has_ended_ = waits_ = false;
    answer_.reset();
  }
}

void LineServer::serveClient() {
  constexpr std::size_t kLongestLine = 4000;
  if (!client_) {
    return;
  }
  has_ended_ = !client_->receive() || !client_->flush() || has_ended_;
  if (answer_ || client_->hasUnsent()) {
    return;  // a client that does not read answers gets no more
  }
  const Bytes stream = client_->received();
  const std::uint8_t* const end = stream.data + stream.size;
  const std::uint8_t* const line_end = std::find(stream.data, end, '\n');
  if (line_end == end) {
    if (has_ended_) {
      client_.reset();
    } else if (stream.size >= kLongestLine) {
      dismiss(std::move(client_), "error: A line is longer than 4000 characters.");
    }
    return;
  }
  has_spoken_ = true;
  const std::string line(stream.data, line_end);
  waits_ = !isReady(line);
  if (!waits_) {
    client_->consume(line.size() + 1);
    answer_ = answer(line);
    const auto entry = entries_.find(nameIn(line));
    const bool executed = entry != entries_.end() && answer_->rfind("ok", 0) == 0;
    done_ = executed ? entry->second.done : Ready();
  }
}

void LineServer::published() {
  if (client_ && answer_ && !isDone()) {
    return;
  }
  if (client_ && answer_ && !sendLine(*client_, *answer_)) {
    client_.reset();
  }
  answer_.reset();
}

void LineServer::dismiss(std::unique_ptr<Connection> connection, const std::string& sentence) {
  sendLine(*connection, sentence);
  // Closing at once, with unread lines of the peer, would discard the sentence.
  ::shutdown(connection->descriptor(), SHUT_WR);
  if (leaving_.size() < kMostLeaving) {
    leaving_.push_back({std::move(connection), Clock::now() + kTimeToLeave});
  }
}

void LineServer::closeLeaving() {
  const auto gone = [](Leaving& leaving) {
    const bool open = leaving.connection->receive();
    leaving.connection->consume(leaving.connection->received().size);
    return !open || Clock::now() > leaving.until;
  };
  leaving_.erase(std::remove_if(leaving_.begin(), leaving_.end(), gone), leaving_.end());
}

void LineServer::addDescriptors(std::vector<pollfd>& fds) const {
  fds.push_back({listener_.descriptor(), POLLIN, 0});
  if (client_ && !answer_ && !has_ended_ && !waits_) {
    const short events = client_->hasUnsent() ? POLLIN | POLLOUT : POLLIN;
    fds.push_back({client_->descriptor(), events, 0});
  }
}

double toNumber(const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !std::isfinite(value)) {
    throw std::invalid_argument("'" + word + "' is not a finite number.");
  }
  return value;
}

std::uint64_t toSeed(const std::string& word) {
  std::uint64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end) {
    throw std::invalid_argument(
        "'" + word + "' is no seed: give a whole number from 0 to 18446744073709551615.");
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
