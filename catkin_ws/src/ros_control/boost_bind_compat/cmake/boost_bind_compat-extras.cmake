# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# Before the system's include folders, so that boost/bind/placeholders.hpp is found here. This file
# and that folder are beside each other in the sources and when installed.
get_filename_component(_boost_bind_compat_placeholders "${CMAKE_CURRENT_LIST_DIR}/../placeholders"
                       ABSOLUTE)
list(APPEND boost_bind_compat_INCLUDE_DIRS ${_boost_bind_compat_placeholders})
