"""What others have published of the worlds of tools/league. docs/league.md says what of it can be
compared. None stands for a figure that was not found."""

SANDO = "arXiv 2604.07599, section IX-C"
MIGHTY = "arXiv 2511.10822v3, section IV-F, and its repository's notebook"
DYNUS = "arXiv 2504.16734, section VII-A"

# success and collisions in per cent; times in s, replans in ms
PEERS = {
    "standardized": [
        {"peer": "SANDO, N = 6, one thread", "success": 100, "time_s": 12.40, "length_m": 8.62,
         "jerk_m_s2": 2.27, "replan_p50_ms": 43.9,
         "machine": "desktop with an i9 (the paper's; the notebook names none)",
         "source": "notebook local_traj_benchmark.ipynb of mit-acl/sando, 101 goals"},
        {"peer": "FASTER, N = 6", "success": 100, "time_s": 12.40, "length_m": 8.62,
         "jerk_m_s2": 2.27, "replan_p50_ms": 40.3,
         "machine": "the same", "source": "the same"},
    ],
    "forest_easy": [
        {"peer": "SANDO", "success": 100, "time_s": None, "machine": "desktop with an i9, Gurobi",
         "source": SANDO},
    ],
    "forest_medium": [
        {"peer": "SANDO", "success": 100, "time_s": None, "machine": "desktop with an i9, Gurobi",
         "source": SANDO},
        {"peer": "FASTER", "success": 90, "time_s": None, "machine": "the same", "source": SANDO},
    ],
    "forest_hard": [
        {"peer": "SANDO", "success": 100, "time_s": None, "machine": "desktop with an i9, Gurobi",
         "source": SANDO},
        {"peer": "FASTER", "success": 70, "time_s": None, "machine": "the same", "source": SANDO},
    ],
    "forest_300m": [
        {"peer": "MIGHTY", "success": 100, "time_s": 78.98, "length_m": 310.95, "jerk_m_s2": 522.2,
         "replan_p50_ms": 19.7, "machine": "i9-9900K", "source": MIGHTY},
        {"peer": "SUPER, w_t 10", "success": 100, "time_s": None, "machine": "i9-9900K",
         "source": MIGHTY},
        {"peer": "EGO-Swarm", "success": 40, "time_s": None, "machine": "i9-9900K",
         "source": MIGHTY},
    ],
    "thin_10": [
        {"peer": "DYNUS", "success": 100, "time_s": None, "machine": "i9-9900K", "source": DYNUS},
    ],
}

# [s] that no flight can beat: the straight way under the limits of speed, acceleration and jerk
FLOORS_S = {"standardized": 7.65, "forest_easy": 21.45, "forest_medium": 21.45,
            "forest_hard": 21.45, "forest_300m": 76.98}


def best(world):
    """The peer that a row names: the one with the shortest published time, else the first."""
    peers = PEERS.get(world, [])
    timed = [p for p in peers if p["time_s"] is not None]
    return min(timed, key=lambda p: p["time_s"]) if timed else (peers[0] if peers else None)
