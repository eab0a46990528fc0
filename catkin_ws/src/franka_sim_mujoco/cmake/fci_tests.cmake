# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# The robots' network face; after tests.cmake, which brings sim_test.
sim_test(fci_test
  SOURCES
    test/fci/command_link_test.cpp
    test/fci/hostile_clients_test.cpp
    test/fci/host_rules_test.cpp
    test/fci/host_test.cpp
    test/fci/line_server_test.cpp
    test/fci/own_client_test.cpp
    test/fci/robot_server_test.cpp
    test/fci/served_models_test.cpp
    test/fci/sim_robot_test.cpp
    test/fci/vacuum_gripper_test.cpp
  LIBRARIES franka_sim_fci franka_sim_physics Franka::Franka PkgConfig::TINYXML2)
