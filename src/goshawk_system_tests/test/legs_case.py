"""Flights between two places of the default world, in which something happens while the vehicle moves."""

import math

import harness
import second_opinion
from harness import note, until
from stack import StackTest

# Free places of the default world, far from each other.
PLACES = [(3.0, 0.0, 1.0), (3.0, 8.0, 2.0)]
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
        self.assertTrue(moving, "the vehicle does not move")
        return goal, since

    def check_untouched(self):
        clearance = second_opinion.smallest_clearance(self.stack.world, self.stack.track(), 0.02)
        note(f"smallest distance of the centre to an obstacle so far {clearance:.3f} m")
        self.assertGreater(clearance, harness.BODY_RADIUS_M)

    def said(self, since):
        return [f"{s['state']}/{s['code']}" for s in self.stack.states.lines()[since:]]

    def fly_on(self):
        """The next goal is reached, with all that was restarted; a stage may need a second."""
        state = self.stack.fly_to(BETWEEN)
        self.assertIsNotNone(state, "no answer to the next goal\n" + self.stack.launch.tails())
        self.assertEqual(state["state"], "arrived", state)
