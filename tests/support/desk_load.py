# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sends requests to Desk at a steady rate from several connections; prints how it answered as JSON.

Arguments: address, port, requests a second, seconds, source addresses with commas.
"""

import asyncio
import json
import ssl
import sys
import time
from collections import Counter

CONNECTIONS = 10  # of each source address
PATHS = ("/admin/api/control-token", "/admin/api/startup-phase")


async def send_all(place, source: str, period: float, end: float, answers: Counter) -> None:
    """Requests of one connection, each at its time; the next one waits for the answer."""
    context = ssl._create_unverified_context()  # noqa: S323 - it measures, it does not trust
    reader, writer = await asyncio.open_connection(*place, ssl=context, local_addr=(source, 0))
    due, number = time.monotonic(), 0
    while (due := max(due + period, time.monotonic() - 1.0)) < end:
        await asyncio.sleep(max(0.0, due - time.monotonic()))
        path = PATHS[number % len(PATHS)]
        number += 1
        writer.write(f"GET {path} HTTP/1.1\r\nHost: {place[0]}\r\n\r\n".encode())
        head = (await reader.readuntil(b"\r\n\r\n")).decode()
        length = next(line for line in head.splitlines() if line.lower().startswith("content-length:"))
        await reader.readexactly(int(length.split(":")[1]))
        answers[head.split()[1]] += 1
    writer.close()


async def load(address: str, port: int, rate: float, seconds: float, sources: list[str]) -> dict:
    answers: Counter = Counter()
    begin = time.monotonic()
    period = CONNECTIONS * len(sources) / rate
    senders = [
        send_all((address, port), source, period, begin + seconds, answers)
        for source in sources
        for _ in range(CONNECTIONS)
    ]
    await asyncio.gather(*senders)
    return {"answers": answers, "requests a second": sum(answers.values()) / (time.monotonic() - begin)}


def main() -> None:
    address, port, rate, seconds, sources = sys.argv[1:]
    print(json.dumps(asyncio.run(load(address, int(port), float(rate), float(seconds), sources.split(",")))))


main()
