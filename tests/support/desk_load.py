# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sends requests to Desk at a steady rate from several connections; prints `begun`, and at the end how it
answered as JSON.

Arguments: address, port, requests a second, seconds, source addresses with commas.
"""

import asyncio
import contextlib
import json
import ssl
import sys
import time
from collections import Counter

CONNECTIONS = 10  # of each source address
PATHS = ("/admin/api/control-token", "/admin/api/startup-phase")


async def send_all(writer, host: str, due: float, period: float, end: float) -> int:
    """Requests of one connection, each at its time, whether or not the one before is answered."""
    number = 0
    while due < end:
        await asyncio.sleep(max(0.0, due - time.monotonic()))
        writer.write(f"GET {PATHS[number % len(PATHS)]} HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
        number += 1
        due += period
    return number


async def count_answers(reader, answers: Counter) -> None:
    """Reads answers until the connection ends."""
    with contextlib.suppress(asyncio.IncompleteReadError, ConnectionError):
        while True:
            head = (await reader.readuntil(b"\r\n\r\n")).decode()
            length = next(line for line in head.splitlines() if line.lower().startswith("content-length:"))
            await reader.readexactly(int(length.split(":")[1]))
            answers[head.split()[1]] += 1


async def load_from(place, source: str, due: float, period: float, end: float, answers: Counter) -> int:
    """@returns how many requests one connection has sent."""
    context = ssl._create_unverified_context()  # noqa: S323 - it measures, it does not trust
    reader, writer = await asyncio.open_connection(*place, ssl=context, local_addr=(source, 0))
    reading = asyncio.get_running_loop().create_task(count_answers(reader, answers))
    sent = await send_all(writer, place[0], due, period, end)
    writer.transport.abort()
    await reading
    return sent


async def load(address: str, port: int, rate: float, seconds: float, sources: list[str]) -> dict:
    answers: Counter = Counter()
    places = [(source, number) for source in sources for number in range(CONNECTIONS)]
    period, begin = len(places) / rate, time.monotonic() + 0.5  # to open the connections
    senders = [
        load_from((address, port), source, begin + index / rate, period, begin + seconds, answers)
        for index, (source, _) in enumerate(places)
    ]
    all_senders = asyncio.gather(*senders)
    await asyncio.sleep(max(0.0, begin - time.monotonic()))
    print("begun", flush=True)
    sent = sum(await all_senders)
    return {"sent a second": sent / seconds, "took": time.monotonic() - begin, "answers": answers}


def main() -> None:
    address, port, rate, seconds, sources = sys.argv[1:]
    print(json.dumps(asyncio.run(load(address, int(port), float(rate), float(seconds), sources.split(",")))))


main()
