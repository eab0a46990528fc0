# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Remote: each line of franka_sim's control port, its effects, refusals and time limits."""

import inspect
import re
import signal
import socket
import threading
import time
from contextlib import ExitStack, contextmanager, suppress
from types import SimpleNamespace

import numpy
import page_output
import pyfranka
import pyfranka.sim
import pytest
from operator_table import markdown, table_of_page
from pyfranka.remote import LineRefused, Remote
from pyfranka.sim import FR3, Panda
from scipy.spatial.transform import Rotation
from waiting import wait_for

READY = [0, -0.7854, 0, -2.3562, 0, 1.5708, 0.7854]
# Methods without a line of their own.
HELPERS = {"address", "port", "send", "close", "remove_wall"}
OTHER_LINES = {
    **dict.fromkeys(("close_brakes", "open_brakes"), "brakes"),
    **dict.fromkeys(("activate_fci", "deactivate_fci"), "fci"),
    **dict.fromkeys(("lock_joints", "unlock_joints"), "joints"),
    "commands": "help",
    "place_body": "place",
    "body_position": "where",
    "state_hash": "hash",
}


@pytest.fixture(scope="module")
def server(franka_sim_session):
    """A Panda and an FR3 in one world with a stone, in lock-step and without friction."""
    robots = [
        Panda(base=(-0.5, 0, 0), realism="ideal"),
        FR3(name="left", base=(0, 2, 0), realism="ideal", hand="vacuum"),
    ]
    server = franka_sim_session(*robots, world="stone.xml", pace="lockstep")
    yield server
    server.stop()


@pytest.fixture(params=["panda", "left"])
def robot(server, request):
    server[request.param].remote.reset()
    return server[request.param]


@pytest.fixture
def remote(robot):
    return robot.remote


@pytest.fixture
def clock(monkeypatch):
    """The clock of a Remote: only its own pauses advance it, by 30 s each."""
    clock = SimpleNamespace(pauses=[])
    clock.monotonic, clock.sleep = lambda: 30.0 * len(clock.pauses), clock.pauses.append
    for module in ("pyfranka.remote", "pyfranka._remote_connection"):
        monkeypatch.setattr(f"{module}.time", clock)
    monkeypatch.setattr("pyfranka.remote.MIN_ANSWER_TIME", 30.0)
    monkeypatch.setattr("pyfranka._remote_connection.MIN_TIME_OF_RETRY", 30.0)
    return clock


def names(usages):
    return {usage.split()[0] for usage in usages}


# ---- the list of lines -----------------------------------------------------------------------------------


def test_each_line_of_the_program_is_a_method_and_each_method_a_line(server):
    lines = names(server["panda"].remote.commands()) | names(server["left"].remote.commands()) | {"help"}
    methods = {
        name
        for name, each in vars(Remote).items()
        if not (name.startswith("_") or each.__doc__.startswith("Deprecated"))
    }
    # hand_move(), for example, is the line `hand move`, set_user_stop() the line `user_stop`.
    words = {name: name.removeprefix("set_") for name in methods - HELPERS}
    line_of = {name: word if word in lines else word.partition("_")[0] for name, word in words.items()}
    assert {OTHER_LINES.get(name, line) for name, line in line_of.items()} == lines


def test_the_documentation_has_the_table_of_the_robot():
    """Else: python3 tests/support/operator_table.py"""
    assert table_of_page() == markdown()


def test_the_example_of_the_documentation_works(franka_panda, capsys):
    (example,) = page_output.examples("python.md", "## Control interface")
    example.run(address=franka_panda.address)
    example.check(capsys.readouterr().out, tolerance=1e-3)


# ---- what lines do ---------------------------------------------------------------------------------------


def test_switches_show_in_the_state_at_once(remote):
    assert remote.state().mode == "Idle"
    remote.set_user_stop(True)
    assert remote.state().mode == "User stopped"
    remote.set_user_stop(False)
    remote.set_guiding(True)
    assert remote.state().mode == "Guiding"
    remote.set_guiding(False)
    remote.close_brakes()
    assert remote.state().mode == "Other"
    remote.open_brakes()
    state = remote.wait()
    assert state.mode == "Idle" and state.protocol == 0 and state.errors == {} and state.fault == ""
    assert state.q == pytest.approx(READY, abs=1e-3)


def test_a_client_and_the_errors_of_its_motion_are_reported(server):
    """A push stops a moving arm by a reflex, which the state names with its force."""
    robot = server["panda"]
    robot.remote.reset()
    client = robot.connect()
    assert robot.remote.state().protocol == 5
    pushed = []

    def push(state, period):
        if not pushed:
            pushed.append(robot.remote.push("panda_hand", (0, 80, 0), ticks=200))
        return pyfranka.JointPositions(state.q_d)

    with pytest.raises(pyfranka.ControlException, match="reflex"):
        client.control_joint_positions(push)
    state = robot.remote.state()
    assert state.mode == "Reflex"
    assert any("joint" in name or "cartesian" in name for name in state.errors)
    assert any(re.search(r"\d (N|Nm)", detail) for detail in state.errors.values()), state.errors
    client.automatic_error_recovery()
    assert robot.remote.wait().errors == {}


def test_the_interface_for_clients_can_be_switched_off(robot, remote):
    remote.deactivate_fci()
    with pytest.raises(pyfranka.NetworkException, match="FCI"):
        robot.connect()
    remote.activate_fci()
    assert robot.connect().read_once().robot_mode == pyfranka.RobotMode.Idle


def test_load_and_walls(robot, remote):
    remote.set_load(0.5, (0, 0, 0.05))
    client = robot.connect()
    state = client.read_once()
    assert state.m_load == pytest.approx(0.5) and state.F_x_Cload == pytest.approx([0, 0, 0.05])
    assert not state.I_load.any()
    inertia = numpy.array([[3.0, 0.1, 0.2], [0.1, 4.0, 0.3], [0.2, 0.3, 5.0]]) * 1e-3
    for form in (inertia, inertia.ravel().tolist()):
        remote.set_load(0.7, load_inertia=form)
        state = client.read_once()
        assert state.I_load == pytest.approx(inertia) and not state.F_x_Cload.any()
    remote.set_load(0)
    assert client.read_once().m_load == 0
    remote.wall(2, (0.3, 0, 0.2), (1, 1, 0.5), numpy.array([0, 0, 0, 2.0]))
    if robot.kind == "panda":  # protocol 10 cannot ask for walls
        wall = client.get_virtual_wall(2)
        assert wall.active and wall.object_world_size == pytest.approx([1, 1, 0.5])
        assert wall.p_frame[:3, 3] == pytest.approx([0.3, 0, 0.2])
    remote.remove_wall(2)
    assert robot.kind != "panda" or not client.get_virtual_wall(2).active


def test_lost_and_delayed_commands(server):
    robot = server["panda"]
    robot.remote.reset()
    client = robot.connect()
    rates, count = [], [0]

    def hold(state, period):
        count[0] += 1
        rates.append(state.control_command_success_rate)
        if count[0] == 150:
            robot.remote.lose(5)
        command = pyfranka.JointPositions(state.q_d)
        return pyfranka.motion_finished(command) if count[0] == 200 else command

    client.control_joint_positions(hold)
    assert rates[149] == 1.0 and min(rates[150:]) == pytest.approx(0.95, abs=1e-6)
    robot.remote.loss(0.2, 2**64 - 1)
    robot.remote.loss(0)
    robot.remote.delay(3)
    robot.remote.delay(0)


def test_places_and_pushes_in_the_world(server):
    panda, left = server["panda"], server["left"]
    panda.remote.reset()
    assert left.remote.body_position("left_link0") == pytest.approx([0, 2, 0])
    panda.remote.place_body("stone", (0.3, -0.6, 0.5), (0, 1, 0, 0))
    # A second remote sees the same world. The stone falls to the ground.
    panda.remote.wait()
    assert left.remote.body_position("stone")[:2] == pytest.approx([0.3, -0.6], abs=0.02)
    assert 0 < left.remote.body_position("stone")[2] < 0.1
    before = panda.remote.wait().q
    panda.remote.push("panda_hand", numpy.array([0, 8.0, 0]), ticks=1000000)  # time runs as fast as possible
    pushed = panda.remote.wait(lambda state: abs(state.q - before).max() > 1e-4)
    assert pushed.mode == "Idle"
    panda.remote.reset()
    panda.remote.push("panda_hand", (0, 8, 0), ticks=1000)
    assert panda.remote.wait().q == pytest.approx(before, abs=1e-4)
    left.remote.reset()
    left.remote.wait()
    assert left.remote.body_position("stone") == pytest.approx(panda.remote.body_position("stone"))


def test_a_torque_turns_a_body_about_its_axis(server):
    remote = server["panda"].remote
    remote.reset()
    stone = remote.scene().bodies.index("stone")
    for sign in (1, -1):
        remote.place_body("stone", (0.3, -0.6, 0.04))
        remote.wait()
        remote.push("stone", (0, 0, 0.1), (0, 0, sign * 0.02), ticks=20)
        remote.wait()
        w, x, y, z = remote.poses()[stone, 3:]
        turn = Rotation.from_quat([x, y, z, w]).as_rotvec()
        assert sign * turn[2] > 0.1 and abs(turn[:2]).max() < 0.01, turn


def test_what_a_simulation_in_process_does_too_has_the_same_arguments():
    """Of the same name, or `hand_` and the name: the first arguments, with the same defaults."""
    words = pyfranka.sim
    shared = set()
    for name, method in vars(Remote).items():
        for cls in (words.Simulation, words.SimulatedRobot, words.Gripper):
            prefix = "hand_" if cls is words.Gripper else ""
            twin = vars(cls).get(name.removeprefix(prefix)) if name.startswith(prefix) else None
            if inspect.isfunction(method) and inspect.isfunction(twin) and not name.startswith("_"):
                own = [p.replace(annotation=p.empty) for p in inspect.signature(method).parameters.values()]
                other = [p.replace(annotation=p.empty) for p in inspect.signature(twin).parameters.values()]
                own = [parameter for parameter in own if parameter.name != "timeout"]
                assert own == other[: len(own)], name
                shared.add(name)
    assert {"push", "set_load", "place_body", "step", "recover", "state_hash", "hand_grasp"} <= shared


def test_the_scene_describes_the_world_to_draw(server):
    remote = server["left"].remote
    remote.reset()
    scene = remote.scene()
    assert scene.robots == {"panda": "panda", "left": "fr3"}
    for link in ("panda_link0", "panda_link7", "panda_hand", "panda_leftfinger", "left_link6", "stone"):
        shapes = [shape for shape in scene.shapes if scene.bodies[shape.body] == link]
        assert shapes, link
    (stone,) = shapes
    assert stone.kind == "box" and stone.mesh == ""
    assert stone.size == pytest.approx([0.0125, 0.016, 0.032])
    assert stone.color == pytest.approx([0.93, 0.92, 0.89, 1])
    assert stone.pose == pytest.approx([0, 0, 0, 1, 0, 0, 0])
    assert remote.scene().bodies == scene.bodies


def test_poses_follow_the_bodies(server):
    remote = server["panda"].remote
    remote.reset()
    bodies = remote.scene().bodies
    before = remote.poses()
    assert before.shape == (len(bodies), 7)
    assert numpy.linalg.norm(before[:, 3:], axis=1) == pytest.approx(1.0, abs=1e-6)
    remote.place_body("stone", (0.1, 0.2, 0.7), (0.6, 0, 0.8, 0))
    remote.wait()
    poses = remote.poses()
    stone = bodies.index("stone")
    assert numpy.abs(poses[stone] - before[stone])[3:].max() > 0.1, "It has been turned."
    for body in ("stone", "panda_hand", "left_link7", "panda_link8"):
        assert poses[bodies.index(body)][:3] == pytest.approx(remote.body_position(body), abs=1e-6)
    remote.reset()


# A grid of squares, each of two triangles, over one of 100 m: no vertex of it can be left out.
def grid(count):
    vertices = [(i, j, (i * j) % 7) for i in range(count) for j in range(count)]
    faces = []
    for i in range(count - 1):
        for j in range(count - 1):
            corner = i * count + j
            faces += [(corner, corner + count, corner + 1), (corner + 1, corner + count, corner + count + 1)]
    return vertices, faces


def test_meshes_are_read_in_parts(franka_sim, tmp_path):
    vertices, faces = grid(50)
    text = " ".join(str(number) for vertex in vertices for number in vertex)
    triangles = " ".join(str(corner) for face in faces for corner in face)
    world = tmp_path / "world.xml"
    world.write_text(
        f"""<mujoco>
        <asset><mesh name="grid" vertex="{text}" face="{triangles}" scale="0.01 0.01 0.001"/></asset>
        <worldbody><body name="field" pos="0 5 0">
          <geom type="mesh" mesh="grid" contype="0" conaffinity="0"/>
        </body></worldbody></mujoco>"""
    )
    remote = franka_sim("panda", world=str(world)).robot.remote
    scene = remote.scene()
    (shape,) = (shape for shape in scene.shapes if scene.bodies[shape.body] == "field")
    mesh = remote.mesh(shape.mesh)
    turn = Rotation.from_quat(numpy.roll(shape.pose[3:], -1))
    seen = turn.apply(mesh.vertices) + shape.pose[:3]
    expected = numpy.array(vertices) * (0.01, 0.01, 0.001)
    assert mesh.faces.shape == (len(faces), 3)

    def triangles_of(points, indices):
        return {tuple(numpy.round(corners, 4).ravel() + 0.0) for corners in points[numpy.array(indices)]}

    assert triangles_of(seen, mesh.faces) == triangles_of(expected, faces)
    part = remote.send(f"mesh {shape.mesh} 0")
    assert 15000 < len(part) < 16000
    for line in (f"mesh {shape.mesh} -1", f"mesh {shape.mesh} 1000000", "mesh mesh0"):
        with pytest.raises(LineRefused):
            remote.send(line)


@pytest.mark.realtime("the 1 kHz loop must not wait while the scene is read")
def test_reading_the_scene_delays_no_state(franka_sim):
    """Measured at the robot's own clock: simulated time follows the wall clock while the scene is read."""
    robots = [Panda(base=(-0.5, 0, 0)), FR3(base=(0, 2, 0))]
    remote = franka_sim(*robots, world="stone.xml", pace="realtime").robot.remote
    with remote, Remote(remote.address) as other:
        remote.step(200)
        thread = threading.Thread(target=other.scene)
        begin = time.monotonic() - remote.time
        late = []
        thread.start()
        while thread.is_alive() or len(late) < 100:
            late.append(time.monotonic() - remote.time - begin)
        thread.join()
    assert max(late) < 0.05, "The host makes up for delays of up to 50 ms."


def test_the_hand_works_for_the_operator(franka_sim):
    remote = franka_sim("panda", pace="lockstep", realism="ideal").robot.remote

    def width():
        return numpy.linalg.norm(
            remote.body_position("panda_leftfinger") - remote.body_position("panda_rightfinger")
        )

    with remote:
        begin = remote.time
        remote.hand_homing()
        assert remote.time > begin + 4.0, "Closing and opening take seconds."
        assert width() == pytest.approx(0.08, abs=1e-3)
        remote.hand_move(0.02, 0.1)
        assert width() == pytest.approx(0.02, abs=1e-3)
        with pytest.raises(LineRefused, match=r"Nothing of that width has been grasped. The width is 0.0"):
            remote.hand_grasp(0.05, 0.1, 30)
        remote.hand_stop()
        remote.wait()


def test_one_command_of_the_hand_ends_another(franka_sim):
    remote = franka_sim("panda", pace="realtime").robot.remote
    failures = []

    def open_slowly():
        with pytest.raises(LineRefused) as failure:
            Remote(remote.address).hand_move(0.08, 0.001)  # takes more than a minute
        failures.append(str(failure.value))

    before = remote.body_position("panda_leftfinger")
    thread = threading.Thread(target=open_slowly)
    thread.start()
    wait_for(lambda: numpy.linalg.norm(remote.body_position("panda_leftfinger") - before) > 1e-4, "A motion")
    remote.hand_stop()
    thread.join(60)
    assert failures == ["Another command or a reset has ended this one."]


def test_the_vacuum_gripper_has_lines_of_its_own(server):
    left = server["left"].remote
    left.part(True)
    left.pump("orange")
    left.part(False)
    left.pump("green")
    with pytest.raises(LineRefused, match="There is no command 'part'"):
        server["panda"].remote.part(True)


# ---- time ------------------------------------------------------------------------------------------------


def test_steps_are_exact_in_lock_step_and_time_stands_still_between_them(remote):
    remote.wait()
    begin = remote.time
    for ticks in (1, 7, 250):
        before = remote.time
        remote.step(ticks)
        assert remote.time == pytest.approx(before + 1e-3 * ticks, abs=1e-9)
    assert remote.time == pytest.approx(begin + 0.258, abs=1e-9)


def test_step_follows_earlier_commands(remote, robot):
    """The push is over when the step begins: twice the same lines take the same time."""
    spans = []
    for _ in range(2):
        remote.reset()
        remote.wait()
        begin = remote.time
        remote.push(f"{robot.name}_link7", (0, 5, 0), ticks=300)
        remote.step(10)
        spans.append(remote.time - begin)
    assert spans[0] == pytest.approx(spans[1], abs=1e-9) and spans[0] > 0.31


def test_a_world_that_does_not_come_to_rest_is_reported(server):
    remote = server["panda"].remote
    remote.reset()
    remote.push("panda_hand", (0, 5, 0), ticks=60000)
    with pytest.raises(LineRefused, match="has not come to rest within 10 s of its time"):
        remote.wait()
    before = remote.time
    remote.step(100)
    assert remote.time >= before + 0.1
    remote.reset()
    assert remote.wait().mode == "Idle"


def test_reset_sets_time_to_its_beginning(remote):
    remote.step(500)
    remote.reset()
    assert remote.wait() and remote.time < 0.5


def test_the_hash_waits_until_the_world_is_at_rest_and_repeats(server):
    robot, ticks = server["panda"], 200
    robot.remote.reset()
    assert robot.remote.state_hash() == 0xCBF29CE484222325  # FNV-1a of nothing
    client, count = robot.connect(), [0]

    def hold(state, period):
        count[0] += 1
        command = pyfranka.JointPositions(state.q_d)
        return pyfranka.motion_finished(command) if count[0] == ticks else command

    hashes = []
    for _ in range(2):
        count[0] = 0
        robot.remote.reset()
        client.control_joint_positions(hold)
        hashes.append(robot.remote.state_hash())
    assert hashes[0] == hashes[1] != 0xCBF29CE484222325
    assert isinstance(hashes[0], int)


# ---- connections -----------------------------------------------------------------------------------------


def test_a_reset_is_refused_while_a_client_moves_any_robot(server, robot):
    def hold(state, period):
        with pytest.raises(LineRefused, match="motion"):
            server["panda"].remote.reset()
        return pyfranka.motion_finished(pyfranka.JointPositions(state.q_d))

    robot.connect().control_joint_positions(hold)


def test_reset_by_another_client_does_not_block_a_step(server):
    address = server["panda"].address
    with Remote(address) as first, Remote(address) as second:

        def is_reset_during_step():
            first.reset()
            thread = threading.Thread(target=first.step, args=(20000,))
            thread.start()
            wait_for(lambda: second.time >= 0.5 or not thread.is_alive(), pause=0.0)
            second.reset()
            thread.join(60)
            assert not thread.is_alive()
            # After a reset at the end of the step, less than a second has passed.
            return 1.0 < second.time < 20.0

        wait_for(is_reset_during_step, "A reset during a step", 120.0)


def test_a_ninth_client_is_refused_and_waits_for_its_turn(server, clock):
    address = server["panda"].address
    with ExitStack() as others:
        clients = [others.enter_context(Remote(address)) for _ in range(8)]
        with pytest.raises(LineRefused, match="8 clients use this control interface"):
            Remote(address).state(timeout=90.0)
        assert len(clock.pauses) == 2, "It has waited for its turn."
        assert all(client.state().mode == "Idle" for client in clients)
        # One leaves while another one waits.
        clock.monotonic, clock.sleep = time.monotonic, lambda pause: clients[4].close()
        assert Remote(address).state().mode == "Idle"
    with clients[0] as again:
        assert again.state().mode == "Idle"


def test_threads_share_a_remote(server):
    with server["panda"].remote as remote:
        bodies = ["stone", "panda_link0"] * 20
        expected = {body: remote.body_position(body) for body in set(bodies)}
        found = {}

        def look(index):
            found[index] = remote.body_position(bodies[index])

        threads = [threading.Thread(target=look, args=(index,)) for index in range(len(bodies))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
    assert len(found) == len(bodies)
    assert all(numpy.array_equal(found[i], expected[body]) for i, body in enumerate(bodies))


def test_a_stopped_robot_times_out_and_works_again(franka_sim):
    server = franka_sim("panda")
    remote = server.robot.remote
    server.process.send_signal(signal.SIGSTOP)
    with pytest.raises(TimeoutError, match="has not answered 'state' within 0.3 s. The line may still"):
        remote.state(timeout=0.3)
    server.process.send_signal(signal.SIGCONT)
    assert remote.state().mode == "Idle"


def test_a_state_that_does_not_come_is_reported(server, clock):
    with pytest.raises(TimeoutError, match="has not come to the awaited state within 60 s"):
        server["panda"].remote.wait(lambda state: state.mode == "Move", timeout=60.0)


def test_lost_robot_is_reported(franka_sim):
    server = franka_sim("panda", pace="realtime")
    with server.robot.remote as remote:
        threading.Timer(0.3, server.process.terminate).start()
        with pytest.raises(ConnectionError, match="went away before it answered|broke at 'step"):
            remote.step(60000)
        server.process.wait(60)  # its connections end before its port
        with pytest.raises(ConnectionError, match="There is no control interface"):
            remote.wait(lambda state: False)


def test_quit_returns_once_the_port_is_closed(franka_sim):
    server = franka_sim("panda")
    server.robot.remote.quit()
    with socket.socket() as probe:
        assert probe.connect_ex((server.robot.address, 1340)) != 0
    assert server.process.wait(60) == 0


@contextmanager
def answering(text, limit):
    """Something at a free port that accepts a connection and sends this."""
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve():
            client, _ = listener.accept()
            with client, suppress(ConnectionResetError):
                client.recv(100)
                client.sendall(text)
                client.recv(100)  # until the other side closes

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        yield Remote("127.0.0.1", listener.getsockname()[1], timeout=limit)
        thread.join(60)


@pytest.mark.parametrize(
    "text, error, sentence",
    [
        (
            b"SSH-2.0-server\r\n",
            ConnectionError,
            "is not a control interface of franka_sim: 'SSH-2.0-server'",
        ),
        (b"x" * 100000, ConnectionError, "is not a control interface"),
        (b"ok strange\n", ConnectionError, "cannot be read: 'strange'"),
        (b"ok Idle, cli", TimeoutError, "has not answered 'state' within 1 s"),
        (b"", TimeoutError, "has not answered 'state' within 1 s"),
    ],
)
def test_other_servers_are_recognized(text, error, sentence):
    limit = 1.0 if error is TimeoutError else 60.0
    with answering(text, limit) as remote, pytest.raises(error, match=sentence):
        remote.state()
