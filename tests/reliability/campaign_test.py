"""A short campaign, and that a campaign finds what is wrong with a careless program."""

import contextlib
import io
import os
import shutil
import tempfile
import unittest

import campaign
import programs

# How often each program is tried, by scenario: 10 kills in all.
SHORT = {"kills": {"stereo": 3, "tapa": 2, "fusion": 2, "colmap_fusion": 1,
                   "automatic": 2},
         "io_errors": {"stereo": 1, "fusion": 1},
         "disks": {"stereo": 1, "fusion": 1},
         "memory": {"fusion": 1},
         "two_runs": {"stereo": 1},
         "clocks": {"fusion": 1}}


class CampaignTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="tapa-reliability-")
        self.addCleanup(shutil.rmtree, self.folder, True)

    def test_short_campaign(self):
        reports = campaign.run(SHORT, programs.all_programs(), seed=1,
                               folder=self.folder)
        for name, report in reports.items():
            self.assertEqual(report.faults, [], name)
        self.assertEqual(reports["kills"].num_trials, 10)

    def careless(self, script):
        """A program that makes the file out."""
        return programs.Program("careless", ["sh", "-c", script], os.makedirs)

    def faults_of(self, script, **counts):
        with contextlib.redirect_stdout(io.StringIO()):
            reports = campaign.run(
                {name: {"careless": count} for name, count in counts.items()},
                [self.careless(script)], seed=1, folder=self.folder)
        return "\n".join(fault for report in reports.values()
                         for fault in report.faults)

    def test_finds_files_that_are_not_whole(self):
        self.assertIn("out is there, but is another file", self.faults_of(
            "echo half > out; sleep 0.3; echo whole > out", kills=6))

    def test_finds_what_is_left_over(self):
        self.assertIn(".part is left over", self.faults_of(
            "echo half > $$.part; sleep 0.3; mv $$.part out", kills=6))

    def test_finds_a_failure_that_passes_for_a_success(self):
        if not os.path.exists(campaign.io_errors.LIBRARY):
            self.skipTest("there is no " + campaign.io_errors.LIBRARY)
        self.assertIn("out is missing", self.faults_of(
            "cp /proc/self/stat out 2>/dev/null; [ ! -e out ] || echo whole > out; exit 0",
            io_errors=2))

    def test_knows_programs_that_do_well(self):
        self.assertEqual("", self.faults_of(
            "rm -f *.part; echo whole > x.part; sleep 0.2; mv x.part out", kills=4))


if __name__ == "__main__":
    unittest.main()
