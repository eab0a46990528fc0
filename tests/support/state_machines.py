# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Generated sequences of steps (hypothesis.stateful), whose invariants are checked after each step.

A failure prints the smallest sequence that Hypothesis finds, and after how many sequences it was found. What
fails only after the sequences before it cannot be repeated: the failure then has the steps of its sequence.
"""

import random
import sys

import hypothesis
import hypothesis.stateful
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.errors import Flaky
from hypothesis.internal.conjecture.providers import AVAILABLE_PROVIDERS, HypothesisProvider

# Sequences that do not depend on each other. Hypothesis itself begins with short ones and varies each:
# of 16 sequences, six were then empty, two repeated one rule, and four differed in one argument (measured).
INDEPENDENT = "independent"
AVAILABLE_PROVIDERS[INDEPENDENT] = HypothesisProvider
NOT_CHECKED = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


def rule(when=lambda machine: True, **arguments):
    """Marks a method of a Machine as a step.

    Args:
        when: whether the step is possible, as a function of the machine.
        arguments: strategies of the method's arguments.
    """

    def mark(method):
        method.when, method.arguments = when, arguments
        return method

    return mark


class Machine(hypothesis.stateful.RuleBasedStateMachine):
    """Draws each step from all that are possible, and counts sequences and steps until the first failure."""

    sequences = steps = 0
    failure: Exception | None = None  # the first one
    step_names: tuple[str, ...] = ()

    def __init_subclass__(cls):
        cls.step_names = tuple(name for name, value in vars(cls).items() if hasattr(value, "arguments"))

    def __init__(self):
        super().__init__()
        type(self).sequences += 1
        self._done: list[str] = []

    @hypothesis.stateful.rule(data=st.data())
    def take_a_step(self, data):
        """One rule for all steps, because Hypothesis leaves some of its rules out of each sequence."""
        possible = [name for name in self.step_names if getattr(self, name).when(self)]
        name = data.draw(st.sampled_from(possible))
        arguments = data.draw(st.fixed_dictionaries(getattr(self, name).arguments))
        type(self).steps += 1
        self._done.append(f"{name}({', '.join(f'{key}={value!r}' for key, value in arguments.items())})")
        getattr(self, name)(**arguments)

    def teardown(self):
        error = sys.exc_info()[1]  # Hypothesis has some of its own, with which it ends a sequence
        own = isinstance(error, Exception) and not type(error).__module__.startswith("hypothesis")
        if own and self.failure is None:
            error.add_note(f"Found in sequence {self.sequences} after {self.steps} steps in all.")
            error.add_note("First found with: " + "; ".join(self._done))
            type(self).failure = error


def run(
    machine: type[Machine], sequences: int, steps: int, seed: int | None = None, shrink: bool = True
) -> None:
    """Runs sequences of at most so many steps, until one fails.

    Args:
        machine: the steps and invariants.
        seed: of the sequences, which are the same in each run with it. None: another one in each run.
        shrink: whether to search for the smallest sequence that fails.
    """
    machine.sequences = machine.steps = 0
    machine.failure = None
    seed = random.getrandbits(32) if seed is None else seed
    phases = [Phase.explicit, Phase.generate] + [Phase.shrink] * shrink
    options = settings(
        max_examples=sequences,
        stateful_step_count=steps,
        backend=INDEPENDENT,
        database=None,
        deadline=None,
        phases=phases,
        report_multiple_bugs=False,
        suppress_health_check=NOT_CHECKED,
    )
    try:
        hypothesis.stateful.run_state_machine_as_test(hypothesis.seed(seed)(machine), settings=options)
    except Exception as error:
        found = machine.failure or error
        shown = found if isinstance(error, Flaky) else error
        for note in found.__notes__ if shown is not found else ():
            shown.add_note(note)
        shown.add_note(f"The seed was {seed}.")
        raise shown from (error if shown is not error else None)
