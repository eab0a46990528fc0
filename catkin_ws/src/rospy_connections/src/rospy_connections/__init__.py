# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What our Python nodes have in common: answer_help() and init_node().

init_node() is for nodes that start together with what they listen to.

A subscriber learns of its publishers on two ways: from the master's answer when it registers, and from
the master's later updates. On a busy machine an update can overtake the answer. rospy then keeps only
what it heard last, which is the outdated answer, and the subscriber waits for ever for a publisher that
is there (seen: an action client whose server started in the same few milliseconds; it reports "no
server"). Connecting to a publisher that has gone meanwhile does no harm, so nothing that waits to be
connected needs to be forgotten.
"""

import sys

import rospy
from rospy.impl.registration import RegManager


def _publisher_update(self, resolved_name, uris):
    """RegManager.publisher_update that keeps the publishers which an earlier, unread update names."""
    with self.cond:
        waiting = [uri for name, queued in self.updates if name == resolved_name for uri in queued]
        self.updates.append((resolved_name, list(dict.fromkeys([*uris, *waiting]))))
        self.cond.notify_all()


def answer_help(command: str, text: str) -> None:
    """Ends a program that was started with -h or --help, after printing what it is. Needs no master.

    `command` is how to call it, without "usage: ".
    """
    if {"-h", "--help"} & set(rospy.myargv(sys.argv)[1:]):
        print(f"usage: {command} [NAME:=VALUE]...\n\n{text.strip()}")
        sys.exit(0)


def init_node(*arguments, **options) -> None:
    """rospy.init_node(), after which subscribers find their publishers in whatever order these start."""
    RegManager.publisher_update = _publisher_update
    rospy.init_node(*arguments, **options)
