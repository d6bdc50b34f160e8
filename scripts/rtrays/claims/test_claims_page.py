# SPDX-License-Identifier: MIT
"""Tests the file of claims and the page of verdicts, with and without runs."""

import unittest

from rtrays.claims.claims_page import claim_row, claims_page, overview
from rtrays.claims.judge import all_counts, is_thesis, judge, judge_all, summary
from rtrays.claims.readers import READERS
from rtrays.claims.testing import Folders
from rtrays.documents.experiments import claim_sections, experiment
from rtrays.testing import made_up_run


class ClaimsPage(Folders):
    def test_every_reader_is_told_what_it_takes(self):
        for section in claim_sections():
            for claim in section["claims"]:
                for source in claim["figures"]:
                    options = {
                        key: option for key, option in source.items() if key not in ("run", "read")
                    }
                    reader = READERS[source["read"]]
                    count = reader.__code__.co_argcount
                    needed = reader.__code__.co_varnames[1 : count - len(reader.__defaults__ or ())]
                    self.assertLessEqual(set(needed), set(options), source)
                    self.assertLessEqual(
                        set(options), set(reader.__code__.co_varnames[1:count]), source
                    )

    def test_gains_are_those_of_the_experiments(self):
        rules = {
            (source["run"], source.get("of")): claim["rule"].get("gain")
            for section in claim_sections()
            for claim in section["claims"]
            for source in claim["figures"]
            if source["read"] == "gain" and "curve" not in source
        }
        for name in ("mirror_ring", "glass_goblets", "door_ajar", "floor_lamps"):
            expected = experiment(name)["expected_gain"]
            self.assertEqual(
                (rules[name, "spp"], rules[name, "seconds"]),
                (expected["samples"], expected["time"]),
                name,
            )

    def test_missing_runs_are_lines(self):
        sections = judge_all(self.folder)
        self.assertFalse(is_thesis(sections))
        claims_page(sections, self.folder).write()
        text = (self.folder / "claims/claims.md").read_text()
        self.assertNotIn("holds |", text)
        count = sum(len(section["claims"]) for section in claim_sections())
        self.assertIn(f"Of {count} claims of chapter 4, {count} are not measured.", text)
        self.assertEqual(
            summary(sections), f"Of {count} claims of chapter 4, {count} are not measured."
        )
        self.assertEqual(text.count(": not measured | not measured |"), count)
        self.assertEqual(overview(sections).columns[1:], ["not measured"])
        self.assertEqual(sum(int(row[1]) for row in overview(sections).rows), count)
        self.assertEqual(all_counts(sections), {"not measured": count})

    def test_what_was_measured_is_judged(self):
        self.write("cornell_diffuse", made_up_run())
        claim = {
            "claim": "It falls.",
            "thesis": "-1/2",
            "rule": {"within": [-0.53, -0.47]},
            "figures": [{"run": "cornell_diffuse", "read": "slopes"}],
        }
        row = claim_row(judge(claim, self.folder), self.folder)
        self.assertEqual(row[-1], "holds")
        self.assertIn("path tracing (MIS): -0.5 [-0.51, -0.49]", row[-2])
        self.assertEqual(row[0].html, "../cornell_diffuse/index.html")
        claim["figures"].append({"run": "cornell_bumps", "read": "slopes"})
        row = claim_row(judge(claim, self.folder), self.folder)
        self.assertEqual(row[-1], "holds, of what was measured")
        self.assertIn("cornell bumps: not measured", row[-2])
        claim["rule"] = {"within": [-0.45, -0.4]}
        self.assertEqual(
            claim_row(judge(claim, self.folder), self.folder)[-1],
            "does not hold here, of what was measured",
        )

    def test_undecided_claims_say_how_many_more_samples(self):
        self.write("cornell_diffuse", made_up_run())  # slopes of -0.5 [-0.51, -0.49]
        claim = {
            "claim": "It falls.",
            "thesis": "-1/2",
            "rule": {"within": [-0.505, None]},
            "figures": [{"run": "cornell_diffuse", "read": "slopes"}],
        }
        judged = judge(claim, self.folder)
        self.assertEqual(judged.verdict, "undecided")
        self.assertEqual(
            judged.verdict_text, "undecided: about 4 times as many repetitions would decide it"
        )


if __name__ == "__main__":
    unittest.main()
