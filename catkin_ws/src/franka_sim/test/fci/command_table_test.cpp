// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/serve/command_table.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace franka_sim::fci {
namespace {

using Vector3 = std::array<double, 3>;

std::string textOf(double value) { return std::to_string(static_cast<int>(value)); }

/// Its lines answer with the values that their handlers get.
CommandTable makeTable() {
  CommandTable table;
  table.add(line("push", text("BODY"), numbers<3>("FX FY FZ", "N"),
                 optional(numbers<3>("TX TY TZ", "Nm")), integer("MILLISECONDS", 1, 1000)),
            "a force", kInput,
            [](const std::string& body, const Vector3& force, const std::optional<Vector3>& torque,
               std::uint64_t ticks) {
              return body + " " + textOf(force[2]) + " " + (torque ? textOf((*torque)[0]) : "-") +
                     " " + std::to_string(ticks);
            });
  table.add(line("power on"), "it starts", kInput, [] { return "on"; });
  table.add(line("power off"), "it ends", kControl, [] { return "off"; });
  table.add(line("move", numbers<2>("Q*2", "rad"), optional(number("SPEED", "", 0.0, 1.0))), "",
            kControl, [](const std::array<double, 2>& q, std::optional<double> speed) {
              return textOf(q[1]) + (speed ? " faster" : "");
            });
  table.add(line("move stop"), "", kUrgentInput, [] { return "stopped"; });
  table.add(line("wall", integer("NUMBER", 0, 7), choice({"off"})), "", kNotOnPage,
            [](std::uint64_t number, std::uint64_t /*off*/) { return std::to_string(number); });
  table.add(line("wall", integer("NUMBER", 0, 7), numbers<3>("X Y Z", "m")), "", kNotOnPage,
            [](std::uint64_t /*number*/, const Vector3& /*center*/) { return "set"; });
  table.add(line("axes", choice({"none", "all", "these"}), optional(switches<2>())), "", kNotOnPage,
            [](std::uint64_t which, const std::optional<std::array<bool, 2>>& axes) {
              return std::to_string(which) + (axes ? std::to_string((*axes)[1]) : "");
            });
  table.add(line("seed", integer("SEED", 0, std::numeric_limits<std::uint64_t>::max())), "",
            kNotOnPage, [](std::uint64_t seed) { return std::to_string(seed); });
  return table;
}

struct LineCase {
  std::string line, answer;
};

class CommandTableTest : public ::testing::TestWithParam<LineCase> {};

TEST_P(CommandTableTest, AnswersALineWithItsTypedArguments) {
  EXPECT_EQ(GetParam().answer, makeTable().execute(GetParam().line).line());
}

INSTANTIATE_TEST_SUITE_P(
    Lines, CommandTableTest,
    ::testing::Values(
        LineCase{"push cube 0 0 5 20", "ok cube 5 - 20"},
        LineCase{"  push cube 0 0 5 7 0 0 1e2\r", "ok cube 5 7 100"},
        LineCase{"push cube 0 0 nan 20", "error: FZ must be a finite number [N], not 'nan'."},
        LineCase{"push cube 0 0 5 0.5",
                 "error: MILLISECONDS must be a whole number from 1 to 1000, not '0.5'."},
        LineCase{"push cube 0 0 5 1001",
                 "error: MILLISECONDS must be a whole number from 1 to 1000, not '1001'."},
        LineCase{"push cube 0 0 5 7 20",
                 "error: This line is written: push BODY FX FY FZ [TX TY "
                 "TZ] MILLISECONDS."},
        LineCase{"power off", "ok off"},
        LineCase{"power", "error: This line is written: power on; power off."},
        LineCase{"power maybe", "error: This line is written: power on; power off."},
        LineCase{"power on twice", "error: This line is written: power on."},
        LineCase{"move 1 2", "ok 2"}, LineCase{"move 1 2 0.5", "ok 2 faster"},
        LineCase{"move stop", "ok stopped"},
        LineCase{"move 1 2 1.5", "error: SPEED must be a number from 0 to 1, not '1.5'."},
        LineCase{"move 1 x", "error: Q must be a finite number [rad], not 'x'."},
        LineCase{"move", "error: This line is written: move Q*2 [SPEED]; move stop."},
        LineCase{"wall 7 off", "ok 7"}, LineCase{"wall 7 1 2 3", "ok set"},
        LineCase{"wall 7 on", "error: 'on' is not one of off."},
        LineCase{"axes these on off", "ok 20"}, LineCase{"axes all", "ok 1"},
        LineCase{"axes some", "error: 'some' is not one of none|all|these."},
        LineCase{"axes these on 1", "error: '1' is not one of on|off."},
        LineCase{"seed 18446744073709551615", "ok 18446744073709551615"},
        LineCase{"seed 18446744073709551616",
                 "error: SEED must be a whole number from 0 to "
                 "18446744073709551615, not '18446744073709551616'."},
        LineCase{"seed -1",
                 "error: SEED must be a whole number from 0 to 18446744073709551615, "
                 "not '-1'."},
        LineCase{"nothing", "error: There is no command 'nothing'; help lists them."},
        LineCase{"help power", "ok power on: it starts; power off: it ends"},
        LineCase{"help push",
                 "ok push BODY FX FY FZ [TX TY TZ] MILLISECONDS: a force (FX FY FZ in "
                 "N, TX TY TZ in Nm, MILLISECONDS from 1 to 1000)"},
        LineCase{"help nothing", "error: There is no command 'nothing'; help lists them."}));

TEST(CommandTable, ListsItsLinesAndDescribesThemForPrograms) {
  CommandTable table;
  table.add(line("stop", onOff()), "it stops", kUrgentInput, [](bool /*on*/) {});
  table.add(line("load", number("MASS", "kg", 0.0, 10.0), optional(integer("SEED", 1, 9))),
            "a load", kControl, [](double /*mass*/, std::optional<std::uint64_t> /*seed*/) {});
  EXPECT_EQ("ok stop on|off; load MASS [SEED]", table.execute("help").line());
  EXPECT_EQ(
      R"j(ok [{"name":"stop","arguments":[{"words":"on|off","kind":"choice","count":1,)j"
      R"j("optional":false,"choices":["on","off"]}],"page":true,"control":false,"urgent":true,)j"
      R"j("help":"it stops","usage":"stop on|off"},{"name":"load","arguments":[{"words":"MASS",)j"
      R"j("kind":"number","count":1,"optional":false,"unit":"kg","min":0,"max":10},{"words":"SEED",)j"
      R"j("kind":"integer","count":1,"optional":true,"min":1,"max":9}],"page":true,"control":true,)j"
      R"j("urgent":false,"help":"a load (MASS from 0 to 10 kg, SEED from 1 to 9)",)j"
      R"j("usage":"load MASS [SEED]"}])j",
      table.execute("help json").line());
}

}  // namespace
}  // namespace franka_sim::fci
