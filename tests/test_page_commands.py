# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What the commands of the documentation's pages name exists (tests/support/page_commands.py)."""

import textwrap

import pytest
from code_blocks import all_blocks
from docsite.paths import TOP
from page_commands import faults, faults_in


@pytest.mark.parametrize("page", sorted({block.page for block in all_blocks()}))
def test_commands_of_a_page_could_run(page):
    assert not faults(TOP / page)


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("./franka dance", "no command dance"),
        ("./franka shell rosrun franka_sim_mujoco dance", "no program dance"),
        ("frnka_sim", "no command frnka_sim"),
        ("FRANKA_OFFLINE=1 no_such_program --help | cat", "no command no_such_program"),
        ("echo $(no_such_program)", "no command no_such_program"),
        ("python3 examples/python/no_such.py", "no examples/python/no_such.py"),
        ("franka_sim --robt panda", "franka_sim has no --robt"),
        ("franka_sim --pac=realtime", "franka_sim has no --pac"),
        ("franka_info record 127.0.0.1 a.csv 30 --mov", "franka_info has no --mov"),
        ("franka_desk --lisen 127.0.0.1:1", "franka_desk has no --lisen"),
        ("roslaunch franka_gazebo panda.launch speed:=3", "takes no speed:=3"),
        ("roslaunch franka_gazebo ur5.launch", "has no ur5.launch"),
        ("roslaunch franka_gazeboo panda.launch", "no package franka_gazeboo"),
        ("rosservice call /franka_control/set_weight '{}'", "no /franka_control/set_weight"),
        ("rosservice call /franka_control/set_load '{weight: 1}'", "weight"),
        ("rosservice cal /franka_control/set_load '{}'", "no command cal"),
        ("rostopic pub -1 /joint_states franka_msgs/Weight '{}'", "no type franka_msgs/Weight"),
        ("rostopic pub -r 10 /joint_states sensor_msgs/JointState '{size: 1}'", "size"),
        ("rostopic echo -n 1 /no_such_topic", "no /no_such_topic"),
        ("docker build --target runtim .", "no runtim"),
        ("echo 'dance' | nc -q 1 127.0.0.1 1340", "no line dance"),
    ],
)
def test_a_command_that_could_not_run_is_found(line, what):
    (fault,) = faults_in(f"```bash\n{line}\n```\n")
    assert what in fault


@pytest.mark.parametrize(
    "line",
    [
        "./franka dance",
        "roslaunch franka_gazebo panda.launch speed:=3",
        "rosservice call /franka_control/set_weight '{}'",
        "echo 'dance' | nc -q 1 127.0.0.1 1340",
    ],
)
def test_commands_in_the_text_and_in_indented_blocks_are_found_too(line):
    assert len(faults_in(f"Then `{line}` does it.\n")) == 1
    assert len(faults_in(f"Then type\n\n    {line}\n")) == 1


def test_right_commands_are_accepted():
    script = """
        # comment; with | signs
        cd ~/catkin_ws && source devel/setup.bash
        roslaunch franka_example_controllers force_example_controller.launch sim:=true \\
            robot:=fr3 rviz:=false &
        for robot in panda fr3; do ./franka demo robot:=$robot --gui; done
        rosservice call /franka_control/set_load "{mass: 0.1}" > answer.txt 2>&1
        cat > file.yaml <<EOF
        no_such_program: 3
        EOF
        rostopic echo -n 1 /franka_state_controller/franka_states
        rostopic pub -1 /franka_control/error_recovery/goal franka_msgs/ErrorRecoveryActionGoal "{}"
        echo 'push panda_link4 0 30 0 3000' | nc -q 1 127.0.0.1 1340
    """
    assert not faults_in(f"```bash{textwrap.dedent(script)}```\n")


def test_packages_of_the_reader_are_accepted():
    made = "rosrun franka_example_controllers new_controller spring_controller Spring\n"
    use = "roslaunch spring_controller run.launch\nrostopic echo -n 1 /spring_controller/energy\n"
    assert not faults_in(f"```bash\n{made}{use}```\n")
    assert len(faults_in(f"```bash\n{use}```\n")) == 2
