# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the sources of the documentation site: pages of docs/, and a reference read from the sources."""
