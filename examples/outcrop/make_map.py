#!/usr/bin/env python3
"""Makes outcrop.geojson, a joint map as a survey leaves it. Usage: make_map.py > outcrop.geojson

A face of 120 m x 80 m in UTM coordinates. Set A is long and steep, set B runs from one trace of A to another,
set C is short. Every end that should meet a line misses it by a few centimetres: half stop short, half go on;
some traces were digitised twice, and crumbs of a hand that slipped are left. The same file every time.
"""
import json
import math
import random

EAST, NORTH = 352100.0, 3456700.0
WIDTH, HEIGHT = 120.0, 80.0
rng = random.Random(20161)


def crossing(a, b, c, d):
    """Share along a-b at which c-d crosses it, or None."""
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]
    turn = ux * vy - uy * vx
    if abs(turn) < 1e-12:
        return None
    s = ((c[0] - a[0]) * vy - (c[1] - a[1]) * vx) / turn
    t = ((c[0] - a[0]) * uy - (c[1] - a[1]) * ux) / turn
    return s if 0 <= s <= 1 and 0 <= t <= 1 else None


def along(p, angle, length):
    return (p[0] + length * math.cos(angle), p[1] + length * math.sin(angle))


def hit_distances(p, angle, reach, lines):
    """Distances from p at which a ray crosses the lines, in rising order."""
    q = along(p, angle, reach)
    found = [s * reach for line in lines if (s := crossing(p, q, *line)) is not None]
    return sorted(found)


def miss():
    """How far an end goes on beyond the line it should meet [m]; < 0: stops short."""
    return rng.choice((-1, 1)) * (0.005 + 0.03 * rng.random())


def rough(a, b):
    """A digitised line: points every few metres, a little off."""
    n = max(1, round(math.dist(a, b) / 4))
    angle = math.atan2(b[1] - a[1], b[0] - a[0]) + math.pi / 2
    points = [a]
    for k in range(1, n):
        p = (a[0] + (b[0] - a[0]) * k / n, a[1] + (b[1] - a[1]) * k / n)
        points.append(along(p, angle, rng.gauss(0, 0.03)))
    return points + [b]


lines = {"A": [], "B": [], "C": []}
# set A: steep, through the face from below or from above, or from side to side of it
x = -20.0
while x < WIDTH + 10:
    angle = math.radians(rng.gauss(74, 3))
    foot = (x, 0.0)
    top = HEIGHT / math.sin(angle)
    lines["A"].append((along(foot, angle, -1), along(foot, angle, top + 1)))
    x += 0.7 + rng.expovariate(1 / 0.8)
# set B: from a trace of A to the one some further on
while len(lines["B"]) < 1400:
    p = (rng.uniform(0, WIDTH), rng.uniform(0, HEIGHT))
    angle = math.radians(rng.gauss(-8, 4))
    back = hit_distances(p, angle + math.pi, 20, lines["A"])
    ahead = hit_distances(p, angle, 20, lines["A"])
    if not back or not ahead:
        continue
    k = min(len(ahead) - 1, rng.randrange(1, 5))
    lines["B"].append((along(p, angle + math.pi, back[0] + miss()), along(p, angle, ahead[k] + miss())))
# set C: short, between two traces of B
while len(lines["C"]) < 650:
    p = (rng.uniform(0, WIDTH), rng.uniform(0, HEIGHT))
    angle = math.radians(rng.gauss(112, 5))
    up = hit_distances(p, angle, 12, lines["B"])
    down = hit_distances(p, angle + math.pi, 12, lines["B"])
    if not up or not down:
        continue
    lines["C"].append((along(p, angle, up[0] + miss()), along(p, angle + math.pi, down[0] + miss())))

features = []


def add(kind, coordinates, **properties):
    place = [[round(EAST + px, 3), round(NORTH + py, 3)] for px, py in coordinates]
    if kind == "Polygon":
        place = [place]
    features.append({"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": place}})


add("Polygon", [(0, 0), (WIDTH, 0), (WIDTH, HEIGHT), (0, HEIGHT), (0, 0)], set="face")
for name, group in lines.items():
    for a, b in group:
        drawn = rough(a, b)
        add("LineString", drawn, set=name)
        if rng.random() < 0.03:  # digitised twice, shifted by about a centimetre
            shift = (rng.gauss(0, 0.008), rng.gauss(0, 0.008))
            add("LineString", [(px + shift[0], py + shift[1]) for px, py in drawn], set=name)
for _ in range(40):
    p = (rng.uniform(0, WIDTH), rng.uniform(0, HEIGHT))
    add("LineString", [p, along(p, rng.uniform(0, 6), 0.03)], set=rng.choice("ABC"))
add("LineString", [(20, 10), (40, 12)], set="scan line 1")  # where the geologist walked: no joint

print('{"type": "FeatureCollection",')
print('"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32651"}},')
print('"features": [')
print(",\n".join(json.dumps(f, separators=(",", ":")) for f in features))
print("]}")
