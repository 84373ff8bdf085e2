#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Opens pages in headless Chromium: tests/render/page/browser.sh NODE WEB MODULES
# WEB: render/page/web; MODULES: its node_modules. The tests read AIMS_PAGES and others, see
# tests/render/page/CMakeLists.txt. Exit code 77: skipped.
set -euo pipefail
node=$1 web=$2 modules=$3
if ! [ -x /usr/bin/chromium ]; then
  echo "skipped: /usr/bin/chromium is not installed (Debian package chromium)"
  exit 77
fi
if ! [ -d "$modules/playwright-core" ]; then
  echo "skipped: $modules holds no playwright-core (npm did not work when this was built)"
  exit 77
fi
AIMS_PAGE_MODULES=$modules "$node" --test "$web"/test/*.test.mjs
