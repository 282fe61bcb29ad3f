"""The switches of a stage's shim (faults/control.hpp): its wall clock, and datagrams that are lost."""

import mmap
import os
import pathlib
import struct

# wall_offset_ns, receive_loss_ppm, send_loss_ppm, seed, drawn, lost
LAYOUT = struct.Struct("=qIIQQQ")
WALL_OFFSET_AT, LOSS_AT, LOST_AT = 0, 8, 32


class FaultControl:
    """One stage's file, which is mapped as long as this lives."""

    def __init__(self, folder, stage, seed=1):
        path = pathlib.Path(folder) / stage
        path.write_bytes(LAYOUT.pack(0, 0, 0, seed & 0xffffffffffffffff, 0, 0))
        with open(path, "r+b") as file:
            self.memory = mmap.mmap(file.fileno(), LAYOUT.size)

    def step_clock(self, by_s):
        offset = struct.unpack_from("=q", self.memory, WALL_OFFSET_AT)[0]
        struct.pack_into("=q", self.memory, WALL_OFFSET_AT, offset + round(by_s * 1e9))

    def lose(self, received=0.0, sent=0.0):
        """From now on, of the datagrams received and sent these parts."""
        struct.pack_into("=II", self.memory, LOSS_AT, round(received * 1e6), round(sent * 1e6))

    def lost(self):
        return struct.unpack_from("=Q", self.memory, LOST_AT)[0]


def shim_of(prefix):
    return pathlib.Path(prefix) / "lib/goshawk/libgoshawk_fault_shim.so"


def environment(shim, folder, env=os.environ):
    """What `goshawk fly` needs for its stages to have shims that look at this folder.

    @param env what it has already: its own options of these kinds stay"""
    return {"GOSHAWK_FAULTS": str(folder),
            "LD_PRELOAD": joined(env.get("LD_PRELOAD"), str(shim)),
            # With sanitizers their library comes first, unless it is told that it need not.
            "ASAN_OPTIONS": joined(env.get("ASAN_OPTIONS"), "verify_asan_link_order=0")}


def joined(*texts):
    return ":".join(text for text in texts if text)
