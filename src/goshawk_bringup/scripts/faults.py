"""Faults of a flight: which, when, how long (all from a seed), and how each is done.

    kill     SIGKILL of a stage, which the supervisor starts again
    stall    SIGSTOP of a stage, of all stages, or of everything and the vehicle; then SIGCONT
    clock    the wall clock of a stage, or of all, is stepped, and later stepped back
    loss     a stage, or all, lose a part of the datagrams that they receive
    blind    the map server falls silent, or starts again with an empty map; in a live flight the
             lidar falls silent or is covered
    hostile  mutated datagrams to every process, or a stranger who publishes forged messages

The vehicle (the plant) is never killed, and never stalled alone: no fault of software stops a body.
"""

import random
import shutil
import signal

KINDS = ["kill", "stall", "clock", "loss", "blind", "hostile"]
PLANT = "simulator"
STAGES = ["map_server", "path_search", "corridor_builder", "trajectory_optimizer", "navigator",
          "tracker", "flight_check"]
# Everything that runs in a flight; the more a stage has to do with control, the more often it is hit.
TARGETS = STAGES + ["navigator", "tracker"]
# What goshawk_impostor can send in the name of a stage.
LIES = {"commit": "committed trajectories", "trajectory": "certified trajectories through obstacles",
        "bad_trajectory": "trajectories that are not certified", "corridor": "corridors",
        "request": "plan requests", "report": "stage reports", "map": "a map that is free everywhere",
        "update": "map updates that free bricks", "blocked_map": "a map that is blocked everywhere",
        "odom": "odometry of another place", "command": "500 setpoints a second of full tilt"}
LIDAR = "lidar"
CLOUD_LIES = {"cloud_of_wall": "clouds of a wall before the vehicle",
              "cloud_of_nothing": "clouds that say that all is free",
              "cloud_of_garbage": "clouds of points that are no numbers, or far away"}
HOSTILE_PROGRAMS = ["goshawk_datagram_storm", "goshawk_impostor"]
EMPTY_MAP = (b"# Octomap OcTree binary file\nid OcTree\nsize 0\nres 0.1\ndata\n")


def log_uniform(draw, low, high):
    return low * (high / low) ** draw.random()


class Fault:
    """One fault, as it was drawn. begin() does it, end() undoes it; both may be called at any time
    of a flight, end() once after begin()."""

    instant = False  # over as soon as it has begun

    def __init__(self, draw, live):
        """@param live the flight maps what its lidar sees"""
        self.live = live
        self.all = [*STAGES, LIDAR] if live else STAGES
        self.singles = [*TARGETS, LIDAR] if live else TARGETS
        self.targets = []  # names of processes
        self.duration_s = 0.0
        self.after_s = draw.uniform(0.3, 4.0)  # since the end of the one before
        self.choose(draw)

    def row(self):
        return {"kind": self.kind, "what": self.what(), "targets": self.targets,
                "duration_s": round(self.duration_s, 3)}


class Kill(Fault):
    kind, instant = "kill", True

    def choose(self, draw):
        self.targets = [draw.choice(self.singles)]

    def what(self):
        return f"SIGKILL of {self.targets[0]}"

    def begin(self, flight):
        flight.signal(self.targets, signal.SIGKILL)

    def end(self, flight):
        pass


class Stall(Fault):
    kind = "stall"

    def choose(self, draw):
        self.duration_s = log_uniform(draw, 0.05, 10.0)
        # Of everything with the plant: a machine that was suspended with a simulated vehicle on it.
        self.targets = draw.choice([*([t] for t in self.singles), self.all, [*self.all, PLANT]])

    def what(self):
        return f"stop of {names(self.targets)} for {self.duration_s:.2f} s"

    def begin(self, flight):
        flight.signal(self.targets, signal.SIGSTOP)

    def end(self, flight):
        flight.signal(self.targets, signal.SIGCONT)


class Clock(Fault):
    kind = "clock"

    def choose(self, draw):
        self.duration_s = log_uniform(draw, 0.5, 10.0)
        self.step_s = draw.uniform(-5.0, 5.0)
        self.targets = draw.choice([*([t] for t in self.singles), [PLANT], [*self.all, PLANT]])

    def what(self):
        return (f"wall clock of {names(self.targets)} stepped by {self.step_s:+.2f} s, and back "
                f"after {self.duration_s:.2f} s")

    def begin(self, flight):
        flight.for_each(self.targets, lambda control: control.step_clock(self.step_s))

    def end(self, flight):
        flight.for_each(self.targets, lambda control: control.step_clock(-self.step_s))


class Loss(Fault):
    kind = "loss"

    def choose(self, draw):
        self.duration_s = log_uniform(draw, 0.1, 5.0)
        self.part = draw.choice([draw.uniform(0.05, 0.5), draw.uniform(0.5, 0.99), 1.0])
        self.targets = draw.choice([*([t] for t in self.singles), [PLANT], [*self.all, PLANT]])

    def what(self):
        return (f"{names(self.targets)} lose {100 * self.part:.0f} % of what they receive for "
                f"{self.duration_s:.2f} s")

    def begin(self, flight):
        flight.for_each(self.targets, lambda control: control.lose(received=self.part))

    def end(self, flight):
        flight.for_each(self.targets, lambda control: control.lose())


class Blind(Fault):
    kind = "blind"
    # what: how it is said
    WAYS = {"silent": "map server is silent", "empty": "map server starts again with an empty map",
            "no clouds": "lidar is silent", "covered": "lidar is covered"}

    def choose(self, draw):
        self.duration_s = log_uniform(draw, 0.5, 10.0)
        # A live map comes from nowhere but its journal.
        ways = ["silent", "no clouds", "covered"] if self.live else ["empty", "silent"]
        self.way = ways[int(len(ways) * draw.random())]
        self.targets = [LIDAR if self.way in ("no clouds", "covered") else "map_server"]

    def what(self):
        return f"{self.WAYS[self.way]} for {self.duration_s:.2f} s"

    def begin(self, flight):
        if self.way == "empty":
            flight.world.write_bytes(EMPTY_MAP)
            flight.signal(self.targets, signal.SIGKILL)
        elif self.way == "covered":
            self.setting = flight.start([flight.program("goshawk"), "param", "set", LIDAR,
                                         "covered", "true"])
        else:
            flight.for_each(self.targets, lambda control: control.lose(sent=1.0))

    def end(self, flight):
        if self.way == "empty":
            shutil.copyfile(flight.true_world, flight.world)
            flight.signal(self.targets, signal.SIGKILL)
        elif self.way == "covered":
            self.setting.wait()  # it ends by itself, whatever the lidar answers
            flight.start([flight.program("goshawk"), "param", "set", LIDAR, "covered",
                          "false"]).wait()
        else:
            flight.for_each(self.targets, lambda control: control.lose())


class Hostile(Fault):
    """Programs of goshawk_system_tests (hostile/)."""

    kind = "hostile"

    def choose(self, draw):
        self.seed = draw.randrange(1, 1 << 31)
        self.duration_s = draw.uniform(2.0, 5.0)
        self.lies = {**LIES, **(CLOUD_LIES if self.live else {})}
        self.lie = draw.choice(["", *self.lies])
        self.place = [draw.random() for _ in range(3)]  # of the world's size

    def what(self):
        return (f"an impostor sends {self.lies[self.lie]}" if self.lie else
                f"mutated datagrams to every process, seed {self.seed}")

    def begin(self, flight):
        self.process = flight.start(self.command(flight))

    def command(self, flight):
        if not self.lie:
            return [flight.program("goshawk_datagram_storm"), "--count", "1000000", "--rate",
                    "1000", "--listen", "1", "--seed", str(self.seed)]
        to = ",".join(f"{part * size:.2f}" for part, size in zip(self.place, flight.size_m))
        rates = {"command": "500", **dict.fromkeys(CLOUD_LIES, "10")}
        rate = ["--rate", rates[self.lie]] if self.lie in rates else []
        return [flight.program("goshawk_impostor"), self.lie, "--to", to, *rate]

    def end(self, flight):
        flight.stop(self.process)


CLASSES = {c.kind: c for c in (Kill, Stall, Clock, Loss, Blind, Hostile)}


def names(targets):
    if targets in (STAGES, [*STAGES, LIDAR]):
        return "all stages"
    if targets in ([*STAGES, PLANT], [*STAGES, LIDAR, PLANT]):
        return "all stages and the vehicle"
    return ", ".join(targets)


def drawn(kinds, seed, live=False):
    """Faults without an end; the k-th follows from the seed alone."""
    k = 0
    while True:
        draw = random.Random(f"{seed}/fault {k}")
        yield CLASSES[draw.choice(kinds)](draw, live)
        k += 1
