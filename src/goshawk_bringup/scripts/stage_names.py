"""Names that one launch at a time may use on this machine: a node's name in a DDS domain.

Each is an abstract socket: it needs no file, belongs to a network namespace as loopback does, and
is free again when the last process that has it ends, however it ends.
"""

import errno
import fcntl
import hashlib
import json
import os
import socket
import struct

FIRST_DESCRIPTOR = 100  # above those that supervisord closes (its minfds)


class InUse(Exception):
    """A name that another launch has, and by which process."""


class StageNames:
    def __init__(self, domain, nodes):
        """@param nodes full names. Raises InUse for the first one that is taken"""
        self.sockets = []
        try:
            for node in nodes:
                self.sockets.append(claim(address_of(domain, node), domain, node))
        except BaseException:
            self.close()
            raise

    def close(self):
        for held in self.sockets:
            held.close()

    def descriptors(self):
        """For the children: a name is taken for as long as any of them lives."""
        return [s.fileno() for s in self.sockets]


def address_of(domain, node):
    """An abstract address; it has room for 107 bytes."""
    name = f"{domain}{node}".encode()
    return b"\0goshawk/stage/" + (name if len(name) < 90 else hashlib.sha256(name).hexdigest().encode())


def claim(name, domain, node):
    held = socket.socket(socket.AF_UNIX)
    try:
        held.bind(name)
    except OSError as error:
        held.close()
        if error.errno != errno.EADDRINUSE:
            raise
        raise InUse(f"{node} in domain {domain} is already started by {holder(name)}: stop that "
                    "one, or choose another ROS_DOMAIN_ID or namespace") from error
    held.listen(1000)  # who asks for the holder stays in the queue
    high = fcntl.fcntl(held.fileno(), fcntl.F_DUPFD_CLOEXEC, FIRST_DESCRIPTOR)
    held.close()
    return socket.socket(fileno=high)


def holder(name):
    """Who holds a name, in words."""
    with socket.socket(socket.AF_UNIX) as asking:
        asking.setblocking(False)
        try:
            asking.connect(name)
        except BlockingIOError:
            return "another launch"
        except OSError:
            return "a launch that has just ended"
        pid, _, _ = struct.unpack("3i", asking.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED,
                                                          struct.calcsize("3i")))
    command = command_of(pid)
    if command is None:
        return f"process {pid}, which has ended, but not all that it started"
    return f"process {pid} ({command})"


def command_of(pid):
    try:
        with open(f"/proc/{pid}/cmdline", encoding="utf-8", errors="replace") as file:
            words = file.read().rstrip("\0").split("\0")
    except OSError:
        return None
    try:
        return f"goshawk launch {json.loads(words[-1])['file']}"
    except (ValueError, KeyError, TypeError):
        return os.path.basename(words[0])
