"""What slender exports, read by other means: glTF, PLY, STL, 3MF and npz against the result's own numbers.    exports.py PROGRAM"""
import csv
import json
import os
import struct
import subprocess
import sys
import unittest
import xml.etree.ElementTree as tree
import zipfile
import zlib

import numpy as np

PROGRAM = os.path.abspath(sys.argv.pop(1))
HERE = os.path.dirname(os.path.abspath(__file__))


def slender(*words, code=0):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
    if done.returncode != code:
        raise AssertionError(f"{words} ends with {done.returncode}, not {code}: {done.stderr}")
    return done.stdout + done.stderr


def run(name, scene, *settings):
    """A scene of the tests, or the text of one; the result has this name."""
    path = os.path.join(HERE, scene)
    if "\n" in scene:
        path = name + ".yaml"
        with open(path, "w") as file:
            file.write(scene)
    slender("run", path, "-o", name, "--quiet", "--no-picture", *[w for s in settings for w in ("--set", s)])


def export(name, output, *options):
    said = slender("export", name + ".vtkhdf", "-o", output, *options)
    return said


def changed(name, source, old, new):
    """The result with other bytes, and a check sum that is right."""
    with open(source + ".vtkhdf", "rb") as file:
        stored = file.read()[:-20]
    assert old in stored
    stored = stored.replace(old, new)
    with open(name + ".vtkhdf", "wb") as file:
        file.write(stored + b"SLENDRCK" + len(stored).to_bytes(8, "little") + zlib.crc32(stored).to_bytes(4, "little"))


def numbers(name):
    export(name, name + ".npz")
    return np.load(name + ".npz")


EVALUATE = """slender: 1
job: evaluate
shell:
  mesh: {%s}
  thickness: %s
  young: 1 MPa
  poisson: 0.3
  magnetization: %s
"""

BOX = """slender: 1
job: evaluate
solid:
  mesh: {shape: box, size: [20 mm, 6 mm, 4 mm], cells: [4, 2, 2]}
  young: 1 MPa
  poisson: 0.3
  order: %d
  magnetization: {formula: ["x < 0.01 ? 1e4 : 3e4", "0", "0"]}
"""


DESIGN = """slender: 1
job: design
shell:
  mesh: {shape: hexagram, size: 40 mm, n: 4}
  thickness: 1 mm
  young: 0.1 MPa
  poisson: 0.5
fix:
  - {ball: {center: [0, 0, 0], radius: 8 mm}}
cases:
  - {name: up, flux_density: [0, 0, 0.05], target: ["x", "y", "20*r^2"]}
  - {name: down, flux_density: [0, 0, -0.05], target: ["x", "y", "-10*r^2"]}
design:
  unknowns: {magnetization: {noise: 100}, young: {bounds: [5.0e4, 2.0e5]}, thickness: {bounds: [0.5 mm, 2 mm]}}
  objectives: [{target: 1}]
  optimizer: gauss_newton
  iterations: 6
output: {every: 2}
"""

ROD_FAR = """slender: 1
job: evaluate
rod: {curve: {formula: ["1.0e4 + 0.01*u", "0.001*u*u", "0"], range: [0, 3]}, elements: 20, radius: 1 mm, young: 1 MPa, poisson: 0.4, density: 1000}
"""

MOVING = """slender: 1
job: simulate
shell:
  mesh: {shape: strip, size: [20 mm, 5 mm], n: 4}
  thickness: 1 mm
  young: 1 MPa
  poisson: 0.3
  density: 1000
  gravity: [0, 0, -9.81]
%stime: {step: 1 ms, steps: 5}
output: {every: 2}
"""

# ---- Closed surfaces ----


def volume(points, faces):
    a, b, c = (points[faces[:, i]] for i in range(3))
    return np.einsum("fi,fi->", a, np.cross(b, c)) / 6


def area(points, faces):
    a, b, c = (points[faces[:, i]] for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def is_closed(faces):
    """Each edge is run along once in either direction."""
    edges = np.concatenate([faces[:, [i, (i + 1) % 3]] for i in range(3)])
    once = len(np.unique(edges, axis=0)) == len(edges)
    return once and {tuple(e) for e in edges} == {tuple(e[::-1]) for e in edges}


def read_stl(path):
    with open(path, "rb") as file:
        data = file.read()
    (count,) = struct.unpack_from("<I", data, 80)
    rows = np.frombuffer(data, np.dtype([("n", "<f4", 3), ("x", "<f4", (3, 3)), ("a", "<u2")]), count, 84)
    assert len(data) == 84 + 50 * count and not data.startswith(b"solid")
    x = rows["x"].astype(float)
    points, faces = np.unique(x.reshape(-1, 3), axis=0, return_inverse=True)
    normal = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    assert abs(normal - rows["n"]).max() < 1e-3
    return points, faces.reshape(-1, 3)


def read_3mf(path):
    """Name, colour, points and faces of each part."""
    spaces = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        assert set(archive.namelist()) == {"[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"}
        model = tree.fromstring(archive.read("3D/3dmodel.model"))
    assert model.get("unit") == "millimeter"
    bases = [b.get("displaycolor") for b in model.findall("m:resources/m:basematerials/m:base", spaces)]
    parts = {}
    for one in model.findall("m:resources/m:object", spaces):
        mesh = one.find("m:mesh", spaces)
        if mesh is None:
            whole = one
            continue
        points = [[float(v.get(c)) for c in "xyz"] for v in mesh.find("m:vertices", spaces)]
        faces = [[int(t.get(c)) for c in ("v1", "v2", "v3")] for t in mesh.find("m:triangles", spaces)]
        parts[one.get("id")] = (one.get("name"), bases[int(one.get("pindex"))], np.array(points), np.array(faces))
    assert [c.get("objectid") for c in whole.find("m:components", spaces)] == list(parts)
    assert [i.get("objectid") for i in model.find("m:build", spaces)] == [whole.get("id")]
    return list(parts.values())


class Printing(unittest.TestCase):
    def check(self, part, wanted, tolerance=1e-6):
        points, faces = part
        self.assertTrue(is_closed(faces))
        self.assertLess(abs(volume(points, faces) / wanted - 1), tolerance)

    def test_groups(self):
        groups = "{groups: {hub: [0, 0, -1.0e+4], flap2: [2.0e+4, 0, 0]}, other: [0, 0, 0]}"
        run("star", EVALUATE % ("shape: hexagram, size: 40 mm, n: 1", "1 mm", groups))
        z = numbers("star")
        of = area(1e3 * z["rest"], z["faces"])
        said = export("star", "star.3mf", "--per", "group")
        parts = read_3mf("star.3mf")
        names = str(z["groups/names"]).split()
        self.assertEqual(sorted(p[0] for p in parts), sorted(names))
        self.assertEqual(len({p[1] for p in parts}), len(parts))
        begin = z["groups/offsets"]
        for name, _, points, faces in parts:
            members = z["groups/members"][begin[names.index(name)] : begin[names.index(name) + 1]]
            self.check((points, faces), of[members].sum())
            self.assertIn(f"star.3mf: {name}: ", said)
        # Parts meet without gaps: the walls between them are there twice, and with all of them gone it is the whole.
        self.assertLess(abs(sum(volume(p[2], p[3]) for p in parts) / of.sum() - 1), 1e-6)
        export("star", "level.stl", "--levels", "2")
        self.check(read_stl("level_1.stl"), of[[f for f in range(len(of)) if z["design/magnetization"][f][2]]].sum(), 1e-5)
        self.assertFalse(os.path.exists("level.stl") or os.path.exists("level_4.stl"))
        whole = sum(volume(*read_stl(f"level_{k}.stl")) for k in (1, 2, 3))  # two levels, and what is no magnet
        self.assertLess(abs(whole / of.sum() - 1), 1e-5)

    def test_uneven_and_in_a_frame(self):
        run("uneven", EVALUATE % ("shape: sheet, size: [20 mm, 10 mm], cells: [8, 4]", '{formula: "0.001 + 0.1*x"}', "[0, 0, 1e4]"))
        z = numbers("uneven")
        export("uneven", "uneven.stl")
        self.check(read_stl("uneven.stl"), (area(1e3 * z["rest"], z["faces"]) * 1e3 * z["design/thickness"]).sum(), 1e-5)

    def test_design_in_a_frame(self):
        """Each frame has its own thickness and magnetisation; at rest they are the final ones."""
        run("found", DESIGN)
        z = numbers("found")
        thickness, M = z["VTKHDF/CellData/thickness"], np.linalg.norm(z["VTKHDF/CellData/magnetization"], axis=2)
        self.assertTrue(np.allclose(thickness[-1], z["design/thickness"], rtol=1e-6))
        for frame in (0, 1, -1):
            x = z["VTKHDF/Points"][frame] if frame >= 0 else z["rest"]
            self.assertTrue(frame < 0 or abs(thickness[frame].mean() / thickness[-1].mean() - 1) > 0.03)
            options = ("--frame", str(frame)) if frame >= 0 else ()
            export("found", "found.stl", *options)
            self.check(read_stl("found.stl"), (area(1e3 * x, z["faces"]) * 1e3 * thickness[frame]).sum(), 0.01)
            (level,) = read_3mf("found.3mf") if export("found", "found.3mf", "--levels", "1", *options) else ()
            self.assertEqual(level[0], f"{M[frame].min():.4g} to {M[frame].max():.4g} A/m")

    def roof(self, top):
        """Of 2 mm, its ridge so many mm above its sides, which are 20 mm apart: points, faces, and the ridge's heights."""
        with open("roof.obj", "w") as file:
            for x, height in ((-0.01, 0), (0, 1e-3 * top), (0.01, 0)):
                file.write("".join(f"v {x} {y} {height}\n" for y in (0, 0.005, 0.01)))
            for k in (1, 2, 4, 5):
                file.write(f"f {k} {k + 3} {k + 4}\nf {k} {k + 4} {k + 1}\n")
        name = f"roof_{top}"
        run(name, EVALUATE % ("file: roof.obj", "2 mm", "[0, 0, 1e4]"))
        export(name, "roof.stl")
        points, faces = read_stl("roof.stl")
        return points, faces, points[abs(points[:, 0]) < 1e-6][:, 2]

    def test_fold_keeps_its_thickness(self):
        points, faces, ridge = self.roof(10)
        self.check((points, faces), 2 * 10 * 10 * 2**0.5 * 2, 1e-6)
        self.assertLess(abs(ridge - 10).max() - 2**0.5, 1e-5)  # 1 mm from both faces: sqrt 2 above and below the fold
        self.assertLess(abs(ridge.max() - ridge.min() - 2 * 2**0.5), 1e-5)

    def test_sharp_fold_is_cut(self):
        points, faces, ridge = self.roof(30)  # sqrt 10 mm would keep the thickness; twice 1 mm is the most
        self.assertTrue(is_closed(faces))
        self.assertLess(abs(abs(ridge - 30) - 2).max(), 1e-5)

    def test_slits(self):
        run("slit", EVALUATE % ("shape: kirigami, size: 44 mm, n: 3", "0.5 mm", "[0, 0, 1e4]"))
        z = numbers("slit")
        export("slit", "slit.3mf")
        (part,) = read_3mf("slit.3mf")
        self.check(part[2:], area(1e3 * z["rest"], z["faces"]).sum() * 0.5)

    def test_closed(self):
        """An octahedron of edges a: its hulls are octahedra, of inner radii r + h/2 and r - h/2."""
        with open("eight.obj", "w") as file:
            file.write("".join("v %g %g %g\n" % v for v in ((0.01, 0, 0), (0, 0.01, 0), (0, 0, 0.01), (-0.01, 0, 0), (0, -0.01, 0), (0, 0, -0.01))))
            file.write("f 1 2 3\nf 2 4 3\nf 4 5 3\nf 5 1 3\nf 2 1 6\nf 4 2 6\nf 5 4 6\nf 1 5 6\n")
        run("eight", EVALUATE % ("file: eight.obj", "1 mm", "[0, 0, 1e4]"))
        export("eight", "eight.stl")
        r = 10 / 3**0.5
        self.check(read_stl("eight.stl"), 4 * 3**0.5 * ((r + 0.5) ** 3 - (r - 0.5) ** 3), 1e-5)

    def test_solids(self):
        for order in (1, 2):
            box = f"box{order}"
            run(box, BOX % order)
            export(box, "box.3mf", "--levels", "4")
            parts = read_3mf("box.3mf")
            self.assertEqual([p[0] for p in parts], ["1e+04 A/m", "3e+04 A/m"])
            for part, side in zip(parts, (0, 10)):
                self.check(part[2:], 240)
                self.assertTrue(np.allclose([part[2][:, 0].min(), part[2][:, 0].max()], [side, side + 10], atol=1e-9))
            export(box, "box.stl")
            self.check(read_stl("box.stl"), 480)
        self.assertIn("no groups of tetrahedra", slender("export", "box2.vtkhdf", "-o", "x.stl", "--per", "group", code=3))


# ---- glTF ----


class Glb:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        magic, version, size = struct.unpack_from("<4sII", data, 0)
        length, kind = struct.unpack_from("<I4s", data, 12)
        assert (magic, version, size, kind) == (b"glTF", 2, len(data), b"JSON") and length % 4 == 0
        self.json = json.loads(data[20 : 20 + length])
        self.binary, kind = struct.unpack_from("<I4s", data, 20 + length)
        assert kind == b"BIN\0"
        self.data = data[28 + length :]
        assert len(self.data) == self.binary == self.json["buffers"][0]["byteLength"]

    def numbers(self, accessor):
        """Of an accessor, which keeps its bounds."""
        a = self.json["accessors"][accessor]
        view = self.json["bufferViews"][a["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[a["type"]]
        rows = np.frombuffer(self.data, {5126: "<f4", 5125: "<u4"}[a["componentType"]], a["count"] * width, view["byteOffset"])
        assert rows.nbytes == view["byteLength"]
        rows = rows.reshape(-1, width)
        if "min" in a:
            assert np.array_equal(rows.min(0), np.float32(a["min"])) and np.array_equal(rows.max(0), np.float32(a["max"]))
        return rows

    def node(self, name):
        (node,) = [k for k, n in enumerate(self.json["nodes"]) if n["name"] == name]
        return node

    def primitive(self, name):
        return self.json["meshes"][self.json["nodes"][self.node(name)]["mesh"]]["primitives"][0]

    def channels(self, name):
        """Times and numbers of what moves of a node."""
        found = {}
        animation = self.json["animations"][0]
        for channel in animation["channels"]:
            if channel["target"]["node"] == self.node(name):
                sampler = animation["samplers"][channel["sampler"]]
                found[channel["target"]["path"]] = self.numbers(sampler["input"])[:, 0], self.numbers(sampler["output"])
        return found

    def moments(self, name):
        """Points at each key of the animation, as a viewer has them."""
        primitive = self.primitive(name)
        first = self.numbers(primitive["attributes"]["POSITION"]).astype(float)
        away = np.array([self.numbers(t["POSITION"]) for t in primitive["targets"]], float)
        times, weights = self.channels(name)["weights"]
        return times, first + np.tensordot(weights.reshape(len(times), -1).astype(float), away, 1)


def rotation(q):
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class Moving(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        run("moving", "scene_contact.yaml", "time.steps=24", "output.stress=true")
        cls.z = numbers("moving")

    def test_body(self):
        z = self.z
        export("moving", "moving.glb", "--field", "von_mises")
        glb = Glb("moving.glb")
        times, x = glb.moments("body")
        self.assertTrue(np.allclose(times, z["VTKHDF/Steps/Values"], atol=1e-7))
        faces = glb.numbers(glb.primitive("body")["indices"]).reshape(-1, 3)
        wanted = z["VTKHDF/Points"][:, z["faces"]]
        self.assertEqual(len(faces), len(z["faces"]))
        self.assertLess(abs(x[:, faces] - wanted).max(), 1e-8)
        root = glb.json["nodes"][0]
        self.assertTrue(np.allclose(rotation(root["rotation"]) @ [0, 0, 1], [0, 1, 0]))  # z is glTF's y
        self.assertEqual(root["children"], [1, 2, 3])
        # Each face has its number.
        attributes = glb.primitive("body")["attributes"]
        stress, color = glb.numbers(attributes["_VON_MISES"])[:, 0], glb.numbers(attributes["COLOR_0"])
        own = z["VTKHDF/CellData/von_mises"][-1].astype(np.float32)
        self.assertTrue(np.array_equal(stress[faces], np.repeat(own[:, None], 3, 1)))
        # At each moment its own, on one scale: the larger the number, the lighter. The mesh alone has those of the end.
        away = np.array([glb.numbers(t["COLOR_0"]) for t in glb.primitive("body")["targets"]])
        self.assertEqual(len(away), len(times))
        self.assertEqual(abs(away[-1]).max(), 0)
        light = ((color + away) @ [0.2126, 0.7152, 0.0722])[:, faces[:, 0]].ravel()
        order = np.argsort(z["VTKHDF/CellData/von_mises"].ravel(), kind="stable")
        self.assertGreater(np.diff(light[order]).min(), -1e-6)
        self.assertGreater(light.max(), 10 * light.min())
        self.assertTrue(color.min() >= 0 and color.max() <= 1)
        extras = glb.json["meshes"][0]["extras"]
        self.assertEqual((extras["field"], extras["unit"], len(extras["targetNames"])), ("von_mises", "Pa", len(times)))

    def test_obstacles(self):
        export("moving", "moving.glb")
        glb, z = Glb("moving.glb"), self.z
        for row, name in enumerate(("belt", "post")):
            points = glb.numbers(glb.primitive(name)["attributes"]["POSITION"])
            self.assertTrue(np.array_equal(points, z[f"obstacles/{name}/points"].astype(np.float32)))
            pose = z["frames/obstacle_pose"][:, row].reshape(-1, 3, 4)
            ways = glb.channels(name)
            for k, (place, turn) in enumerate(zip(ways["translation"][1], ways["rotation"][1])):
                self.assertLess(abs(place - pose[k, :, 3]).max(), 1e-8)
                self.assertLess(abs(rotation(turn) - pose[k, :, :3]).max(), 1e-6)

    def test_fewer_and_one(self):
        z = self.z
        export("moving", "few.glb", "--frames", "4")
        times, x = Glb("few.glb").moments("body")
        all_times = z["VTKHDF/Steps/Values"]
        self.assertEqual((len(times), times[0]), (4, 0))
        self.assertLess(abs(times[-1] - all_times[-1]), 1e-7)
        for option, value, frame in (("--frame", "3", 3), ("--frames", "1", -1)):  # of one frame the last
            export("moving", "one.glb", option, value)
            glb = Glb("one.glb")
            self.assertNotIn("animations", glb.json)
            faces = glb.numbers(glb.primitive("body")["indices"]).reshape(-1, 3)
            points = glb.numbers(glb.primitive("body")["attributes"]["POSITION"])
            self.assertLess(abs(points[faces] - z["VTKHDF/Points"][frame][z["faces"]]).max(), 1e-8)

    def test_plain_shares_vertices(self):
        export("moving", "plain.glb", "--field", "none")
        primitive = Glb("plain.glb").primitive("body")
        self.assertEqual(set(primitive["attributes"]), {"POSITION"})
        self.assertEqual(len(primitive["targets"]), 8)  # the first of nine moments is the mesh itself
        self.assertEqual(len(Glb("plain.glb").numbers(primitive["attributes"]["POSITION"])), len(self.z["rest"]))

    def test_rods(self):
        run("rod", "scene_rod_simulate.yaml", "time.steps=30")
        z = numbers("rod")
        export("rod", "rod.glb")
        glb = Glb("rod.glb")
        times, x = glb.moments("rod")
        self.assertTrue(np.allclose(times, z["VTKHDF/Steps/Values"], atol=1e-7))
        faces = glb.numbers(glb.primitive("rod")["indices"]).reshape(-1, 3)
        nodes, strip = len(z["rod/x"]), x[:, : 12 * len(z["rod/x"])].reshape(len(times), -1, 12, 3)
        middle = z["VTKHDF/Points"][:, :nodes]
        self.assertLess(abs(strip.mean(2) - middle).max(), 1e-8)  # rings about the nodes, of the rod's radius
        self.assertLess(abs(np.linalg.norm(strip - middle[:, :, None], axis=3) - 0.6e-3).max(), 1e-8)
        self.assertTrue(is_closed(faces) and volume(x[-1], faces) > 0)
        self.assertIn("--field is of meshes", slender("export", "rod.vtkhdf", "-o", "x.glb", "--field", "young", code=3))
        self.assertIn("there is no mesh in it", slender("export", "rod.vtkhdf", "-o", "x.ply", code=3))

    def test_lines(self):
        """An inversion does not say how thick its rods are."""
        curve = '{formula: ["0.02*cos(u)", "0.02*sin(u)", "-0.003*u"], range: [0, 6], parameter: u}'
        rod = f"{{curve: {curve}, elements: 20, radius: 1 mm, young: 5 MPa, poisson: 0.5, density: 1000}}"
        run("helix", f"slender: 1\njob: invert\nrod: {rod}\nchecks: [round_trip]\n")
        export("helix", "helix.glb")
        glb, z = Glb("helix.glb"), numbers("helix")
        primitive = glb.primitive("rod")
        points = glb.numbers(primitive["attributes"]["POSITION"])
        self.assertEqual(primitive["mode"], 1)
        self.assertLess(abs(points - z["VTKHDF/Points"][0][: len(points)]).max(), 1e-8)
        lines = glb.numbers(primitive["indices"]).reshape(-1, 2)
        self.assertTrue(np.array_equal(lines, [[i, i + 1] for i in range(len(z["rod/x"]) - 1)]))

    def test_nowhere(self):
        """A point that is no number is in no file."""
        x = self.z["state/x"].tobytes()
        changed("nowhere", "moving", x, np.full(3, np.nan).tobytes() + x[24:])
        for ending in ("ply", "obj"):
            words = slender("export", "nowhere.vtkhdf", "-o", "nowhere." + ending, code=3)
            self.assertIn("point 0 is nowhere: it is no number", words)
            self.assertFalse(os.path.exists("nowhere." + ending))

    def test_nothing(self):
        """A mesh whose faces are not there is no page."""
        changed("faceless", "moving", b"faces\0", b"facez\0")
        self.assertIn("there is no body and no drawing in it", slender("report", "faceless.vtkhdf", code=3))
        self.assertFalse(os.path.exists("faceless.html"))

    def test_far(self):
        """10 km from the origin single numbers are 1 mm apart: the body's middle is its node's place."""
        with open("far.obj", "w") as file:
            file.write("".join(f"v {1e4 + 0.01 * i:.9g} {-1e4 + 0.01 * j:.9g} 0\n" for i in range(5) for j in range(2)))
            file.write("".join(f"f {2 * i + 1} {2 * i + 3} {2 * i + 2}\nf {2 * i + 3} {2 * i + 4} {2 * i + 2}\n" for i in range(4)))
        run("far", EVALUATE % ("file: far.obj", "1 mm", "[0, 0, 1e4]"))
        run("far_rod", ROD_FAR)
        for name, node in (("far", "body"), ("far_rod", "rod")):
            export(name, name + ".glb")
            glb, z = Glb(name + ".glb"), numbers(name)
            points = glb.numbers(glb.primitive(node)["attributes"]["POSITION"]) + np.array(glb.json["nodes"][glb.node(node)]["translation"])
            wanted = z["state/x" if node == "body" else "rod/x"]
            away = [np.linalg.norm(points - p, axis=1).min() for p in wanted]
            self.assertLess(max(away), 1e-8 if node == "body" else 1e-3 + 1e-8)  # within the rod, whose radius is 1 mm

    def test_group_names(self):
        """Commas and quotes of names are in a table as they are in the mesh."""
        names = ['a,"b', "c,d", 'e"f']
        with open("named.obj", "w") as file:
            file.write("".join(f"v {0.01 * i} {0.01 * j} 0\n" for i in range(4) for j in range(2)))
            file.write("".join(f"g {n}\nf {2 * i + 1} {2 * i + 3} {2 * i + 2}\nf {2 * i + 3} {2 * i + 4} {2 * i + 2}\n" for i, n in enumerate(names)))
        run("named", EVALUATE % ("file: named.obj", "1 mm", "[0, 0, 1e4]"))
        export("named", "named.csv", "--per", "group")
        with open("named.csv", newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual([r[0] for r in rows[1:]], names)
        self.assertEqual({len(r) for r in rows}, {7})

    def test_no_state(self):
        """A design whose start is not solved is nowhere; one that has not finished is where its last frame is."""
        path = "unsolved.yaml"
        with open(path, "w") as file:
            file.write(DESIGN.replace("0.05]", "50000]"))
        slender("run", path, "--quiet", "--no-picture", code=1)
        for verb, output in (("picture", "x.png"), ("picture", "x.webp"), ("report", "x.html"), ("export", "x.glb"), ("export", "x.ply"),
                             ("export", "x.obj"), ("export", "x.stl"), ("export", "x.3mf")):  # fmt: skip
            self.assertIn("the result has no state yet", slender(verb, "unsolved.vtkhdf", "-o", output, code=3), output)
            self.assertFalse(os.path.exists(output))
        run("solved", DESIGN)
        export("solved", "solved.glb")
        names = Glb("solved.glb").json["meshes"][0]["extras"]["targetNames"]
        self.assertEqual((names[0], names[-2:]), ("frame 0", ["up", "down"]))  # as a report has them
        changed("unfinished", "solved", b"case_names\0", b"case_namez\0")
        slender("picture", "unfinished.vtkhdf", "-o", "unfinished.svg")
        with open("unfinished.svg") as file:
            self.assertIn("<svg", file.read())

    def test_foreign(self):
        """A file that slender has not made is replaced by force only; its own, and empty ones, at once."""
        run("mine", EVALUATE % ("shape: sheet, size: [20 mm, 10 mm], cells: [2, 1]", "1 mm", "[0, 0, 1e4]"))
        names = {"picture": ("png", "svg", "pdf"), "report": ("html",), "export": ("glb", "ply", "obj", "stl", "3mf", "npz")}
        for verb, endings in names.items():
            for ending in endings:
                path = "mine." + ending
                words = (verb, "mine.vtkhdf", "-o", path)
                with open(path, "w") as file:
                    file.write("made by hand, slender: 1\n")
                self.assertIn(f"'{path}' is there, and slender has not made it", slender(*words, code=4))
                with open(path) as file:
                    self.assertEqual(file.read(), "made by hand, slender: 1\n")
                slender(*words, "--force")
                slender(*words)
                for text in ("a slender 3 mm rod", "Computed with slender 1.0", "made by slender 2 mm rods", "slender 0.1.0", "generator slender 1.2.3"):
                    with open(path, "w") as file:
                        file.write(f"<!-- # % {text} -->\n")
                    self.assertIn(f"'{path}' is there, and slender has not made it", slender(*words, code=4))
                with open(path, "w"):
                    pass
                slender(*words)
                self.assertGreater(os.path.getsize(path), 0)
        for path in ("mine.PNG", "mine.Svg", "mine.pDf", "mine.WebP"):  # of any case
            words = ("picture", "mine.vtkhdf", "-o", path)
            with open(path, "w") as file:
                file.write("by hand")
            self.assertIn(f"'{path}' is there", slender(*words, code=4))
            slender(*words, "--force")
            slender(*words)
        with open("mine.obj", "w") as file:
            file.write("v 0 0 0\n")
        for words in (("mesh", "mine.yaml"), ("export", "mine.vtkhdf", "-o", "mine.obj")):
            self.assertIn("'mine.obj' is there", slender(*words, code=4))
        with open("mine.html", "w") as file:
            file.write("by hand")
        self.assertIn("'mine.html' is there", slender("report", "mine.vtkhdf", code=4))  # by its own choice of names, too
        slender("picture", "moving.vtkhdf", "-o", "moving.webp", "--seconds", "0.1", "--width", "400")
        with open("moving.webp", "rb") as file:
            data = file.read()
        self.assertEqual(int.from_bytes(data[4:8], "little") + 8, len(data))
        self.assertIn(b"XMP ", data)
        slender("picture", "moving.vtkhdf", "-o", "moving.webp", "--seconds", "0.1", "--width", "400")

    def test_unreadable(self):
        """Nobody knows whose a file is that may not be read."""
        run("closed", EVALUATE % ("shape: sheet, size: [20 mm, 10 mm], cells: [2, 1]", "1 mm", "[0, 0, 1e4]"))
        os.mkdir("open")
        os.chmod("open", 0o777)
        os.rename("closed.vtkhdf", "open/closed.vtkhdf")
        with open("open/closed.png", "w") as file:
            file.write("mine")
        os.chmod("open/closed.png", 0o200)
        nobody = {"user": 65534} if os.geteuid() == 0 else {}  # root may read all
        words = [PROGRAM, "picture", "closed.vtkhdf"]
        done = subprocess.run(words, cwd="open", capture_output=True, text=True, **nobody)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("'closed.png' is there, and slender has not made it", done.stderr)
        subprocess.run([*words, "--force"], cwd="open", check=True, capture_output=True, **nobody)
        with open("open/closed.png", "rb") as file:
            self.assertIn(b"Software\0slender", file.read()[-2048:])

    def test_refusals(self):
        for options, code, words in (
            (("-o", "x.glb", "--frame", "99"), 3, "the result has 9 frames, from 0"),
            (("-o", "x.glb", "--field", "colour"), 3, "the frames of the result have no 'colour', only "),
            (("-o", "x.glb", "--frame", "1", "--frames", "2"), 2, "--frame and --frames exclude each other"),
            (("-o", "x.stl", "--field", "young"), 2, "--field is for a body in colours, -o FILE.glb, and is not used here"),
            (("-o", "x.ply", "--levels", "2"), 2, "--levels is for parts to print"),
            (("-o", "x.stl", "--levels", "2", "--per", "group"), 2, "--per and --levels exclude each other"),
            (("-o", "x.stl", "--levels", "0"), 2, "--levels must be a whole number from 1 to 100"),
            (("-o", "x.stl", "--per", "group"), 3, "the body's mesh has no groups of faces"),
            (("-o", "x.npz", "--frame", "1"), 2, "--frame is for a mesh"),
            (("-o", "x.npz", "--dataset", "rest"), 2, "--dataset is for numbers, -o FILE.csv, and is not used here"),
            (("-o", "x.gltf"), 2, "further .glb, .ply, .stl, .3mf (bodies) and .npz"),
        ):
            self.assertIn(words, slender("export", "moving.vtkhdf", *options, code=code))
            self.assertFalse(os.path.exists(options[1]))

    # ---- Numbers ----

    def test_npz(self):
        z = self.z
        for path in ("state/x", "edges", "history/contact_force", "design/young"):
            export("moving", "one.csv", "--dataset", path)
            self.assertTrue(np.array_equal(np.loadtxt("one.csv", delimiter=",").ravel(), z[path].ravel()), path)
        self.assertEqual((z["state/x"].dtype, z["edges"].dtype, z["history/contact_force"].ndim), ("<f8", "<i4", 3))
        self.assertEqual(str(z["obstacle_names"]).split(), ["belt", "post"])
        self.assertTrue(str(z["scene"]).startswith("slender: 1\n"))
        self.assertEqual(z["final/energy/bending"].shape, ())
        self.assertEqual(z["VTKHDF/CellData/von_mises"].shape, (9, len(z["faces"])))
        self.assertTrue(np.array_equal(z["VTKHDF/Points"], z["frames/x"]))
        self.assertTrue(np.array_equal(z["VTKHDF/Points"][-1], z["state/x"]))
        listed = [w.split()[0] for w in slender("info", "moving.vtkhdf").splitlines() if w.startswith("  slender/")]
        self.assertEqual([p for p in listed if p[len("slender/") :] not in z.files], [])

    def test_ply(self):
        z = self.z
        export("moving", "moving.ply", "--frame", "5")
        with open("moving.ply", "rb") as file:
            head, data = file.read().split(b"end_header\n", 1)
        rows = {}
        for element in head.decode().split("element ")[1:]:
            name, count = element.split("\n")[0].split()
            fields = [("n", "u1"), ("corners", "<i4", 3)] if name == "face" else []
            fields += [(w.split()[2], "<f8") for w in element.split("\n") if w.startswith("property double")]
            rows[name] = np.frombuffer(data, np.dtype(fields), int(count))
            data = data[rows[name].nbytes :]
        self.assertEqual(data, b"")
        vertex, face = rows["vertex"], rows["face"]
        self.assertTrue(np.array_equal(np.stack([vertex[c] for c in "xyz"], 1), z["VTKHDF/Points"][5]))
        self.assertTrue(np.array_equal(face["corners"], z["faces"]))
        self.assertTrue(np.array_equal(face["von_mises"], z["VTKHDF/CellData/von_mises"][5]))
        self.assertTrue(np.array_equal(face["magnetization_x"], z["VTKHDF/CellData/magnetization"][5, :, 0]))
        self.assertTrue(np.array_equal(vertex["contact_force_z"], z["VTKHDF/PointData/contact_force"][5, :, 2]))
        run("again", EVALUATE % ("file: moving.ply", "1 mm", "[0, 0, 1e4]"))  # by slender's own reader
        back = numbers("again")
        self.assertTrue(np.array_equal(back["rest"], z["VTKHDF/Points"][5]) and np.array_equal(back["faces"], z["faces"]))

    def test_probes(self):
        """What the run has written beside the result, once more."""
        probes = "probes:\n  tip: {vertex: \"3\"}\n  high: {height: \"3\"}\n"
        cases = "cases:\n  - {name: a, flux_density: [0, 0, 1 mT], target: [x, y, 9*x^2]}\n  - {name: b, flux_density: [0, 0, -1 mT], target: [x, y, -9*x^2]}\n"
        strip = EVALUATE % ("shape: strip, size: [20 mm, 5 mm], n: 4", "1 mm", "[1e4, 0, 0]")
        design = strip.replace("evaluate", "design") + "fix: [{group: root, clamp: true}]\n" + probes + cases
        design += "design: {iterations: 2, unknowns: {magnetization: {noise: 100}}, objectives: [{target: 1}], optimizer: gauss_newton}\n"
        for name, scene in (("stage", strip + probes), ("time", MOVING % probes), ("evaluation", design)):
            run(name, scene)
            export(name, "again.csv", "--probes")
            with open("again.csv") as one, open(name + "_probes.csv") as other:
                text = one.read()
                self.assertEqual(text, other.read())
            self.assertTrue(text.startswith(name + (",case" if name == "evaluation" else "") + ",tip.x,tip.y,tip.z,high\n"))
            self.assertGreater(text.count("\n"), 1)
        self.assertIn("no rows of probes", slender("export", "moving.vtkhdf", "-o", "x.csv", "--probes", code=3))
        self.assertIn("--probes is for a table", slender("export", "stage.vtkhdf", "-o", "x.obj", "--probes", code=2))

    def test_what_is_not_there(self):
        """A magnet that one load case has: in the other one it has no size."""
        hand = "{name: hand, magnet: {at: [30 mm, 2.5 mm, 50 mm], radius: 6 mm, length: 12 mm, remanence: [0, 0, 1.3]}}"
        strip = EVALUATE % ("shape: strip, size: [40 mm, 5 mm], n: 8", "0.5 mm", "[1e4, 0, 0]")
        cases = "cases:\n  - {name: none, flux_density: [0, 0, 1 mT]}\n  - {name: near, flux_density: %s}\n" % hand
        run("two", strip.replace("evaluate", "equilibrium") + "fix: [{group: root, clamp: true}]\n" + cases)
        export("two", "two.glb")
        glb = Glb("two.glb")
        self.assertEqual(glb.json["nodes"][glb.node("hand")]["scale"], [0, 0, 0])
        times, sizes = glb.channels("hand")["scale"]
        self.assertEqual((times.tolist(), sizes.tolist()), ([0, 1], [[0, 0, 0], [1, 1, 1]]))
        places = glb.channels("hand")["translation"][1]
        pose = numbers("two")["frames/source_pose"].reshape(2, 3, 4)
        self.assertTrue(np.isnan(pose[0]).all() and abs(places[1] - pose[1, :, 3]).max() < 1e-8)

    def test_solid_ply(self):
        """Faces without a number of their own have that of the tetrahedron behind them."""
        run("block", BOX % 1)
        z = numbers("block")
        export("block", "block.ply")
        with open("block.ply", "rb") as file:
            head, data = file.read().split(b"end_header\n", 1)
        fields = [w.split()[2] for w in head.decode().split("element face")[1].splitlines() if "double" in w]
        row = np.dtype([("n", "u1"), ("corners", "<i4", 3)] + [(f, "<f8") for f in fields])
        face = np.frombuffer(data[-row.itemsize * len(z["faces"]) :], row)
        cells = z["VTKHDF/CellData/magnetization"][-1][: len(z["cells"]), 0]
        self.assertTrue(np.array_equal(face["magnetization_x"], cells[z["cell_of_face"]]))
        stress = z["VTKHDF/CellData/cauchy_stress"][-1][z["cell_of_face"]]
        for column, of in enumerate(("xx", "yy", "zz", "xy", "yz", "xz")):  # docs/result.md
            self.assertTrue(np.array_equal(face["cauchy_stress_" + of], stress[:, column]))
        self.assertTrue((stress[:, 4] != stress[:, 5]).any())


if __name__ == "__main__":
    unittest.main()
