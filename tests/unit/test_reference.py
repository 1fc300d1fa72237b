"""docs/scene_reference.md is what the command prints, so that no key goes undocumented."""
import os
import subprocess
import unittest


class Reference(unittest.TestCase):
    def test_page_is_up_to_date(self):
        printed = subprocess.run([os.environ["CLAST"], "reference"], capture_output=True, text=True, timeout=60)
        self.assertEqual(printed.returncode, 0, printed.stderr)
        with open(os.path.join(os.environ["CLAST_SOURCE_DIR"], "docs", "scene_reference.md")) as file:
            kept = file.read()
        self.assertEqual(printed.stdout.splitlines(), kept.splitlines(), "run: clast reference > docs/scene_reference.md")


if __name__ == "__main__":
    unittest.main()
