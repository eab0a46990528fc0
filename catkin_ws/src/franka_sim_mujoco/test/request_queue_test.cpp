// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Work that other threads queue for the stepping thread, and what services answer about it.

#include "request_queue.h"

#include <gtest/gtest.h>
#include <ros_test/eventually.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "sentences.h"
#include "service_handlers.h"

namespace franka_sim_mujoco {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kDeadline{60000};

TEST(ServiceAnswer, IsASentenceForEveryTypeOfException) {
  const auto answerTo = [](const std::function<void()>& handler) {
    std_srvs::Trigger::Response response;
    answer(response, handler, [](const char* sentence) { EXPECT_STRNE("", sentence); });
    EXPECT_FALSE(response.success);
    return response.message;
  };
  EXPECT_EQ("no arm", answerTo([] { throw std::runtime_error("no arm"); }));
  EXPECT_NE(std::string::npos,
            answerTo([] { throw XmlRpc::XmlRpcException("type error"); }).find("type error"));
  EXPECT_NE(std::string::npos, answerTo([] { throw 1; }).find("unknown"));
}

TEST(RequestQueue, RunsWorkInTheServingThreadInOrder) {
  RequestQueue queue;
  std::atomic<bool> stop{false};
  std::thread::id server;
  std::thread serving([&] {
    queue.adopt();
    server = std::this_thread::get_id();
    while (!stop) {
      queue.waitForWork(milliseconds(5));
      queue.serve();
    }
  });
  std::string order;
  std::thread::id worker;
  queue.run(
      [&] {
        worker = std::this_thread::get_id();
        order += "a";
        queue.run([&] { order += "b"; });  // from the serving thread itself: at once
      },
      kDeadline);
  queue.run([&] { order += "c"; }, kDeadline);
  EXPECT_EQ("abc", order);
  EXPECT_EQ("no", sentence([&] { queue.run([] { throw std::runtime_error("no"); }, kDeadline); }));
  stop = true;
  serving.join();
  EXPECT_EQ(server, worker);
}

TEST(RequestQueue, ServesForABoundedTimeSoThatTicksGoOn) {
  constexpr int kCallers = 6;
  struct Case {
    std::chrono::microseconds work;
    int calls;  ///< of serve, for all work that is queued
  };
  for (const Case& expected :
       {Case{milliseconds(1), kCallers}, Case{std::chrono::microseconds(0), 1},
        Case{RequestQueue::kServingTime / 2, kCallers / 2}}) {
    RequestQueue::Clock::time_point now;
    RequestQueue queue([&] { return now; });
    queue.adopt();
    std::vector<int> served(kCallers, 0);
    std::vector<std::thread> callers;
    int calls = 0;
    for (int i = 0; i < kCallers; ++i) {
      callers.emplace_back([&, i] {
        queue.run(
            [&, i] {
              now += expected.work;
              served[i] = calls;
            },
            kDeadline);
      });
      ASSERT_TRUE(ros_test::eventually([&] { return queue.pending() == i + 1U; }));
    }
    while (queue.pending() > 0 && calls < 2 * kCallers) {
      ++calls;
      queue.serve();
    }
    for (std::thread& caller : callers) {
      caller.join();
    }
    EXPECT_EQ(expected.calls, calls) << expected.work.count() << " us";
    EXPECT_TRUE(std::is_sorted(served.begin(), served.end())) << "a later caller came first";
  }
}

TEST(RequestQueue, TimesOutWithoutRunningTheWork) {
  RequestQueue queue;
  bool done = false;
  const std::string text = sentence([&] { queue.run([&] { done = true; }, milliseconds(20)); });
  EXPECT_TRUE(contains(text, "20 ms")) << text;
  queue.serve();
  EXPECT_FALSE(done) << "abandoned work must not run later: its data may be invalid";
  queue.close();
  EXPECT_TRUE(contains(sentence([&] { queue.run([] {}); }), "shutting down"));
}

TEST(RequestQueue, CloseEndsAllWaits) {
  RequestQueue queue;
  std::string text;
  std::thread waiting([&] { text = sentence([&] { queue.run([] {}); }); });
  std::this_thread::yield();
  queue.close();
  waiting.join();
  EXPECT_TRUE(contains(text, "shutting down")) << text;
}

}  // namespace
}  // namespace franka_sim_mujoco
