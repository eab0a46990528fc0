# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sends requests to Desk at a steady rate from several connections; prints `begun` when all are open.

Arguments: address, port, requests a second, seconds, source addresses with commas.
"""

import asyncio
import ssl
import sys

CONNECTIONS = 10  # of each source address
PATHS = ("/admin/api/control-token", "/admin/api/startup-phase")


async def read_answers(reader) -> None:
    """Reads answers until the connection ends."""
    while await reader.read(65536):
        pass


async def connect(address: str, port: int, source: str):
    """@returns a connection's writer, and the task that reads its answers."""
    context = ssl._create_unverified_context()  # noqa: S323 - it makes load, it does not trust
    reader, writer = await asyncio.open_connection(address, port, ssl=context, local_addr=(source, 0))
    return writer, asyncio.get_running_loop().create_task(read_answers(reader))


async def load(address: str, port: int, rate: float, seconds: float, sources: list[str]) -> None:
    opening = [connect(address, port, source) for source in sources for _ in range(CONNECTIONS)]
    connections = await asyncio.gather(*opening)
    print("begun", flush=True)
    loop = asyncio.get_running_loop()
    begin = loop.time()
    for number in range(int(rate * seconds)):
        writer, reading = connections[number % len(connections)]
        path = PATHS[number // len(connections) % len(PATHS)]
        writer.write(f"GET {path} HTTP/1.1\r\nHost: {address}\r\n\r\n".encode())
        ended, _ = await asyncio.wait([reading], timeout=max(0.0, begin + number / rate - loop.time()))
        if ended:
            sys.exit("Desk has ended a connection.")


def main() -> None:
    address, port, rate, seconds, sources = sys.argv[1:]
    asyncio.run(load(address, int(port), float(rate), float(seconds), sources.split(",")))


main()
