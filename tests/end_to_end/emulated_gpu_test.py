"""Dense stereo on an emulated GPU, which works or does not.
"""

import os
import re
import unittest

import tiny_workspace as tiny


CPU = {"use_gpu": 0}


def gpu(index):
    return {"gpu_index": index}


class EmulatedGpu(tiny.TestCase):

    def stereo(self, name, workers, size=40, masks="", **environment):
        """A run in a workspace of its own; size: of the images, as it is slow."""
        folder = self.path(name)
        self.names = tiny.make_workspace(folder, num_views=3)
        command = tiny.stereo_command(folder, tapa=1, num_threads=1,
                                      max_image_size=size, mask_path=masks,
                                      **workers)
        result = tiny.run([os.environ["EMULATED_GPU_STEREO"]] + command[2:],
                          env=dict(os.environ, **environment))
        return result, folder

    def maps(self, name, workers, **environment):
        """Files and output of a run that succeeds."""
        result, folder = self.stereo(name, workers, **environment)
        self.assert_success(result)
        return tiny.snapshot(folder), result.stdout

    def test_maps_are_as_good_as_those_of_the_cpu(self):
        _, cpu_folder = self.stereo("cpu", CPU)
        result, gpu_folder = self.stereo("gpu", gpu("-1"))
        self.assert_success(result)
        self.assertIn("Computing on GPU 0 (Emulated GPU).", result.stdout)
        right = [self.share_right(folder) for folder in (cpu_folder, gpu_folder)]
        self.assertGreater(right[0], 0.4)
        # Of three thousand pixels; rounding lets other draws win, as another seed does,
        # which moves that of a single view by up to 0.2.
        self.assertGreater(right[1], right[0] - 0.1)

    def share_right(self, folder):
        """Mean over the views of the share of pixels with a depth to 1 %."""
        shares = []
        for index, name in enumerate(self.names):
            errors, count = tiny.depth_errors(folder, name, index)
            shares.append(sum(error < 0.01 for error in errors) / count)
        return sum(shares) / len(shares)

    def test_masked_pixels_have_nothing(self):
        for name in ("view%d.png" % i for i in range(3)):
            tiny.write_mask(self.path("masks", name + ".png"))
        result, folder = self.stereo("gpu", gpu("-1"), masks=self.path("masks"))
        self.assert_success(result)
        for name in self.names:
            for kind in ("depth_maps", "normal_maps"):
                width, _, values = tiny.read_map(tiny.map_path(folder, name, kind))
                columns = [any(values[column::width]) for column in range(width)]
                self.assertFalse(any(columns[:width // 2]))
                self.assertGreater(sum(columns[width // 2:]), 0.6 * width / 2)

    def test_maps_do_not_depend_on_the_number_of_workers(self):
        expected, _ = self.maps("one", gpu("0"))
        actual, output = self.maps("two", gpu("0,0"))
        self.assert_same_files(expected, actual)
        for name in self.names:
            # Photometric maps, drafts and geometric maps.
            self.assertEqual(output.count(" %s: " % name), 3, output)

    def test_views_that_need_more_memory_are_left_to_the_cpu(self):
        expected, _ = self.maps("cpu", CPU, size=64)
        # Enough for the small test, and too little for a view.
        actual, output = self.maps("little", gpu("-1"), size=64,
                                   EMULATED_GPU_MEMORY_KB="68")
        self.assert_same_files(expected, actual)
        for name in self.names:
            self.assertRegex(
                output, "View %s cannot be computed on GPU 0 "
                r"\(it takes 1 MB of GPU memory, .*\): the CPU is used for it" %
                name)

    def test_a_gpu_that_fails_leaves_the_rest_to_the_cpu(self):
        _, output = self.maps("sound", gpu("0"))
        calls = int(re.search(r"^Calls: (\d+)$", output, re.M)[1])
        for workers in "0", "0,0":
            _, output = self.maps("failing " + workers, gpu(workers),
                                  EMULATED_GPU_FAILING_CALL=str(calls // 2))
            self.assertIn("failed at view", output)
            self.assertIn("unspecified launch failure", output)
            self.assertIn("from now on the CPU is used in its place", output)
            self.assertEqual(output.count("failed at view"), 1, output)

    def test_a_gpu_that_computes_wrongly_is_not_used(self):
        expected, _ = self.maps("cpu", CPU)
        actual, output = self.maps("wrong", gpu("-1"),
                                   EMULATED_GPU_BLACK_TEXTURES="1")
        self.assert_same_files(expected, actual)
        self.assertIn("Computing on the CPU, as GPU 0 (Emulated GPU) cannot be "
                      "used: of a small test it computes", output)

        result, _ = self.stereo("named", gpu("0"), EMULATED_GPU_BLACK_TEXTURES="1")
        self.assert_one_error(result, "gpu_index names GPU 0", "use_gpu 0")


if __name__ == "__main__":
    unittest.main()
