# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The robot's protocol byte by byte, and a client in which each step is a separate call.

It checks and corrects nothing, so that a test can send bytes that no library sends. Layouts are those of
versions 5 (Panda) and 10 (FR3). All waits have a limit and fail with a message.
"""

import select
import socket
import struct
from dataclasses import dataclass

HEADER = struct.Struct("<III")  # command, id, size of the whole message
PORT = 1337
LIMIT = 60.0  # [s] of each wait
IDLE, MOVE, REFLEX = 1, 2, 4  # robot_mode
CONNECT, START, STOP = 0, 1, 2  # requests whose numbers are the same in both versions
JOINT_POSITION, NO_GENERATOR, JOINT_IMPEDANCE, EXTERNAL = 0, 4, 0, 2
COMMUNICATION = 25  # the error's index


@dataclass(frozen=True)
class Layout:
    """Layout of the datagrams of one version."""

    state_size: int
    command_size: int
    number: str  # of the state's floats
    fields: dict[str, int]  # offsets
    errors: int
    reasons: int
    mode: int
    rate: int
    recovery: int  # the request's number
    reflex: int  # status of a motion that a reflex ended


LAYOUTS = {
    5: Layout(
        2373,
        370,
        "d",
        {"q": 1184, "q_d": 1240, "dq": 1296, "tau_ext": 1672},
        2282,
        2323,
        2364,
        2365,
        12,
        6,
    ),
    10: Layout(
        1377,
        371,
        "f",
        {"q": 596, "q_d": 624, "dq": 652, "tau_ext": 840},
        1290,
        1331,
        1372,
        1373,
        10,
        8,
    ),
}


class State:
    """One state datagram."""

    def __init__(self, version: int, data: bytes):
        self.layout, self.data = LAYOUTS[version], data

    @property
    def message_id(self) -> int:
        return struct.unpack_from("<Q", self.data)[0]

    @property
    def mode(self) -> int:
        return self.data[self.layout.mode]

    @property
    def rate(self) -> float:
        """control_command_success_rate."""
        return struct.unpack_from("<" + self.layout.number, self.data, self.layout.rate)[0]

    @property
    def errors(self) -> list[int]:
        return [i for i in range(41) if self.data[self.layout.errors + i]]

    @property
    def reasons(self) -> list[int]:
        """reflex_reason, the errors that ended the last motion."""
        return [i for i in range(41) if self.data[self.layout.reasons + i]]

    def joints(self, field: str) -> tuple[float, ...]:
        return struct.unpack_from("<7" + self.layout.number, self.data, self.layout.fields[field])


def command(version: int, message_id: int, q=(0.0,) * 7, finished=False) -> bytes:
    """A command datagram with joint positions, and torques of 0."""
    data = bytearray(LAYOUTS[version].command_size)
    struct.pack_into("<Q7d", data, 0, message_id, *q)
    data[313] = finished
    if version >= 7:
        data[370] = finished
    return bytes(data)


def move_request(version: int, controller: int, generator: int) -> bytes:
    payload = struct.pack("<II6d", controller, generator, *(10.0, 3.12, 6.3) * 2)
    return payload + (bytes(57) if version >= 10 else b"")


class Client:
    """One client."""

    def __init__(self, address: str, version: int, port: int = PORT):
        self.version, self.next_id, self.robot = version, 0, None
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.bind(("", 0))
        self.tcp = socket.create_connection((address, port), timeout=LIMIT)
        self.tcp.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.tcp.close()
        self.udp.close()

    def reset(self):
        """Ends the connection like a crashed program: with RST instead of FIN."""
        self.tcp.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.close()

    def request(self, number: int, payload: bytes = b"") -> int:
        """@returns the request's id"""
        identity, self.next_id = self.next_id, self.next_id + 1
        self.tcp.sendall(HEADER.pack(number, identity, HEADER.size + len(payload)) + payload)
        return identity

    def connect(self) -> tuple[int, int]:
        """@returns status and the robot's version."""
        self.request(CONNECT, struct.pack("<HH", self.version, self.udp.getsockname()[1]))
        _, reply = self.reply()
        return reply[0], struct.unpack_from("<H", reply, 1)[0]

    def reply(self, timeout: float = LIMIT) -> tuple[int, bytes]:
        """@returns the next reply's id and its payload. Raises EOFError if there is none."""
        self.tcp.settimeout(timeout)
        _, identity, size = HEADER.unpack(self._exactly(HEADER.size))
        return identity, self._exactly(size - HEADER.size)

    def _exactly(self, size: int) -> bytes:
        data = b""
        while len(data) < size:
            part = self.tcp.recv(size - len(data))
            if not part:
                raise EOFError("The robot has ended the connection.")
            data += part
        return data

    def ended(self, timeout: float = LIMIT) -> bool:
        """Whether the robot closes the connection within that time."""
        self.tcp.settimeout(timeout)
        try:
            return self.tcp.recv(1) == b""
        except ConnectionError:
            return True
        except TimeoutError:
            return False

    def state(self, timeout: float = LIMIT) -> State:
        """The oldest unread state."""
        if not select.select([self.udp], [], [], timeout)[0]:
            raise TimeoutError(f"The robot has sent no state for {timeout} s.")
        data, self.robot = self.udp.recvfrom(65536)
        return State(self.version, data)

    def newest_state(self) -> State:
        """The newest state; waits for one if there is none."""
        state = self.state()
        while select.select([self.udp], [], [], 0)[0]:
            state = self.state()
        return state

    def state_until(self, condition, most: int = 100000) -> State:
        for _ in range(most):
            state = self.state()
            if condition(state):
                return state
        raise AssertionError(f"None of {most} states was the awaited one; the last is in mode {state.mode}.")

    def send(self, datagram: bytes):
        self.udp.sendto(datagram, self.robot)

    def start(self, controller: int, generator: int) -> State:
        """Starts a motion. @returns the state to answer: as for all clients, the second that shows it."""
        self.request(START, move_request(self.version, controller, generator))
        _, reply = self.reply()
        assert reply[0] == 1, f"The motion was not started but answered with status {reply[0]}."
        self.state_until(lambda state: state.mode == MOVE)
        return self.state()

    def recover(self) -> State:
        """Automatic error recovery. @returns the first state in Idle."""
        self.request(LAYOUTS[self.version].recovery)
        _, reply = self.reply()
        assert reply[0] == 0, f"The recovery was answered with status {reply[0]}."
        return self.state_until(lambda state: state.mode == IDLE)


def connected(sim) -> Client:
    """A new client of a simulated robot."""
    client = Client(sim.address, sim.protocol)
    assert client.connect() == (0, sim.protocol)
    return client
