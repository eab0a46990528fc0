# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The certificate of Desk: signed by itself, for one address, kept in the user's cache folder."""

from __future__ import annotations

import datetime
import ipaddress
import os
import ssl
import tempfile
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

ROBOT_NAME = "robot.franka.de"  # clients send it as the server's name
DAYS, LEFT = 825, 30  # [days] of validity; a certificate with fewer days left is replaced (chosen here)


def tls_context(address: str, folder: Path | None = None) -> ssl.SSLContext:
    """A context for servers at that address. folder: where key and certificate are kept; None: in the user's
    cache folder, or only in memory if that cannot be written."""
    folder = folder or cache_folder()
    path = folder / f"{address.replace(':', '_')}.pem"
    if not _is_valid(path):
        try:
            _write(path, make_pem(address))
        except OSError:
            return _context_of(make_pem(address))
    return _context(path)


def cache_folder() -> Path:
    """The folder of the certificates."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / "franka_desk"


def make_pem(address: str) -> bytes:
    """A new key and its certificate, for the address and the server's name that clients send."""
    key = ec.generate_private_key(ec.SECP256R1())
    now = datetime.datetime.now(datetime.UTC)
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, ROBOT_NAME)])
    names: list[x509.GeneralName] = [x509.DNSName(ROBOT_NAME), x509.DNSName("localhost")]
    try:
        names.append(x509.IPAddress(ipaddress.ip_address(address)))
    except ValueError:
        names.append(x509.DNSName(address))
    usage = x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH])
    identifier = x509.SubjectKeyIdentifier.from_public_key(key.public_key())
    certificate = (
        x509.CertificateBuilder(name, name, key.public_key(), x509.random_serial_number())
        .not_valid_before(now - datetime.timedelta(days=1))
        .not_valid_after(now + datetime.timedelta(days=DAYS))
        .add_extension(x509.SubjectAlternativeName(names), critical=False)
        # Clients that check it take it for its own authority.
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_key_usage(), critical=True)
        .add_extension(usage, critical=False)
        # Strict clients (Python 3.13) require both.
        .add_extension(identifier, critical=False)
        .add_extension(
            x509.AuthorityKeyIdentifier.from_issuer_subject_key_identifier(identifier), critical=False
        )
        .sign(key, hashes.SHA256())
    )
    private = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    return private + certificate.public_bytes(serialization.Encoding.PEM)


def _key_usage() -> x509.KeyUsage:
    names = ("digital_signature", "key_cert_sign")
    others = ["content_commitment", "key_encipherment", "data_encipherment", "key_agreement"]
    others += ["crl_sign", "encipher_only", "decipher_only"]
    return x509.KeyUsage(**dict.fromkeys(names, True), **dict.fromkeys(others, False))


def _is_valid(path: Path) -> bool:
    try:
        certificate = x509.load_pem_x509_certificate(
            path.read_bytes().partition(b"-----END PRIVATE KEY-----\n")[2]
        )
    except (OSError, ValueError):
        return False
    if hasattr(certificate, "not_valid_after_utc"):  # from cryptography 42 on
        end: datetime.datetime = certificate.not_valid_after_utc
    else:
        end = certificate.not_valid_after.replace(tzinfo=datetime.UTC)
    return end - datetime.datetime.now(datetime.UTC) > datetime.timedelta(days=LEFT)


def _write(path: Path, pem: bytes) -> None:
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent)  # readable by this user only
    with os.fdopen(handle, "wb") as file:
        file.write(pem)
    os.replace(name, path)


def _context_of(pem: bytes) -> ssl.SSLContext:
    with tempfile.NamedTemporaryFile() as file:
        file.write(pem)
        file.flush()
        return _context(Path(file.name))


def _context(path: Path) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(path)
    # A client with one thread that reads and one that writes (Python's websockets, so panda-python) can lose
    # the answer to its first request while it reads tickets: 6 of 2400 times, and never without tickets.
    context.num_tickets = 0
    return context
