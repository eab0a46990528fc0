# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The certificate of Desk: what it permits, where it is kept, and what happens to one that is damaged."""

import datetime
import os
import socket
import ssl

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID
from pyfranka.desk.certificate import make_pem, tls_context
from scripted_desk import desk_with_robot

ADDRESS = "127.0.0.1"
PARTING = b"-----END PRIVATE KEY-----\n"
CODING = serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8
NEWER_PYTHON = ssl.VERIFY_X509_STRICT | ssl.VERIFY_X509_PARTIAL_CHAIN  # from 3.13 on


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


@pytest.mark.parametrize("flags", [0, ssl.VERIFY_X509_STRICT, ssl.VERIFY_X509_PARTIAL_CHAIN, NEWER_PYTHON])
def test_clients_that_have_it_as_their_trusted_file_trust_it_for_its_names_only(trusted, flags, monkeypatch):
    desk, file = trusted
    monkeypatch.setenv("SSL_CERT_FILE", str(file))
    context = ssl.create_default_context()
    context.verify_flags |= flags

    def connect(name):
        with socket.create_connection((ADDRESS, desk.port)) as plain:
            with context.wrap_socket(plain, server_hostname=name) as secure:
                return secure.version()

    for name in ("robot.franka.de", "localhost", ADDRESS):
        assert connect(name) in ("TLSv1.2", "TLSv1.3")
    with pytest.raises(ssl.SSLCertVerificationError):
        connect("evil.example")


# ---- where it is kept ------------------------------------------------------------------------------------


def test_it_is_kept_where_only_its_user_can_read_it(path, folder, caplog):
    assert path.stat().st_mode & 0o077 == 0 and folder.stat().st_mode & 0o077 == 0
    first = path.read_bytes()
    assert tls_context(ADDRESS, folder).num_tickets == 0  # which some clients lose answers by
    assert path.read_bytes() == first
    assert os.listdir(folder) == [path.name] and not caplog.records


def test_folders_above_it_are_made(tmp_path, caplog):
    folder = tmp_path / "cache" / "below"
    tls_context(ADDRESS, folder)
    assert os.listdir(folder) == [f"{ADDRESS}.pem"] and not caplog.records


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
    return key.private_bytes(*CODING, serialization.NoEncryption()) + certificate.public_bytes(CODING[0])


def with_other_key(pem):
    return make_pem(ADDRESS).partition(PARTING)[0] + PARTING + pem.partition(PARTING)[2]


def with_encrypted_key(pem):
    key = serialization.load_pem_private_key(pem.partition(PARTING)[0] + PARTING, None)
    hidden = key.private_bytes(*CODING, serialization.BestAvailableEncryption(b"secret"))
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
