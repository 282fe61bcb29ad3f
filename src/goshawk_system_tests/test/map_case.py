"""What tests of the map server alone share: clouds, odometry, a server that is listened to."""

import struct

from harness import GOSHAWK, Publisher, SystemTest, node_of, until

STAMP = {"sec": 100, "nanosec": 0}  # of all odometry and clouds: the newest pose places them


def cloud(points, frame="map", **changes):
    """A PointCloud2 of float32 x, y, z."""
    data = b"".join(struct.pack("<fff", *p) for p in points)
    fields = [{"name": n, "offset": 4 * k, "datatype": 7, "count": 1} for k, n in enumerate("xyz")]
    return {"header": {"frame_id": frame, "stamp": STAMP}, "height": 1, "width": len(points), "fields": fields,
            "is_bigendian": False, "point_step": 12, "row_step": 12 * len(points),
            "data": list(data), "is_dense": True, **changes}


def odometry(position, frame="map", child="base_link"):
    x, y, z = position
    return {"header": {"frame_id": frame, "stamp": STAMP}, "child_frame_id": child,
            "pose": {"pose": {"position": {"x": x, "y": y, "z": z}, "orientation": {"w": 1.0}}}}


def bits_of(words, row, x):
    """Bit x of a row of words; words may be numbers or their decimal texts."""
    return int(words[row]) >> x & 1


def first_with(messages, condition=lambda _: True):
    """The first one that fulfils the condition, or None."""
    return next((m for m in messages if condition(m)), None)


class MapCase(SystemTest):
    def setUp(self):
        super().setUp()
        self.publishers = {}
        self.place = None  # of the newest odometry

    def tell(self, topic, kind, message):
        if topic not in self.publishers:
            self.publishers[topic] = Publisher(self.sandbox, topic, kind)
        self.publishers[topic].send(message)

    def send_odometry(self, position):
        self.place = position
        self.tell("odom", "nav_msgs/msg/Odometry", odometry(position))

    def send_cloud(self, message, effect):
        """Again and again until it has an effect, with the newest odometry before it: the readers
        are best effort and may lose either. @return the effect"""
        def once_more():
            if self.place is not None:
                self.send_odometry(self.place)
            self.tell("cloud_in", "sensor_msgs/msg/PointCloud2", message)
            return until(effect, 0.1)
        found = until(once_more, 10.0)
        self.assertTrue(found, f"no effect of {str(message)[:300]}")
        return found

    def echo(self, topic, *options):
        return self.sandbox.start(GOSHAWK, "topic", "echo", topic, "--json", "--timeout", "60",
                                  *options)

    def wait_line(self, process, condition=lambda _: True, timeout_s=20.0):
        found = until(lambda: first_with(process.lines(), condition), timeout_s)
        self.assertIsNotNone(found, str(process.outcome()))
        return found

    def run_server(self, *parameters):
        options = [word for p in parameters for word in ("-p", p)]
        server = self.sandbox.start(GOSHAWK, "run", "map_server", "--ros-args", *options)
        reports = self.echo("stage_report")
        self.wait_line(reports, lambda r: r["code"] == "ok" and node_of(r) == "map_server", 60.0)
        return server, reports
