# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The generated types have the MD5 sums that other people's programs expect."""

import importlib
import os
import unittest

OWN_PACKAGE = "control_msgs"
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "md5.txt")


def read_table():
    """Return [(package, type, md5)] of the data file."""
    rows = []
    with open(TABLE, encoding="utf-8") as lines:
        for line in lines:
            line = line.split("#")[0].split()
            if line:
                name, md5 = line
                rows.append((*name.split("/"), md5))
    return rows


def generated_class(package, name):
    """Return the message or service class, None when the package is not part of this build."""
    try:
        messages = importlib.import_module(package + ".msg")
    except ImportError:
        return None
    if hasattr(messages, name):
        return getattr(messages, name)
    return getattr(importlib.import_module(package + ".srv"), name)


class Md5Test(unittest.TestCase):
    def test_every_type_of_the_table(self):
        checked = set()
        not_built = set()
        for package, name, expected in read_table():
            generated = generated_class(package, name)
            if generated is None:
                not_built.add(package)
                continue
            with self.subTest(type=package + "/" + name):
                self.assertEqual(generated._md5sum, expected)
            checked.add(package)
        self.assertIn(OWN_PACKAGE, checked)
        if not_built:
            self.skipTest("not built, so not checked: " + ", ".join(sorted(not_built)))

    def test_every_own_type_is_in_the_table(self):
        listed = {name for package, name, _ in read_table() if package == OWN_PACKAGE}
        for kind in ("msg", "srv"):
            module = importlib.import_module(OWN_PACKAGE + "." + kind)
            generated = {name for name in dir(module) if hasattr(getattr(module, name), "_md5sum")}
            self.assertEqual(generated - listed, set())
