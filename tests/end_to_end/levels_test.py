#!/usr/bin/env python3
"""Dense stereo from coarse to fine: what a run with levels leaves behind, however
it was stopped.

The images of these workspaces are so small that all levels have them at their
full size; quality_test.py has real ones.
"""

import os
import random
import signal
import subprocess
import time
import unittest

import tiny_workspace as tiny

PHOTOMETRIC = ("depth_maps/%s.photometric.bin", "normal_maps/%s.photometric.bin")
GEOMETRIC = ("depth_maps/%s.geometric.bin", "normal_maps/%s.geometric.bin")


class Levels(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def run_in(self, folder, **options):
        self.assert_success(tiny.run_stereo(folder, **{"num_levels": 3, **options}))
        return tiny.snapshot(folder)

    def undisturbed(self, config=None, **options):
        folder = self.path("undisturbed%d" % len(os.listdir(self.folder)))
        tiny.make_workspace(folder)
        if config:
            config(folder)
        return self.run_in(folder, **options)

    def assert_maps(self, files, *patterns):
        maps = {name for name in files if name.endswith(".bin")}
        self.assertEqual(maps, {pattern % name for pattern in patterns
                                for name in self.names})

    def test_only_maps_of_full_size_stay(self):
        result = tiny.run_stereo(self.folder, num_levels=3)
        self.assert_success(result)
        files = tiny.snapshot(self.folder)
        self.assert_maps(files, *PHOTOMETRIC, *GEOMETRIC)
        self.assertFalse(os.path.exists(self.path("stereo", "levels")))
        for which, before in (("photometric", 4), ("geometric", 5)):
            record = files["options.%s.txt" % which].decode()
            self.assertIn("num_levels = 3\n", record)
            self.assertIn("passes_before = level 2 photometric", record)
            self.assertEqual(record.count("level "), before)
        for text in ("level 2 photometric 1/4", "level 1 geometric 4/4",
                     "coarse levels", "100.0 %"):
            self.assertIn(text, result.stdout)

    def test_without_the_geometric_pass(self):
        files = self.run_in(self.folder, geom_consistency=0)
        self.assert_maps(files, *PHOTOMETRIC)

    def test_with_all_that_the_last_pass_writes(self):
        files = self.run_in(self.folder, tapa=1, write_consistency_graph=1,
                            tapa_debug=self.path("pictures"))
        self.assert_maps(files, *PHOTOMETRIC, *GEOMETRIC,
                         "consistency_graphs/%s.geometric.bin")
        self.assertEqual(sorted(os.listdir(self.path("pictures"))), self.names)

    def test_every_level_counts(self):
        name = GEOMETRIC[0] % self.names[0]
        maps = {levels: self.undisturbed(num_levels=levels)[name]
                for levels in (1, 2, 3)}
        self.assertEqual(len(set(maps.values())), 3)

    def test_stopped_at_random_moments(self):
        expected = self.undisturbed()
        rng = random.Random(7)
        for _ in range(12):
            process = subprocess.Popen(
                tiny.stereo_command(self.folder, num_levels=3),
                stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT)
            time.sleep(rng.uniform(0, 0.5))
            process.send_signal(rng.choice([signal.SIGKILL, signal.SIGINT]))
            process.wait()
            for name, content in tiny.snapshot(self.folder).items():
                if name.endswith(".bin") and name in expected:
                    self.assertEqual(content, expected[name], name)
        self.assert_same_files(expected, self.run_in(self.folder))

    def stop_at(self, text):
        self.assertTrue(tiny.stop_stereo_at(self.folder, text, num_levels=3), text)

    def test_levels_of_another_run_are_dropped(self):
        self.stop_at("level 1 photometric 2/4")
        self.assertTrue(os.path.exists(self.path("stereo", "levels", "2")))
        self.assert_same_files(self.undisturbed(seed=1),
                               self.run_in(self.folder, seed=1))

    def test_damaged_levels_are_dropped(self):
        self.stop_at("level 1 photometric 2/4")
        path = self.path("stereo", "levels", "2", "depth_maps",
                         self.names[0] + ".photometric.bin")
        with open(path, "r+b") as file:
            file.truncate(100)
        self.assert_same_files(self.undisturbed(), self.run_in(self.folder))

    def test_lost_maps_are_made_again(self):
        expected = self.run_in(self.folder)
        for pattern in PHOTOMETRIC + GEOMETRIC:
            os.remove(self.path("stereo", pattern % self.names[1]))
        self.assert_same_files(expected, self.run_in(self.folder))

    def test_a_finished_run_is_not_repeated(self):
        self.run_in(self.folder)
        result = tiny.run_stereo(self.folder, num_levels=3)
        self.assert_success(result)
        self.assertNotIn("megapixels in", result.stdout)

    def write_config(self, folder, *views):
        tiny.write_sources(folder, self.names, *views)

    def test_views_added_later(self):
        first = [(0, [1]), (1, [0])]
        both = [*first, (2, [1, 3]), (3, [2])]
        self.write_config(self.folder, *first)
        self.run_in(self.folder)
        self.write_config(self.folder, *both)
        self.assert_same_files(
            self.undisturbed(lambda folder: self.write_config(folder, *both)),
            self.run_in(self.folder))

    def test_a_source_that_only_an_earlier_run_computed(self):
        # Its maps of coarse levels are gone, that of full size is there.
        expected = self.run_in(self.folder)
        for pattern in PHOTOMETRIC + GEOMETRIC:
            os.remove(self.path("stereo", pattern % self.names[0]))
        self.write_config(self.folder, (0, [1, 2, 3]))
        files = self.run_in(self.folder)
        for pattern in GEOMETRIC:
            self.assertEqual(files[pattern % self.names[1]],
                             expected[pattern % self.names[1]])
        depths = tiny.read_map(tiny.map_path(self.folder, self.names[0]))[2]
        self.assertGreater(sum(depth > 0 for depth in depths), len(depths) / 4)

    def test_numbers_of_levels_that_make_no_sense(self):
        for value in (0, -2, 17):
            result = tiny.run_stereo(self.folder, num_levels=value)
            self.assert_one_error(result, "num_levels is %d, but must be" % value)


if __name__ == "__main__":
    unittest.main()
