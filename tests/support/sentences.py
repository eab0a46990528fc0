# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Errors for users: whether a text is a sentence of ours."""

import re
import threading

from waiting import wait_for

ERRORS = (ValueError, TypeError, KeyError, IndexError, RuntimeError, FileNotFoundError)
# Of numpy and Python, which name no argument of the user.
FOREIGN = re.compile(
    r"could not convert|object cannot be interpreted|has no attribute"
    r"|not supported between|unsupported|must be real number|unhashable|out of range|expected str"
    r"|object is not|inhomogeneous|invalid literal|_pyfranka"
)
# Of pybind11, with the names and types that a function takes; the first part of the text.
SIGNATURES = re.compile(r"\w*\(\): incompatible (function|constructor) arguments\.")


def unlike_ours(sentence):
    """Why this is not a sentence of ours; None if it is one, or names arguments and types."""
    text = sentence.strip("\"'")
    if SIGNATURES.match(text):
        return None if "_pyfranka" not in text else "it has names that users do not import"
    if FOREIGN.search(text):
        return "it is Python's or a library's"
    # Genuine libfranka's own words stay.
    if not text.endswith(".") and not text.startswith("libfranka"):
        return "it does not end with a full stop"
    return None


def faults_of(cases, thing, owner=""):
    """What is wrong with the refusals of a table: function -> a part of the sentence -> the call, which gets
    the thing."""
    wrong = []
    for function, sentences in cases.items():
        for part, call in sentences.items():
            where = f"{owner}.{function}, {part!r}"
            try:
                call(thing)
                wrong.append(f"{where}: not refused")
            except ERRORS as error:
                # KeyError shows the repr of its argument.
                text = str(error.args[0]) if error.args else ""
                if part not in text or unlike_ours(text):
                    wrong.append(f"{where}: {unlike_ours(text) or 'another sentence'}: {type(error)} {text}")
    return wrong


def check_refused_while_another_thread_steps(sim, calls):
    """Each call (its name, the function) is refused while another thread steps the simulation."""
    ended = threading.Event()

    def step():
        while not ended.is_set():
            try:
                sim.step(3000)
            except RuntimeError:  # the other thread was first
                pass

    worker = threading.Thread(target=step)
    worker.start()
    try:
        for name, call in calls:

            def is_refused(call=call):
                try:
                    call()  # may come between two steps
                except RuntimeError as error:
                    return "Another thread uses this simulation" in str(error)

            wait_for(is_refused, f"The refusal of {name}", pause=0.0)
    finally:
        ended.set()
        worker.join()
    sim.step()
