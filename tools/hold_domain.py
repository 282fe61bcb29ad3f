#!/usr/bin/python3
"""Holds a private DDS domain, as goshawk::runtime::hold_private_domain() does: prints its number and
gives it back when standard input is closed or this process ends.

    coproc HOLDER { exec tools/hold_domain.py; }; read -r ROS_DOMAIN_ID <&"${HOLDER[0]}"
"""

import os
import socket
import sys

FIRST, MANY = 20, 80


def hold(domain):
    """A socket that holds the domain while it is open, or None."""
    probe = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    held = socket.socket(socket.AF_UNIX)
    try:
        probe.bind(("", 7400 + 250 * domain + 10))  # a DDS program is in it if this is taken
        held.bind(f"\0goshawk-domain-{domain}")
        return held
    except OSError:
        held.close()
        return None
    finally:
        probe.close()


def hold_private_domain():
    """A domain that nobody else uses, and the socket that holds it."""
    for k in range(MANY):
        domain = FIRST + (os.getpid() * 7 + k) % MANY
        if held := hold(domain):
            return domain, held
    raise RuntimeError(f"no DDS domain from {FIRST} to {FIRST + MANY - 1} is free")


def main():
    try:
        domain, _held = hold_private_domain()
    except RuntimeError as error:
        sys.exit(str(error))
    print(domain, flush=True)
    sys.stdin.read()


if __name__ == "__main__":
    main()
