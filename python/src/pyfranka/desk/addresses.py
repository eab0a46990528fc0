# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Addresses of clients and of servers."""

from __future__ import annotations

import ipaddress
import typing

if typing.TYPE_CHECKING:  # the program's --help does not need aiohttp
    from aiohttp import web

PREFIX = 64  # [bits] of an IPv6 address: its owner has all addresses with this prefix


def address_of(request: web.Request) -> str:
    """The client's address for limits, see network_of()."""
    return network_of(request.transport.get_extra_info("peername") if request.transport else None)


def network_of(peer: typing.Any) -> str:
    """What limits count as one address: an IPv4 address, or the network of an IPv6 address. peer: of a
    transport, or None."""
    if not peer:
        return "unknown"
    try:
        address = ipaddress.ip_address(str(peer[0]))
    except ValueError:
        return str(peer[0])
    if isinstance(address, ipaddress.IPv4Address):
        return str(address)
    if address.ipv4_mapped is not None:
        return str(address.ipv4_mapped)
    return str(ipaddress.ip_network((int(address), PREFIX), strict=False))


def url_of(address: str, port: int) -> str:
    """The URL of a server."""
    host = f"[{address.replace('%', '%25')}]" if ":" in address else address
    return f"https://{host}:{port}"


def place_of(word: str, port: int) -> tuple[str, int]:
    """Address and port of a word ADDRESS, ADDRESS:PORT, IPV6, [IPV6] or [IPV6]:PORT. port: if the word has
    none. Raises ValueError with a sentence."""
    if word.startswith("["):
        address, bracket, rest = word[1:].partition("]")
        colon, number = rest[:1], rest[1:]
        valid = bool(bracket) and ":" in address and colon in ("", ":")
    elif word.count(":") > 1:
        address, colon, number, valid = word, "", "", True
    else:
        address, colon, number = word.partition(":")
        valid = True
    if colon and not (number.isascii() and number.isdigit() and len(number) <= 5 and int(number) < 65536):
        valid = False
    if not valid or not address:
        raise ValueError(f"'{word}' is not an ADDRESS:PORT; IPv6 addresses are in brackets: [::1]:8443.")
    return address, int(number) if colon else port
