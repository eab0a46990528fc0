# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The proxy itself: its faults are as configured, and equal for equal seeds."""

from fci_proxy import (
    Channel,
    bursts,
    duplicating,
    every,
    late_from,
    losing,
    losing_from,
    oversized,
    renumbered,
    stalling,
    truncated,
    worst_share,
)

DATA = bytes(range(200)) + bytes(170)


def sent(rule, count, seed=1):
    channel = Channel(rule, seed)
    channel.restart()
    return [channel.apply(DATA) for _ in range(count)]


def lost(items):
    return [number for number, item in enumerate(items) if not item]


def longest(items):
    """How many in a row are lost at most."""
    kept = [-1, *(number for number, item in enumerate(items) if item), len(items)]
    return max(b - a - 1 for a, b in zip(kept, kept[1:]))


def test_without_a_rule_everything_passes():
    assert sent(None, 50) == [[DATA]] * 50


def test_losses_have_their_probability_and_repeat():
    items = sent(losing(0.2), 20000)
    assert abs(len(lost(items)) / 20000 - 0.2) < 0.012  # four standard deviations
    assert sent(losing(0.2), 20000) == items
    assert sent(losing(0.2), 20000, seed=2) != items


def test_only_the_chosen_messages_are_lost():
    items = sent(losing_from(200, 19), 400)
    assert lost(items) == list(range(200, 219))
    assert worst_share([bool(item) for item in items]) == 0.81


def test_bursts_are_dropped():
    items = sent(bursts(0.05, 0.02, 18), 5000)
    assert len(lost(items)) > 500
    # Two bursts may follow each other: then at least one datagram has passed between them.
    assert longest(items) <= 18


def test_a_changed_message_accompanies_the_original():
    for change in (truncated, oversized, renumbered(-1), renumbered(3)):
        items = sent(every(3, change), 9)
        assert [len(item) for item in items] == [1, 1, 2] * 3
        assert all(item[-1] == DATA for item in items)
        assert items[2][0] != DATA
    assert {len(item) for item in sent(duplicating, 100)} == {1, 2, 3}


def numbered(rule, count):
    """What is sent of datagrams that are numbers."""
    channel = Channel(rule)
    return [channel.apply(number) for number in range(count)]


def test_late_messages_come_one_by_one_and_a_backlog_together():
    assert numbered(late_from(2), 5) == [[0], [1], [], [2], [3]]
    assert numbered(stalling(1, 2), 5) == [[0], [], [], [1, 2, 3], [4]]
