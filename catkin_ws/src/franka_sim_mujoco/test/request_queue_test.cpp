// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Work that other threads queue for the stepping thread, and what services answer about it.

#include "request_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

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
