# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The generated service has the MD5 sum of the original's."""

import unittest

from control_toolbox.srv import SetPidGains


class Md5Test(unittest.TestCase):
    def test_set_pid_gains(self):
        self.assertEqual(SetPidGains._md5sum, "4a43159879643e60937bf2893b633607")
