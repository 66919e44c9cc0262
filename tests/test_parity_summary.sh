#!/bin/sh
# test_parity_summary.sh: the table of tests/parity_summary.sh: each row once, nothing of other tests, skipped ones told.
set -eu
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat > "$work/log" << 'END'
Start testing: Nov 29 12:00 UTC
----------------------------------------------------------
1/4 Testing: test_gl_verify
1/4 Test: test_gl_verify
Output:
----------------------------------------------------------
parity: glsl | gl 330 | llvmpipe | executed
parity: glsl | gl 450 | - | skipped: not offered by this driver
[  PASSED  ] 5 test(s).
<end of output>
Test time =   2.10 sec
----------------------------------------------------------
2/4 Testing: test_gl_verify_again
Output:
parity: glsl | gl 330 | llvmpipe | executed
Test time =   2.10 sec
3/4 Testing: test_web_parity_dawn
Output:
skipped: no node
Test time =   0.01 sec
4/4 Testing: test_locale
Output:
skipped: no locale with a decimal comma
Test time =   0.01 sec
End testing: Nov 29 12:01 UTC
END
sh "$here/parity_summary.sh" "$work/log" > "$work/found"
cat > "$work/expected" << 'END'
Shaders in this run: language, API, driver
  glsl   gl 330                     llvmpipe                           executed
  glsl   gl 450                     -                                  skipped: not offered by this driver
  test_web_parity_dawn                     skipped: no node
END
diff "$work/expected" "$work/found" || { echo "failed: another table"; exit 1; }
: > "$work/log"
sh "$here/parity_summary.sh" "$work/log" | grep -q '^  none$' || { echo "failed: an empty log"; exit 1; }
sh "$here/parity_summary.sh" "$work/missing" 2> /dev/null && { echo "failed: a missing log"; exit 1; }
echo ok
