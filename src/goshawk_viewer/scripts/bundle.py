#!/usr/bin/python3
"""Joins page, style, scripts and three.js into one file that needs nothing else.

    bundle.py PAGE_FOLDER THREE_FOLDER STUDIO_FOLDER PAGE_OUTPUT MESSAGES_OUTPUT

MESSAGES_OUTPUT is the script with which Foxglove Studio draws our messages.
"""

import pathlib
import sys

SCRIPTS = ["geometry.js", "theme.js", "world.js", "map_meshes.js", "map_layers.js", "parts.js",
           "vehicle.js", "sight.js", "scene.js", "plots.js", "panel.js", "flight.js", "cdr.js",
           "octomap.js", "messages.js", "foxglove.js", "glance.js", "saved.js",
           "live.js", "aim.js", "start.js"]
MESSAGES = ["geometry.js", "theme.js", "world.js", "parts.js", "messages.js", "octomap.js",
            "sight.js"]
THREE = ["three.min.js", "examples/js/controls/OrbitControls.js",
         "examples/js/lines/LineSegmentsGeometry.js", "examples/js/lines/LineGeometry.js",
         "examples/js/lines/LineMaterial.js", "examples/js/lines/LineSegments2.js",
         "examples/js/lines/Line2.js"]
NOTICE = """/*
three.js and its examples (controls, lines): The MIT License

Copyright (c) 2010-2019 three.js authors

Permission is hereby granted, free of charge, to any person obtaining a copy of this software and
associated documentation files (the "Software"), to deal in the Software without restriction,
including without limitation the rights to use, copy, modify, merge, publish, distribute,
sublicense, and/or sell copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all copies or
substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT
NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND
NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM,
DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT
OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.
*/
"""


def joined(folder, names):
    texts = [(folder / name).read_text(encoding="utf-8") for name in names]
    # A script must not hold the end of its element.
    return "\n;\n".join(texts).replace("</script", "<\\/script")


def main():
    page, three, studio, output, messages = map(pathlib.Path, sys.argv[1:])
    missing = [name for name in THREE if not (three / name).is_file()]
    if missing:
        sys.exit(f"{missing[0]} is missing in {three}: install libjs-three")
    text = (page / "page.html").read_text(encoding="utf-8")
    parts = {"@STYLE@": (page / "style.css").read_text(encoding="utf-8"),
             "@THREE@": NOTICE + joined(three, THREE), "@SCRIPTS@": joined(page, SCRIPTS)}
    for mark, part in parts.items():
        before, after = text.split(mark)
        text = before + part + after
    output.write_text(text, encoding="utf-8")
    messages.write_text(joined(page, MESSAGES) + joined(studio, ["messages.js"]), encoding="utf-8")


if __name__ == "__main__":
    main()
