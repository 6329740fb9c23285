"""Scenes that are rendered before they are evaluated, with a stand-in for the renderer."""

import os
import unittest

from helpers import ProgramTest
from evaluation import evaluate, plan, processes, scenes

_PLAN = """
page = "page.md"
title = "Results"
[sets.cave]
data = "cave"
num_views = 1
"""


class ScenesTest(ProgramTest):
    main = evaluate.main

    def setUp(self):
        super().setUp()
        self.write("cave/scene.pov")
        self.addCleanup(setattr, scenes, "PROGRAM", scenes.PROGRAM)
        scenes.PROGRAM = self.write(
            "generate", "#!/bin/sh\n[ \"$2\" = --out ] || exit 3\n"
            "mkdir -p \"$3/$1/images\" \"$3/$1/sparse\" \"$3/$1/gt_depth\"\n"
            "for i in 0 1 2; do touch \"$3/$1/images/$i.jpg\" \"$3/$1/gt_depth/$i.png\"; done\n",
            executable=True)
        self.out = self.path("out")
        self.rendered = self.path("out/scenes/cave")

    def test_what_is_a_scene(self):
        cave = self.path("cave")
        self.assertTrue(scenes.is_scene(cave))
        self.assertEqual(scenes.rendered(cave, self.out), self.rendered)
        os.makedirs(self.path("cave/images"))  # As examples/room.
        self.assertFalse(scenes.is_scene(cave))
        self.assertEqual(scenes.rendered(cave, self.out), cave)
        self.assertFalse(scenes.is_scene(self.path("none")))

    def test_dry_run_tells_how_it_is_rendered(self):
        plan_path = self.write("plan.toml", _PLAN)
        for words in ([self.path("cave")], ["--plan", plan_path, "--data", self.folder]):
            status, printed, _ = self.run_main(*words, "--out", self.out, "--dry_run", "--no_clouds")
            self.assertEqual(status, 0)
            lines = printed.splitlines()
            self.assertEqual(lines[0], f"{scenes.PROGRAM} cave --out {self.out}/scenes")
            self.assertIn(f"make_workspace.sh {self.rendered} ", lines[1])
            self.assertFalse(os.path.exists(self.out))

    def test_a_plan_renders_and_chooses_views(self):
        page = plan.Plan(self.write("plan.toml", _PLAN), self.folder, "/none", self.out)
        self.assertEqual((page.sets["cave"].data, page.sets["cave"].views), (self.rendered, []))
        scenes.render(page.scenes["cave"], self.out)
        page.choose_views("cave")
        self.assertEqual(page.sets["cave"].views, ["1.jpg"])

    def test_what_cannot_be_rendered_is_left_out_of_a_plan(self):
        said = []
        processes.say = said.append
        self.write("generate", "#!/bin/sh\necho 'ERROR: no renderer' >&2\nexit 1\n", executable=True)
        status, _, errors = self.run_main(
            "--plan", self.write("plan.toml", _PLAN), "--data", self.folder, "--out", self.out)
        self.assertEqual((status, errors), (0, ""))
        self.assertRegex(said[-1], "^SKIPPED: cave: generate: no renderer \\(see .*generate.log\\)$")
        status, _, errors = self.run_main(self.path("cave"), "--out", self.out)
        self.assertEqual(status, 1)
        self.assertIn("no renderer", errors)


if __name__ == "__main__":
    unittest.main()
