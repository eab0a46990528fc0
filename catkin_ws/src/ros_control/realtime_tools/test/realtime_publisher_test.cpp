// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/realtime_publisher.h"

#include <dirent.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <ros_test/eventually.h>
#include <rt_guard/rt_guard.h>
#include <rt_guard/syscall_guard.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_msgs/UInt32.h>

#include <chrono>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

using realtime_tools::RealtimePublisher;
using ros_test::eventually;

namespace {

std::set<std::string> threads() {
  std::set<std::string> ids;
  DIR* tasks = opendir("/proc/self/task");
  while (const dirent* entry = readdir(tasks)) {
    if (entry->d_name[0] != '.') {
      ids.insert(entry->d_name);
    }
  }
  closedir(tasks);
  return ids;
}

/// Collects the numbers that arrive on a topic.
class Collector {
 public:
  explicit Collector(const std::string& topic)
      : subscriber_(node_.subscribe(topic, 5000, &Collector::receive, this,
                                    ros::TransportHints().tcpNoDelay())) {}
  std::vector<std::uint32_t> received() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return received_;
  }
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

 private:
  void receive(const std_msgs::UInt32ConstPtr& message) {
    std::lock_guard<std::mutex> lock(mutex_);
    received_.push_back(message->data);
  }
  ros::NodeHandle node_;
  mutable std::mutex mutex_;
  std::vector<std::uint32_t> received_;
  ros::Subscriber subscriber_;
};

void send(RealtimePublisher<std_msgs::UInt32>& publisher, std::uint32_t number) {
  ASSERT_TRUE(eventually([&] { return publisher.trylock(); }));
  publisher.msg_.data = number;
  publisher.unlockAndPublish();
}

}  // namespace

TEST(RealtimePublisher, CanBeLockedOnlyAfterInit) {
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::UInt32> publisher;
  EXPECT_FALSE(publisher.trylock());
  publisher.init(node, "late", 1);
  EXPECT_TRUE(publisher.trylock());
  EXPECT_FALSE(publisher.trylock());
  publisher.unlock();
  for (int i = 0; i < 100; ++i) {
    RealtimePublisher<std_msgs::UInt32> fresh(node, "fresh", 1);
    ASSERT_TRUE(fresh.trylock());
    fresh.unlock();
  }
}

TEST(RealtimePublisher, PublishesTheFirstMessageToALateSubscriberWhenLatched) {
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::UInt32> publisher(node, "latched", 1, true);
  send(publisher, 7);
  ASSERT_TRUE(eventually([&] {
    const bool free = publisher.trylock();
    if (free) {
      publisher.unlock();
    }
    return free;
  }));
  Collector collector("latched");
  ASSERT_TRUE(eventually([&] { return collector.received().size() == 1; }));
  EXPECT_EQ(7u, collector.received()[0]);
}

TEST(RealtimePublisher, TakesEveryMessageOfALoopThatPublishesPendingOnes) {
  constexpr std::uint32_t kMessages = 2000;
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::UInt32> heard(node, "each", kMessages);
  RealtimePublisher<std_msgs::UInt32> unheard(node, "each_unheard", kMessages);
  Collector collector("each");
  ASSERT_TRUE(eventually([&] { return collector.connected(); }));
  for (std::uint32_t i = 0; i < kMessages; ++i) {
    for (RealtimePublisher<std_msgs::UInt32>* publisher : {&heard, &unheard}) {
      ASSERT_TRUE(publisher->trylock()) << "message " << i;
      publisher->msg_.data = i;
      publisher->unlockAndPublish();
    }
    realtime_tools::publishPending();
  }
  EXPECT_TRUE(eventually([&] { return collector.received().size() == kMessages; }));
}

TEST(RealtimePublisher, TakesAMessageEveryFiveMillisecondsOnlyWhileNobodySubscribes) {
  using Clock = std::chrono::steady_clock;
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::UInt32> publisher(node, "unheard", 1);
  const Clock::time_point start = Clock::now();
  Clock::time_point begin{};
  for (int taken = 0; taken < 20;) {
    if (!publisher.trylock()) {
      std::this_thread::yield();
      continue;
    }
    publisher.unlockAndPublish();
    // Checks are more frequent at first.
    if (Clock::now() - start > std::chrono::milliseconds(60) && taken++ == 0) {
      begin = Clock::now();
    }
  }
  EXPECT_GE(Clock::now() - begin, std::chrono::milliseconds(18 * 5));
  Collector collector("unheard");
  ASSERT_TRUE(eventually([&] { return collector.connected(); }));
  send(publisher, 1);
  send(publisher, 2);
  EXPECT_TRUE(eventually([&] { return collector.received().size() >= 2; }));
}

TEST(RealtimePublisher, WorksWithLockGuardAndPublishesOnRequest) {
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::UInt32> publisher(node, "guarded", 10);
  Collector collector("guarded");
  ASSERT_TRUE(eventually([&] { return collector.connected(); }));
  {
    std::lock_guard<RealtimePublisher<std_msgs::UInt32>> guard(publisher);
    publisher.msg_.data = 1;
  }
  publisher.lock();
  publisher.msg_.data = 2;
  publisher.unlockAndPublish();
  ASSERT_TRUE(eventually([&] { return !collector.received().empty(); }));
  EXPECT_EQ(std::vector<std::uint32_t>({2}), collector.received());
}

TEST(RealtimePublisher, CanBeInitializedAgainForAnotherTopic) {
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::UInt32> publisher(node, "before", 1, true);
  publisher.init(node, "after", 1, true);
  Collector collector("after");
  send(publisher, 5);
  EXPECT_TRUE(eventually([&] { return collector.received() == std::vector<std::uint32_t>{5}; }));
}

TEST(RealtimePublisher, SendsNothingAfterStop) {
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::UInt32> publisher(node, "stopped", 1, true);
  publisher.stop();
  ASSERT_TRUE(publisher.trylock());
  publisher.unlockAndPublish();
  EXPECT_FALSE(publisher.trylock());
}

TEST(RealtimePublisher, DestructionEndsTheThreadAndTheTopic) {
  ros::NodeHandle node;
  const std::set<std::string> before = threads();
  Collector collector("gone");
  {
    RealtimePublisher<std_msgs::UInt32> publisher(node, "gone", 1);
    ASSERT_TRUE(eventually([&] { return collector.connected(); }));
  }
  EXPECT_TRUE(eventually([&] { return !collector.connected(); }));
  EXPECT_TRUE(eventually([&] { return before.size() == threads().size(); }));
}

TEST(RealtimePublisher, AllShareOneThread) {
  ros::NodeHandle node;
  const std::set<std::string> before = threads();
  RealtimePublisher<std_msgs::UInt32> publisher(node, "idle", 1);
  RealtimePublisher<std_msgs::UInt32> another(node, "idle_too", 1);
  std::set<std::string> own = threads();
  for (const std::string& id : before) {
    own.erase(id);
  }
  EXPECT_EQ(1u, own.size());
}

TEST(RealtimePublisher, RealTimeSideNeitherAllocatesNorLocksNorEntersTheKernel) {
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::Float64MultiArray> publisher(node, "guard", 10);
  publisher.msg_.data.assign(100, 0.0);
  int published = 0;
  ASSERT_TRUE(eventually([&] {
    rt_guard::Scope scope;
    const rt_guard::SyscallScope syscalls;
    if (publisher.trylock()) {
      publisher.msg_.data[0] += 1.0;
      publisher.unlockAndPublish();
      ++published;
    }
    EXPECT_EQ(0u, scope.allocations());
    const bool called = syscalls.called();
    EXPECT_EQ(0u, scope.locks());
    EXPECT_FALSE(called) << syscalls.number();
    return published == 200;
  }));
}

TEST(RealtimePublisher, PublishesEachMessageThatItTakesInOrder) {
  ros::NodeHandle node;
  RealtimePublisher<std_msgs::UInt32> publisher(node, "fast", 5000);
  Collector collector("fast");
  ASSERT_TRUE(eventually([&] { return collector.connected(); }));
  std::vector<std::uint32_t> sent;
  for (std::uint32_t number = 0; number < 1000; ++number) {
    send(publisher, number);
    sent.push_back(number);
  }
  EXPECT_TRUE(eventually([&] { return collector.received().size() >= sent.size(); }));
  EXPECT_EQ(sent, collector.received());
}

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "realtime_publisher_test");
  ros::NodeHandle node;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
