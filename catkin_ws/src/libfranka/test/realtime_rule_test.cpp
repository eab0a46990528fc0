// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/realtime_rule.h>
#include <gtest/gtest.h>
#include <netinet/in.h>

#include <cstdlib>
#include <stdexcept>

namespace {

using franka_core::isLoopback;
using franka_core::realtimeRule;

TEST(IsLoopback, RecognizesAddressesAndNamesWithAndWithoutPorts) {
  for (const char* address :
       {"127.0.0.1", "127.0.0.1:1340", "127.1.2.3", "127.255.255.254:1337", "localhost",
        "localhost:4711", "::1", "[::1]", "[::1]:1337", "::ffff:127.0.0.1", "0.0.0.0"}) {
    EXPECT_TRUE(isLoopback(address)) << address;
  }
  for (const char* address :
       {"", "126.255.255.255", "128.0.0.1", "172.16.0.2", "192.168.0.1:1337", "1.0.0.127",
        "fe80::1", "[2001:db8::1]:1337", "::ffff:10.0.0.1", "["}) {
    EXPECT_FALSE(isLoopback(address)) << address;
  }
}

TEST(IsLoopback, RecognizesTheAddressOfASocket) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(0x7f010203);  // 127.1.2.3
  EXPECT_TRUE(isLoopback(reinterpret_cast<const sockaddr&>(address)));
  address.sin_addr.s_addr = htonl(0xac100002);  // 172.16.0.2
  EXPECT_FALSE(isLoopback(reinterpret_cast<const sockaddr&>(address)));
  address.sin_family = AF_UNIX;
  EXPECT_FALSE(isLoopback(reinterpret_cast<const sockaddr&>(address)));
}

class RealtimeRule : public ::testing::Test {
 protected:
  RealtimeRule() { unsetenv("FRANKA_REALTIME"); }
  ~RealtimeRule() override { unsetenv("FRANKA_REALTIME"); }
};

TEST_F(RealtimeRule, LiftsEnforcementOnlyForSimulatedRobotsOnOrdinaryKernels) {
  for (const char* variable : {"", "enforce", "ignore", "nonsense"}) {
    setenv("FRANKA_REALTIME", variable, 1);
    for (bool has_kernel : {false, true}) {
      EXPECT_TRUE(realtimeRule(true, false, has_kernel).enforce) << variable;
      EXPECT_FALSE(realtimeRule(false, true, has_kernel).enforce) << variable;
      EXPECT_TRUE(realtimeRule(true, false, has_kernel).warning.empty()) << variable;
      EXPECT_TRUE(realtimeRule(false, true, has_kernel).warning.empty()) << variable;
    }
  }
  unsetenv("FRANKA_REALTIME");
  EXPECT_TRUE(realtimeRule(true, true, true).enforce);
  EXPECT_FALSE(realtimeRule(true, true, false).enforce);
  EXPECT_NE("", realtimeRule(true, true, false).warning);
}

TEST_F(RealtimeRule, FollowsTheEnvironmentVariable) {
  setenv("FRANKA_REALTIME", "enforce", 1);
  EXPECT_TRUE(realtimeRule(true, true, false).enforce);
  setenv("FRANKA_REALTIME", "ignore", 1);
  for (bool has_kernel : {false, true}) {
    EXPECT_FALSE(realtimeRule(true, true, has_kernel).enforce);
    EXPECT_EQ("", realtimeRule(true, true, has_kernel).warning);
  }
  for (const char* wrong : {"yes", "Enforce", "ignore "}) {
    setenv("FRANKA_REALTIME", wrong, 1);
    EXPECT_THROW(realtimeRule(true, true, false), std::invalid_argument) << wrong;
  }
}

}  // namespace
