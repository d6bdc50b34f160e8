# SPDX-License-Identifier: MIT
"""Tests that the stored table is that of the stored document."""

import unittest

from rtrays.documents.document import read_json
from rtrays.paths import RESULTS
from rtrays.peers.table import table


class StoredTable(unittest.TestCase):
    def test_is_made_from_the_stored_document(self):
        folder = RESULTS / "peers"
        made = table(read_json(folder / "agreement.json"))
        self.assertEqual(made, (folder / "agreement.md").read_text())


if __name__ == "__main__":
    unittest.main()
