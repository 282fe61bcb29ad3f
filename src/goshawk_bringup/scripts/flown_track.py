"""The flown track of a flight with faults, in which the vehicle's process may have been stopped: its
times without these gaps; and how fast it was."""

import bisect
import csv
import math

GAP_S = 0.25    # odometry comes every few milliseconds
STEP_S = 0.004  # what is written for a gap in which the vehicle stood still
STILL_M = 0.02
LONGEST_STEP_S = 0.1  # the plant's world goes on by so much at the most after a pause


class Track:
    """Rows of flown.csv. `times` is their table's time axis without the gaps that faults explain."""

    def __init__(self, path, stalls=0):
        """@param stalls how often the vehicle's process was stopped"""
        with open(path, encoding="utf-8", newline="") as file:
            self.rows = list(csv.DictReader(file))
        self.stamps = [float(r["t_s"]) for r in self.rows]
        self.points = [tuple(float(r[k]) for k in ("x_m", "y_m", "z_m")) for r in self.rows]
        self.unseen = []  # numbers of the rows before which the vehicle flew unseen
        self.times = self.without_gaps(stalls)

    def without_gaps(self, stalls):
        """A vehicle that did not move across a gap, because its process was stopped, did not fly
        unseen. If it did, the parts before and after are judged each. Any other gap stays, and its
        track is not judged."""
        times, shift_s = [], 0.0
        for k, stamp_s in enumerate(self.stamps):
            if k > 0:
                gap_s = stamp_s - self.stamps[k - 1]
                if gap_s > GAP_S and stalls > 0:
                    stalls -= 1
                    shift_s += STEP_S - gap_s
                    if self.moved_before(k):
                        self.unseen.append(k)
            times.append(stamp_s + shift_s)
        return times

    def moved_before(self, k):
        reach_m = STILL_M + max(self.speed(k - 1), self.speed(k)) * LONGEST_STEP_S
        return math.dist(self.points[k - 1], self.points[k]) > reach_m

    def speed(self, k):
        return math.hypot(*(float(self.rows[k][v]) for v in ("vx_m_s", "vy_m_s", "vz_m_s")))

    def parts(self):
        """Ranges of rows, each without a gap."""
        ends = [*self.unseen, len(self.rows)]
        return [range(a, b) for a, b in zip([0, *self.unseen], ends) if b > a]

    def write(self, path, part):
        with open(path, "w", encoding="utf-8", newline="") as file:
            table = csv.DictWriter(file, self.rows[0].keys())
            table.writeheader()
            for k in part:
                time_s = self.times[k] - self.times[part.start]
                table.writerow({**self.rows[k], "t_s": f"{time_s:.6f}"})

    def stamp_at(self, time_s):
        """The vehicle's own stamp at a time of the written table, [s] since its first."""
        k = bisect.bisect_left(self.times, time_s)
        return self.stamps[min(k, len(self.stamps) - 1)]

    def fastest(self):
        """@return largest speed and the stamp at which it was flown"""
        k = max(range(len(self.rows)), key=self.speed, default=None)
        return (0.0, 0.0) if k is None else (self.speed(k), self.stamps[k])
