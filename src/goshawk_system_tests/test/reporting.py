"""Results of unittest in the form that CTest and colcon read."""

import re
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree


def printable(text):
    """Without the control characters that XML cannot hold."""
    return re.sub(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd]", "?", text)


class Report(unittest.TextTestResult):
    """Collects one <testcase> a test, and says how long each took."""

    def __init__(self, *arguments, **keywords):
        super().__init__(*arguments, **keywords)
        self.suite = ElementTree.Element("testsuite", name="system")
        self.begin = {}
        self.good = 0

    def startTest(self, test):
        self.begin[test] = time.monotonic()
        super().startTest(test)

    def add(self, test, tag=None, text=""):
        group, _, name = test.id().rpartition(".")
        seconds = time.monotonic() - self.begin.get(test, time.monotonic())
        case = ElementTree.SubElement(self.suite, "testcase", classname=group, name=name,
                                      time=f"{seconds:.3f}")
        if tag:
            text = printable(text)
            ElementTree.SubElement(case, tag, message=text.strip().split("\n")[-1]).text = text

    def addSuccess(self, test):
        super().addSuccess(test)
        self.good += 1
        self.add(test)

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        print(f"SKIPPED {test.id()}: {reason}", file=sys.stderr)
        self.add(test, "skipped", reason)

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self.add(test, "failure", self.failures[-1][1])

    def addError(self, test, err):
        super().addError(test, err)
        self.add(test, "error", self.errors[-1][1])

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)
        if err is not None:
            self.add(subtest, "failure", (self.failures + self.errors)[-1][1])
