"""Who reads and writes which topics: the one table from which permissions are made.

A right is a topic in the vehicle's namespace, or one of the whole domain if it begins with '/'.
`SecuredStages` compares this table with what the stages open.
"""

EVERY_NODE = {"reads": ["/parameter_request"], "writes": ["/parameter_answer"]}
MAP = ["map/voxels", "map/voxels/updates"]
ALL = ["/*"]

# name: what it reads and writes besides EVERY_NODE (stages also write stage_report)
STAGES = {
    # cloud_in and depth_in are remapped if Goshawk's own sensors fill them (launch file live).
    "map_server": {"reads": ["cloud_in", "points", "depth_in", "depth/image_rect_raw",
                             "depth_info_in", "depth/camera_info", "octomap_in", "odom", "/tf",
                             "/tf_static"],
                   "writes": [*MAP, "octomap_binary", "octomap_world"]},
    "path_search": {"reads": [*MAP, "plan_request"], "writes": ["path"]},
    "corridor_builder": {"reads": [*MAP, "plan_request", "path"], "writes": ["corridor"]},
    "trajectory_optimizer": {"reads": ["plan_request", "corridor"], "writes": ["trajectory"]},
    "navigator": {"reads": [*MAP, "goal_pose", "goal", "operator_command", "odom", "trajectory",
                            "stage_report", "tracking_state"],
                  "writes": ["plan_request", "committed_trajectory", "navigator_state",
                             "navigator_alive", "operator_answer",
                             # In place of plan_request, while a benchmark asks for the plans.
                             "bench/unheard_requests"]},
    "mission": {"reads": ["mission", "operator_command", "navigator_state", "odom"],
                "writes": ["goal", "mission_state", "operator_answer"]},
    # In the navigator's place, for another planner's plans.
    "guard": {"reads": [*MAP, "plan/path", "plan/trajectory", "plan/polynomial", "plan/bspline",
                        "odom", "tracking_state", "stage_report"],
              "writes": ["committed_trajectory", "guard_verdict", "navigator_state",
                         "navigator_alive"]},
    "tracker": {"reads": [*MAP, "committed_trajectory", "odom", "vehicle_status",
                          "navigator_alive", "stage_report"],
                "writes": ["command", "fallback_stop", "tracking_state"]},
    "vehicle": {"reads": [*MAP, "command", "fallback_stop"],
                "writes": ["odom", "odom_true", "vehicle_status", "/tf"]},
    "flight_check": {"reads": ["octomap_binary", "committed_trajectory", "odom", "odom_true",
                               "vehicle_status"], "writes": []},
    "sensors": {"reads": ["odom", "odom_true"],
                "writes": ["points", "depth/image_rect_raw", "depth/camera_info", "/tf_static"]},
    "movers": {"reads": [], "writes": ["movers"]},
    # cloud_in is remapped as map_server's.
    "obstacle_tracker": {"reads": ["cloud_in", "points", "odom", "/tf", "/tf_static", "movers"],
                         "writes": ["obstacles", "tracks"]},
    "visualizer": {"reads": ["octomap_binary", "path", "committed_trajectory", "odom"],
                   "writes": ["view/obstacles", "view/plan", "view/flown", "path_line", "markers"]},
}
# They are no stages: they report nothing.
PEOPLE = {
    "viewer": {"reads": ALL, "writes": ["goal_pose", "operator_command", "why"]},
    "recorder": {"reads": ALL, "writes": []},
    "benchmark": {"reads": ["trajectory", "stage_report"], "writes": ["plan_request"]},
    "operator": {"reads": ALL, "writes": ["goal_pose", "goal", "mission", "operator_command",
                                          "octomap_in", "/parameter_request"]},
}
COMPONENTS = {"simulator": "vehicle", "mujoco": "vehicle", "viewer_bridge": "viewer",
              "baseline_optimizer": "trajectory_optimizer"}


def role_of(component):
    """The name under which a component of a launch file is certified."""
    return COMPONENTS.get(component, component)


def roles():
    """name: (topics that it reads, topics that it writes)"""
    table = {}
    for name, own in STAGES.items():
        table[name] = (own["reads"] + EVERY_NODE["reads"],
                       own["writes"] + ["stage_report"] + EVERY_NODE["writes"])
    for name, own in PEOPLE.items():
        writes = own["writes"] + (EVERY_NODE["writes"] if name == "viewer" else [])
        table[name] = (own["reads"], writes + (["stage_report"] if name == "viewer" else []))
    return table


def wire_name(topic, namespace):
    """As permissions name it: "map/voxels" in /uav1 is rt/uav1/map/voxels."""
    return "rt" + (topic if topic.startswith("/") else f"{namespace.rstrip('/')}/{topic}")
