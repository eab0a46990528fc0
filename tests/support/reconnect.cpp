// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// A hostile client of a simulated robot, until it is killed: connects again and again, as fast as
// it can, keeps the last connections open, and sends noise over every second one. reconnect ADDRESS
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace {

constexpr std::uint16_t kRobotPort = 1337;
constexpr std::size_t kKept = 40;

}  // namespace

int main(int argc, char** argv) {
  sockaddr_in robot{};
  robot.sin_family = AF_INET;
  robot.sin_port = htons(kRobotPort);
  if (argc != 2 || inet_pton(AF_INET, argv[1], &robot.sin_addr) != 1) {
    return 2;
  }
  std::array<int, kKept> kept{};
  kept.fill(-1);
  const std::string noise(40, 'x');
  std::puts("attacks");
  std::fflush(stdout);
  for (std::size_t i = 0;; i++) {
    int& connection = kept[i % kKept];
    if (connection >= 0) {
      ::close(connection);
    }
    connection = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    ::connect(connection, reinterpret_cast<const sockaddr*>(&robot), sizeof(robot));
    if (i % 2 == 0) {
      ::send(connection, noise.data(), noise.size(), MSG_NOSIGNAL);
    }
  }
}
