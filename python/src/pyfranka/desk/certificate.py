# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The certificate of Desk: signed by itself, for one address, kept in the user's cache folder."""

from __future__ import annotations

import contextlib
import datetime
import ipaddress
import logging
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
log = logging.getLogger("franka_desk")


def tls_context(address: str, folder: Path | None = None) -> ssl.SSLContext:
    """A context for servers at that address. folder: where key and certificate are kept; None: in the user's
    cache folder, or only in memory if that cannot be written. Kept ones that cannot be used are replaced,
    with one warning."""
    path = (folder or cache_folder()) / f"{address.replace(':', '_')}.pem"
    try:
        return _kept_context(path)
    except (FileNotFoundError, NotADirectoryError):
        pass
    except Exception as error:  # whatever reads a damaged file may raise anything
        log.warning(
            "The certificate %s cannot be used (%s). Desk makes a new one: clients that trust the old one "
            "need the new one.",
            path,
            str(error) or type(error).__name__,
        )
    pem = make_pem(address)
    with contextlib.suppress(OSError):
        _write(path, pem)
    return _context_of(pem)


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
        # A client that trusts it trusts this server only: it cannot sign certificates of other servers.
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
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
    others = ["content_commitment", "key_encipherment", "data_encipherment", "key_agreement"]
    others += ["key_cert_sign", "crl_sign", "encipher_only", "decipher_only"]
    return x509.KeyUsage(digital_signature=True, **dict.fromkeys(others, False))


# Raises an exception if key or certificate cannot be used.
def _kept_context(path: Path) -> ssl.SSLContext:
    pem = path.read_bytes()
    certificate = x509.load_pem_x509_certificate(pem.partition(b"-----END PRIVATE KEY-----\n")[2])
    key = certificate.public_key()
    if not isinstance(key, ec.EllipticCurvePublicKey):
        raise ValueError("its key is of another kind")
    key.verify(certificate.signature, certificate.tbs_certificate_bytes, ec.ECDSA(hashes.SHA256()))
    if certificate.extensions.get_extension_for_class(x509.BasicConstraints).value.ca:
        raise ValueError("it could sign other certificates, as earlier versions made it")
    if hasattr(certificate, "not_valid_after_utc"):  # from cryptography 42 on
        end: datetime.datetime = certificate.not_valid_after_utc
    else:
        end = certificate.not_valid_after.replace(tzinfo=datetime.UTC)
    if end - datetime.datetime.now(datetime.UTC) <= datetime.timedelta(days=LEFT):
        raise ValueError(f"it is valid until {end:%Y-%m-%d} only")
    return _context_of(pem)


def _write(path: Path, pem: bytes) -> None:
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent)  # readable by this user only
    with os.fdopen(handle, "wb") as file:
        file.write(pem)
    os.replace(name, path)


def _context_of(pem: bytes) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    with tempfile.NamedTemporaryFile() as file:  # load_cert_chain reads files only
        file.write(pem)
        file.flush()
        # Without a password OpenSSL would ask for that of an encrypted key at the terminal.
        context.load_cert_chain(file.name, password="")
    # A client with one thread that reads and one that writes (Python's websockets, so panda-python) can lose
    # the answer to its first request while it reads tickets: 6 of 2400 times, and never without tickets.
    context.num_tickets = 0
    return context
