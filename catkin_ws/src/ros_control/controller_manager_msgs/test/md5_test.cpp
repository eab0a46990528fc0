// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The sums are those of the original package: two programs talk to each other only if they agree.
#include <controller_manager_msgs/ControllerState.h>
#include <controller_manager_msgs/ControllerStatistics.h>
#include <controller_manager_msgs/ControllersStatistics.h>
#include <controller_manager_msgs/HardwareInterfaceResources.h>
#include <controller_manager_msgs/ListControllerTypes.h>
#include <controller_manager_msgs/ListControllers.h>
#include <controller_manager_msgs/LoadController.h>
#include <controller_manager_msgs/ReloadControllerLibraries.h>
#include <controller_manager_msgs/SwitchController.h>
#include <controller_manager_msgs/UnloadController.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/service_traits.h>

using namespace controller_manager_msgs;

namespace {

template <class T, class = void>
struct Sum {
  static const char* value() { return ros::message_traits::MD5Sum<T>::value(); }
};

/// Services carry their two halves as types; their own sum comes from other traits.
template <class T>
struct Sum<T, std::void_t<typename T::Request>> {
  static const char* value() { return ros::service_traits::MD5Sum<T>::value(); }
};

template <class T>
const char* md5Of() {
  return Sum<T>::value();
}

}  // namespace

TEST(ControllerManagerMsgs, md5SumsAreThoseOfTheOriginal) {
  EXPECT_STREQ("aeb6b261d97793ab74099a3740245272", md5Of<ControllerState>());
  EXPECT_STREQ("697780c372c8d8597a1436d0e2ad3ba8", md5Of<ControllerStatistics>());
  EXPECT_STREQ("a154c347736773e3700d1719105df29d", md5Of<ControllersStatistics>());
  EXPECT_STREQ("f25b55cbf1d1f76e82e5ec9e83f76258", md5Of<HardwareInterfaceResources>());
  EXPECT_STREQ("c1d4cd11aefa9f97ba4aeb5b33987f4e", md5Of<ListControllerTypes>());
  EXPECT_STREQ("d41d8cd98f00b204e9800998ecf8427e", md5Of<ListControllerTypesRequest>());
  EXPECT_STREQ("c1d4cd11aefa9f97ba4aeb5b33987f4e", md5Of<ListControllerTypesResponse>());
  EXPECT_STREQ("1341feb2e63fa791f855565d0da950d8", md5Of<ListControllers>());
  EXPECT_STREQ("d41d8cd98f00b204e9800998ecf8427e", md5Of<ListControllersRequest>());
  EXPECT_STREQ("1341feb2e63fa791f855565d0da950d8", md5Of<ListControllersResponse>());
  EXPECT_STREQ("647e5c54b8d6468952d8d31f1efe96c0", md5Of<LoadController>());
  EXPECT_STREQ("c1f3d28f1b044c871e6eff2e9fc3c667", md5Of<LoadControllerRequest>());
  EXPECT_STREQ("6f6da3883749771fac40d6deb24a8c02", md5Of<LoadControllerResponse>());
  EXPECT_STREQ("40e8c411fd1797d2e2c486018f846040", md5Of<ReloadControllerLibraries>());
  EXPECT_STREQ("18442b59be9479097f11c543bddbac62", md5Of<ReloadControllerLibrariesRequest>());
  EXPECT_STREQ("6f6da3883749771fac40d6deb24a8c02", md5Of<ReloadControllerLibrariesResponse>());
  EXPECT_STREQ("b29a7abc673b2c54c14b54e50f8d06a5", md5Of<SwitchController>());
  EXPECT_STREQ("36d99a977432b71d4bf16ce5847949d7", md5Of<SwitchControllerRequest>());
  EXPECT_STREQ("6f6da3883749771fac40d6deb24a8c02", md5Of<SwitchControllerResponse>());
  EXPECT_STREQ("647e5c54b8d6468952d8d31f1efe96c0", md5Of<UnloadController>());
  EXPECT_STREQ("c1f3d28f1b044c871e6eff2e9fc3c667", md5Of<UnloadControllerRequest>());
  EXPECT_STREQ("6f6da3883749771fac40d6deb24a8c02", md5Of<UnloadControllerResponse>());
}

TEST(ControllerManagerMsgs, strictnessValues) {
  EXPECT_EQ(1, SwitchControllerRequest::BEST_EFFORT);
  EXPECT_EQ(2, SwitchControllerRequest::STRICT);
}

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
