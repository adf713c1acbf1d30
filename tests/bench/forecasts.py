#!/usr/bin/env python3
"""Forecast of `palpate import` against what `palpate touch` takes, with and without kept grids.

    tests/bench/forecasts.py build/release/bin/palpate "$PALPATE_SCANS"

Of each scan: the processor seconds that the import forecasts, those (user and system) that one tick
takes, and their ratio, first on an empty cache, then with all grids kept.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

SCANS = {
    "pelvis": ["pelvis/label.mhd", "--names", "pelvis/labels.csv", "--body", "pelvis/mask.mhd"],
    "abdomen": ["abdomen/example_seg.nii.gz", "--names", "abdomen/labels.csv"],
    "head and neck": ["head_neck/HN-Atlas-labels.nrrd", "--names", "head_neck/colors.ctbl"],
}


def run(arguments, cache):
    """Output, and the processor time that it took [s]."""

    def spent():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    before = spent()
    done = subprocess.run(
        arguments,
        env={**os.environ, "PALPATE_CACHE": cache},
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    return done.stdout, spent() - before


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    palpate, scans = sys.argv[1], Path(sys.argv[2])
    print("| scan | grids | kept | forecast, s | taken, s | taken / forecast |")
    print("|---|---|---|---|---|---|")
    for name, asked in SCANS.items():
        with tempfile.TemporaryDirectory() as folder:
            at = Path(folder)
            cache = str(at / "cache")
            path = at / "path.csv"
            path.write_text("t,x,y,z\n0,0,0,0\n")
            files = [a if a.startswith("--") else str(scans / a) for a in asked]
            scene = str(at / "scene.yaml")
            for _ in range(2):
                told, _ = run([palpate, "import", *files, "-o", scene, "--force", "--json"], cache)
                estimate = json.loads(told)["estimate"]
                touched, taken = run(
                    [palpate, "touch", scene, "--path", str(path), "--json"], cache
                )
                grids = json.loads(touched)["grids"]
                kept = sum(grid["was_kept"] for grid in grids)
                forecast = estimate["processor_seconds"]
                print(
                    f"| {name} | {len(grids)} | {kept} | {forecast:.2f} | {taken:.2f} "
                    f"| {taken / forecast:.2f} |",
                    flush=True,
                )


main()
