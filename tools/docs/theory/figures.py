#!/usr/bin/env python3
"""Draws the figures of the theory pages, each out of what `palpate` prints or writes.

    figures.py [PALPATE [NAME...]]   PALPATE: the command, build/release/bin/palpate if not given

Needs Debian's python3-numpy and python3-nibabel. Takes about a minute.
"""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import nibabel
import numpy

HERE = Path(__file__).resolve().parent
SCENES = HERE.parents[2] / "data/scenes"
COLORS = ("#0072b2", "#d55e00", "#009e73", "#7f7f7f")
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 560, 300, 74, 14, 12, 44


def thinned(points, least=0.4):
    """The points of a line that matter to the eye: none within `least` pixels of the line through its neighbors."""
    if len(points) < 3:
        return points
    (x0, y0), (x1, y1) = points[0], points[-1]
    length = math.hypot(x1 - x0, y1 - y0)

    def off(p):
        if length == 0.0:
            return math.hypot(p[0] - x0, p[1] - y0)
        return abs((x1 - x0) * (p[1] - y0) - (y1 - y0) * (p[0] - x0)) / length

    most = max(range(1, len(points) - 1), key=lambda n: off(points[n]))
    if off(points[most]) <= least:
        return [points[0], points[-1]]
    return thinned(points[: most + 1], least)[:-1] + thinned(points[most:], least)


class Axis:
    def __init__(self, values, log, begin, end, bounds=None):
        self.log = log
        low, high = bounds or (min(values), max(values))
        if log:
            low, high = math.floor(math.log10(low) + 1e-9), math.ceil(math.log10(high) - 1e-9)
            self.ticks = [10.0**n for n in range(low, high + 1, max(1, (high - low) // 6))]
        else:
            step = 10.0 ** math.floor(math.log10((high - low) / 3))
            step *= next(s for s in (1, 2, 5, 10) if (high - low) / (s * step) <= 7)
            low, high = math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step
            self.ticks = [low + n * step for n in range(round((high - low) / step) + 1)]
        self.low, self.high, self.begin, self.end = low, high, begin, end

    def at(self, value):
        value = math.log10(value) if self.log else value
        return self.begin + (value - self.low) / (self.high - self.low) * (self.end - self.begin)


def plot(name, about, x_label, y_label, lines, log=(False, False), bounds=(None, None), height=HEIGHT):
    """`lines`: (label, points, dashed or not[, with dots]); a label of None is not in the legend."""
    x = Axis([p[0] for line in lines for p in line[1]], log[0], LEFT, WIDTH - RIGHT, bounds[0])
    y = Axis([p[1] for line in lines for p in line[1]], log[1], height - BOTTOM, TOP, bounds[1])
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
           'font-family="sans-serif" font-size="12">',
           f"<title>{about}</title>", f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
           '<g stroke="#dddddd">']
    out += [f'<path d="M{x.at(t):.1f} {TOP}V{height - BOTTOM}"/>' for t in x.ticks]
    out += [f'<path d="M{LEFT} {y.at(t):.1f}H{WIDTH - RIGHT}"/>' for t in y.ticks]
    out.append("</g>")
    out += [f'<text x="{x.at(t):.1f}" y="{height - BOTTOM + 16}" text-anchor="middle">{t:.4g}</text>' for t in x.ticks]
    out += [f'<text x="{LEFT - 6}" y="{y.at(t) + 4:.1f}" text-anchor="end">{t:.4g}</text>' for t in y.ticks]
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2:.0f}" y="{height - 8}" text-anchor="middle">{x_label}</text>')
    out.append(f'<text x="14" y="{(TOP + height - BOTTOM) / 2:.0f}" text-anchor="middle" '
               f'transform="rotate(-90 14 {(TOP + height - BOTTOM) / 2:.0f})">{y_label}</text>')
    legend = 0
    for number, (label, points, dashed, *dots) in enumerate(lines):
        color = COLORS[number % len(COLORS)]
        dash = ' stroke-dasharray="5 4"' if dashed else ""
        drawn = thinned([(x.at(a), y.at(b)) for a, b in points])
        path = "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in drawn)
        out.append(f'<path d="{path}" fill="none" stroke="{color}" stroke-width="1.6"{dash}/>')
        if dots:
            out += [f'<circle cx="{x.at(a):.1f}" cy="{y.at(b):.1f}" r="3" fill="{color}"/>' for a, b in points]
        if label:
            top = TOP + 14 + 16 * legend
            out.append(f'<path d="M{LEFT + 8} {top - 4}h22" stroke="{color}" stroke-width="1.6"{dash}/>'
                       f'<text x="{LEFT + 36}" y="{top}">{label}</text>')
            legend += 1
    (HERE / f"{name}.svg").write_text("\n".join(out) + "\n</svg>\n")
    print(f"{name}.svg {(HERE / f'{name}.svg').stat().st_size} bytes")


class Command:
    def __init__(self, program, folder):
        self.program, self.folder = program, Path(folder)

    def run(self, *words):
        result = subprocess.run([self.program, *map(str, words), "--quiet"], cwd=self.folder, text=True,
                                capture_output=True, check=False)
        if result.returncode != 0:
            raise SystemExit(f"palpate {' '.join(map(str, words))}\n{result.stderr}")
        return result.stdout

    def json(self, *words):
        return json.loads(self.run(*words, "--json"))

    def file(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def touch(self, *words):
        """The trace of a touch, a column each."""
        self.run("touch", *words, "--trace", "trace.csv", "--force")
        return numpy.genfromtxt(self.folder / "trace.csv", delimiter=",", names=True, dtype=None, encoding=None)


def direction(trace):
    """[degrees] of the force from straight up, towards x."""
    return numpy.degrees(numpy.arctan2(trace["force_x"], trace["force_z"]))


def contact(palpate):
    scene = palpate.file("box.yaml", "{palpate: 1, length: mm, "
                         "layers: [{name: box, inside: {box: {center: [0, 0, 0], size: [40, 40, 40]}}}]}")
    trace = palpate.touch(scene, "--insert", "-15,0,26", "-12,0,17", "25,0,17", "25,0,2", "14,0,-2", "14,0,-16")
    box = [(-20, -20), (-20, 20), (20, 20), (20, -20)]
    lines = [("hand", list(zip(1e3 * trace["hip_x"], 1e3 * trace["hip_z"])), True),
             ("proxy", list(zip(1e3 * trace["proxy_x"], 1e3 * trace["proxy_z"])), False),
             (None, box, False)]
    plot("contact", "A hand goes through a box, the proxy around it", "x, mm", "z, mm", lines,
         bounds=((-30, 40), (-20, 30)), height=400)


def force(palpate):
    trace = palpate.touch(SCENES / "crease.yaml", "--insert", "-3,0,6", "-3,0,-2", "3,0,-2", "--speed", "5mm/s")
    trace = trace[(trace["hip_z"] < -1.9999e-3)]
    x = 1e3 * trace["hip_x"]
    strength = numpy.sqrt(sum(trace[f"force_{a}"] ** 2 for a in "xyz"))
    apart = numpy.sqrt(sum((trace[f"proxy_{a}"] - trace[f"hip_{a}"]) ** 2 for a in "xyz"))
    plot("force", "The force along a stroke below a groove of two stiffnesses", "x of the hand, mm", "force, N",
         [("felt", list(zip(x, strength)), False),
          ("1000 N/m times the way to the proxy", list(zip(x, 1e3 * apart)), True),
          ("3000 N/m times that", list(zip(x, 3e3 * apart)), True)])


def friction(palpate):
    scene = palpate.file("rough.yaml", """{palpate: 1, length: mm,
      materials: {felt: {stiffness: 1000 N/m, friction: {static: 0.4, kinetic: 0.25}}},
      layers: [{name: floor, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: felt}]}""")
    trace = palpate.touch(scene, "--insert", "0,0,3", "0,0,-2", "4,0,-2", "2,0,-2", "--speed", "10mm/s")
    trace = trace[trace["hip_z"] < -1.9999e-3]
    plot("friction", "The force along a floor with friction", "x of the hand, mm", "force along the floor, N",
         [(None, list(zip(1e3 * trace["hip_x"], -trace["force_x"])), False)])


def ports(palpate):
    (palpate.folder / "data").symlink_to(SCENES.parent)  # the picture names the scene as it was given
    palpate.run("explain", "data/scenes/composite_tube.yaml", "--svg", HERE / "ports.svg", "--force")


def needle(palpate):
    trace = palpate.touch(SCENES / "slab.yaml", "--insert", "0,0,5", "0,0,-25", "--back", "--speed", "10mm/s")
    turn = numpy.argmin(trace["hip_z"])
    pushed = list(zip(-1e3 * trace["hip_z"], trace["force_z"]))
    plot("needle", "A needle goes through skin, fat and muscle, and is drawn out", "depth of the hand, mm",
         "force against the way in, N", [("in", pushed[:turn], False), ("out", pushed[turn:], False)])


def around(radius, degrees, y=0):
    """The point of a circle about the y axis, as the command takes it."""
    return f"{radius * math.sin(math.radians(degrees))},{y},{radius * math.cos(math.radians(degrees))}"


def stroke_over(palpate, scene, options, radius, most, y=0):
    """A stroke from -most to most [degrees] along a circle of `radius`: direction of the hand, and of the force."""
    arc = [around(radius, degrees, y) for degrees in numpy.arange(-most, most + 0.1, 1)]
    trace = palpate.touch(scene, *options, "--insert", around(radius + 7, -most, y), *arc, "--speed", "20mm/s")
    trace = trace[trace["contact"] == 1]
    angle = numpy.degrees(numpy.arctan2(trace["hip_x"], trace["hip_z"]))
    inside = numpy.abs(angle) < most - 5
    return angle[inside], direction(trace)[inside]


def shading(palpate):
    faces = []
    for n in range(24):
        x, z = math.sin(math.radians(15 * n + 7.5)), math.cos(math.radians(15 * n + 7.5))
        faces.append(f"{{half_space: {{point: [{20 * x}, 0, {20 * z}], normal: [{x}, 0, {z}]}}}}")
    lines = []
    for label, shade in (("24 flat facets", 0), ("the same with shading: 5", 5)):
        scene = palpate.file("prism.yaml", f"""{{palpate: 1, length: mm,
          materials: {{wood: {{stiffness: 1000 N/m, shading: {shade}}}}},
          layers: [{{name: prism, inside: {{intersection: [{", ".join(faces)},
            {{box: {{center: [0, 0, 0], size: [60, 60, 60]}}}}]}}, wall: wood}}]}}""")
        lines.append((label, list(zip(*stroke_over(palpate, scene, [], 18.5, 35))), False))
    lines.append(("a round rod", [(-30, -30), (30, 30)], True))
    plot("shading", "The direction of the force on a stroke round a prism of 24 facets",
         "direction of the hand, degree", "direction of the force, degree", lines)


def sampling(palpate):
    lines = []
    report = palpate.json("accuracy", SCENES / "reference.yaml", "--field", "torus", "--ladder", "2,1,0.5",
                          "--sampler", "cubic", "--sampler", "trilinear", "--points", "8000", "--repeat", "1")
    for sampler in ("cubic", "trilinear"):
        points = []
        for grid in report["results"][0]["grids"]:
            for each in grid["samplers"]:
                if each["sampler"] == sampler:
                    points.append((1e3 * grid["voxel_size_m"], each["smooth"]["normal_error_degrees"]["rms"]))
        lines.append((sampler, points, False, True))
    plot("sampling", "Error of the normal over the voxel size, torus of 35 and 15 mm", "voxel, mm",
         "error of the normal, degree RMS", lines, log=(True, True))


CUBE = """v -20 -20 -20\nv 20 -20 -20\nv 20 20 -20\nv -20 20 -20
v -20 -20 20\nv 20 -20 20\nv 20 20 20\nv -20 20 20
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""


def meshes(palpate):
    palpate.file("cube.obj", CUBE)
    lines = []
    for label, keys in (("flat faces as they are", ""), ("a grid of 1 mm", ", edges: rounded, voxel: 1"),
                        ("a grid of 2 mm", ", edges: rounded, voxel: 2")):
        scene = palpate.file("cube.yaml", "{palpate: 1, length: mm, "
                             f"layers: [{{name: cube, inside: {{mesh: {{file: cube.obj{keys}}}}}}}]}}")
        trace = palpate.touch(scene, "--insert", "10,3,24", "10,3,19", "19.9,3,19", "--speed", "10mm/s")
        trace = trace[(trace["hip_z"] < 19.0001e-3) & (trace["proxy_x"] > 16e-3)]
        lines.append((label, list(zip(1e3 * trace["proxy_x"], 1e3 * trace["proxy_z"])), False))
    plot("meshes", "The way of the proxy on the top of a cube to its edge", "x of the proxy, mm",
         "z of the proxy, mm", lines, bounds=((16, 21), (19, 20.5)))


def implicit(palpate):
    grid = palpate.file("heart.yaml", """{palpate: 1, length: mm,
      fields: {heart: {heart: {center: [0, 0, 0], width: 60}}},
      layers: [{name: heart, inside: heart},
        {name: grid, inside: {baked: {field: heart, voxel: 0.5, half_width: 24, parts: whole}}}]}""")
    heights = [20 + 0.25 * n for n in range(57)]
    points = "x,y,z\n" + "\n".join(f"15,0,{z}" for z in heights) + "\n"
    palpate.file("points.csv", points)
    report = palpate.json("query", grid, "--points", "points.csv")
    values = {"heart": [], "grid": []}
    for z, point in zip(heights, report["points"]):
        for field in point["fields"]:
            if field["name"] in values and field["in_band"]:
                values[field["name"]].append((z, field["value"]))
    plot("implicit", "The heart's own function and the distance that a grid of it holds", "z, mm, at x = 15 mm",
         "value, mm", [("the function", values["heart"], False), ("its grid: the distance", values["grid"], True)])


def labels(palpate):
    axes = numpy.arange(64) - 31.5  # [mm] of voxel centers
    x, y, z = axes[:, None, None], axes[None, :, None], axes[None, None, :]
    ball = (x * x + y * y + z * z < 20.3**2).astype(numpy.uint8)
    affine = numpy.eye(4)
    affine[:3, 3] = axes[0]
    image = nibabel.Nifti1Image(ball, affine)
    image.header.set_xyzt_units("mm")
    image.to_filename(palpate.folder / "ball.nii.gz")
    lines = []
    for label, how in (("a threshold of the same voxels", ["--above", "0.5"]), ("the label", ["--labels", "1"])):
        hand, force_at = stroke_over(palpate, "ball.nii.gz", how, 19, 25, y=0.3)
        lines.append((label, list(zip(hand, force_at - hand)), False))
    plot("labels", "The direction of the force on a stroke over a ball made of voxels", "direction of the hand, degree",
         "force off the ball's, degree", lines)


def energy(palpate):
    points = []
    for speed in (100, 50, 20, 10, 5, 2, 1):
        report = palpate.json("touch", SCENES / "crease.yaml", "--insert", "0,0,6", "1.2,0,-2", "0,0,-0.8", "-1.2,0,-2",
                              "0,0,-3.2", "1.2,0,-2", "0,0,6", "--speed", f"{speed}mm/s")
        points.append((speed, 1e3 * report["work_on_hand_J"]))
    plot("energy", "Work of the held forces on a hand that goes round a closed way",
         "speed of the hand, mm/s, at 1 kHz", "work on the hand, mJ", [("of the held forces", points, False, True)], log=(True, True))


def falcon_slope(p):
    """Rows: d angle / d position of the three thighs (Stamper 1997, equations 3.1 to 3.9), as kinematics.cpp has it."""
    a, b, c, d, f, r, s = 0.060, 0.1025, 0.01443, 0.0225, -0.025, 0.0400, -0.02309
    rows = []
    for degrees in (105, -15, -135):
        ca, sa = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        u, v, w = ca * p[0] + sa * p[1] - r, -sa * p[0] + ca * p[1] - s, p[2]
        tilt = (v + f) / b
        if abs(tilt) >= 1.0:
            return None
        sine = math.sqrt(1.0 - tilt * tilt)
        reach, across = d + b * sine, u + c
        square = w * w + across * across
        knee = (square + a * a - reach * reach) / (2.0 * a * math.sqrt(square))
        if abs(knee) >= 1.0:
            return None
        angle = math.atan2(w, across) - math.acos(knee)
        shin = math.atan2(w - a * math.sin(angle), across - a * math.cos(angle))
        bend = a * sine * math.sin(shin - angle)
        along = (math.cos(shin) * sine, math.sin(shin) * sine)
        rows.append(numpy.array([along[0] * ca - tilt * sa, along[0] * sa + tilt * ca, along[1]]) / bend)
    return numpy.array(rows)


def kinematics(_palpate):
    lines = []
    for z in (90, 110, 130):
        points = []
        for n in range(-60, 61):
            slope = falcon_slope((1e-3 * n, 0.0, 1e-3 * z))
            if slope is not None:
                values = numpy.linalg.svd(slope, compute_uv=False)
                if values[0] / values[-1] < 10.0:
                    points.append((n, values[0] / values[-1]))
        lines.append((f"z = {z} mm", points, False))
    plot("kinematics", "How uneven the arms of a Falcon are", "x of the grip, mm",
         "largest over smallest singular value", lines)


FIGURES = (contact, force, friction, ports, needle, shading, sampling, meshes, implicit, labels, energy, kinematics)


def main(given):
    program = str(Path(given[0] if given else HERE.parents[2] / "build/release/bin/palpate").resolve())
    with tempfile.TemporaryDirectory(prefix="palpate_theory_") as folder:
        for figure in FIGURES:
            if not given[1:] or figure.__name__ in given[1:]:
                figure(Command(program, folder))


if __name__ == "__main__":
    main(sys.argv[1:])
