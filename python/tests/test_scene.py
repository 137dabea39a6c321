"""Scenes: from files, dicts and texts; what is wrong with them is one sentence that says where."""
import json
import unittest
from pathlib import Path

import support
from support import np, slender


class Scenes(support.TestCase):
    def test_sources_say_the_same(self) -> None:
        path = self.folder / "strip.yaml"
        path.write_text(json.dumps(support.STRIP))
        texts = {slender.Scene(source).text for source in (path, str(path), support.STRIP)}
        texts.add(slender.Scene.parse(path.read_text()).text)
        self.assertEqual(len(texts), 1)

    def test_numbers_of_numpy(self) -> None:
        scene = support.strip()
        scene["shell"]["young"] = np.float64(1e5)
        scene["shell"]["mesh"]["cells"] = np.array([6, 2])
        scene["shell"]["magnetization"] = np.array([2e4, 0, 0], dtype=np.float32)
        scene["flux_density"] = (0, np.int64(0), 0.005)
        scene["fix"][0]["clamp"] = np.bool_(True)
        self.assertEqual(slender.Scene(scene).text, slender.Scene(support.STRIP).text)
        tiny = slender.Scene(support.strip(flux_density=np.array([1e-300, 1 / 3, 5e-3])))
        self.same(tiny.model().params["flux_density"][0], [1e-300, 1 / 3, 5e-3])

    def test_paths(self) -> None:
        (self.folder / "sheet.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")
        scene = support.strip(fix=[])
        scene["shell"]["mesh"] = {"file": self.folder / "sheet.obj"}
        self.assertEqual(support.model_of(scene).points, 4)

    def test_set(self) -> None:
        scene = slender.Scene(support.STRIP, set={"shell.thickness": "2 mm", "shell.young": np.float64(2e5), "modes": 3,
                                                  "flux_density": np.array([0, 0, 0.001])})
        for line in ("value: 0.002", "value: 200000", "modes: 3", "value: [0, 0, 0.001]"):
            self.assertIn(line, scene.text)

    def test_what_is_wrong(self) -> None:
        path = self.folder / "bad.yaml"
        path.write_text("slender: 1\njob: equilibrium\nshell: {thickness: -1 mm}\n")
        error = self.refuses(slender.SceneError, rf"^{path}:3:\d+: ", slender.Scene, path)
        self.assertEqual(getattr(error, "status"), 3)
        self.assertIsInstance(error, slender.Error)
        scene = support.strip()
        scene["shell"]["thickness"] = "-1 mm"
        self.refuses(slender.SceneError, r"^shell\.thickness", slender.Scene, scene)
        self.refuses(slender.SceneError, "thicknes", slender.Scene, support.STRIP, set={"shell.thicknes": 1})
        self.refuses(slender.SceneError, "nowhere.yaml", slender.Scene, Path("nowhere.yaml"))
        self.refuses(TypeError, "cannot hold", slender.Scene, support.strip(modes=object()))
        scene["shell"].update(thickness="1 mm", mesh={"file": "nowhere.obj"})
        self.refuses(slender.SceneError, "nowhere.obj", slender.Scene(scene).model)

    def test_a_model_keeps_its_scene(self) -> None:
        scene = slender.Scene(support.STRIP)
        model = scene.model()
        del scene
        self.assertEqual(model.equilibrium().status, "converged")

    def test_what_is_doubtful(self) -> None:
        with self.assertWarns(slender.SlenderWarning) as caught:
            model = slender.Scene(support.strip(flux_density=[0, 0, 5])).model()
        self.assertEqual(model.warnings[0], str(caught.warning))
        self.assertEqual(caught.filename, __file__)


if __name__ == "__main__":
    unittest.main()
