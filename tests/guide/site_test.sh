#!/usr/bin/env bash
# Builds the site of the guide without the live scenes, and looks for dead links. Skipped where Sphinx and its theme are missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
python=/usr/bin/python3
[ -x $python ] || python=python3
if ! $python -c 'import sphinx, furo, myst_parser' 2>/dev/null || [ ! -e /usr/share/javascript/katex ]; then
  echo "No python3-sphinx, furo, python3-myst-parser, libjs-katex: the site of the guide is left out."
  exit 77
fi
tools/build_guide.sh --text
$python tests/guide/site_test.py build/guide
