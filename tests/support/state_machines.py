# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Generated sequences of steps (hypothesis.stateful), whose invariants are checked after each step.

A failure prints the smallest sequence that Hypothesis finds, and after how many sequences it was found. What
fails only after the sequences before it cannot be repeated: the failure then has the steps of its sequence.
"""

import sys

from hypothesis import HealthCheck, Phase, settings
from hypothesis.errors import Flaky
from hypothesis.internal.conjecture.providers import AVAILABLE_PROVIDERS, HypothesisProvider
from hypothesis.stateful import RuleBasedStateMachine, run_state_machine_as_test

# Sequences that do not depend on each other. Hypothesis itself begins with short ones and varies each:
# of 16 sequences, six were then empty, two repeated one rule, and four differed in one argument (measured).
INDEPENDENT = "independent"
AVAILABLE_PROVIDERS[INDEPENDENT] = HypothesisProvider
NOT_CHECKED = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


class Machine(RuleBasedStateMachine):
    """Counts its sequences and steps until the first failure. Each rule calls `begins_step` first."""

    sequences = steps = 0
    failure: Exception | None = None  # the first one

    def __init__(self):
        super().__init__()
        type(self).sequences += 1
        self._done: list[str] = []

    def begins_step(self) -> None:
        type(self).steps += 1
        rule = sys._getframe(1)
        names = rule.f_code.co_varnames[1 : rule.f_code.co_argcount]
        arguments = (f"{name}={rule.f_locals[name]!r}" for name in names)
        self._done.append(f"{rule.f_code.co_name}({', '.join(arguments)})")

    def teardown(self):
        error = sys.exc_info()[1]  # Hypothesis has some of its own, with which it ends a sequence
        own = isinstance(error, Exception) and not type(error).__module__.startswith("hypothesis")
        if own and self.failure is None:
            error.add_note(f"Found in sequence {self.sequences} after {self.steps} steps in all.")
            error.add_note("First found with: " + "; ".join(self._done))
            type(self).failure = error


def run(machine: type[Machine], sequences: int, steps: int, random: bool, shrink: bool = True) -> None:
    """Runs sequences of at most so many steps, until one fails.

    Args:
        machine: the rules and invariants.
        random: whether other sequences than at the last time; otherwise they are the same in each run.
        shrink: whether to search for the smallest sequence that fails.
    """
    machine.sequences = machine.steps = 0
    machine.failure = None
    phases = [Phase.explicit, Phase.generate] + [Phase.shrink] * shrink
    options = settings(
        max_examples=sequences,
        stateful_step_count=steps,
        derandomize=not random,
        backend=INDEPENDENT,
        database=None,
        deadline=None,
        phases=phases,
        report_multiple_bugs=False,
        suppress_health_check=NOT_CHECKED,
    )
    try:
        run_state_machine_as_test(machine, settings=options)
    except Flaky as error:
        raise machine.failure or error from error
    except Exception as error:
        if machine.failure is not None and error is not machine.failure:
            for note in machine.failure.__notes__:
                error.add_note(note)
        raise
