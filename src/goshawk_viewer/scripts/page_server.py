"""Serves a few files to browsers on this machine, in parts if they ask for parts (RFC 9110,
ranges): a viewer of recordings asks for the end of a file first, then for what it shows."""

import http.server
import mimetypes
import os
import pathlib
import re
import threading

TYPES = {".js": "text/javascript; charset=utf-8", ".html": "text/html; charset=utf-8",
         ".wasm": "application/wasm", ".json": "application/json", ".mcap": "application/octet-stream"}
CHUNK = 1 << 18
# The names by which a browser reaches a server that listens on loopback. A page from elsewhere whose
# name was made to lead here (DNS rebinding) sends its own name.
OWN_NAMES = {"127.0.0.1", "localhost", "[::1]"}


def is_own_host(hosts):
    """@param hosts the values of all Host headers @return whether the client asked for this machine
    by one of its own names; the port may be another one, as behind an ssh tunnel"""
    match = re.fullmatch(r"(\[[^\]]*\]|[^:\[]*)(?::[0-9]{0,5})?", hosts[0]) if len(hosts) == 1 else None
    return match is not None and match[1].lower() in OWN_NAMES


def byte_range(header, size):
    """@return the first and the last byte that a Range header asks for of `size`; None if it is to be
    ignored (none, several, or no range of bytes); raises ValueError if nothing is there."""
    match = re.fullmatch(r"bytes=(\d*)-(\d*)", (header or "").replace(" ", ""))
    if not match or match[1] == match[2] == "":
        return None
    if not match[1]:  # the last so many
        first, last = max(0, size - int(match[2])), size - 1
    else:
        first = int(match[1])
        last = min(int(match[2]), size - 1) if match[2] else size - 1
        if match[2] and int(match[2]) < first:
            return None
    if first >= size or last < first:
        raise ValueError(f"bytes {header} of {size}")
    return first, last


class Site:
    """What is served: bytes or files by their names, and folders by the beginnings of names."""

    def __init__(self):
        self.parts, self.folders = {}, {}

    def add(self, name, content):
        self.parts[name] = content

    def add_folder(self, name, folder):
        self.folders[name] = pathlib.Path(folder).resolve()

    def find(self, path):
        """@return bytes, a file's path, or None; never anything outside of the folders"""
        if path in self.parts:
            return self.parts[path]
        if "\0" in path:
            return None
        for name, folder in self.folders.items():
            if path.startswith(name):
                file = (folder / path[len(name):]).resolve()
                if file.is_relative_to(folder) and file.is_file():
                    return file
        return None


def handler_of(site):
    class Handler(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"
        server_version = "goshawk"
        timeout = 30  # a silent client does not hold its thread for ever

        def do_GET(self):
            self.answer(with_body=True)

        def do_HEAD(self):
            self.answer(with_body=False)

        def answer(self, with_body):
            name = self.path.split("?")[0]
            content = site.find("/" if name == "/index.html" else name)
            try:
                if not is_own_host(self.headers.get_all("Host") or []):
                    self.refuse(421, b"open this page as http://127.0.0.1 or http://localhost\n", with_body)
                elif content is None:
                    self.refuse(404, b"not found; the page is /\n", with_body)
                elif isinstance(content, bytes):
                    self.give_bytes(content, name, with_body)
                else:
                    self.give_file(pathlib.Path(content), name, with_body)
            except (BrokenPipeError, ConnectionResetError, TimeoutError):
                self.close_connection = True

        def refuse(self, status, sentence, with_body):
            self.head(status, "text/plain", len(sentence))
            if with_body:
                self.wfile.write(sentence)

        def give_bytes(self, content, name, with_body):
            kind = TYPES.get(pathlib.PurePath(name).suffix, TYPES[".html"])
            self.head(200, kind, len(content))
            if with_body:
                self.wfile.write(content)

        def give_file(self, path, name, with_body):
            kind = TYPES.get(path.suffix) or mimetypes.guess_type(name)[0] or "application/octet-stream"
            try:
                file = open(path, "rb")
            except OSError:
                self.head(404, "text/plain", 0)
                return
            with file:
                size = os.fstat(file.fileno()).st_size
                try:
                    part = byte_range(self.headers.get("Range"), size)
                except ValueError:
                    self.head(416, kind, 0, ("Content-Range", f"bytes */{size}"))
                    return
                if "If-Range" in self.headers:  # there are no validators to compare with
                    part = None
                first, last = part or (0, size - 1)
                extra = [("Content-Range", f"bytes {first}-{last}/{size}")] if part else []
                self.head(206 if part else 200, kind, last - first + 1, *extra)
                if with_body:
                    self.copy(file, first, last - first + 1)

        def copy(self, file, first, count):
            file.seek(first)
            while count > 0:
                chunk = file.read(min(CHUNK, count))
                if not chunk:  # the file became shorter: the client sees a broken answer
                    self.close_connection = True
                    return
                self.wfile.write(chunk)
                count -= len(chunk)

        def head(self, status, kind, length, *extra):
            self.send_response(status)
            for name, value in [("Content-Type", kind), ("Content-Length", str(length)),
                                ("Accept-Ranges", "bytes"), ("Cache-Control", "no-store"), *extra]:
                self.send_header(name, value)
            self.end_headers()

        def log_message(self, *_):
            pass
    return Handler


def start(site, port):
    """@return the server, which has its own threads; raises OSError if the port is busy"""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", port), handler_of(site))
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server
