#!/usr/bin/python3
"""What a stranger in the domain publishes: as a table of acts, and as a program that prints one JSON
message a line for `goshawk topic pub TOPIC TYPE -`.

    forgery.py odometry SEED | goshawk topic pub odom nav_msgs/msg/Odometry -
"""

import json
import random
import shlex
import sys
import time

RATE_HZ = 200.0


def stamp(ahead_s=0.0):
    ns = time.time_ns() + round(ahead_s * 1e9)
    return {"sec": ns // 10 ** 9, "nanosec": ns % 10 ** 9}


def odometry(draw):
    """A vehicle that drifts away from some place, stamped a little ahead."""
    at = [draw.uniform(1.0, 9.0), draw.uniform(-4.0, 9.0), draw.uniform(0.5, 3.0)]
    velocity = [draw.uniform(-1.0, 1.0) for _ in range(3)]
    while True:
        at = [x + v / RATE_HZ for x, v in zip(at, velocity)]
        yield {"header": {"frame_id": "map", "stamp": stamp(0.02)}, "child_frame_id": "base_link",
               "pose": {"pose": {"position": dict(zip("xyz", at)), "orientation": {"w": 1.0}}},
               "twist": {"twist": {"linear": dict(zip("xyz", velocity))}}}


def command(draw):
    """Full thrust to one side."""
    tilt = draw.choice([-1.0, 1.0]) * 0.25
    while True:
        yield {"header": {"frame_id": "map", "stamp": stamp()}, "thrust": 20.0,
               "orientation": {"x": tilt, "w": (1.0 - tilt * tilt) ** 0.5}}


STREAMS = {"odometry": odometry, "command": command}


class Stream:
    """Messages of one of the streams above, on the flight's topic."""

    def __init__(self, stream, topic, kind, what):
        self.stream, self.topic, self.kind, self.what = stream, topic, kind, what

    def command(self, flight, draw):
        forge = shlex.join([sys.executable, __file__, self.stream, str(draw.randrange(1 << 31))])
        publish = shlex.join([flight.program("goshawk"), "topic", "pub", self.topic, self.kind, "-",
                              "--wait-matching-subscriptions", "1", "--timeout", "10"])
        return ["/bin/bash", "-c", f"{forge} | {publish}"]


class Map:
    """A second map server, whose map is free everywhere."""

    what = "a map without obstacles"

    def command(self, flight, draw):
        return [flight.program("goshawk"), "run", "map_server", "--ros-args", "-r",
                "__node:=stranger", "-p", f"map_file:={flight.free_world}"]


ACTS = {"odometry": Stream("odometry", "odom", "nav_msgs/msg/Odometry", "odometry that drifts"),
        "command": Stream("command", "command", "goshawk_msgs/msg/AttitudeSetpoint",
                          "commands of full thrust"),
        "map": Map()}


def main():
    messages = STREAMS[sys.argv[1]](random.Random(int(sys.argv[2])))
    begin = time.monotonic()
    for number, message in enumerate(messages):
        time.sleep(max(0.0, begin + number / RATE_HZ - time.monotonic()))
        print(json.dumps(message), flush=True)


if __name__ == "__main__":
    try:
        main()
    except (BrokenPipeError, KeyboardInterrupt):
        pass
