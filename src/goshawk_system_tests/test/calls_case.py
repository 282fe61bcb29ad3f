"""What tests of single calls share."""

from harness import SystemTest

DONE, NOT_DONE, WRONG_CALL = 0, 1, 2


def ascii_pcd(points, claimed=None):
    head = (f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
            f"WIDTH {claimed or len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
            f"POINTS {claimed or len(points)}\nDATA ascii\n")
    return (head + "".join(f"{x} {y} {z}\n" for x, y, z in points)).encode()


def ascii_ply(points, claimed=None):
    head = (f"ply\nformat ascii 1.0\nelement vertex {claimed or len(points)}\nproperty float x\n"
            "property float y\nproperty float z\nend_header\n")
    return (head + "".join(f"{x} {y} {z}\n" for x, y, z in points)).encode()


class CallsCase(SystemTest):
    def expect(self, arguments, status, code, *words, timeout_s=30.0, cwd=None):
        """One wrong call with --json and the same without it."""
        arguments = [str(a) for a in arguments]
        with self.subTest(call=" ".join(arguments)[:120]):
            outcome = self.sandbox.goshawk(*arguments, "--json", timeout_s=timeout_s, cwd=cwd)
            self.assert_civil(outcome)
            self.assertEqual(outcome.status, status, str(outcome))
            answer = self.json_object(outcome)
            self.assertIs(answer["ok"], False)
            self.assertEqual(answer["code"], code, str(outcome))
            for word in words:
                self.assertIn(str(word), answer["message"])
            return answer
        return None

    def file(self, name, content):
        path = self.sandbox.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path
