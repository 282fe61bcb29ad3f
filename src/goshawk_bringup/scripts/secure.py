#!/usr/bin/python3
"""goshawk secure init: an authority, and a certificate with signed permissions for each stage.

Its one argument is a JSON object of options, which goshawk_cli writes (verbs/secure.cpp).
"""

import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import secure_files
import topic_rights
from launch_file import NAME

DONE, NOT_DONE, WRONG_CALL = 0, 1, 2


class Failure(Exception):
    def __init__(self, code, message, status):
        super().__init__(message)
        self.code, self.status = code, status


def wrong(message):
    return Failure("invalid_parameter", message, WRONG_CALL)


def openssl(*arguments):
    try:
        done = subprocess.run(["openssl", *map(str, arguments)], text=True, capture_output=True,
                              stdin=subprocess.DEVNULL)
    except FileNotFoundError:
        raise Failure("io_failed", "there is no openssl: install it (tools/setup does)",
                      NOT_DONE) from None
    if done.returncode != 0:
        raise Failure("io_failed", f"openssl {arguments[0]} failed: {done.stderr.strip()}", NOT_DONE)


def asn1_time(moment):
    return moment.strftime("%Y%m%d%H%M%SZ")


def make_key(path):
    openssl("ecparam", "-name", "prime256v1", "-genkey", "-noout", "-out", path)
    path.chmod(0o600)


class Authority:
    """Signs certificates and documents. Its key makes members of the domain.

    @param begin, end when all of them are valid, UTC"""

    def __init__(self, folder, begin, end):
        self.folder, self.begin, self.end = folder, begin, end
        self.certificate, self.key = folder / "ca.pem", folder / "ca_key.pem"

    def found(self):
        self.folder.mkdir(mode=0o700)
        make_key(self.key)
        self.issue("authority", self.key, self.certificate, "-selfsign", "-extensions", "authority")
        self.sign(secure_files.governance(), self.folder / "governance.smime")

    def sign(self, text, path):
        plain = path.with_suffix(".xml")
        plain.write_text(text, encoding="utf-8")
        openssl("smime", "-sign", "-in", plain, "-text", "-out", path, "-signer", self.certificate,
                "-inkey", self.key)

    def certify(self, name, folder):
        make_key(folder / "key.pem")
        self.issue(name, folder / "key.pem", folder / "certificate.pem", "-cert", self.certificate)

    def issue(self, name, key, certificate, *options):
        """Of openssl's commands only `ca` lets a certificate begin before now, and it needs files."""
        with tempfile.TemporaryDirectory(dir=self.folder) as work:
            request, configuration = (pathlib.Path(work) / f for f in ("request", "configuration"))
            (pathlib.Path(work) / "database").touch()
            configuration.write_text(secure_files.authority_configuration(work), encoding="utf-8")
            openssl("req", "-new", "-key", key, "-subj", f"/O=Goshawk/CN={name}", "-out", request)
            openssl("ca", "-batch", "-notext", "-config", configuration, "-in", request,
                    "-keyfile", self.key, "-startdate", asn1_time(self.begin), "-enddate",
                    asn1_time(self.end), "-out", certificate, *options)


def members(like):
    """name: rights, of all roles and of the user's own programs, "NAME=ROLE"."""
    table = topic_rights.roles()
    for pair in like:
        name, _, role = pair.partition("=")
        if role not in table or not NAME.fullmatch(name) or name in table:
            raise wrong(f"--like {pair}: write NAME=ROLE, with a new name and one of "
                        f"{', '.join(topic_rights.roles())}")
        table[name] = table[role]
    return table


def init(options):
    folder = pathlib.Path(options["folder"]).absolute()
    namespace = "/" + options["namespace"].strip("/")
    if "//" in namespace or not all(NAME.fullmatch(p) for p in namespace.split("/") if p):
        raise wrong(f"namespace '{options['namespace']}' is not one of letters, digits, '_', '.' and "
                    "'-'")
    table = members(options["like"])
    if folder.exists() and any(folder.iterdir()):
        raise wrong(f"{folder} is not empty: keys are never overwritten; name another folder, or "
                    "remove this one")
    folder.mkdir(parents=True, exist_ok=True)
    now = datetime.datetime.now(datetime.timezone.utc).replace(microsecond=0, tzinfo=None)
    begin = now - datetime.timedelta(days=1)  # the clocks of other machines may be behind
    end = now + datetime.timedelta(days=options["days"])
    authority = Authority(folder / "authority", begin, end)
    authority.found()
    for name, (reads, writes) in table.items():
        own = folder / name
        own.mkdir(mode=0o700)
        authority.certify(name, own)
        authority.sign(secure_files.permissions(name, reads, writes, namespace, begin.isoformat(),
                                                end.isoformat()), own / "permissions.smime")
        (own / "profile.xml").write_text(secure_files.profile(own, authority.folder),
                                         encoding="utf-8")
    return folder, list(table)


def main():
    options = json.loads(sys.argv[1])
    try:
        folder, names = init(options)
    except (Failure, OSError) as fault:
        code = getattr(fault, "code", "io_failed")
        if options["json"]:
            print(json.dumps({"ok": False, "code": code, "message": str(fault)}))
        else:
            print(f"goshawk secure init: {code}: {fault}", file=sys.stderr)
        return getattr(fault, "status", NOT_DONE)
    if options["json"]:
        print(json.dumps({"ok": True, "code": "ok", "folder": str(folder), "members": names}))
    else:
        print(f"{folder} has an authority and certificates of {', '.join(names)}.\n"
              f"Fly with them:  goshawk launch flight --secure {folder}\n"
              f"Your own shell: export FASTRTPS_DEFAULT_PROFILES_FILE={folder}/operator/profile.xml\n"
              f"Take {folder}/authority/ca_key.pem off the vehicle: this key makes members of the domain.")
    return DONE


if __name__ == "__main__":
    os.umask(0o077)
    sys.exit(main())
