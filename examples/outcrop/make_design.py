#!/usr/bin/env python3
"""Makes design.dxf, what a designer adds to the map: an adit, its bolts and gauges, in millimetres from the
corner of the face. Needs ezdxf. Usage: make_design.py design.dxf"""
import math
import sys

import ezdxf

doc = ezdxf.new("R2010")
doc.header["$INSUNITS"] = 4
space = doc.modelspace()
x, y, radius, wall = 352160000.0, 3456720000.0, 3000.0, 2500.0
half = math.tan(math.pi / 4)  # bulge of half a circle
space.add_lwpolyline([(x - radius, y - wall, 0), (x + radius, y - wall, 0), (x + radius, y, half), (x - radius, y, 0)],
                     format="xyb", close=True, dxfattribs={"layer": "ADIT"})
for degrees in (20, 50, 90, 130, 160):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    space.add_line((x + 3010 * c, y + 3010 * s), (x + 6000 * c, y + 6000 * s), dxfattribs={"layer": "BOLTS"})
for px, py in ((x, y + 3050), (x - 20000, y + 30000)):
    space.add_point((px, py), dxfattribs={"layer": "GAUGES"})
space.add_text("adit, section 3-3", dxfattribs={"layer": "FRAME"}).set_pos((x, y + 9000))
doc.saveas(sys.argv[1])
