"""Objects of boxes that lie on themselves after a turn, and ones that nearly do: which are registered, and rightly?

Each is sampled twice all around with 1,500 to 50,000 points (the same number, log-uniform) and noise of 0.3 mm, a room from
one corner, where points grow rarer with the square of their distance. One of the two clouds is moved at random. Right is
what comes within 5 degrees and 3 voxels of that motion; what turns lay on itself comes out turned as often as not. Prints
a row an object.

usage: turned_objects.py IGSP [--pairs 30] [--only NAME]
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from covariance import write_ply
from scipy.spatial.transform import Rotation

NOISE = 0.0003  # m


def box(centre, size, turned_deg=0):
    return np.array(centre, float), np.array(size, float), np.radians(turned_deg)


def legs(number):
    return [box((0.4, 0, 0), (0.6, 0.12, 0.2), 360 / number * i) for i in range(number)]


def table(length, width):
    posts = [box((x * (length / 2 - 0.05), y * (width / 2 - 0.05), 0.35), (0.06, 0.06, 0.7)) for x in (-1, 1) for y in (-1, 1)]
    return [box((0, 0, 0.72), (length, width, 0.03)), *posts]


CHAIR = [box((0, 0, 0.45), (0.45, 0.45, 0.04)), box((0, 0.21, 0.75), (0.45, 0.03, 0.5)),
         *[box((x * 0.2, y * 0.2, 0.22), (0.04, 0.04, 0.44)) for x in (-1, 1) for y in (-1, 1)]]
ROOM = [box((0, 0, 1.35), (6, 6, 2.7))]
WARDROBE = box((1, 2.68, 1), (1.2, 0.6, 2))

# Name: boxes, turns that lay it on itself, whether it is a room.
OBJECTS = {
    "table 1.6 x 0.9": (table(1.6, 0.9), 2, False),
    "bench": ([box((0, 0, 0.44), (1.5, 0.4, 0.05)), *[box((x, 0, 0.21), (0.08, 0.36, 0.42)) for x in (-0.6, 0.6)]], 2, False),
    "box 1 x 0.7 x 0.4": ([box((0, 0, 0), (1, 0.7, 0.4))], 4, False),
    "H-beam": ([box((0, 0, z), (1.2, 0.3, 0.03)) for z in (-0.15, 0.15)] + [box((0, 0, 0), (1.2, 0.03, 0.27))], 4, False),
    "square table": (table(0.9, 0.9), 4, False),
    "cross with a post": ([box((0, 0, 0), (1.2, 0.15, 0.1)), box((0, 0, 0), (0.15, 1.2, 0.1)), box((0, 0, 0.4), (0.1, 0.1, 0.7))], 4, False),
    "cube": ([box((0, 0, 0), (0.6, 0.6, 0.6))], 24, False),
    "three legs and a square post": ([*legs(3), box((0, 0, 0.3), (0.1, 0.1, 0.4))], 1, False),
    "three legs": (legs(3), 6, False),
    "five legs": (legs(5), 10, False),
    "square room": (ROOM, 8, True),
    "chair": (CHAIR, 1, False),
    "table with a lamp and a box": ([*table(1.6, 0.9), box((0.5, 0.2, 0.95), (0.2, 0.2, 0.43)), box((-0.4, -0.1, 0.81), (0.3, 0.25, 0.15))], 1, False),
    "table with a mug": ([*table(1.6, 0.9), box((0.5, 0.2, 0.785), (0.09, 0.09, 0.1))], 1, False),
    "square room with a wardrobe": ([*ROOM, WARDROBE], 1, True),
}


def sampled(boxes, count, is_room, random):
    """(count, 3) points [m] on the surfaces."""
    faces = [(b, axis, side) for b in boxes for axis in range(3) for side in (-0.5, 0.5)]
    areas = np.array([np.prod(size) / size[axis] for (_, size, _), axis, _ in faces])
    points = np.empty((0, 3))
    corner = np.array([-2.0, -2.0, 1.5])
    while len(points) < count:
        places = random.uniform(-0.5, 0.5, (count, 3))
        which = random.choice(len(faces), count, p=areas / areas.sum())
        for k, ((centre, size, turned), axis, side) in enumerate(faces):
            places[which == k, axis] = side
            on_face = centre + places[which == k] * size
            places[which == k] = on_face @ Rotation.from_euler("z", turned).as_matrix().T
        if is_room:
            inside = [np.all(np.abs(places - c) < s / 2 - 1e-6, axis=1) for c, s, _ in boxes[1:]]
            seen = random.uniform(0, 1, count) * np.sum((places - corner) ** 2, axis=1) < 4
            places = places[seen & ~np.any([np.zeros(count, bool), *inside], axis=0)]
        points = np.concatenate([points, places])
    return points[:count] + random.normal(0, NOISE, (count, 3))


def answer(igsp, boxes, is_room, random, folder):
    """Whether the answer is right, and whether it is registered."""
    count = int(np.exp(random.uniform(np.log(1500), np.log(50000))))
    rotation, shift = Rotation.random(random_state=random), random.uniform(-3, 3, 3)
    write_ply(folder / "target.ply", sampled(boxes, count, is_room, random))
    write_ply(folder / "source.ply", rotation.inv().apply(sampled(boxes, count, is_room, random) - shift))
    subprocess.run([igsp, "align", "source.ply", "target.ply", "--report", "r.json", "--quiet"], cwd=folder,
                   stdout=subprocess.DEVNULL, check=False)
    run = json.loads((folder / "r.json").read_text())
    if run["target_from_source"] is None:
        return False, False
    estimate = np.array(run["target_from_source"])
    turned = (Rotation.from_matrix(estimate[:3, :3]) * rotation.inv()).magnitude()
    middle = np.mean([centre for centre, _, _ in boxes], axis=0)
    moved = estimate[:3, :3] @ rotation.inv().apply(middle - shift) + estimate[:3, 3] - middle
    return np.degrees(turned) < 5 and np.linalg.norm(moved) < 3 * run["voxel_size"], run["verdict"] == "registered"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("igsp", type=Path)
    parser.add_argument("--pairs", type=int, default=30)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    print("| object | turns that lay it on itself | right | registered rightly | registered wrongly |\n|---|---|---|---|---|")
    for name, (boxes, turns, is_room) in OBJECTS.items():
        if arguments.only not in name:
            continue
        random = np.random.default_rng(1)
        with tempfile.TemporaryDirectory() as folder:
            answers = [answer(arguments.igsp.resolve(), boxes, is_room, random, Path(folder)) for _ in range(arguments.pairs)]
        right = sum(is_right for is_right, _ in answers)
        rightly = sum(is_right and is_registered for is_right, is_registered in answers)
        wrongly = sum(not is_right and is_registered for is_right, is_registered in answers)
        print(f"| {name} | {turns} | {right} | {rightly} | {wrongly} |", flush=True)


if __name__ == "__main__":
    main()
