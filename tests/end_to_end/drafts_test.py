"""With TAPA, views judge each other's drafts at the end: what a run leaves behind, however it
went."""

import os
import unittest

import tiny_workspace as tiny

MAPS = ("depth_maps", "normal_maps")


class Drafts(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def run_in(self, folder, **options):
        result = tiny.run_stereo(folder, **{"tapa": 1, **options})
        self.assert_success(result)
        return tiny.snapshot(folder)

    def undisturbed(self, **options):
        folder = self.path("undisturbed%d" % len(os.listdir(self.folder)))
        tiny.make_workspace(folder)
        return self.run_in(folder, **options)

    def stop_at(self, view, **options):
        self.assertTrue(tiny.stop_stereo_at(
            self.folder, " %s view" % view, **{"tapa": 1, **options}), view)

    def draft_path(self, name, folder="depth_maps"):
        return self.path("stereo", "levels", "0", folder, name + ".draft.bin")

    def geometric(self, files):
        return {name: content for name, content in files.items()
                if name.endswith(".geometric.bin")}

    def test_nothing_of_them_stays(self):
        result = tiny.run_stereo(self.folder, tapa=1)
        self.assert_success(result)
        for text in ("draft 1/4", "draft 4/4", "geometric 1/4", "100.0 %"):
            self.assertIn(text, result.stdout)
        files = tiny.snapshot(self.folder)
        self.assertEqual([name for name in files if "draft" in name or "levels" in name], [])
        self.assertIn("level 0 draft", files["options.geometric.txt"].decode())
        result = tiny.run_stereo(self.folder, tapa=1)
        self.assert_success(result)
        self.assertNotIn("megapixels in", result.stdout)

    def test_only_tapa_has_them(self):
        for options in ({"tapa": 0}, {"tapa_completion_consensus": 0}, {"tapa_completion": 0},
                        {"tapa_refinement": 0}, {"geom_consistency": 0}):
            with self.subTest(options=options):
                folder = self.path("-".join(options))
                tiny.make_workspace(folder)
                result = tiny.run_stereo(folder, **{"tapa": 1, **options})
                self.assert_success(result)
                self.assertNotIn("draft", result.stdout)

    def test_the_rest_is_what_views_did_not_speak_against(self):
        """A pixel keeps its estimate, gets one that source views see, or has none."""
        without = self.undisturbed(tapa_completion_consensus=0)
        files = self.run_in(self.folder)
        for name in files:
            if name.endswith(".photometric.bin"):
                self.assertEqual(files[name], without[name])
        kept = changed = 0
        folder = [name for name in os.listdir(self.folder) if name.startswith("undisturbed")][0]
        for name in self.names:
            draft = tiny.read_map(tiny.map_path(self.path(folder), name))[2]
            depth = tiny.read_map(tiny.map_path(self.folder, name))[2]
            normal = tiny.read_map(tiny.map_path(self.folder, name, "normal_maps"))[2]
            size = len(depth)
            kept += sum(a == b > 0 for a, b in zip(draft, depth))
            changed += sum(a != b for a, b in zip(draft, depth))
            for i, value in enumerate(depth):
                self.assertEqual(value > 0, any(normal[i + k * size] for k in range(3)))
        self.assertGreater(changed, 0)
        self.assertGreater(kept, 4 * changed)

    def test_stopped_at_every_view(self):
        expected = self.undisturbed()
        for text in ("draft 1/4", "draft 4/4", "geometric 1/4", "geometric 3/4"):
            self.stop_at(text)
            for name, content in tiny.snapshot(self.folder).items():
                if name in self.geometric(expected):
                    self.assertEqual(content, expected[name], name)
        self.assert_same_files(expected, self.run_in(self.folder))

    def test_those_of_other_options_are_dropped(self):
        self.stop_at("draft 2/4")
        # The photometric maps are the same with both.
        options = {"tapa_completion_radius": 0.3}
        self.assert_same_files(self.undisturbed(**options), self.run_in(self.folder, **options))

    def test_damaged_ones_are_dropped(self):
        for folder in MAPS:
            with self.subTest(folder=folder):
                self.stop_at("draft 3/4")
                with open(self.draft_path(self.names[1], folder), "r+b") as file:
                    file.truncate(100)
                self.assert_same_files(self.undisturbed(), self.run_in(self.folder))
                for name in self.geometric(tiny.snapshot(self.folder)):
                    os.remove(self.path("stereo", name))

    def test_pictures_that_the_drafts_did_not_have(self):
        expected = self.undisturbed()
        self.stop_at("geometric 1/4")
        self.assert_same_files(expected, self.run_in(self.folder, tapa_debug=self.path("pictures")))
        # Of the views that were not complete, with those of the first picture to the last.
        self.assertEqual(sorted(os.listdir(self.path("pictures"))), sorted(self.names)[-3:])
        for name in os.listdir(self.path("pictures")):
            pictures = sorted(os.listdir(self.path("pictures", name)))
            self.assertEqual([pictures[0], pictures[-1]], ["00_legend.png", "13_final_normals.png"])
            self.assertEqual(len(pictures), 14)

    def test_the_last_picture_is_of_the_result(self):
        self.run_in(self.folder, tapa_debug=self.path("with"))
        other = self.path("other")
        tiny.make_workspace(other)
        self.run_in(other, tapa_debug=self.path("without"), tapa_completion_consensus=0)
        changed = []
        for name in self.names:
            pictures = [tiny.read_rgb_png(self.path(folder, name, "12_final_depth.png"))
                        for folder in ("with", "without")]
            maps = [tiny.read_map(tiny.map_path(folder, name)) for folder in (self.folder, other)]
            changed.append(maps[0] != maps[1])
            self.assertEqual(pictures[0] != pictures[1], changed[-1])
        self.assertTrue(any(changed))

    def test_damaged_graphs(self):
        options = {"write_consistency_graph": 1}
        expected = self.undisturbed(**options)
        self.stop_at("geometric 1/4", **options)
        path = self.draft_path(self.names[2], "consistency_graphs")
        with open(path, "r+b") as file:
            file.truncate(os.path.getsize(path) - 4)
        result = tiny.run_stereo(self.folder, tapa=1, **options)
        self.assert_one_error(result, path, "damaged", "remove it")
        os.remove(path)
        self.assert_same_files(expected, self.run_in(self.folder, **options))

    def test_graphs_that_the_drafts_did_not_have(self):
        options = {"write_consistency_graph": 1}
        expected = self.undisturbed(**options)
        self.stop_at("draft 4/4")
        files = self.run_in(self.folder, **options)
        self.assert_same_files(expected, files)
        for name in self.names:
            path = self.path("stereo", "consistency_graphs", name + ".geometric.bin")
            pixels = tiny.read_graph(path)
            self.assertGreater(len(pixels), 10)
            width, _, depth = tiny.read_map(tiny.map_path(self.folder, name))
            for col, row in pixels:
                self.assertGreater(depth[row * width + col], 0)

    def test_sources_that_are_not_listed_have_no_say(self):
        tiny.write_sources(self.folder, self.names, (0, [1, 2, 3]))
        with_consensus = self.geometric(self.run_in(self.folder))
        for name in with_consensus:
            os.remove(self.path("stereo", name))
        os.remove(self.path("stereo", "options.geometric.txt"))
        without = self.geometric(self.run_in(self.folder, tapa_completion_consensus=0))
        self.assertEqual(len(without), 2)
        self.assertEqual(with_consensus, without)

    def test_views_added_later(self):
        """Those that are complete stay, and make drafts again for what the new ones are asked by."""
        first = [(0, [1]), (1, [0])]
        both = [*first, (2, [1, 3]), (3, [2])]
        tiny.write_sources(self.folder, self.names, *first)
        before = self.geometric(self.run_in(self.folder))
        self.assertEqual(len(before), 4)
        tiny.write_sources(self.folder, self.names, *both)
        result = tiny.run_stereo(self.folder, tapa=1)
        self.assert_success(result)
        files = tiny.snapshot(self.folder)
        self.assertEqual({name: files[name] for name in before}, before)
        for number, count in ((1, 0), (2, 1), (3, 1), (4, 1)):
            self.assertEqual(result.stdout.count(" draft %d/4 " % number), count, result.stdout)
        for name in self.geometric(files):
            os.remove(self.path("stereo", name))
        self.assert_same_files(files, self.run_in(self.folder))

    def test_lost_maps_are_made_again(self):
        expected = self.run_in(self.folder)
        os.remove(tiny.map_path(self.folder, self.names[1]))
        os.remove(tiny.map_path(self.folder, self.names[2], "normal_maps"))
        self.assert_same_files(expected, self.run_in(self.folder))

    def test_range_of_depths(self):
        """Asked for, it holds for what other views see, too."""
        self.run_in(self.folder, depth_min=3.5, depth_max=4.5)
        for name in self.names:
            depth = tiny.read_map(tiny.map_path(self.folder, name))[2]
            self.assertTrue(any(depth))
            for value in depth:
                self.assertTrue(value == 0 or 3.5 <= value <= 4.5, value)

    def test_masks(self):
        for name in self.names:
            tiny.write_mask(self.path("masks", name + ".png"))
        without = self.run_in(self.folder, mask_path=self.path("masks"),
                              tapa_completion_consensus=0)
        masked = {}
        for name in self.names:
            width, height, depth = tiny.read_map(tiny.map_path(self.folder, name))
            # The border of a mask is half of the image.
            masked[name] = [i for i in range(width * height) if i % width < width // 2 - 1]
            self.assertFalse(any(depth[i] for i in masked[name]))
        for name in self.geometric(without):
            os.remove(self.path("stereo", name))
        os.remove(self.path("stereo", "options.geometric.txt"))
        self.run_in(self.folder, mask_path=self.path("masks"))
        for name in self.names:
            depth = tiny.read_map(tiny.map_path(self.folder, name))[2]
            self.assertFalse(any(depth[i] for i in masked[name]))


if __name__ == "__main__":
    unittest.main()
