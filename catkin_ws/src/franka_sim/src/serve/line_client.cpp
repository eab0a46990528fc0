// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/line_client.h"

#include <algorithm>
#include <utility>

namespace franka_sim::fci {

namespace {

constexpr std::size_t kMaxLineLength = 4000;

}  // namespace

bool sendLine(Connection& connection, const std::string& text) {
  const std::string line = text + "\n";
  return connection.send({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
}

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

}  // namespace franka_sim::fci
