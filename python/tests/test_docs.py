"""The code on docs/python.md runs: all blocks of a section one after the other, in a folder with the clone's scenes."""
import contextlib
import io
import os
import re
import unittest
from typing import Any

import support

PAGE = (support.SOURCE / "docs/python.md").read_text()
OPTIONAL = ("scipy", "torch", "matplotlib")


class Recipes(support.TestCase):
    def run_section(self, title: str, text: str) -> None:
        for name in ("scenes", "tests"):
            (self.folder / name).symlink_to(support.SOURCE / name)
        before, names = os.getcwd(), {"__name__": title}
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
            try:
                with contextlib.redirect_stdout(io.StringIO()):
                    exec(compile(block, f"docs/python.md, {title}", "exec"), names)
            except ModuleNotFoundError as error:
                if error.name in OPTIONAL:
                    self.skipTest(str(error))
                raise

    def test_lines(self) -> None:
        """The controller is 40 lines."""
        block = re.search(r"## A learned controller.*?```python\n(.*?)```", PAGE, re.DOTALL)
        assert block
        self.assertLessEqual(len(block[1].splitlines()), 40)


def add(title: str, text: str) -> None:
    def test(self: Any) -> None:
        self.run_section(title, text)
    setattr(Recipes, "test_" + re.sub(r"\W+", "_", title).lower(), test)


sections = [section for section in re.split(r"^## ", PAGE, flags=re.MULTILINE) if "```python" in section]
assert len(sections) >= 6
for section in sections:
    add(section.split("\n")[0], section)

if __name__ == "__main__":
    unittest.main(verbosity=2)
