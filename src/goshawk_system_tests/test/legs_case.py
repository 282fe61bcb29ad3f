"""Flights between two places of the default world, in which something happens while the vehicle moves."""

import math

from harness import until
from stack import PLACES, StackTest

BETWEEN = (3.5, 6.1, 1.1)


class LegsCase(StackTest):
    def farthest_place(self):
        here = self.stack.place()
        return max(PLACES, key=lambda p: math.dist(p, here))

    def start_leg(self, goal=None):
        """Sends a goal; returns once the vehicle moves."""
        goal, here = goal or self.farthest_place(), self.stack.place()
        since = len(self.stack.states.lines())
        self.stack.send_goal(goal)
        state = self.stack.wait_state({"flying", "failed"}, since, 15.0)
        self.assertIsNotNone(state, "no answer to a goal\n" + self.stack.launch.tails())
        self.assertEqual(state["state"], "flying", state)
        moving = until(lambda: math.dist(self.stack.place(), here) > 0.5, 10.0)
        self.assertTrue(moving, f"the vehicle does not move: navigator {self.said(since)}\n"
                        + self.stack.launch.tails())
        return goal, since

    def said(self, since):
        return [f"{s['state']}/{s['code']}" for s in self.stack.states.lines()[since:]]

    def fly_on(self):
        """The next goal is reached, with all that was restarted; a stage may need a second."""
        self.fly([BETWEEN])
