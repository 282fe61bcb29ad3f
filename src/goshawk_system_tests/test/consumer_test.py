#!/usr/bin/python3
"""A user's own program on the installed libraries, compiled for other processors than they were."""

import os
import pathlib
import subprocess

import harness
from harness import SystemTest, note

CONSUMER = harness.SOURCE / "src" / "goshawk_system_tests" / "consumer"


def processor_has(flag):
    text = pathlib.Path("/proc/cpuinfo").read_text(errors="replace")
    return any(flag in line.split() for line in text.splitlines() if line.startswith("flags"))


class Consumer(SystemTest):
    """Eigen's alignment and allocation follow the processor that a program is compiled for: the
    libraries must not care."""

    def built_and_run(self, name, flags):
        build = self.sandbox.folder / name
        configure = ["cmake", "-S", str(CONSUMER), "-B", str(build), "-G", "Ninja",
                     f"-DCMAKE_PREFIX_PATH={harness.PREFIX}", f"-DCMAKE_CXX_FLAGS={flags}"]
        for call in (configure, ["cmake", "--build", str(build)]):
            done = subprocess.run(call, capture_output=True, text=True, timeout=300, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        environment = {**os.environ, "LD_LIBRARY_PATH": str(harness.PREFIX / "lib")}
        run = subprocess.run([build / "consumer"], capture_output=True, text=True, timeout=120,
                             check=False, env=environment)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        note(f"{name}: {run.stdout.strip()}")
        return run.stdout.splitlines()[0]

    def test_programs_for_any_processor_plan_the_same(self):
        plain = self.built_and_run("plain", "-O1")
        self.assertEqual(self.built_and_run("native", "-O1 -march=native"), plain)
        if processor_has("avx2"):
            self.assertEqual(self.built_and_run("avx2", "-O1 -mavx2 -mfma"), plain)
        else:
            note("this processor has no AVX2: not run")


if __name__ == "__main__":
    harness.main()
