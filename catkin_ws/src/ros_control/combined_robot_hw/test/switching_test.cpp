// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "guard.h"
#include "test_combined.h"
#include "test_robot.h"

using combined_robot_hw_test::Combined;
using combined_robot_hw_test::Controllers;
using combined_robot_hw_test::Robot;
using hardware_interface::ControllerInfo;
using hardware_interface::InterfaceResources;
using testing::IsEmpty;
typedef hardware_interface::RobotHW::SwitchState State;

namespace {

const char* const kEffort = "hardware_interface::EffortJointInterface";
const char* const kPosition = "hardware_interface::PositionJointInterface";

ControllerInfo controller(const std::string& name,
                          const std::vector<InterfaceResources>& claims = {}) {
  ControllerInfo info;
  info.name = name;
  info.type = "test/" + name;
  info.claimed_resources = claims;
  return info;
}

ControllerInfo effort(const std::string& name, const std::set<std::string>& joints) {
  return controller(name, {InterfaceResources(kEffort, joints)});
}

/// `name(interface: joints; ...)` of all controllers, for short comparisons.
std::string text(const Controllers& list) {
  std::string all;
  for (const ControllerInfo& info : list) {
    all += info.name + "(";
    for (const InterfaceResources& claim : info.claimed_resources) {
      all += claim.hardware_interface == kEffort ? "e:" : "p:";
      for (const std::string& resource : claim.resources) {
        all += " " + resource;
      }
      all += ";";
    }
    all += ")";
  }
  return all;
}

std::string text(const std::pair<Controllers, Controllers>& lists) {
  return text(lists.first) + "|" + text(lists.second);
}

class Switching : public testing::Test {
 protected:
  Combined combined_;
  Robot& left_{combined_.add({"l1", "l2"})};
  Robot& right_{combined_.add({"r1", "r2"})};
  const Controllers none_;
};

}  // namespace

TEST_F(Switching, EachMemberGetsItsOwnControllers) {
  const Controllers list{
      effort("both", {"l1", "r1", "nowhere"}),
      controller("mixed", {{kEffort, {"r2"}}, {kPosition, {"l2"}}, {"other::Interface", {"l1"}}}),
      controller("nothing"), controller("empty", {{kEffort, {}}}), effort("absent", {"x"})};
  Controllers filtered{effort("left over", {})};
  combined_.filterControllerList(list, filtered, combined_.member(0));
  EXPECT_EQ("both(e: l1;)mixed(p: l2;)nothing()", text(filtered));
  EXPECT_EQ("test/mixed", std::next(filtered.begin())->type);
  combined_.filterControllerList(list, filtered, combined_.member(1));
  EXPECT_EQ("both(e: r1;)mixed(e: r2;)nothing()", text(filtered));
}

TEST_F(Switching, PrepareAndDoReachEveryMember) {
  const Controllers start{effort("both", {"l1", "r1"})};
  const Controllers stop{effort("old", {"r2"})};
  ASSERT_TRUE(combined_.prepareSwitch(start, stop));
  combined_.doSwitch(start, stop);
  ASSERT_EQ(1u, left_.prepared.size());
  EXPECT_EQ("both(e: l1;)|", text(left_.prepared[0]));
  EXPECT_EQ("both(e: r1;)|old(e: r2;)", text(right_.prepared[0]));
  EXPECT_EQ(1, left_.switches);
  EXPECT_EQ("both(e: l1;)", text(*left_.last_start));
  EXPECT_EQ("", text(*left_.last_stop));
  EXPECT_EQ("both(e: r1;)", text(*right_.last_start));
  EXPECT_EQ("old(e: r2;)", text(*right_.last_stop));
}

TEST_F(Switching, MembersWithoutAPartHearNothing) {
  right_.result = State::ERROR;  // of an earlier switch
  const Controllers left{effort("left", {"l1"})};
  const std::vector<std::pair<Controllers, Controllers>> switches{
      {left, none_}, {left, left}, {none_, left}, {none_, none_}};
  for (const auto& [start, stop] : switches) {
    SCOPED_TRACE(text({start, stop}));
    ASSERT_TRUE(combined_.prepareSwitch(start, stop));
    combined_.doSwitch(start, stop);
    EXPECT_EQ(State::DONE, combined_.switchResult());
  }
  EXPECT_EQ(3, left_.switches);
  EXPECT_EQ("left(e: l1;)|left(e: l1;)", text(left_.prepared[1])) << "a restart";
  EXPECT_EQ(0, right_.switches);
  EXPECT_THAT(right_.prepared, IsEmpty());
  left_.agrees = false;
  EXPECT_FALSE(combined_.prepareSwitch(left, none_));
  EXPECT_THAT(right_.prepared, IsEmpty());
}

TEST_F(Switching, RefusalOfAMemberRevertsPreparations) {
  Robot& third = combined_.add({"t1"});
  const Controllers start{effort("new", {"l1", "r1", "t1"})};
  const Controllers stop{effort("old", {"l2"})};
  right_.agrees = false;
  EXPECT_FALSE(combined_.prepareSwitch(start, stop));
  ASSERT_EQ(2u, left_.prepared.size());
  EXPECT_EQ("new(e: l1;)|old(e: l2;)", text(left_.prepared[0]));
  EXPECT_EQ("old(e: l2;)|new(e: l1;)", text(left_.prepared[1])) << "the way back";
  EXPECT_EQ(1u, right_.prepared.size());
  EXPECT_THAT(third.prepared, IsEmpty()) << "not called at all";
}

TEST_F(Switching, ExceptionOfAMemberIsARefusal) {
  right_.throws = true;
  EXPECT_FALSE(combined_.prepareSwitch({effort("new", {"l1", "r1"})}, none_));
  EXPECT_EQ(2u, left_.prepared.size());
}

TEST_F(Switching, RefusedSwitchKeepsThePreviousPlan) {
  const Controllers start{effort("good", {"l1"})};
  ASSERT_TRUE(combined_.prepareSwitch(start, none_));
  right_.agrees = false;
  EXPECT_FALSE(combined_.prepareSwitch({effort("bad", {"l1", "r1"})}, none_));
  combined_.doSwitch(start, none_);
  EXPECT_EQ("good(e: l1;)", text(*left_.last_start));
}

TEST_F(Switching, UnpreparedSwitchIsFilteredToo) {
  ASSERT_TRUE(combined_.prepareSwitch({effort("one", {"l1"})}, none_));
  combined_.doSwitch({effort("other", {"l2", "r2"})}, none_);
  EXPECT_EQ("other(e: l2;)", text(*left_.last_start));
  EXPECT_EQ("other(e: r2;)", text(*right_.last_start));
}

TEST_F(Switching, WorstResultCounts) {
  const Controllers start{effort("both", {"l1", "r1"}), effort("left", {"l2"})};
  ASSERT_TRUE(combined_.prepareSwitch(start, none_));
  combined_.doSwitch(start, none_);
  for (const State left : {State::DONE, State::ONGOING, State::ERROR}) {
    for (const State right : {State::DONE, State::ONGOING, State::ERROR}) {
      left_.result = left;
      right_.result = right;
      const State worst = left == State::ERROR || right == State::ERROR       ? State::ERROR
                          : left == State::ONGOING || right == State::ONGOING ? State::ONGOING
                                                                              : State::DONE;
      EXPECT_EQ(worst, combined_.switchResult());
      EXPECT_EQ(worst, combined_.switchResult(start.front()));
      EXPECT_EQ(left, combined_.switchResult(start.back())) << "the right arm is not concerned";
    }
  }
  EXPECT_EQ(1u, right_.claim_count);
  left_.result = State::ERROR;
  EXPECT_EQ(State::DONE, combined_.switchResult(effort("not of this switch", {"l1"})));
}

TEST_F(Switching, TheLoopNeitherAllocatesNorLocks) {
  ASSERT_NE(0u, guard::allocationsAndLocks([this] { left_.prepared.emplace_back(); }))
      << "the guard sleeps";
  const Controllers start{effort("a controller with quite a long name", {"l1", "r1"})};
  const Controllers stop{effort("another controller with quite a long name", {"l2"})};
  ASSERT_TRUE(combined_.prepareSwitch(start, stop));
  const ros::Time time(1.0);
  const ros::Duration period(0.001);
  int done = 0;
  EXPECT_EQ(0u, guard::allocationsAndLocks([&] {
              for (int i = 0; i < 100; ++i) {
                combined_.read(time, period);
                combined_.doSwitch(start, stop);
                done += combined_.switchResult() == State::DONE;
                done += combined_.switchResult(start.front()) == State::DONE;
                combined_.write(time, period);
              }
            }));
  EXPECT_EQ(200, done);
}

TEST_F(Switching, ConflictsAreCheckedByTheirMember) {
  const Controllers clash{effort("a", {"l1", "r1"}), effort("b", {"l1"})};
  EXPECT_TRUE(combined_.checkForConflict(clash));
  EXPECT_EQ("a(e: l1;)b(e: l1;)", text(left_.checked));
  EXPECT_EQ("a(e: r1;)", text(right_.checked));
  EXPECT_FALSE(combined_.checkForConflict({effort("a", {"l1"}), effort("b", {"l2", "r1"})}));

  left_.lenient = true;
  EXPECT_FALSE(combined_.checkForConflict(clash)) << "the left arm allows it";
  EXPECT_TRUE(combined_.checkForConflict({effort("a", {"r1"}), effort("b", {"r1"})}));
}

TEST_F(Switching, ResourcesOfNoneOrSeveralMembersFollowTheCommonRule) {
  left_.lenient = right_.lenient = true;
  const auto own = [](const std::string& name) {
    return controller(name, {{"other::Interface", {"lamp"}}});
  };
  EXPECT_TRUE(combined_.checkForConflict({own("a"), own("b")}));
  EXPECT_FALSE(combined_.checkForConflict({own("a")}));
  Robot& third = combined_.add({"l1"});
  third.lenient = true;
  EXPECT_TRUE(combined_.checkForConflict({effort("a", {"l1"}), effort("b", {"l1"})}));
}
