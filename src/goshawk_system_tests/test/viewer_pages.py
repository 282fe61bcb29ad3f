"""What the page of a flight holds, read without the page's own code."""

import base64
import json


def page_data(page):
    """What a page draws, from the page."""
    text = page.read_text(encoding="utf-8")
    mark = '<script type="application/json" id="flight">'
    begin = text.index(mark) + len(mark)
    return json.loads(text[begin:text.index("</script>", begin)])


def set_voxels(runs):
    """@return numbers of the voxels that are set, of alternating lengths: LEB128, base64"""
    voxels, at, value, length, shift = set(), 0, False, 0, 0
    for byte in base64.b64decode(runs):
        length |= (byte & 127) << shift
        shift += 7
        if byte & 128:
            continue
        if value:
            voxels.update(range(at, at + length))
        at, value, length, shift = at + length, not value, 0, 0
    return voxels


def voxels_after(growth, moments):
    """@return known voxels and obstacles after so many moments"""
    known, obstacles = set(), set()
    for moment in growth["moments"][:moments]:
        known ^= set_voxels(moment["known"])
        obstacles ^= set_voxels(moment["obstacles"])
    return known, obstacles
