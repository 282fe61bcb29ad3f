"""Tests of tools/hold_domain.py: one holder of a domain, and nothing left when it ends."""

import pathlib
import socket
import subprocess
import sys
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(TOOLS))
import hold_domain  # noqa: E402


class HoldDomain(unittest.TestCase):
    def test_a_domain_has_one_holder_until_it_is_closed(self):
        domain, held = hold_domain.hold_private_domain()
        self.assertIn(domain, range(20, 100))
        self.assertIsNone(hold_domain.hold(domain))
        held.close()
        again = hold_domain.hold(domain)
        self.assertIsNotNone(again)
        again.close()

    def test_a_domain_that_another_program_is_in_is_not_given(self):
        domain, held = hold_domain.hold_private_domain()
        held.close()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 7400 + 250 * domain + 10))
            self.assertIsNone(hold_domain.hold(domain))

    def test_the_program_holds_until_its_input_ends(self):
        with subprocess.Popen([TOOLS / "hold_domain.py"], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, text=True) as holder:
            domain = int(holder.stdout.readline())
            self.assertIsNone(hold_domain.hold(domain))
            holder.stdin.close()
            holder.wait(timeout=60)
        self.assertIsNotNone(hold_domain.hold(domain))


if __name__ == "__main__":
    unittest.main()
