"""Every key of the schema, set in small scenes of every job: what changes nothing must be refused.

  /usr/bin/python3 tests/keys.py PROGRAM [SCENE ..]      needs numpy and h5py

A key that may change nothing is in FREE. Prints what is ignored, what is refused and why; ends with 1 where a key is
ignored. Ten minutes."""
import json, os, subprocess, sys, tempfile
import h5py, numpy as np

FREE = {
    "solver.max_iterations", "solver.step_tolerance", "solver.force_tolerance",  # where the first guess is good enough
    "output.every", "output.precision",  # of frames, where there is one
    "design.tolerance", "rod.curve.where", "output.png",  # no pictures are made here
    "spline.tolerance", "spline.rounds", "spline.draft",  # where iterations are done before
    "shell.coercivity", "solid.coercivity", "rod.coercivity",  # which warn only
    "solver.direct",  # finds the same
    "time", "time.step", "time.steps",  # the statics of a motion's scene leave them
}

SHELL = """
shell:
  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [4, 2]}
  thickness: 1 mm
  young: 1 MPa
  poisson: 0.3
  magnetization: [20000, 0, 5000]
  gravity: [0, 0, -1]
flux_density: ["0", "0", "0.02*(1 + t)"]
fix: [{group: root, clamp: true}]
"""
SOLID = """
solid:
  mesh: {shape: box, size: [20 mm, 6 mm, 4 mm], cells: [2, 1, 1]}
  young: 0.1 MPa
  poisson: 0.3
  magnetization: [10000, 0, 5000]
  gravity: [0, 0, -1]
  skin: {thickness: 1 mm, magnetization: [20000, 0, 5000], young: 0.2 MPa, poisson: 0.3}
flux_density: ["0", "0", "0.02*(1 + t)"]
fix: [{group: left}]
"""
ROD = """
  length: 200 mm
  radius: 1 mm
  young: 2 MPa
  poisson: 0.4
  density: 1100
  magnetization: [20000, 0, 0]
"""
CURVE = """
  curve: {formula: ["u", "0.1*u*u", "-u*u"], range: [0, 0.2]}
  radius: 1 mm
  young: 20 MPa
  poisson: 0.4
  density: 1100
"""
FLUX = 'flux_density: ["0.01", "0", "0.02*(1 + t)"]\n'
SCENES = {
    "shell equilibrium": "job: equilibrium" + SHELL,
    "shell sequence": "job: equilibrium" + SHELL + "sequence: [{}, {gravity: [0, 0, -2]}]\n",
    "shell evaluate": "job: evaluate" + SHELL,
    "shell design": "job: design" + SHELL + """
target: ["x", "y", "20*x*x"]
design: {unknowns: {magnetization: {noise: 100}}, objectives: [{target: 1}], iterations: 3}
""",
    "shell simulate": "job: simulate" + SHELL + "time: {step: 5 ms, steps: 5}\n",
    "shell trajectory": "job: trajectory" + SHELL + """
time: {step: 5 ms, steps: 5}
design: {unknowns: {flux_density: {noise: 0.01}}, objectives: [{waypoint: {mass_center: true, at: [0.02, 0, 0.01]}}], iterations: 3}
""",
    "solid equilibrium": "job: equilibrium" + SOLID,
    "solid evaluate": "job: evaluate" + SOLID,
    "solid design": "job: design" + SOLID + """
target: ["x", "y", "z + 10*x*x"]
design: {unknowns: {magnetization: {noise: 100}}, objectives: [{target: 1}], iterations: 3}
""",
    "solid simulate": "job: simulate" + SOLID + "time: {step: 5 ms, steps: 5}\n",
    "solid trajectory": "job: trajectory" + SOLID + """
time: {step: 5 ms, steps: 5}
design: {unknowns: {flux_density: {noise: 0.01}}, objectives: [{waypoint: {mass_center: true, at: [0.02, 0, 0.01]}}], iterations: 3}
""",
    "rod equilibrium": "job: equilibrium\nrod:\n  natural_strain: [1, 2, 3]" + ROD + "  elements: 20\n" + FLUX + "",
    "rod section": "job: equilibrium\nrod:\n  model: cosserat\n  natural_strain: [1, 2, 3]\n  length: 0.2\n  section: {area: 4.0e-6, I1: 1.0e-12, I2: 2.0e-12, J: 1.5e-12, kappa: [0.8, 0.7]}\n"
    "  young: 5 MPa\n  poisson: 0.4\n  density: 1180\n  elements: 20\n" + FLUX,
    "rod curve": "job: equilibrium\nrod:" + CURVE + "  elements: 20\n" + FLUX,
    "rod held": "job: equilibrium\nrod:\n  natural_strain: [1, 2, 3]" + ROD + "  elements: 20\n  end: {position: [0.15, 0, 0]}\n" + FLUX,
    "rod evaluate": "job: evaluate\nrod:" + CURVE + "  elements: 20\n  start: curve\n" + FLUX,
    "rod design": "job: design\nrod:\n  natural_strain: [0, 0, 0]" + ROD + "  elements: 20\n" + FLUX + """target: ["s", "0", "s*s"]
design: {unknowns: {magnetization: {noise: 100}}, objectives: [{target: 1}], iterations: 3}
""",
    "rod simulate": "job: simulate\nrod:\n  natural_strain: [1, 2, 3]" + ROD + "  elements: 20\n" + FLUX + "time: {step: 5 ms, steps: 5}\n",
    "rod curve simulate": "job: simulate\nrod:" + CURVE + "  elements: 20\n  start: curve\n  gravity: [0, 0, -5]\n" + FLUX + "time: {step: 5 ms, steps: 5}\n",
    "rod trajectory": "job: trajectory\nrod:\n  natural_strain: [1, 2, 3]" + ROD + "  elements: 20\n" + FLUX + """time: {step: 5 ms, steps: 5}
design: {unknowns: {flux_density: {noise: 0.01}}, objectives: [{waypoint: {vertex: tip, at: [0.15, 0, 0.05]}}], iterations: 3}
""",
    "rod preview": "job: simulate\nrod:" + CURVE + "  elements: 20\n  solver: pbd\n  magnetization: [20000, 0, 0]\n" + FLUX + "time: {step: 5 ms, steps: 5}\n",
    "rod invert": "job: invert\nrod:" + CURVE + "  elements: 20\n  magnetization: [1000, 0, 0]\n" + FLUX,
    "rod invert file": "job: invert\nrod:\n  curve: {file: points.csv}" + CURVE.split("\n", 2)[2].join(["\n", ""]) + "  elements: 20\n  magnetization: [1000, 0, 0]\n" + FLUX,
    "rod identify": "job: identify\nrod:\n  poses:\n" + "".join(
        "    - {file: pose%d.csv, frame: %s, noise: 0.1 mm}\n" % (k, f) for k, f in enumerate([
            "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
            "[[0.9397, 0, -0.3420], [0.3368, -0.1736, 0.9254], [-0.0594, -0.9848, -0.1632]]",
            "[[0, 0, -1], [0, 1, 0], [1, 0, 0]]"])) + "  radius: 1.3 mm\n  density: 1180\n  elements: 40\n  magnetization: [2000, 0, 0]\n" + FLUX,
    "spline": """job: draw
spline:
  density: "0.3 + 0.4*u"
  page: {size: [60 mm, 40 mm], margin: 2 mm}
  pen: 0.6 mm
  iterations: 10
  rounds: 1
""",
    "spline image": """job: draw
spline:
  image: grey.pgm
  page: {size: [60 mm, 40 mm], margin: 2 mm}
  pen: 0.6 mm
  iterations: 10
  rounds: 1
  pens: [cyan, black]
  separation: cmyk
""",
    "spline regions": """job: draw
spline:
  density: "0.3 + 0.4*u"
  page: {size: [60 mm, 40 mm], margin: 2 mm}
  pen: 0.6 mm
  iterations: 10
  rounds: 1
  regions: [{mask: grey.pgm}]
""",
}

# Values by section and key; else they follow from the kind.
VALUES = {
    "scene.fix": ["[{boundary: true}]"], "scene.loads": ["[{force: [0, 0, 1 mN]}]"],
    "scene.target": ['["x + 0.001", "y", "10*x"]', '["s", "0", "-s"]'],
    "scene.cases": ["[{name: one, gravity: [0, 0, -3]}, {name: two}]", "[{weight: 2}]"],
    "scene.sequence": ["[{gravity: [0, 0, -3]}, {gravity: [0, 0, -4]}]"],
    "scene.design": ["{unknowns: {magnetization: {}}, objectives: [{target: 1}]}"],
    "scene.checks": ["[stability]", "[self_contact]", "[round_trip]"], "scene.load_steps": ["3"],
    "scene.time": ["0.1 s", "{step: 1 ms, steps: 3}"], "time.at": ["0.1 s"], "time.step": ["4 ms"], "time.steps": ["4"],
    "scene.flux_density": ["[0.01, 0, 0]", '["0.01*t", "0.1*x", "0.02"]', "{dipole: {at: [0, 0, 0.1], moment: [0, 0, 1]}}"],
    "scene.obstacles": ["[{plane: {point: [0, 0, -0.0005]}}]", "[{sphere: {center: [0.03, 0, 0.005], radius: 5 mm}}]"],
    "shell.gravity": ["[0, 1, -3]"], "solid.gravity": ["[0, 1, -3]"], "clamp.position": ["[0.01, 0, 0]"],
    "end.position": ["[0.1, 0, 0]"], "magnetization.value": ["[1, 2, 3]"], "natural_strain.value": ["[0, 0, 4]"],
    "natural_strain.formula": ['["0", "s", "1"]'], "natural_strain.where": ["{a: s}"], "natural_strain.file": [],
    "velocity.value": ["[0, 0, 0.1]"], "velocity.formula": ['["0", "0", "x"]'], "velocity.where": ["{a: x}"], "velocity.file": [],
    "velocity of water.value": ["[0.1, 0, 0]"], "velocity of water.formula": ['["0.1", "0", "x"]'], "velocity of water.where": ["{a: x}"],
    "unknown young.bounds": ["[0.1 MPa, 0.2 MPa]"], "unknown thickness.bounds": ["[0.5 mm, 0.9 mm]"], "unknown fold.bounds": ["[0.5, 0.9]"],
    "unknown natural_strain.bounds": ["[-0.5, 0.5]"], "unknown source_strength.bounds": ["[0.5, 0.9]"],
    "unknown source_move.bounds": ["[-1 mm, 1 mm]"], "unknown source_turn.bounds": ["[-0.1, 0.1]"],
    "unknown source_strength.sources": ["[source1]"], "unknown source_move.sources": ["[source1]"],
    "unknown source_turn.sources": ["[source1]"], "cross.from": ["0.3"], "flow.formula": ['["1", "u"]'], "flow.where": ["{a: u}"],
    "potential.formula": ['"x"'], "potential.where": ["{a: u}"], "frame.formula": ['"s"'], "frame.file": ["frame.csv"],
    "pose.file": [], "pose.formula": ['["x", "y", "0.1*x"]'], "pose.where": ["{a: x}"], "start.result": [], "start.case": [],
    "start of flux_density.file": [], "start of flux_density.value": ["[0.01, 0, 0]"], "start of a drawing.file": [],
    "servo.up": ["M1"], "servo.down": ["M2"], "size of a page.name": ["a6"], "size of a page.sides": ["[50 mm, 40 mm]"],
    "place of a skin.group": ["left"],
    "shell.pose": [], "shell.velocity": ["[0, 0, 0.1]"],
    "rod.radius": ["1.2 mm", '"0.001*(1 + s/L)"'], "rod.young": ["4 MPa", '"4e6*(1 + s/L)"'], "section of a rod.kappa": ["[0.6, 0.7]"],
    "section of a rod.area": ["3.0e-6"], "section of a rod.I1": ["2.0e-12"], "section of a rod.I2": ['"2e-12*(1 + s/L)"'], "section of a rod.J": ["2.0e-12"],
    "length along a rod.formula": ['"0.001*(1 + s/L)"'], "young along a rod.formula": ['"4e6*(1 + s/L)"'],
    "length along a rod.where": ["{a: s}"], "young along a rod.where": ["{a: s}"], "area along a rod.where": ["{a: s}"],
    "moment of area along a rod.where": ["{a: s}"],
    "rod.natural_strain": ["[0, 0, 4]"], "rod.poses": [], "rod.ellipse": ["[1 mm, 2 mm]"],
    "rod.clamp": ["{position: [0.01, 0, 0]}", "{frame: [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]}"],
    "rod.end": ["{position: [0.1, 0, 0]}"], "rod.loads": ["[{point: 0.1, force: [0, 0, -1 mN]}]", "[{line: [0, 0, -1 mN/m]}]"],
    "rod.velocity": ["[0, 0, 0.1]"], "rod.bishop_normal": ["[0, 1, 0.1]"], "rod.magnetization": ["[10000, 0, 0]"],
    "rod.frame": ["frenet", '{formula: "s"}', "{formula: \"s\", from: bishop}", "{file: frame.csv}"], "rod.length": ["190 mm"],
    "frame.from": ["bishop"], "rod.pbd": ["{substeps: 20}"], "rod.gravity": ["[0, 1, -3]"],
    "curve of a rod.range": ["[0, 0.19]"], "curve of a rod.where": ["{a: u}"], "curve of a rod.parameter": ["v"],
    "curve of a rod.noise": ["0", "1 mm"], "curve of a rod.file": [], "curve of a rod.formula": ['["u", "0", "0"]'],
    "end.frame": ["[[0, 1, 0], [-1, 0, 0], [0, 0, 1]]"], "clamp.frame": ["[[0, 1, 0], [-1, 0, 0], [0, 0, 1]]"],
    "young.groups": ["{flap: 1 MPa}"], "young.other": ["3 MPa"], "young.where": ["{a: x}"], "young.file": [], "young.formula": ['"1e6+x"'],
    "thickness.groups": ["{flap: 1 mm}"], "thickness.other": ["2 mm"], "thickness.where": ["{a: x}"], "thickness.file": [], "thickness.formula": ['"1e-3+0.01*x"'],
    "density.groups": ["{flap: 900}"], "density.other": ["800"], "density.where": ["{a: x}"], "density.file": [], "density.formula": ['"900+1e4*x"'],
    "fold.groups": [], "fold.other": ["3"], "fold.where": ["{a: x}"], "fold.file": [], "fold.formula": ['"1+10*x"'],
    "magnetization.groups": [], "magnetization.other": ["[1, 2, 3]"], "magnetization.where": ["{a: x}"], "magnetization.file": [],
    "magnetization.formula": ['["x", "1", "2"]'], "flux_density.file": [], "flux_density.where": ["{a: x}"],
    "mesh.file": [], "mesh.shape": [], "mesh.n": ["3"], "mesh.size": ["[50 mm, 20 mm]"], "mesh.cells": ["[3, 2]"],
    "spline.pens": ["[{name: black, turn: 30 deg}, {name: red, width: 2 mm}]", "[{name: white, opaque: true}]"], "spline.paper": ['"#101010"'], "spline.separation": ["cmyk", "{kind: tones}"],
    "spline.cross": ["{from: [0, 0.3]}"], "spline.regions": ["[{mask: grey.pgm}]", "[{mask: grey.pgm, invert: true, direction: 40 deg}]"], "spline.direction": ["30 deg", '{formula: ["1", "u"]}', "{file: grey.pgm}"],
    "spline.potential": ['"x"'], "spline.flow": ['["1", "u"]'], "spline.density": ['"0.5*v"'], "spline.image": [],
    "tone.curve": ["[[0, 1], [1, 0]]"], "tone.crop": ["[0, 0, 0.5, 1]"], "page.size": ["[50 mm, 40 mm]"],
    "spline.pair": ["{radius: 2}"], "direction.where": ["{a: x}"], "direction.formula": ['["1", "u"]'], "direction.file": [],
    "density of a drawing.where": ["{a: x}"], "density of a drawing.formula": ['"0.5*v"'],
    "output.svg": ["o.svg"], "output.png": ["o.png"], "output.gcode": ["o.g"], "output.gcode_servo": ["o.g"], "output.hpgl": ["o.hpgl"],
    "spline.start": ["random", "{kind: random, segments: 5}", "{kind: random, separation: 1}", "{kind: random, longest: 10 mm}"],
    "spline.energies": [], "unknowns.young": ["{bounds: [1 MPa, 2 MPa]}"], "unknowns.thickness": ["{bounds: [1 mm, 2 mm]}"], "unknowns.fold": ["{bounds: [0.5, 2]}"],
    "unknowns.flux_density": ["{}", "{noise: 0.01}", "{noise: 0.01, per: knot}", "{noise: 0.01, knots: 3}", "{noise: 0.01, start: [0, 0.01, 0]}"],
    "unknowns.magnetization": [], "unknowns.skin_young": ["{bounds: [0.1 MPa, 1 MPa]}"],
    "solid.pose": [], "solid.velocity": ["[0, 0, 0.1]"], "solid.order": ["1"], "solid.averaging": ["0.3"],
    "mesh of a solid.file": [], "mesh of a solid.shape": [], "mesh of a solid.extrude": [], "mesh of a solid.surface": [],
    "mesh of a solid.size": ["[30 mm, 6 mm, 4 mm]"], "mesh of a solid.cells": ["[3, 1, 1]"], "mesh of a solid.n": ["2"],
    "skin.on": ["top"],
    "unknown magnetization.start": ["[1, 2, 3]"], "unknown flux_density.start": ["[0.01, 0, 0]"],
    "unknown magnetization.bounds": ["[-1000, 1000]"], "unknown flux_density.bounds": ["[-0.005, 0.005]"],
    "design.objectives": ["[{target: 1}, {height: 1, pairs: 7}]", "[{target: 1, of: root}]", "[{target: 1, frame: 0}]",
                          "[{target: 1}, {magnetization_smoothness: 1.0e-9, frame: 0}]", "[{field_magnitude: 1, of: root}]",
                          "[{field_magnitude: 1, pairs: 7}]", "[{field_magnitude: 1, frame: 2}]",
                          "[{waypoint: {mass_center: true, at: [0.02, 0, 0.01]}, frame: 2}]", "[{target: 1}, {field_smoothness: 1}]"],
}
ONLY = {"loads of a rod", "poses", "pens", "objectives", "cases", "sequence", "fix", "loads", "selection", "target"}  # as wholes


def values_of(section, key, schema):
    given = VALUES.get(section + "." + key)
    if given is not None: return given
    kinds = schema["allOf"][0]
    if "enum" in kinds: return kinds["enum"]
    kind = kinds.get("type")
    if kind == "boolean": return ["true"]
    if kind in ("number", "integer") or kind == ["number", "string"]:
        low, high = kinds.get("minimum", kinds.get("exclusiveMinimum", 0)), kinds.get("maximum", kinds.get("exclusiveMaximum"))
        if kind == "integer": return [str(v) for v in (low + 1, low + 2) if high is None or v <= high]
        return ["%.3g" % (low + f * (high - low if high is not None else 1)) for f in (0.31, 0.77)]
    return None


def keys(schema, section, node, path, depth=0):
    for key, row in node["properties"].items():
        if key in ("slender", "job"): continue
        here = path + "." + key if path else key
        kinds = row["allOf"][0]
        for value in values_of(section, key, row) or []: yield here, value
        name = kinds.get("$ref", "").rsplit("/", 1)[-1]
        if name and name not in ONLY and depth < 4:
            below = schema["definitions"][name]
            yield from keys(schema, name, below["anyOf"][0] if "anyOf" in below else below, here, depth + 1)


def effective(path):
    """The scene with all its defaults: a value that says no more than the default leaves it as it is."""
    with h5py.File(path) as f:
        value = f["slender/scene"][()] if "scene" in f["slender"] else f["slender"].attrs["scene"]
        return value if isinstance(value, (bytes, str)) else bytes(value)


def arrays(path):
    """All numbers that depend on the physics: no parameters, which a result repeats."""
    found = {}
    with h5py.File(path) as f:
        def visit(name, item):
            skip = ("scene", "versions", "seconds")
            if isinstance(item, h5py.Dataset) and not name.endswith(skip) and "/design/" not in name:
                found[name] = item[()]
        f.visititems(visit)
        for name, value in f["slender"].attrs.items():
            if name not in ("scene", "versions", "seconds"): found["@" + name] = value
    return found


def same(a, b):
    return a.keys() == b.keys() and all(np.array_equal(a[k], b[k]) or (np.asarray(a[k]).dtype.kind == "f" and
                                        np.array_equal(a[k], b[k], equal_nan=True)) for k in a)


def run(program, scene, value=None):
    for name in os.listdir("."):
        if name.startswith("out") or name.startswith("o."): os.remove(name)
    command = [program, "run", scene, "-o", "out", "--force", "--quiet", "--no-picture", "--threads", "1"]
    if value: command += ["--set", value]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120)
    files = sorted(n for n in os.listdir(".") if n.startswith("o.") or (n.startswith("out") and not n.startswith("out.")))
    return done.returncode, done.stderr.strip().split("\n")[0], files


def main():
    program, wanted = os.path.abspath(sys.argv[1]), sys.argv[2:]
    here = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    schema = json.loads(subprocess.run([program, "schema"], capture_output=True, text=True).stdout)
    ignored = []
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        for k in range(3):
            with open(f"{here}/scenes/curves/pose{k}.csv") as f, open(f"pose{k}.csv", "w") as g: g.write(f.read())
        u = np.linspace(0, 0.2, 40)
        noise = 1e-5 * np.random.default_rng(1).normal(size=(40, 3))
        np.savetxt("points.csv", np.c_[u, 0.1 * u * u, -u * u] + noise, delimiter=",")
        np.savetxt("frame.csv", np.c_[[0, 0.1], [[0, 1, 0], [0, 1, 0.3]]], delimiter=",")
        with open("grey.pgm", "wb") as f: f.write(b"P5 16 16 255\n" + bytes(range(256)))
        for name, text in SCENES.items():
            if wanted and name not in wanted: continue
            with open("scene.yaml", "w") as f: f.write("slender: 1\n" + text)
            code, sentence, files = run(program, "scene.yaml")
            if code not in (0, 1):
                print(f"{name}: does not run: {sentence}")
                ignored.append(name)
                continue
            base, said, seen = arrays("out.vtkhdf"), effective("out.vtkhdf"), 0
            for key, value in keys(schema, "scene", schema["allOf"][0], ""):
                body = key.split(".")[0]
                if body in ("shell", "solid", "rod", "spline") and not name.startswith(body): continue
                seen += 1
                code, sentence, now = run(program, "scene.yaml", f"{key}={value}")
                if code not in (0, 1):
                    print(f"{name}: {key}={value}: refused {code}: {sentence}")
                elif effective("out.vtkhdf") == said:
                    continue
                elif same(base, arrays("out.vtkhdf")) and files == now and key not in FREE:
                    print(f"{name}: {key}={value}: IGNORED")
                    ignored.append(f"{name}: {key}={value}")
            print(f"{name}: {seen} values tried", flush=True)
    print(f"{len(ignored)} ignored")
    sys.exit(1 if ignored else 0)


main()
