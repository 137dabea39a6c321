"""The package fits its library: functions, structures, types, version; and where it finds it."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import support
from support import slender

PACKAGE = Path(slender.__file__).resolve().parent
CTYPES = {"int": "c_int", "double": "c_double", "SlenderStatus": "c_int", "SlenderType": "c_int"}


class Header(unittest.TestCase):
    def setUp(self) -> None:
        text = (support.SOURCE / "include/slender.h").read_text()
        self.text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)

    def test_functions(self) -> None:
        """Each is there, with as many arguments of such kinds."""
        declared = dict(re.findall(r"SLENDER_API[^;]*?\bslender_(\w+)\(([^)]*)\)", self.text))
        self.assertEqual(set(declared), set(slender._library.FUNCTIONS))
        for name, arguments in declared.items():
            words = [] if arguments == "void" else arguments.split(",")
            kinds = [CTYPES.get(word.split()[0], "?") if "*" not in word else "pointer" for word in words]
            takes = [getattr(kind, "__name__", "") for kind in slender._library.FUNCTIONS[name][1]]
            self.assertEqual(["pointer" if kind.startswith(("c_void", "c_char", "LP_")) else kind for kind in takes], kinds,
                             name)

    def test_structures(self) -> None:
        """The same fields in the same order."""
        for name in ("Error", "Host", "Run", "ModelInfo", "Block", "StateInfo", "MotionDef", "Array"):
            body = re.search(rf"typedef struct Slender{name} {{(.*?)}} Slender{name};", self.text, re.DOTALL)
            assert body
            fields = []
            for part in body[1].split(";"):
                pointer = re.search(r"\(\*(\w+)\)", part)
                fields += [pointer[1]] if pointer else [re.findall(r"\w+", re.sub(r"\[.*?\]", "", word))[-1]
                                                        for word in part.split(",") if word.strip()]
            self.assertEqual([field[0] for field in getattr(slender._library, "C" + name)._fields_], fields)

    def test_version(self) -> None:
        said = re.search(r"project\(slender VERSION (\S+)", (support.SOURCE / "CMakeLists.txt").read_text())
        assert said
        self.assertEqual(slender.__version__, said[1])
        self.assertIn(f"slender {said[1]}", slender.versions())

    def test_types_of_scenes(self) -> None:
        """slender/scene_types.py is what the schema gives."""
        made = support.python(f"import sys; sys.path.insert(0, {str(support.SOURCE / 'python')!r})\n"
                              "import json, slender, make_scene_types\n"
                              "print(make_scene_types.module(json.loads(slender.schema())), end='')")
        self.assertEqual(made.stdout, (support.SOURCE / "python/slender/scene_types.py").read_text(), made.stderr)
        self.assertIn("definitions", json.loads(slender.schema()))


class Found(unittest.TestCase):
    """SLENDER_LIBRARY, beside the package, the clone's, the system's."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.library = slender._library.lib._name
        shutil.copytree(PACKAGE, self.root / "python/slender", ignore=shutil.ignore_patterns("*.so", "__pycache__"))

    def load(self, library: str = "", **more: str) -> "subprocess.CompletedProcess[str]":
        env = {name: value for name, value in os.environ.items() if name != "SLENDER_LIBRARY"}
        env.update({"SLENDER_LIBRARY": library} if library else {}, PYTHONPATH=str(self.root / "python"), **more)
        code = "import slender; print(slender._library.lib._name)"
        return subprocess.run([support.sys.executable, "-c", code], env=env, capture_output=True, text=True, cwd=self.root)

    def refused(self, pattern: str, library: str = "") -> None:
        done = self.load(library)
        self.assertRegex(done.stderr.strip().splitlines()[-1], "^ImportError: .*" + pattern)

    def test_order(self) -> None:
        self.refused(r"libslender cannot be loaded .*libslender\.so\.0.*\./do build")
        system = self.root / "lib"
        system.mkdir()
        shutil.copy(self.library, system / "libslender.so.0")
        self.assertEqual(self.load(LD_LIBRARY_PATH=str(system)).stdout.strip(), "libslender.so.0")
        for place in ("build", "python/slender"):
            (self.root / place).mkdir(exist_ok=True)
            shutil.copy(self.library, self.root / place / "libslender.so")
            self.assertEqual(self.load().stdout.strip(), str(self.root.resolve() / place / "libslender.so"))
        self.assertEqual(self.load(str(system / "libslender.so.0")).stdout.strip(), str(system / "libslender.so.0"))

    def test_refusals(self) -> None:
        self.refused("nowhere.so", str(self.root / "nowhere.so"))
        self.refused("is no libslender", "libm.so.6")

    @unittest.skipUnless(shutil.which("cc"), "no compiler")
    def test_another_version(self) -> None:
        (self.root / "other.c").write_text('const char *slender_version(void) { return "9.9.9"; }\n')
        subprocess.run(["cc", "-shared", "-fPIC", "-o", self.root / "other.so", self.root / "other.c"], check=True)
        self.refused(f"is libslender 9.9.9; this package is for {slender.__version__}", str(self.root / "other.so"))


if __name__ == "__main__":
    unittest.main()
