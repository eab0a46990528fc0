# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The certificate of Desk: what it permits, where it is kept, and what happens to one that is damaged."""

import contextlib
import datetime
import os
import socket
import ssl
import subprocess
import sys

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID
from desk_fixtures import desk_with_robot
from pyfranka.desk.certificate import make_pem, tls_context

ADDRESS = "127.0.0.1"
PARTING = b"-----END PRIVATE KEY-----\n"
DEADLINE = 60.0  # [s]


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "cache"


@pytest.fixture
def path(folder):
    """Of a certificate that Desk has made."""
    tls_context(ADDRESS, folder)
    return folder / f"{ADDRESS}.pem"


@pytest.fixture(scope="module")
def trusted(tmp_path_factory):
    """A running Desk, and a file with its certificate, which clients trust."""
    folder = tmp_path_factory.mktemp("certificates")
    with desk_with_robot(folder) as (_, desk):
        file = folder / "desk.pem"
        file.write_text(ssl.get_server_certificate((ADDRESS, desk.port)))
        yield desk, file


def certificate_of(pem):
    return x509.load_pem_x509_certificate(pem.partition(PARTING)[2])


def extension(certificate, kind):
    return certificate.extensions.get_extension_for_class(kind)


# ---- what it permits -------------------------------------------------------------------------------------


def test_certificate_is_that_of_a_server_and_cannot_sign_others():
    certificate = certificate_of(make_pem(ADDRESS))
    constraints = extension(certificate, x509.BasicConstraints)
    assert constraints.critical and not constraints.value.ca
    usage = extension(certificate, x509.KeyUsage)
    assert usage.critical and usage.value.digital_signature and not usage.value.key_cert_sign
    purposes = extension(certificate, x509.ExtendedKeyUsage).value
    assert list(purposes) == [ExtendedKeyUsageOID.SERVER_AUTH]


def server_certificate(signer, name):
    """Key and certificate of a server of that name, signed with the key of another one, whose certificate
    follows."""
    authority = serialization.load_pem_private_key(signer.partition(PARTING)[0] + PARTING, None)
    key, now = ec.generate_private_key(ec.SECP256R1()), datetime.datetime.now(datetime.UTC)
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])
    certificate = (
        x509.CertificateBuilder(certificate_of(signer).subject, subject, key.public_key(), 1)
        .not_valid_before(now - datetime.timedelta(days=1))
        .not_valid_after(now + datetime.timedelta(days=1))
        .add_extension(x509.SubjectAlternativeName([x509.DNSName(name)]), critical=False)
        .sign(authority, hashes.SHA256())
    )
    coding = serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    own = key.private_bytes(*coding) + certificate.public_bytes(serialization.Encoding.PEM)
    return own + signer.partition(PARTING)[2]


def test_client_that_trusts_it_refuses_a_server_whose_certificate_its_key_has_signed(tmp_path):
    signer = make_pem(ADDRESS)
    (tmp_path / "trusted.pem").write_bytes(signer.partition(PARTING)[2])
    (tmp_path / "server.pem").write_bytes(server_certificate(signer, "bank.example"))
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(tmp_path / "server.pem")
    client = ssl.create_default_context(cafile=str(tmp_path / "trusted.pem"))
    with pytest.raises(ssl.SSLCertVerificationError):
        shake_hands(context, client, "bank.example")


def shake_hands(server, client, name):
    """The handshake of two contexts in memory. Raises ssl.SSLError."""
    one, other = ssl.MemoryBIO(), ssl.MemoryBIO()
    ends = [
        client.wrap_bio(one, other, server_hostname=name),
        server.wrap_bio(other, one, server_side=True),
    ]
    for _ in range(10):
        for end in ends:
            with contextlib.suppress(ssl.SSLWantReadError):
                end.do_handshake()
    assert ends[0].version()


@pytest.mark.parametrize("strict", [False, True])
@pytest.mark.parametrize("partial", [False, True])
def test_clients_of_python_trust_it_for_its_names_only(trusted, strict, partial):
    desk, file = trusted
    context = ssl.create_default_context(cafile=str(file))
    # Both as from Python 3.13 on.
    flags = (ssl.VERIFY_X509_STRICT if strict else 0) | (ssl.VERIFY_X509_PARTIAL_CHAIN if partial else 0)
    context.verify_flags |= flags
    for name in ("robot.franka.de", "localhost", ADDRESS):
        with socket.create_connection((ADDRESS, desk.port)) as plain:
            with context.wrap_socket(plain, server_hostname=name) as secure:
                assert secure.version() in ("TLSv1.2", "TLSv1.3")
    with socket.create_connection((ADDRESS, desk.port)) as plain:
        with pytest.raises(ssl.SSLCertVerificationError):
            context.wrap_socket(plain, server_hostname="evil.example")


REQUEST = "import sys, {module}; print({module}.{call}(sys.argv[1]).{status})"


@pytest.mark.parametrize(
    "command",
    [
        ["openssl", "s_client", "-verify_return_error", "-x509_strict", "-brief", "-connect", "{place}"]
        + ["-CAfile", "{file}", "-verify_ip", ADDRESS],
        [sys.executable, "-c", REQUEST.format(module="urllib.request", call="urlopen", status="status")],
        [sys.executable, "-c", REQUEST.format(module="requests", call="get", status="status_code")],
    ],
    ids=["openssl", "urllib", "requests"],
)
def test_other_clients_trust_it_as_a_file(trusted, command):
    desk, file = trusted
    place = f"{ADDRESS}:{desk.port}"
    url = f"https://{place}/admin/api/startup-phase"
    words = [word.format(place=place, file=file, url=url) for word in command]
    if command[0] == sys.executable:
        words.append(url)
    environment = {**os.environ, "SSL_CERT_FILE": str(file), "REQUESTS_CA_BUNDLE": str(file)}
    options = {"input": "", "capture_output": True, "text": True, "env": environment, "timeout": DEADLINE}
    result = subprocess.run(words, **options)
    assert result.returncode == 0, result.stderr
    assert command[0] != sys.executable or result.stdout == "200\n"


# ---- where it is kept ------------------------------------------------------------------------------------


def test_it_is_kept_where_only_its_user_can_read_it(path, folder, caplog):
    assert path.stat().st_mode & 0o077 == 0 and folder.stat().st_mode & 0o077 == 0
    first = path.read_bytes()
    tls_context(ADDRESS, folder)
    assert path.read_bytes() == first
    assert os.listdir(folder) == [path.name] and not caplog.records


def test_it_is_in_memory_where_it_cannot_be_kept(tmp_path, caplog):
    (tmp_path / "file").write_text("")
    tls_context(ADDRESS, tmp_path / "file" / "below")
    assert not caplog.records


def old_pem(ca=True, days=400):
    """As earlier versions made it (ca), or one that is valid for so many days."""
    key, now = ec.generate_private_key(ec.SECP256R1()), datetime.datetime.now(datetime.UTC)
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "robot.franka.de")])
    certificate = (
        x509.CertificateBuilder(name, name, key.public_key(), 1)
        .not_valid_before(now - datetime.timedelta(days=400))
        .not_valid_after(now + datetime.timedelta(days=days))
        .add_extension(x509.BasicConstraints(ca=ca, path_length=0 if ca else None), critical=True)
        .sign(key, hashes.SHA256())
    )
    coding = serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    return key.private_bytes(*coding) + certificate.public_bytes(serialization.Encoding.PEM)


def with_other_key(pem):
    return make_pem(ADDRESS).partition(PARTING)[0] + PARTING + pem.partition(PARTING)[2]


def with_encrypted_key(pem):
    key = serialization.load_pem_private_key(pem.partition(PARTING)[0] + PARTING, None)
    coding = serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8
    hidden = key.private_bytes(*coding, serialization.BestAvailableEncryption(b"secret"))
    return hidden + pem.partition(PARTING)[2]


def with_changed_signature(pem):
    """One character of the last line."""
    head, last, end = pem.rstrip(b"\n").rsplit(b"\n", 2)
    return b"\n".join([head, (b"B" if last[:1] == b"A" else b"A") + last[1:], end, b""])


UNUSABLE = {
    "empty": lambda pem: b"",
    "nothing": lambda pem: b"nothing",
    "damaged key": lambda pem: pem.replace(b"\nM", b"\n!", 1),
    "short key": lambda pem: pem[:60] + pem[90:],
    "no key": lambda pem: pem.partition(PARTING)[2],
    "other key": with_other_key,
    "encrypted key": with_encrypted_key,
    "no certificate": lambda pem: pem.partition(PARTING)[0] + PARTING,
    "half a certificate": lambda pem: pem[:-300],
    "changed signature": with_changed_signature,
    "zeros": lambda pem: b"\0" * len(pem),
    "authority": lambda pem: old_pem(),
    "nearly expired": lambda pem: old_pem(ca=False, days=10),
}


@pytest.mark.parametrize("change", UNUSABLE.values(), ids=UNUSABLE)
def test_unusable_certificate_is_replaced_with_one_warning(path, folder, caplog, change):
    path.write_bytes(change(path.read_bytes()))
    unusable = path.read_bytes()
    tls_context(ADDRESS, folder)
    (record,) = caplog.records
    assert str(path) in record.getMessage() and record.exc_info is None
    assert path.read_bytes() != unusable
    caplog.clear()
    kept = path.read_bytes()
    tls_context(ADDRESS, folder)
    assert path.read_bytes() == kept and not caplog.records


def test_folder_in_its_place_is_a_warning(folder, caplog):
    (folder / f"{ADDRESS}.pem").mkdir(parents=True)
    tls_context(ADDRESS, folder)
    assert len(caplog.records) == 1
