# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The proxy itself: its faults are as configured, and equal for equal seeds."""

from fci_proxy import (
    Channel,
    bursts,
    delaying,
    duplicating,
    every,
    losing,
    losing_from,
    oversized,
    renumbered,
    truncated,
)

DATA = bytes(range(200)) + bytes(170)


def sent(rule, count, seed=1):
    channel = Channel(rule, seed)
    channel.restart()
    return channel, [channel.apply(DATA) for _ in range(count)]


def test_without_a_rule_everything_passes():
    channel, items = sent(None, 50)
    assert items == [[(0.0, DATA)]] * 50
    assert channel.worst_share() == 1.0


def test_losses_have_their_probability_and_repeat():
    channel, items = sent(losing(0.2), 20000)
    assert abs(channel.lost / 20000 - 0.2) < 0.012  # four standard deviations
    assert sent(losing(0.2), 20000)[1] == items
    assert sent(losing(0.2), 20000, seed=2)[1] != items


def test_only_the_chosen_messages_are_lost():
    channel, items = sent(losing_from(200, 19), 400)
    assert [i for i, item in enumerate(items) if not item] == list(range(200, 219))
    assert (channel.longest, channel.lost, channel.worst_share()) == (19, 19, 0.81)


def test_bursts_are_dropped():
    channel, _ = sent(bursts(0.05, 0.02, 18), 5000)
    assert channel.lost > 500
    # Two bursts may follow each other: then at least one datagram has passed between them.
    assert channel.longest <= 18


def test_a_changed_message_accompanies_the_original():
    for change in (truncated, oversized, renumbered(-1), renumbered(3)):
        _, items = sent(every(3, change), 9)
        assert [len(item) for item in items] == [1, 1, 2] * 3
        assert all(item[-1] == (0.0, DATA) for item in items)
        assert items[2][0][1] != DATA
    _, items = sent(duplicating, 100)
    assert {len(item) for item in items} == {1, 2, 3}


def test_delays_are_random():
    assert sent(delaying(0.5), 2)[1] == [[(0.5, DATA)]] * 2
    delays = [item[0][0] for item in sent(delaying(lambda chance: chance.gauss(0.0, 1.0)), 100)[1]]
    assert min(delays) == 0.0 and max(delays) > 1.0
