"""Wheels carry libslender.so, which is built by cmake from the C sources around this folder, or from `source` in an sdist.

`./do wheel` makes both. The library is for any processor of the architecture (SLENDER_NATIVE=OFF), and for machines with the
shared libraries that it was linked with: so the tag is linux_x86_64, not manylinux's."""
import os
import re
import shutil
import subprocess
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist
from wheel.bdist_wheel import bdist_wheel

HERE = Path(__file__).resolve().parent
SOURCE = HERE / "source" if (HERE / "source").exists() else HERE.parent
PARTS = ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "lib/CMakeLists.txt", "lib/slender.map", "package/*", "*/*.[ch]",
         "*/front/*.[ch]")
VERSION = re.search(r'^VERSION = "(.*?)"', (HERE / "slender/_library.py").read_text(), re.MULTILINE)[1]


class WithLibrary(build_py):
    def run(self):
        super().run()
        build = HERE / "build" / "library"
        subprocess.run(["cmake", "-S", SOURCE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-O3",
                        "-DSLENDER_NATIVE=OFF", "-DSLENDER_TESTS=OFF"], check=True)
        subprocess.run(["cmake", "--build", build, f"-j{os.cpu_count()}", "--target", "slender_shared"], check=True)
        for file in (build / "libslender.so", SOURCE / "LICENSE"):
            shutil.copy(file, Path(self.build_lib) / "slender")


class ForThisPlatform(bdist_wheel):
    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


class WithSources(sdist):
    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        for path in {path for part in PARTS for path in SOURCE.glob(part)}:
            name = path.relative_to(SOURCE)
            if name.parts[0] in ("tests", "bench", "examples") or name.parts[0].startswith("build") or path.is_dir():
                continue
            (Path(base_dir) / "source" / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, Path(base_dir) / "source" / name)


class Binary(Distribution):
    def has_ext_modules(self):
        return True  # a library of this platform's


setup(version=VERSION, distclass=Binary,
      cmdclass={"build_py": WithLibrary, "bdist_wheel": ForThisPlatform, "sdist": WithSources})
