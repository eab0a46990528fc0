# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sequences of lines to the control interfaces of a Panda and an FR3 in one program.

A robot is stopped while any source of a stop is pressed, whichever line pressed it. What a line does not name
stays as it is, the other robot included, and a refused line changes nothing.
"""

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import initialize, invariant
from pyfranka.remote import LineRefused
from pyfranka.sim import FR3, Panda
from state_machines import Machine, rule, run

KINDS = ("panda", "fr3")
STOPS = {"panda": ("x4",), "fr3": ("x31", "x32", "x33")}
INPUTS = ("x31", "x32", "x33", "x4")
SELF_TEST = 0.3  # [s]
WRONG = (
    "user_stop",
    "user_stop maybe",
    "input x99 on",
    "input x31 maybe",
    "brakes half",
    "fci 1",
    "guiding",
    "guiding_mode sideways",
    "guiding_mode user on off",
    "self_test due -1",
    "self_test soon",
    "move 9 9 9 9 9 9 9",
    "move 0 0 0",
    "move 0 -0.8 0 -2.3 0 1.5 0.8 7",
    "end_effector 1 0 0",
    "end_effector 100 0 0 0 " + "0 " * 9 + "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
    "end_effector 1 0 0 0 " + "0 " * 9 + "2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
    "set_load 100 0 0 0",
    "acknowledge td2Timeout",
    "acknowledge nothing",
    "inject nothing on",
    "inject jointLimitViolation 9 on",
    "timing brakes -1",
    "timing hands 1",
    "loss 2",
    "delay 99",
    "push nothing 1 0 0 10",
    "step -1",
    "hand_move 9",
)
PUSH = "push {kind}_link6 300 0 0 30"


def discrete(report) -> dict:
    """All of a report that does not measure."""
    return {
        name: getattr(report, name)
        for name in ("mode", "errors", "rules", "power", "brakes", "brakes_moving", "operating_mode", "fci")
        + ("inputs", "guiding", "recoverable", "joint_limit_violation", "joint_position_error")
        + ("end_effector", "motion")
    } | {"self-test": report.self_test.running}


class LinesMachine(Machine):
    """Lines to both robots, whose world stands still between them."""

    remotes = None

    @initialize()
    def start(self):
        for kind, remote in self.remotes.items():
            if self.report(kind).self_test.running:
                remote.send(f"step {int(1e3 * SELF_TEST) + 100}")
            for line in ("guiding off", "user_stop off", *(f"input {name} off" for name in INPUTS)):
                remote.send(line)
        self.remotes["fr3"].send("reset")  # no recovery with a joint beyond its limits
        for kind, remote in self.remotes.items():
            for line in ("brakes open", "fci on", "wait"):
                remote.send(line)
            if self.report(kind).mode == "Reflex":
                remote.send("recover")
        self.user_stop = dict.fromkeys(KINDS, False)
        self.inputs = {kind: dict.fromkeys(INPUTS, False) for kind in KINDS}
        self.closed = dict.fromkeys(KINDS, False)
        self.fci = dict.fromkeys(KINDS, True)
        for kind in KINDS:
            assert self.report(kind).mode == "Idle", self.report(kind)

    def report(self, kind):
        return self.remotes[kind].report()

    def accepts(self, kind: str, line: str) -> bool:
        """Whether a robot takes a line. The other one must be as before, and this one too if it does not."""
        before = {name: discrete(self.report(name)) for name in KINDS}
        try:
            self.remotes[kind].send(line)
            self.remotes[kind].send("wait")
            accepted = True
        except LineRefused:
            accepted = False
        for name in KINDS:
            if name != kind or not accepted:
                after = discrete(self.report(name))
                changed = {
                    key: (value, after[key]) for key, value in before[name].items() if after[key] != value
                }
                assert not changed, (
                    f"'{line}' to {kind}, accepted: {accepted}, has changed of {name}: {changed}"
                )
        return accepted

    @rule(kind=st.sampled_from(KINDS), on=st.booleans())
    def press_user_stop(self, kind, on):
        if self.accepts(kind, f"user_stop {'on' if on else 'off'}"):
            self.user_stop[kind] = on

    @rule(kind=st.sampled_from(KINDS), name=st.sampled_from(INPUTS), on=st.booleans())
    def press_input(self, kind, name, on):
        if self.accepts(kind, f"input {name} {'on' if on else 'off'}"):
            self.inputs[kind][name] = on

    @rule(kind=st.sampled_from(KINDS), close=st.booleans())
    def move_brakes(self, kind, close):
        tested = self.report(kind).self_test.running
        if self.accepts(kind, f"brakes {'close' if close else 'open'}"):
            assert close or not tested, "the self-test was disturbed"
            self.closed[kind] = close

    @rule(kind=st.sampled_from(KINDS), on=st.booleans())
    def switch_fci(self, kind, on):
        tested = self.report(kind).self_test.running
        if self.accepts(kind, f"fci {'on' if on else 'off'}"):
            assert not on or not tested, "the self-test was disturbed"
            self.fci[kind] = on

    @rule(kind=st.sampled_from(KINDS), on=st.booleans())
    def guide(self, kind, on):
        self.accepts(kind, f"guiding {'on' if on else 'off'}")

    @rule(kind=st.sampled_from(KINDS))
    def test_itself(self, kind):
        self.accepts(kind, "self_test")

    @rule(kind=st.sampled_from(KINDS), line=st.sampled_from(WRONG))
    def wrong_line(self, kind, line):
        assert not self.accepts(kind, line), f"'{line}' was accepted."

    @rule(kind=st.sampled_from(KINDS))
    def collide(self, kind):
        self.accepts(kind, PUSH.format(kind=kind))
        self.remotes[kind].send("step 100")

    @rule(kind=st.sampled_from(KINDS))
    def recover(self, kind):
        self.accepts(kind, "recover")

    @rule(ticks=st.sampled_from([1, 50, int(1e3 * SELF_TEST) + 100]))
    def step(self, ticks):
        self.remotes["panda"].send(f"step {ticks}")

    @rule()
    def reset(self):
        before = {kind: self.report(kind) for kind in KINDS}
        self.remotes["panda"].send("reset")
        for kind in KINDS:
            after = self.report(kind)
            assert (after.inputs, after.fci) == (before[kind].inputs, before[kind].fci)

    @invariant()
    def stopped_while_a_source_is_pressed(self):
        for kind in KINDS if hasattr(self, "fci") else ():
            report = self.report(kind)
            inputs = self.inputs[kind]
            for name, pressed in inputs.items():  # the user stop may be shown as the stop that it acts as
                acts = self.user_stop[kind] and name in STOPS[kind]
                assert getattr(report.inputs, name) == pressed or acts, f"{name} of {kind}"
            pressed = self.user_stop[kind] or any(inputs[name] for name in STOPS[kind])
            if report.mode != "Guiding":  # for which a Panda's X4 is pressed
                stands = self.closed[kind] or report.self_test.running
                allowed = ("User stopped", "Other") if pressed else ("Other",) if stands else ()
                moves = report.mode not in ("User stopped", "Other")
                assert moves == (not allowed), f"{kind} is in mode {report.mode}: {self.sources(kind)}"
                assert moves or report.mode in allowed, f"{kind}: {report.mode}, {self.sources(kind)}"
            if not report.self_test.running:
                assert report.fci == self.fci[kind], f"the FCI of {kind}"

    def sources(self, kind):
        return f"user stop {self.user_stop[kind]}, inputs {self.inputs[kind]}, brakes {self.closed[kind]}"


@pytest.fixture(scope="module")
def machine(franka_sim_session):
    robots = (Panda(name="panda"), FR3(name="fr3", base=(0, 2, 0)))
    with franka_sim_session(*robots, pace="lockstep") as sim:
        with sim["panda"].remote as panda, sim["fr3"].remote as fr3:
            LinesMachine.remotes = {"panda": panda, "fr3": fr3}
            for remote in LinesMachine.remotes.values():
                remote.send(f"timing self_test {SELF_TEST}")
            yield LinesMachine


def test_stops_and_switches_have_the_effect_of_all_their_sources(machine):
    run(machine, sequences=60, steps=30, seed=1)


@pytest.mark.long_form("other sequences each time")
def test_random_sequences(machine):
    run(machine, sequences=2000, steps=60)
