# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Users, their passwords and their logins."""

from __future__ import annotations

import base64
import hashlib
import hmac
import json
import re
import secrets
from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass

WHITE_SPACE = re.compile(r"\s+")


@dataclass(frozen=True)
class User:
    """digest: of the password, as digest_of() makes it."""

    name: str
    digest: str
    role: str = "Admin"


def digest_of(name: str, password: str) -> str:
    """The digest that clients send instead of a password: the numbers of a SHA-256 digest, in base64."""
    digest = hashlib.sha256(f"{password}#{name}@franka".encode(errors="surrogatepass")).digest()
    return base64.b64encode(",".join(map(str, digest)).encode()).decode()


class Users:
    """The users that may log in."""

    def __init__(self, name: str, password: str):
        self._users = {name: User(name, digest_of(name, password))}

    def __iter__(self) -> Iterator[User]:
        return iter(self._users.values())

    def get(self, name: str) -> User | None:
        """The user of that name."""
        return self._users.get(name)

    def replace(self, users: list[User]) -> None:
        """Sets all users."""
        self._users = {user.name: user for user in users}

    def by_digest(self, name: str, digest: str) -> User | None:
        """The user, if the digest is the password's; it may have line breaks. Takes the same time for every
        wrong one."""
        user, expected = self._users.get(name), digest_of(name, secrets.token_hex())
        if user:
            expected = user.digest
        sent = WHITE_SPACE.sub("", digest)
        equal = hmac.compare_digest(expected.encode(), sent.encode(errors="surrogatepass"))
        return user if equal and user else None

    def by_password(self, name: str, password: str) -> User | None:
        """The user, if the password is right."""
        return self.by_digest(name, digest_of(name, password))


class Sessions:
    """Logins: their tokens, which clients send as the cookie or header `authorization`."""

    def __init__(self, longest: int):
        self._longest = longest
        self._names: OrderedDict[bytes, str] = OrderedDict()  # by the digest of the token

    def __len__(self) -> int:
        return len(self._names)

    def open(self, name: str) -> str:
        """A new login's token: three parts like a JSON Web Token, of which the last one is the secret."""
        parts = [json.dumps(each).encode() for each in ({"alg": "none", "typ": "JWT"}, {"user": name})]
        parts.append(secrets.token_bytes(32))
        token = ".".join(base64.urlsafe_b64encode(part).decode().rstrip("=") for part in parts)
        self.add(token, name)
        return token

    def add(self, token: str, name: str) -> None:
        """Makes a token of another Desk valid here too."""
        self._names[_key(token)] = name
        while len(self._names) > self._longest:
            self._names.popitem(last=False)

    def name(self, token: str) -> str | None:
        """The name of the user with this login; None if there is none. Takes the same time for every wrong
        token: tokens are found by their digest."""
        return self._names.get(_key(token))

    def close(self, token: str) -> None:
        """Ends a login."""
        self._names.pop(_key(token), None)

    def close_of(self, name: str) -> None:
        """Ends all logins of a user."""
        self._names = OrderedDict(each for each in self._names.items() if each[1] != name)

    def clear(self) -> None:
        """Ends all logins."""
        self._names.clear()


def _key(token: str) -> bytes:
    return hashlib.sha256(token.encode(errors="surrogatepass")).digest()
