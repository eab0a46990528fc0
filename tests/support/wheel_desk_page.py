# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Prints how often the page of a robot of its own is there, and whether it has a text."""

import ssl
import subprocess
import sys
import urllib.request

program = [sys.prefix + "/bin/franka_sim", "--ip", "127.0.61.10", "--desk"]
with subprocess.Popen(program, stdout=subprocess.PIPE, text=True) as served:
    try:
        while "https://" not in (line := served.stdout.readline()):
            assert line, "franka_sim has ended"
        trusting = ssl._create_unverified_context()
        address = next(word for word in line.split() if word.startswith("https://"))
        page = urllib.request.urlopen(address.rstrip(".,"), context=trusting, timeout=30).read()
        print(page.count(b"<html"), len(page) > 500)
    finally:
        served.terminate()
