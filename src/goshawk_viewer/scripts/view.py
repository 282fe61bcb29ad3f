#!/usr/bin/python3
"""goshawk view: shows a flight, a recording, or a live flight in a browser.

    goshawk view                     the newest flight in ./flights
    goshawk view FLIGHT_FOLDER       this flight
    goshawk view FILE.mcap           this recording
    goshawk view --live              the flight that is running; starts a bridge if none listens
    goshawk view --foxglove ...      the same in Foxglove Studio, with Goshawk's layout

Serves the page on this machine until Ctrl-C.
"""

import http.client
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import types

import page_server

DONE, NOT_DONE, WRONG_CALL = 0, 1, 2
MARK = "@FLIGHT@"
LARGEST_READ_FIRST = 64 << 20  # [byte] of a recording
AROUND = (5.0, 4.0, 1.0)  # [m] least half-size of a live picture


class Fault(Exception):
    def __init__(self, code, message, status=NOT_DONE):
        super().__init__(message)
        self.code, self.status = code, status


def read_options(text):
    """One JSON object, which goshawk_cli writes (verbs/view.cpp)."""
    return types.SimpleNamespace(**json.loads(text))


def newest_flight():
    pages = sorted(pathlib.Path("flights").glob("*/flight.html"), key=lambda p: p.stat().st_mtime)
    if not pages:
        raise Fault("io_failed", "there is no flight in ./flights: fly one with tools/fly, or name "
                    "a folder", WRONG_CALL)
    return pages[-1].parent


def readable(file):
    """@return the file; raises a Fault if it cannot be read"""
    try:
        with open(file, "rb") as opened:
            opened.read(1)
    except OSError as error:
        raise Fault("io_failed", f"{file} cannot be read ({error.strerror}): is it a flight folder, "
                    "or a recording?", WRONG_CALL) from None
    return file


def part_of(what, name):
    """@return the file of that name in a flight folder, or the file itself"""
    path = pathlib.Path(what or newest_flight())
    return readable(path / name if path.is_dir() else path)


def page_of_recording(prefix, recording, template=None):
    """@return the bytes of a page that is made from a recording alone"""
    with tempfile.TemporaryDirectory(prefix="goshawk_view_") as folder:
        page = pathlib.Path(folder) / "flight.html"
        template = template or f"{prefix}/share/goshawk/viewer/page.html"
        made = subprocess.run([f"{prefix}/lib/goshawk/recording_page", str(recording),
                               template, str(page)],
                              stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if made.returncode != 0:
            code, _, sentence = made.stderr.strip().rpartition("\n")[2].partition(": ")
            raise Fault(code or "io_failed", sentence or "the recording cannot be shown",
                        WRONG_CALL if code in ("io_failed", "invalid_input") else NOT_DONE)
        sys.stderr.write(made.stderr)  # what is missing in it
        return page.read_bytes()


def places_flown(prefix, recording):
    """@return where the recorded flight was, to point the camera: [[x, y, z], ...]"""
    if recording.stat().st_size > LARGEST_READ_FIRST:
        return []
    try:
        with tempfile.NamedTemporaryFile("w", suffix=".html") as template:
            template.write(MARK)
            template.flush()
            flight = json.loads(page_of_recording(prefix, recording, template.name))
    except (Fault, ValueError):
        return []  # the studio itself says what it cannot read
    track = flight["flown"]["p"]
    places = [track[k:k + 3] for k in range(0, len(track), 3)]
    for leg in flight["legs"]:
        places += leg["waypoints"]
    return places[::max(1, len(places) // 60)]


def place_now(prefix):
    """@return corners around the vehicle of this domain; [] if no odometry comes within 3 s"""
    asked = subprocess.run([f"{prefix}/bin/goshawk", "topic", "echo", "odom", "--once", "--json",
                            "--timeout", "3"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                           stderr=subprocess.DEVNULL, text=True)
    try:
        p = json.loads(asked.stdout)["pose"]["pose"]["position"]
    except (ValueError, KeyError):
        return []
    return [[p["x"] + x, p["y"] + y, p["z"] + AROUND[2]] for x in (-AROUND[0], AROUND[0])
            for y in (-AROUND[1], AROUND[1])]


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
        raise Fault("invalid_parameter", f"--bridge must look like ws://127.0.0.1:8765, not '{bridge}'",
                    WRONG_CALL)
    return host, int(port)


def listens(place):
    try:
        with socket.create_connection(place, 0.5):
            return True
    except OSError:
        return False


def refusal(place, origin):
    """@return why the bridge would refuse a page of this origin, or None; None if none answers"""
    link = http.client.HTTPConnection(*place, timeout=3)
    try:
        link.request("GET", "/", headers={
            "Connection": "Upgrade", "Upgrade": "websocket", "Origin": origin,
            "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "Z29zaGF3ayB2aWV3IGxpdg==",
            "Sec-WebSocket-Protocol": "foxglove.websocket.v1"})
        answer = link.getresponse()
        return None if answer.status == 101 else answer.read(500).decode(errors="replace").strip()
    except (OSError, http.client.HTTPException):
        return None
    finally:
        link.close()


def bridge_for(options, place, page_port):
    """Makes sure that the page finds a bridge: one that listens must let the page in; on this
    machine, one is started if none listens. @return the process that was started, or None"""
    host, port = place
    if listens(place):
        why = refusal(place, f"http://127.0.0.1:{page_port}")
        if why:
            raise Fault("invalid_parameter", f"the bridge at {options.bridge} refuses this page: {why}")
        return None
    if host not in ("127.0.0.1", "localhost"):
        return None
    origins = f"http://127.0.0.1:{page_port},http://localhost:{page_port}"
    process = subprocess.Popen([f"{options.prefix}/bin/goshawk_container", "viewer_bridge",
                                "--ros-args", "-p", f"port:={port}", "-p", f"origins:={origins}"],
                               stdin=subprocess.DEVNULL, stdout=sys.stderr)
    for _ in range(100):
        if process.poll() is not None:
            raise Fault("io_failed", "the bridge could not be started: see above")
        if listens(place):
            return process
        time.sleep(0.1)
    process.terminate()
    raise Fault("stage_silent", "the bridge does not listen after 10 s")


def open_browser(url):
    opener = shutil.which("xdg-open")
    if opener and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        subprocess.Popen([opener, url], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def start_server(options, site):
    try:
        return page_server.start(site, options.port)
    except OSError as error:
        raise Fault("io_failed", f"port {options.port} cannot be used ({error.strerror}): "
                    "--port takes another, --port 0 any") from None


def serve_until_told(options, server, shown):
    url = f"http://127.0.0.1:{server.server_port}/"
    tell(options, {"ok": True, "code": "ok", "message": "", "url": url, "shows": shown})
    if not options.no_open:
        open_browser(url)
    done = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: done.set())
    done.wait()


def tell(options, result):
    if options.json:
        print(json.dumps(result), flush=True)
    elif result["ok"]:
        print(f"{result['shows']}\nopen {result['url']} in a browser; Ctrl-C ends" if result["url"]
              else result["shows"], flush=True)
    else:
        print(f"goshawk view: {result['code']}: {result['message']}", file=sys.stderr)


def own_site(options):
    """Our own page. @return what is served, and what it shows"""
    site = page_server.Site()
    if options.live:
        site.add("/", live_page(options.prefix, options.bridge).encode())
        return site, f"the flight at {options.bridge}"
    file = part_of(options.what, "flight.html")
    is_page = file.suffix == ".html"
    site.add("/", file.read_bytes() if is_page else page_of_recording(options.prefix, file))
    return site, str(file)


def foxglove_site(options):
    """Foxglove Studio, our layout, and the recording. @return what is served, and what it shows"""
    share = pathlib.Path(options.prefix) / "share/goshawk/viewer"
    site = page_server.Site()
    files = studio_files(options.prefix)
    for name, file in files.items():
        site.add(name, without_source_map(file))
    site.add_folder("/assets/", files["/assets/index.js"].parent)
    site.add("/layout.json", share / "foxglove_layout.json")
    site.add_folder("/", share / "studio")
    site.add("/", (share / "studio/index.html").read_bytes())
    if options.live:
        shown, source = f"the flight at {options.bridge}", {"bridge": options.bridge}
        source["places"] = [] if options.check else place_now(options.prefix)
    else:
        recording = part_of(options.what, "flight.mcap")
        shown, source = str(recording), {"recording": "/recording.mcap"}
        source["places"] = [] if options.check else places_flown(options.prefix, recording)
        site.add("/recording.mcap", recording)
    site.add("/show.json", json.dumps(source).encode())
    return site, f"{shown}, in Foxglove Studio"


def without_source_map(script):
    """The second half of the studio's largest script is a source map."""
    text = script.read_bytes()
    mark = text.rfind(b"\n//# sourceMappingURL=data:")
    return text if mark < 0 else text[:mark]


def studio_files(prefix):
    """@return Foxglove Studio's files from npm, by their names on the page"""
    modules = pathlib.Path(os.environ.get("GOSHAWK_NODE_MODULES") or
                           pathlib.Path(prefix).parent / "build/node/node_modules")
    files = {"/assets/index.js": modules / "@foxglove/studio-base/assets/index.js",
             "/react.js": modules / "react/umd/react.production.min.js",
             "/react-dom.js": modules / "react-dom/umd/react-dom.production.min.js"}
    for file in files.values():
        if not file.is_file():
            raise Fault("io_failed", f"Foxglove Studio is not installed ({file} is missing): "
                        "tools/setup --viewer installs it, or leave --foxglove out")
    return files


def run(options):
    place = place_of(options.bridge) if options.live else None
    site, shown = (foxglove_site if options.foxglove else own_site)(options)
    if options.check:
        tell(options, {"ok": True, "code": "ok", "message": "", "url": None, "shows": shown})
        return
    server = start_server(options, site)
    bridge = None
    try:
        bridge = bridge_for(options, place, server.server_port) if options.live else None
        serve_until_told(options, server, shown)
    finally:
        server.shutdown()
        if bridge:
            bridge.terminate()
            bridge.wait()


def main():
    options = read_options(sys.argv[1])
    try:
        run(options)
    except Fault as fault:
        tell(options, {"ok": False, "code": fault.code, "message": str(fault)})
        return fault.status
    return DONE


if __name__ == "__main__":
    sys.exit(main())
