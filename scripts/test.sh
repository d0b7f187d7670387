#!/usr/bin/env bash
# Sets up and builds HV-LIOM, then runs all its tests. Ends with 'N passed, N failed'; the exit
# status is 0 only when every test passed. Arguments go to cmake; HV_TESTS and HV_TESTS_LEFT_OUT are
# regular expressions of test names.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${HV_BUILD_DIR:-$root/build}")
HV_BUILD_DIR=$build "$root/scripts/setup.sh" "$@"

export PATH="/usr/bin:$PATH"
set +u
# shellcheck disable=SC1091
source "$build/devel/setup.bash"
set -u
rm -rf "$build/test_results"
status=0
ctest --test-dir "$build" --output-on-failure --no-tests=error -j "$(nproc)" \
  -R "${HV_TESTS:-.}" -E "${HV_TESTS_LEFT_OUT:-^$}" 2>&1 |
  tee "$build/ctest.log" || status=$?

# One ctest entry is a whole test program; count the single tests from their result files. Those of
# rostest itself tell only whether a program ran.
/usr/bin/python3 - "$build/test_results" <<'PYTHON' || status=1
import pathlib
import sys
import xml.etree.ElementTree as tree

passed = failed = 0
for path in pathlib.Path(sys.argv[1]).rglob("*.xml"):
    try:
        cases = list(tree.parse(path).getroot().iter("testcase"))
    except tree.ParseError:
        print(f"{path}: broken, its test program has crashed")
        failed += 1
        continue
    for case in cases:
        bad = any(child.tag in ("failure", "error") for child in case)
        failed += bad
        passed += not bad and not path.name.startswith("rostest-")
print(f"{passed} passed, {failed} failed")
sys.exit(failed > 0 or passed == 0)
PYTHON
exit "$status"
