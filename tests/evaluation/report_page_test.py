"""The report of scripts/evaluate as one file."""

import os

import page_workspace
from helpers import ProgramTest, make_record
from result_page_test import Addresses
from evaluation import evaluate, files, record
from evaluation.page import report_page
from evaluation.processes import Failure


class ReportPageTest(ProgramTest):
    main = evaluate.main

    def setUp(self):
        super().setUp()
        self.data = self.path("s")
        page_workspace.make(self.data, ["a.jpg", "b.jpg"])
        os.makedirs(os.path.join(self.data, "gt_depth"))
        self.write("s/gt_depth/a.png")

    def write_page(self, markdown):
        report_page.write(self.path("page/report.html"), markdown, [])
        return self.read("page/report.html")

    def test_pictures_are_taken_in(self):
        files.write_bytes(self.path("page/figures/a b.png"), b"picture")
        text = self.write_page("# Title\n\n![A](figures/a%20b.png)\n\n"
                               "| a | b |\n|---|---|\n| 1 | 2 |")
        self.assertEqual(Addresses(text).found, ["data:image/png;base64,cGljdHVyZQ=="])
        self.assertIn("<title>Title</title>", text)
        self.assertIn("<td>2</td>", text)

    def test_html_is_text(self):
        text = self.write_page("# <b>\n\n<img src=x>\n\nin <script>alert(1)</script> line")
        self.assertEqual(Addresses(text).found, [])
        self.assertNotIn("<b>", text)
        self.assertNotIn("<script>alert", text)

    def test_links_are_addresses_and_no_programs(self):
        text = self.write_page("# T\n\n[a](javascript:alert(1)) [b](&#106;avascript:alert(1)) "
                               "[c](data:text/html,x) [d](other.md) [e](https://x.org/?a=b&c) "
                               "[f](#part)")
        for link in ('href="other.md"', 'href="https://x.org/?a=b&amp;c"', 'href="#part"'):
            self.assertIn(link, text)
        for part in ("avascript:", "data:text"):
            self.assertNotIn(part, text)

    def test_pictures_from_elsewhere_are_not_taken_in(self):
        self.write("secret.png", "secret")
        os.makedirs(self.path("page"))
        os.symlink(self.path("secret.png"), self.path("page/link.png"))
        for address in ("../secret.png", self.path("secret.png"), "link.png",
                        "x/%2e%2e/%2e%2e/secret.png"):
            with self.assertRaisesRegex(Failure, "not beside it"):
                self.write_page(f"# T\n\n![a]({address})")
        self.assertFalse(os.path.exists(self.path("page/report.html")))

    def test_points_of_each_method(self):
        for method in ("plain", "tapa"):
            folder = self.path("out/s", method + "-0")
            record.save(folder, make_record("s", method, 0))
            page_workspace.write_cloud(os.path.join(folder, "fused.ply"), 10)
        page_workspace.write_cloud(self.path("out/s/tapa-0/fused_agreement.ply"), 20)
        words = [self.data, "--out", self.path("out"), "--report_only", "--num_views", "0"]
        self.assertIn(f"Page: {self.path('out/report.html')}\n", self.run_well(*words))
        text = self.read("out/report.html")
        self.assertIn("Points of s", text)
        for part in ('"name": "plain (fused.ply)"', '"name": "TAPA (fused_agreement.ply)"'):
            self.assertIn(part, text)

    def test_a_damaged_cloud_costs_only_the_page(self):
        record.save(self.path("out/s/plain-0"), make_record("s", "plain", 0))
        self.write("out/s/plain-0/fused.ply", "nothing")
        status, out, _ = self.run_main(self.data, "--out", self.path("out"), "--report_only",
                                       "--num_views", "0")
        self.assertEqual(status, 0)
        self.assertNotIn("Page: ", out)
        self.assertFalse(os.path.exists(self.path("out/report.html")))
        self.assertTrue(os.path.exists(self.path("out/report.md")))
