# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What the commands of the documentation's pages name exists (tests/support/page_commands.py)."""

import pytest
from code_blocks import all_blocks
from docsite.paths import TOP
from page_commands import faults_in


@pytest.mark.parametrize("page", sorted({block.page for block in all_blocks()}))
def test_commands_of_a_page_could_run(page):
    assert not faults_in((TOP / page).read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("./franka dance", "no command dance"),
        ("./franka shell rosrun franka_sim_mujoco dance", "no program dance"),
        ("franka_sim --robt panda", "franka_sim has no --robt"),
        ("roslaunch franka_gazebo panda.launch speed:=3", "takes no speed:=3"),
        ("rosservice call /franka_control/set_weight '{}'", "no /franka_control/set_weight"),
        ("rosservice cal /franka_control/set_load '{}'", "no command cal"),
        ("echo 'dance' | nc -q 1 127.0.0.1 1340", "no line 'dance'"),
    ],
)
def test_a_command_that_could_not_run_is_found(line, what):
    for text in (f"```bash\n{line}\n```\n", f"Then type\n\n    {line}\n"):
        (fault,) = faults_in(text)
        assert what in fault


def test_packages_of_the_reader_are_accepted():
    made = "rosrun franka_example_controllers new_controller spring_controller Spring\n"
    use = "roslaunch spring_controller run.launch\nrostopic echo -n 1 /spring_controller/energy\n"
    assert not faults_in(f"```bash\n{made}{use}```\n")
    assert len(faults_in(f"```bash\n{use}```\n")) == 2
