# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The proxy itself: its faults are as configured, and equal for equal seeds."""

from fci_proxy import Channel, losing, losing_from, worst_share

DATA = bytes(range(200)) + bytes(170)


def sent(rule, count, seed=1):
    channel = Channel(rule, seed)
    channel.restart()
    return [channel.apply(DATA) for _ in range(count)]


def lost(items):
    return [number for number, item in enumerate(items) if not item]


def test_only_the_configured_messages_are_lost():
    assert sent(None, 50) == [[DATA]] * 50
    items = sent(losing_from(200, 19), 400)
    assert lost(items) == list(range(200, 219))
    assert worst_share([bool(item) for item in items]) == 0.81
    items = sent(losing(0.2), 20000)
    assert abs(len(lost(items)) / 20000 - 0.2) < 0.012  # four standard deviations
    assert sent(losing(0.2), 20000) == items
    assert sent(losing(0.2), 20000, seed=2) != items
