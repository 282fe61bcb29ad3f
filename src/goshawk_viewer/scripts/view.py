#!/usr/bin/python3
"""goshawk view: shows a flight, or what flies now, in a browser.

    goshawk view                     the newest flight of ./flights
    goshawk view FLIGHT_FOLDER       that one
    goshawk view --live              what flies now; starts a bridge where none listens

Serves one page on this machine until Ctrl-C.
"""

import argparse
import http.server
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time

DONE, NOT_DONE, WRONG_CALL = 0, 1, 2
MARK = "@FLIGHT@"


class Fault(Exception):
    def __init__(self, code, message, status=NOT_DONE):
        super().__init__(message)
        self.code, self.status = code, status


def parse(arguments):
    parser = argparse.ArgumentParser(prog="goshawk view", description=__doc__.split("\n\n")[0],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", help="flight folder (default: the newest in ./flights)")
    parser.add_argument("--live", action="store_true", help="look at what flies now")
    parser.add_argument("--port", type=int, default=8080, help="of the page (default 8080; 0: any)")
    parser.add_argument("--bridge", default="ws://127.0.0.1:8765", help="where the bridge listens")
    parser.add_argument("--no-open", action="store_true", help="do not start a browser")
    parser.add_argument("--check", action="store_true", help="only say what would be shown")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--prefix", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.live and options.folder:
        parser.error("a flight folder and --live: one of them")
    if not 0 <= options.port <= 65535:
        parser.error("--port goes from 0 to 65535")
    return options


def newest_flight():
    pages = sorted(pathlib.Path("flights").glob("*/flight.html"), key=lambda p: p.stat().st_mtime)
    if not pages:
        raise Fault("io_failed", "there is no flight in ./flights: fly one with tools/fly, or name "
                    "a folder", WRONG_CALL)
    return pages[-1].parent


def flight_page(folder):
    path = pathlib.Path(folder)
    file = path / "flight.html" if path.is_dir() else path
    try:
        page = file.read_bytes()
    except OSError as error:
        raise Fault("io_failed", f"{file} cannot be read ({error.strerror}): is it a flight folder?",
                    WRONG_CALL) from None
    return str(file), page


def live_page(prefix, bridge):
    file = pathlib.Path(prefix) / "share/goshawk/viewer/page.html"
    try:
        template = file.read_text(encoding="utf-8")
    except OSError as error:
        raise Fault("io_failed", f"{file} cannot be read ({error.strerror})") from None
    return template.replace(MARK, json.dumps({"live": True, "url": bridge}).replace("<", "\\u003c"))


def place_of(bridge):
    rest = bridge.removeprefix("ws://")
    host, _, port = rest.rstrip("/").rpartition(":")
    if rest == bridge or not host or not port.isdigit() or not 0 < int(port) < 65536:
        raise Fault("invalid_parameter", f"--bridge is like ws://127.0.0.1:8765, not '{bridge}'",
                    WRONG_CALL)
    return host, int(port)


def listens(place):
    try:
        with socket.create_connection(place, 0.5):
            return True
    except OSError:
        return False


def start_bridge(prefix, place):
    """Where nobody listens on this machine, a bridge of our own. @return the process, or None"""
    host, port = place
    if listens(place) or host not in ("127.0.0.1", "localhost"):
        return None
    process = subprocess.Popen([f"{prefix}/bin/goshawk_container", "viewer_bridge", "--ros-args",
                                "-p", f"port:={port}"], stdin=subprocess.DEVNULL,
                               stdout=sys.stderr)
    for _ in range(100):
        if process.poll() is not None:
            raise Fault("io_failed", "the bridge could not be started: see above")
        if listens(place):
            return process
        time.sleep(0.1)
    process.terminate()
    raise Fault("stage_silent", "the bridge does not listen after 10 s")


def handler_of(page):
    class Handler(http.server.BaseHTTPRequestHandler):
        """One page, for this machine alone."""
        server_version = "goshawk"

        def do_GET(self):
            found = self.path.split("?")[0] in ("/", "/index.html")
            body = page if found else b"there is one page here: /\n"
            self.send_response(200 if found else 404)
            self.send_header("Content-Type", "text/html; charset=utf-8" if found else "text/plain")
            self.send_header("Content-Length", str(len(body)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass
    return Handler


def open_browser(url):
    opener = shutil.which("xdg-open")
    if opener and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        subprocess.Popen([opener, url], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def serve(options, page, shown):
    try:
        server = http.server.ThreadingHTTPServer(("127.0.0.1", options.port), handler_of(page))
    except OSError as error:
        raise Fault("io_failed", f"port {options.port} cannot be had ({error.strerror}): "
                    "--port takes another, --port 0 any") from None
    url = f"http://127.0.0.1:{server.server_port}/"
    tell(options, {"ok": True, "code": "ok", "message": "", "url": url, "shows": shown})
    if not options.no_open:
        open_browser(url)
    done = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: done.set())
    threading.Thread(target=server.serve_forever, daemon=True).start()
    done.wait()
    server.shutdown()


def tell(options, result):
    if options.json:
        print(json.dumps(result), flush=True)
    elif result["ok"]:
        print(f"{result['shows']}\nopen {result['url']} in a browser; Ctrl-C ends" if result["url"]
              else result["shows"], flush=True)
    else:
        print(f"goshawk view: {result['code']}: {result['message']}", file=sys.stderr)


def run(options):
    bridge = None
    if options.live:
        place = place_of(options.bridge)
        shown = f"what flies now, by {options.bridge}"
        page = live_page(options.prefix, options.bridge).encode()
    else:
        shown, page = flight_page(options.folder or newest_flight())
    if options.check:
        tell(options, {"ok": True, "code": "ok", "message": "", "url": None, "shows": shown})
        return
    if options.live:
        bridge = start_bridge(options.prefix, place)
    try:
        serve(options, page, shown)
    finally:
        if bridge:
            bridge.terminate()
            bridge.wait()


def main():
    options = parse(sys.argv[1:])
    try:
        run(options)
    except Fault as fault:
        tell(options, {"ok": False, "code": fault.code, "message": str(fault)})
        return fault.status
    return DONE


if __name__ == "__main__":
    sys.exit(main())
