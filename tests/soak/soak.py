#!/usr/bin/python3
"""A long touch in real time while grids are baked, and what must hold of it.

  tests/soak/soak.py [--seconds 600] [--palpate build/release/bin/palpate] [--keep FOLDER]

A hand on the simulated Excalibur goes in and out of the scanned head (data/scenes/head.yaml) at 1 kHz by the clock,
along the needle's way and against the dura beside it, while another palpate bakes grids on every core, again and again.
Reported: overruns, how late turns began (50 %, 99.9 %, most), ticks, memory. It fails (exit status 1) if
  - a force is not finite, or longer than the device's maximum;
  - a tick is missing in the record;
  - the process's memory grows by half of what one forgotten block in each tick would take;
  - the record is not felt anew bit for bit;
  - no bake ended meanwhile.
How late turns were is this machine's, and is not judged.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE = ROOT / "data/scenes/head.yaml"
RATE = 1000  # [Hz]
# Corners of the path: when the hand is there [s], how far along the needle's direction, and how far
# beside it [m]. To the thalamus and back, then beside the opening in the dura and back against it
# from inside.
BEGIN = numpy.array([-0.100, -0.042, 0.060])
END = numpy.array([-0.012, -0.018, 0.008])
ALONG = (END - BEGIN) / numpy.linalg.norm(END - BEGIN)
ASIDE = numpy.array([0.24, -0.88, 0.0]) / math.hypot(0.24, 0.88)
CORNERS = [(0.0, 0.012, 0.0), (1.5, 0.097, 0.0), (3.0, 0.058, 0.0), (3.5, 0.058, 0.014), (4.5, 0.020, 0.014),
           (5.0, 0.020, 0.014), (6.0, 0.058, 0.014), (6.5, 0.058, 0.0), (8.0, 0.012, 0.0)]
PERIOD = CORNERS[-1][0]
SMALLEST_BLOCK = 32  # [bytes] of malloc


def write_path(file, seconds):
    """Rounds until the time is over, with a tremor of 0.2 mm at 9 Hz that never repeats with them."""
    t = numpy.arange(int(seconds * RATE) + 1) / RATE
    times, along, aside = numpy.array(CORNERS).T
    in_round = numpy.mod(t, PERIOD)
    tremor = 2e-4 * numpy.sin(2 * math.pi * 9.1 * t)
    place = (BEGIN + numpy.outer(numpy.interp(in_round, times, along) + tremor, ALONG)
             + numpy.outer(numpy.interp(in_round, times, aside) + tremor, ASIDE))
    with open(file, "w") as out:
        out.write("t,x,y,z\n")
        for row in zip(t, *place.T):
            out.write("%.17g,%.17g,%.17g,%.17g\n" % row)


def memory_of(process):
    """[bytes] that are in memory and this process's own; None once it is over."""
    try:
        with open(f"/proc/{process}/smaps_rollup") as file:
            for line in file:
                if line.startswith("Anonymous:"):
                    return 1024 * int(line.split()[1])
    except OSError:
        pass
    return None


class Bakes:
    """One bake after the other, on every core."""

    def __init__(self, palpate, folder):
        self.command = [palpate, "bake", str(ROOT / "data/scenes/reference.yaml"), "-o", str(folder / "baked.vdb"),
                        "--voxel", "0.4", "--force"]
        self.done = 0
        self.process = None

    def go_on(self):
        if self.process is not None and self.process.poll() is None:
            return
        if self.process is not None:
            if self.process.returncode != 0:
                sys.exit("a bake failed: " + " ".join(self.command))
            self.done += 1
        # No grid is taken from the cache, so that each bake is real work.
        self.process = subprocess.Popen(self.command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                        env={**os.environ, "PALPATE_CACHE": ""})

    def end(self):
        if self.process is not None and self.process.poll() is None:
            self.process.terminate()
            self.process.wait()


def touch(palpate, folder, seconds):
    """Runs it beside the bakes. Its report, samples of its memory (s since it began, bytes), the number of bakes."""
    record = folder / "felt.npy"
    record.unlink(missing_ok=True)
    command = [palpate, "touch", str(SCENE), "--device", "virtual:excalibur", "--path", str(folder / "way.csv"),
               "--realtime", "--record", str(record), "--states", "60000", "--force", "--json"]
    # The head's grids are made first, so that the time is spent in the loop.
    subprocess.run([palpate, "explain", str(SCENE), "--json"], check=True, stdout=subprocess.DEVNULL)
    with open(folder / "report.json", "w") as out, open(folder / "talk.txt", "w") as talk:
        process = subprocess.Popen(command, stdout=out, stderr=talk)
        bakes = Bakes(palpate, folder)
        begun = None
        samples = []
        while process.poll() is None:
            bakes.go_on()
            time.sleep(0.5)
            if begun is None and record.exists() and record.stat().st_size > 100_000:
                begun = time.monotonic()
            memory = memory_of(process.pid)
            if begun is not None and memory is not None:
                samples.append((time.monotonic() - begun, memory))
        bakes.end()
    if process.returncode != 0:
        sys.exit((folder / "talk.txt").read_text() + (folder / "report.json").read_text())
    return json.loads((folder / "report.json").read_text()), samples, bakes.done


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--palpate", default=str(ROOT / "build/release/bin/palpate"))
    parser.add_argument("--keep", help="a folder for the record and the report; without it they are removed")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(options.keep or scratch)
        folder.mkdir(parents=True, exist_ok=True)
        write_path(folder / "way.csv", options.seconds)
        report, samples, bakes = touch(options.palpate, folder, options.seconds)

        failures = []
        rows = numpy.load(folder / "felt.npy", mmap_mode="r", allow_pickle=False)
        most = report["device"]["max_force_N"]["value"]
        longest = 0.0
        finite = True
        for begin in range(0, len(rows), 50_000):
            part = rows[begin:begin + 50_000]
            for name in ("force", "device_force", "written_force"):
                finite = finite and bool(numpy.isfinite(part[name]).all())
            longest = max(longest, float(numpy.linalg.norm(part["written_force"], axis=1).max()))
        if not finite:
            failures.append("a force is not finite")
        if longest > most * (1.0 + 1e-12):
            failures.append(f"a force of {longest} N is longer than {most} N")
        if longest < 1.0:
            failures.append(f"hardly anything was felt: {longest} N at most")
        if not (numpy.diff(rows["tick"]) == 1).all() or rows["tick"][0] != 0:
            failures.append("ticks are missing in the record")

        # All memory that is needed for the whole run is allocated after a tenth of it.
        settled = [each for each in samples if each[0] > 0.1 * options.seconds]
        growth = max(m for _, m in settled) - settled[0][1]
        permitted = SMALLEST_BLOCK / 2 * RATE * (settled[-1][0] - settled[0][0])
        if growth > permitted:
            failures.append(f"memory grew by {growth} bytes, of {permitted:.0f} permitted")
        if bakes < 1:
            failures.append("no bake ended meanwhile")

        replay = subprocess.run([options.palpate, "replay", str(folder / "felt.npy"), "--json"],
                                capture_output=True, text=True)
        again = json.loads(replay.stdout) if replay.stdout else {}
        if replay.returncode != 0:
            failures.append("the record is not felt anew bit for bit: " + replay.stdout + replay.stderr)

        late = report["realtime"]["late_ns"]
        asked = int(options.seconds * RATE) + 1
        print(f"ticks        {len(rows)} in {report['seconds']:.1f} s, of {asked} of the path")
        print(f"overruns     {report['realtime']['overruns']}, real-time priority {report['realtime']['elevated']}")
        print("late         50 %%: %.1f us, 99 %%: %.1f us, 99.9 %%: %.1f us, at most %.1f us"
              % tuple(1e-3 * late[each] for each in ("p50", "p99", "p999", "max")))
        work = report["realtime"]["work_ns"]
        print("turn         50 %%: %.1f us, 99.9 %%: %.1f us, at most %.1f us"
              % tuple(1e-3 * work[each] for each in ("p50", "p999", "max")))
        print(f"force        {'all finite' if finite else 'not finite'}, at most {longest:.2f} N of {most:g} N")
        print(f"memory       {settled[0][1] / 1e6:.2f} MB, grew by {growth / 1e3:.1f} kB, "
              f"of {permitted / 1e3:.0f} kB permitted")
        print(f"bakes        {bakes} beside it")
        print(f"felt anew    {again.get('compared')} ticks, {again.get('different')} different")
        for failure in failures:
            print("FAILED: " + failure)
        sys.exit(1 if failures else 0)


main()
