# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The world goes on while its node waits for the ROS master, and ends what takes long.

Between the node and its master is a program that answers each call only after the world's next ticks: a call
of the stepping thread would never get its answer.
"""

import threading
from functools import partial
from pathlib import Path
from socketserver import ThreadingMixIn
from xmlrpc.client import ServerProxy
from xmlrpc.server import SimpleXMLRPCServer

import pytest
import rospy
from franka_sim_mujoco.session import Session, free_port
from franka_sim_mujoco.srv import Benchmark, DeleteRobot, SpawnRobot, SpawnRobotRequest, Step
from ros_client import call, in_session
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Empty
from waiting import PATIENCE, wait_for

LAUNCH = Path(__file__).resolve().parent / "slow_master.launch"
MOST = {"step": 3600000, "benchmark": 1000000}  # ticks of a request

pytestmark = pytest.mark.own_process


class SlowMaster(ThreadingMixIn, SimpleXMLRPCServer):
    """Forwards calls to the master on a port; when `slow`, after two more ticks of the world."""

    daemon_threads = True

    def __init__(self, port):
        super().__init__(("localhost", 0), logRequests=False, allow_none=True)
        self.uri = f"http://localhost:{self.server_address[1]}"
        self.master, self.slow = f"http://localhost:{port}", False
        self.ticked, self.ticks = threading.Condition(), 0
        self.delayed, self.stalled = 0, []

    def tick(self, _clock):
        with self.ticked:
            self.ticks += 1
            self.ticked.notify_all()

    def _dispatch(self, method, params):
        if self.slow:
            self._wait(method)
        with ServerProxy(self.master, allow_none=True) as master:
            return getattr(master, method)(*params)

    def _wait(self, method):
        with self.ticked:
            self.delayed += 1
            due = self.ticks + 2
            if not self.ticked.wait_for(lambda: self.ticks >= due or self.stalled, PATIENCE):
                self.stalled.append(method)


@pytest.fixture(scope="module")
def master(tmp_path_factory):
    port = free_port()
    with SlowMaster(port) as slow:
        threading.Thread(target=slow.serve_forever, daemon=True).start()
        log = tmp_path_factory.mktemp("simulation") / "launch.log"
        try:
            with in_session(Session(str(LAUNCH), f"master:={slow.uri}", log=log, port=port)):
                rospy.Subscriber("/clock", Clock, slow.tick, queue_size=1000)
                wait_for(lambda: slow.ticks, "The clock")
                yield slow
        finally:
            slow.slow = False
            slow.shutdown()


@pytest.mark.parametrize("name, address", [("in_process", ""), ("served", "127.0.0.19")])
def test_the_world_goes_on_while_a_robot_is_spawned(master, name, address):
    rospy.set_param(f"/{name}/arm_id", "panda")
    rospy.set_param(f"/{name}/fci_ip", address)
    urdf = rospy.get_param("/panda_description")
    order = SpawnRobotRequest(name=name, urdf=urdf, robot_namespace=f"/{name}")
    order.pose.orientation.w = 1
    spawn = rospy.ServiceProxy("/gazebo/spawn_robot", SpawnRobot)
    spawn.wait_for_service(PATIENCE)
    master.delayed, master.stalled, master.slow = 0, [], True
    try:
        answer = spawn(order)
    finally:
        master.slow = False
    assert answer.success, answer.error
    assert call("/gazebo/delete_robot", DeleteRobot, name).success
    assert master.delayed > 20, "The spawn did not ask this master."
    assert master.stalled == []


@pytest.mark.parametrize("name, kind", [("step", Step), ("benchmark", Benchmark)])
def test_long_requests_have_a_maximum_and_end_with_a_pause(master, name, kind):
    ask, pause = partial(call, f"/gazebo/{name}", kind), partial(call, "/gazebo/pause_physics", Empty)
    pause()
    for ticks in (MOST[name] + 1, 2**32 - 1):
        refused = ask(ticks)
        assert not refused.success and str(MOST[name]) in refused.error
    answers = []
    asking = threading.Thread(target=lambda: answers.append(ask(MOST[name])))
    begin = call("/gazebo/step", Step, 0).tick
    asking.start()
    wait_for(lambda: rospy.get_rostime().to_nsec() // 1000000 > begin + 10, "A tick")
    pause()
    asking.join(PATIENCE)
    assert not asking.is_alive()
    assert not answers[0].success and "paused" in answers[0].error
    state = call("/gazebo/step", Step, 1)
    assert state.success and state.tick < begin + MOST[name], state.error
    call("/gazebo/unpause_physics", Empty)
