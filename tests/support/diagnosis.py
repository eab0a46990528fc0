# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A node's diagnostics."""

import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray

OK, ERROR = 0, 2  # levels


class Diagnosis:
    def __init__(self, node: str):
        self.node, self.kept = node, {}
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._keep)

    def _keep(self, message):
        for status in message.status:
            self.kept[status.name] = status

    def shows(self, what, text, patience=15.0, **expected):
        """One status, once it has that text: [level, hardware, values], or its text after a timeout."""
        return self.status_when(
            what, lambda reported, values: reported == text and values.items() >= expected.items(), patience
        )

    def status_when(self, what, condition, patience=15.0):
        """The same, once a condition on its text and its values holds."""
        name = f"{self.node}: {what}"
        deadline = time.monotonic() + patience
        while time.monotonic() < deadline:
            status = self.kept.get(name)
            values = {v.key: v.value for v in status.values} if status is not None else {}
            if status is not None and condition(status.message, values):
                return [status.level, status.hardware_id, values]
            time.sleep(0.02)
        return self.kept[name].message if name in self.kept else sorted(self.kept)
