#!/usr/bin/python3
"""The server of `goshawk view`: files, parts of files, and nothing else of the machine."""

import http.client
import pathlib
import socket
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scripts"))
import page_server  # noqa: E402

CONTENT = bytes(range(256)) * 4096  # 1 MiB: more than one chunk


class PageServer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = pathlib.Path(cls.folder.name)
        (root / "open").mkdir()
        (root / "open/part.js").write_text("1")
        (root / "secret.txt").write_text("secret")
        (root / "open/way_out").symlink_to(root / "secret.txt")
        (root / "flight.mcap").write_bytes(CONTENT)
        (root / "empty.mcap").write_bytes(b"")
        site = page_server.Site()
        site.add("/", b"<p>page</p>")
        site.add("/show.json", b"{}")
        site.add("/flight.mcap", root / "flight.mcap")
        site.add("/empty.mcap", root / "empty.mcap")
        site.add("/gone.mcap", root / "gone.mcap")
        site.add_folder("/open/", root / "open")
        cls.server = page_server.start(site, 0)

    @classmethod
    def tearDownClass(cls):
        cls.server.shutdown()
        cls.server.server_close()
        cls.folder.cleanup()

    def ask(self, path, method="GET", **headers):
        """Asks for 127.0.0.1 unless the headers name another Host."""
        link = http.client.HTTPConnection("127.0.0.1", self.server.server_port, timeout=60)
        link.request(method, path, headers={k.replace("_", "-"): v for k, v in headers.items()})
        answer = link.getresponse()
        body = answer.read()
        link.close()
        return answer, body

    def test_a_whole_file(self):
        answer, body = self.ask("/flight.mcap")
        self.assertEqual((answer.status, body), (200, CONTENT))
        self.assertEqual(answer.headers["Accept-Ranges"], "bytes")

    def test_parts_of_a_file(self):
        size = len(CONTENT)
        for asked, first, last in [("bytes=0-9", 0, 9), ("bytes=7-7", 7, 7),
                                   ("bytes=300000-900000", 300000, 900000),
                                   ("bytes=1048000-", 1048000, size - 1),
                                   ("bytes=-5", size - 5, size - 1),
                                   ("bytes=5-99999999", 5, size - 1),
                                   ("bytes=-99999999", 0, size - 1)]:
            with self.subTest(asked=asked):
                answer, body = self.ask("/flight.mcap", Range=asked)
                self.assertEqual(answer.status, 206)
                self.assertEqual(answer.headers["Content-Range"], f"bytes {first}-{last}/{size}")
                self.assertEqual(body, CONTENT[first:last + 1])

    def test_parts_that_are_not_there(self):
        for path, asked, size in [("/flight.mcap", f"bytes={len(CONTENT)}-", len(CONTENT)),
                                  ("/flight.mcap", "bytes=-0", len(CONTENT)),
                                  ("/empty.mcap", "bytes=0-0", 0), ("/empty.mcap", "bytes=-1", 0)]:
            with self.subTest(path=path, asked=asked):
                answer, body = self.ask(path, Range=asked)
                self.assertEqual((answer.status, body), (416, b""))
                self.assertEqual(answer.headers["Content-Range"], f"bytes */{size}")

    def test_what_is_no_range_gives_the_whole(self):
        for asked in ("bytes=9-2", "bytes=-", "lines=1-2", "bytes=0-1,5-6", "bytes=x-y", "garbage"):
            with self.subTest(asked=asked):
                answer, body = self.ask("/flight.mcap", Range=asked)
                self.assertEqual((answer.status, len(body)), (200, len(CONTENT)))
        answer, body = self.ask("/flight.mcap", Range="bytes=0-1", If_Range='"x"')
        self.assertEqual((answer.status, len(body)), (200, len(CONTENT)))

    def test_heads(self):
        answer, body = self.ask("/flight.mcap", "HEAD")
        self.assertEqual((answer.status, body), (200, b""))
        self.assertEqual(answer.headers["Content-Length"], str(len(CONTENT)))
        answer, _ = self.ask("/flight.mcap", "HEAD", Range="bytes=0-9")
        self.assertEqual((answer.status, answer.headers["Content-Length"]), (206, "10"))

    def test_types(self):
        for path, kind in [("/", "text/html"), ("/index.html", "text/html"),
                           ("/open/part.js", "text/javascript"), ("/show.json", "application/json")]:
            with self.subTest(path=path):
                answer, _ = self.ask(path)
                self.assertEqual(answer.status, 200)
                self.assertTrue(answer.headers["Content-Type"].startswith(kind))

    def test_nothing_else_is_served(self):
        for path in ("/secret.txt", "/open/../secret.txt", "/open/%2e%2e/secret.txt", "/open/way_out",
                     "/open/", "/open//etc/passwd", "//etc/passwd", "/gone.mcap", "/open/\0"):
            with self.subTest(path=path):
                with socket.create_connection(("127.0.0.1", self.server.server_port)) as link:
                    link.settimeout(60)
                    link.sendall(f"GET {path} HTTP/1.0\r\nHost: localhost\r\n\r\n".encode())
                    answer = b""
                    while chunk := link.recv(65536):
                        answer += chunk
                self.assertIn(answer.split()[1], (b"400", b"404"), answer[:80])
                self.assertNotIn(b"secret", answer)

    def test_every_name_of_this_machine_is_served(self):
        for host in ("127.0.0.1", "127.0.0.1:8080", "localhost:9000", "LOCALHOST", "[::1]:80"):
            with self.subTest(host=host):
                self.assertEqual(self.ask("/", Host=host)[0].status, 200)

    def test_a_page_that_was_made_to_lead_here_reads_nothing(self):
        for host in ("evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example",
                     "evil.example:127.0.0.1", "localhost:x", "[::1", "10.0.0.7", ""):
            with self.subTest(host=host):
                for path in ("/", "/flight.mcap", "/nothing"):
                    answer, body = self.ask(path, Host=host)
                    self.assertEqual(answer.status, 421)
                    self.assertIn(b"http://127.0.0.1", body)

    def test_a_request_without_a_host_or_with_two_is_refused(self):
        for hosts in (b"", b"Host: localhost\r\nHost: evil.example\r\n"):
            with self.subTest(hosts=hosts):
                with socket.create_connection(("127.0.0.1", self.server.server_port)) as link:
                    link.settimeout(60)
                    link.sendall(b"GET / HTTP/1.0\r\n" + hosts + b"\r\n")
                    self.assertEqual(link.recv(65536).split()[1], b"421")

    def test_other_methods_are_refused(self):
        self.assertEqual(self.ask("/", "POST")[0].status, 501)

    def test_a_client_that_leaves_in_the_middle_harms_nobody(self):
        with socket.create_connection(("127.0.0.1", self.server.server_port)) as link:
            link.sendall(b"GET /flight.mcap HTTP/1.1\r\nHost: localhost\r\n\r\n")
            link.recv(100)
        self.assertEqual(self.ask("/")[1], b"<p>page</p>")


if __name__ == "__main__":
    unittest.main()
